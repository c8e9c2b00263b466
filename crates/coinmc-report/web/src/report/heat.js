// P(face) over two axes as a map, with sliders for the others; one map for each run, on one scale.

import { el, onResize } from "../dom.js";
import { axisLabel, compact, probability } from "../format.js";
import { onTheme, styleColour } from "../palette.js";
import { axisChoice, faceChoice, heldSliders, section } from "./controls.js";
import { allAxes } from "./model.js";

// Cividis (Nuñez, Anderton & Renslow 2018): even for colour-blind readers, and in grey.
const SCALE = ["#00224e", "#123570", "#3b496c", "#575d6d", "#707173", "#8a8678", "#a59c74", "#c3b369", "#e1cc55", "#fee838"];
const LEFT = 66, BOTTOM = 46, TOP = 10, RIGHT = 12;

export function heatSection(runs) {
  const mapped = runs.filter((run) => run.isGrid && run.axes.filter(({ values }) => values.length > 1).length > 1);
  if (!mapped.length) return null;
  const axes = allAxes(mapped).filter(({ values }) => values.length > 1);
  const state = { face: "side", x: axes[0].name, y: axes[1].name, fixed: {} };
  const maps = mapped.map((run) => new HeatMap(run, mapped.length > 1));
  const controls = el("div", { class: "controls" });
  const key = el("div", { class: "scale" });
  const draw = () => {
    const cells = maps.map((map) => map.cells(state));
    const all = cells.flat().map(({ found }) => found?.p).filter((p) => p !== undefined);
    const range = [Math.min(...all), Math.max(...all)];
    maps.forEach((map, i) => map.show(cells[i], state, range));
    key.replaceChildren(...scale(range));
  };
  const build = () => {
    if (state.x === state.y) state.y = axes.find(({ name }) => name !== state.x).name;
    const others = axes.filter(({ name }) => name !== state.x && name !== state.y);
    for (const name of [state.x, state.y]) delete state.fixed[name];
    controls.replaceChildren(
      faceChoice(mapped, state.face, (face) => ((state.face = face), draw())),
      axisChoice("Across", axes, state.x, (name) => {
        if (name === state.y) state.y = state.x;
        state.x = name;
        build();
      }),
      axisChoice("Up", axes, state.y, (name) => {
        if (name === state.x) state.x = state.y;
        state.y = name;
        build();
      }),
      ...heldSliders(mapped, others, state.fixed, draw),
    );
    draw();
  };
  build();
  const note = "The heavy line divides cells below 1/3 from cells above. Arrow keys move from cell to cell. The numbers are in the table of data.";
  return section("map", "Map", controls, key, el("div", { class: "maps" }, maps.map(({ node }) => node)), el("p", { class: "faint" }, note));
}

class HeatMap {
  constructor(run, named) {
    this.run = run;
    this.at = [0, 0];
    this.canvas = el("canvas", { tabindex: 0, role: "application", onkeydown: (event) => this.key(event), onpointermove: (event) => this.point(event), onclick: (event) => this.point(event) });
    this.told = el("p", { role: "status", class: "faint" }, "\u00a0");
    this.node = el("figure", {}, named && el("figcaption", {}, run.name), el("div", { class: "plot" }, this.canvas), this.told);
    onResize(this.canvas.parentElement, () => this.draw());
    onTheme(() => this.draw());
  }

  cells({ face, x, y, fixed }) {
    const { run } = this;
    const others = Object.entries(fixed).filter(([name]) => run.columns.has(name) && run.axes.some((axis) => axis.name === name));
    return run.rows()
      .filter((row) => others.every(([name, value]) => run.value(name, row) === value))
      .map((row) => ({ x: run.value(x, row), y: run.value(y, row), found: run.face(face, row) ?? undefined }));
  }

  show(cells, state, range) {
    const values = (name) => [...new Set(cells.map((cell) => cell[name]))].sort((a, b) => a - b);
    [this.xs, this.ys] = [values("x"), values("y")];
    this.grid = new Map(cells.map((cell) => [`${this.xs.indexOf(cell.x)} ${this.ys.indexOf(cell.y)}`, cell]));
    Object.assign(this, { state, range });
    this.at = this.at.map((i, n) => Math.min(i, (n ? this.ys : this.xs).length - 1));
    const label = `P(${state.face}) over ${axisLabel(state.x)} and ${axisLabel(state.y)}, from ${compact(range[0])} to ${compact(range[1])}`;
    this.canvas.setAttribute("aria-label", label);
    this.draw();
  }

  cell(i, j) {
    return this.grid.get(`${i} ${j}`)?.found;
  }

  draw() {
    const width = this.canvas.parentElement.clientWidth;
    if (!width || !this.grid) return;
    const height = Math.round(Math.min(460, Math.max(240, 0.7 * width)));
    const scale = Math.min(2, devicePixelRatio);
    Object.assign(this.canvas, { width: width * scale, height: height * scale });
    this.canvas.style.height = `${height}px`;
    this.inner = { width: width - LEFT - RIGHT, height: height - TOP - BOTTOM };
    const context = this.canvas.getContext("2d");
    context.scale(scale, scale);
    context.font = "11px system-ui, sans-serif";
    if (!this.grid.size) return this.drawNothing(context);
    this.each((i, j, box) => this.drawCell(context, i, j, box));
    this.drawThird(context);
    this.drawAxes(context);
    if (document.activeElement === this.canvas) this.drawCursor(context);
  }

  drawNothing(context) {
    context.fillStyle = styleColour("faint");
    context.font = "14px system-ui, sans-serif";
    context.textAlign = "center";
    context.fillText("no points at these values", LEFT + this.inner.width / 2, this.inner.height / 2);
  }

  each(visit) {
    for (let i = 0; i < this.xs.length; i += 1) {
      for (let j = 0; j < this.ys.length; j += 1) visit(i, j, this.box(i, j));
    }
  }

  box(i, j) {
    const w = this.inner.width / this.xs.length, h = this.inner.height / this.ys.length;
    return [LEFT + i * w, TOP + this.inner.height - (j + 1) * h, w, h];
  }

  drawCell(context, i, j, [x, y, w, h]) {
    const found = this.cell(i, j);
    if (!found) return;
    const share = this.share(found.p);
    context.fillStyle = colour(share);
    const [left, top] = [Math.floor(x), Math.floor(y)];
    context.fillRect(left, top, Math.ceil(x + w) - left, Math.ceil(y + h) - top);
    if (w < 44 || h < 17) return;
    context.fillStyle = share > 0.55 ? "#000000" : "#ffffff";
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillText(found.p.toFixed(3), x + w / 2, y + h / 2);
  }

  share(p) {
    const [low, high] = this.range;
    return high > low ? (p - low) / (high - low) : 0.5;
  }

  /** Edges of cells between which P passes 1/3. */
  drawThird(context) {
    if (this.state.face !== "side") return;
    const above = (i, j) => {
      const found = this.cell(i, j);
      return found && found.p > 1 / 3;
    };
    context.beginPath();
    this.each((i, j, [x, y, w, h]) => {
      if (i + 1 < this.xs.length && above(i, j) !== above(i + 1, j)) {
        context.moveTo(x + w, y);
        context.lineTo(x + w, y + h);
      }
      if (j + 1 < this.ys.length && above(i, j) !== above(i, j + 1)) {
        context.moveTo(x, y);
        context.lineTo(x + w, y);
      }
    });
    for (const [width, style] of [[5, "#ffffff"], [2.5, "#000000"]]) {
      context.lineWidth = width;
      context.strokeStyle = style;
      context.stroke();
    }
  }

  drawAxes(context) {
    const { width, height } = this.inner;
    context.fillStyle = styleColour("text");
    context.font = "12px system-ui, sans-serif";
    const every = (n, room) => Math.max(1, Math.ceil(n / Math.max(1, Math.floor(room))));
    context.textAlign = "center";
    context.textBaseline = "top";
    const across = every(this.xs.length, width / 48);
    this.xs.forEach((value, i) => {
      if (i % across === 0) context.fillText(compact(value), LEFT + ((i + 0.5) * width) / this.xs.length, TOP + height + 6);
    });
    context.fillText(axisLabel(this.state.x, this.run.columns.get(this.state.x)?.unit), LEFT + width / 2, TOP + height + 26);
    context.textAlign = "right";
    context.textBaseline = "middle";
    const up = every(this.ys.length, height / 18);
    this.ys.forEach((value, j) => {
      if (j % up === 0) context.fillText(compact(value), LEFT - 6, TOP + height - ((j + 0.5) * height) / this.ys.length);
    });
    context.save();
    context.translate(12, TOP + height / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText(axisLabel(this.state.y, this.run.columns.get(this.state.y)?.unit), 0, 0);
    context.restore();
  }

  drawCursor(context) {
    const [x, y, w, h] = this.box(...this.at);
    for (const [width, style] of [[4, "#ffffff"], [2, "#000000"]]) {
      context.lineWidth = width;
      context.strokeStyle = style;
      context.strokeRect(x, y, w, h);
    }
  }

  key(event) {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!step) return;
    event.preventDefault();
    const within = (x, n) => Math.min(n - 1, Math.max(0, x));
    this.tell(within(this.at[0] + step[0], this.xs.length), within(this.at[1] + step[1], this.ys.length));
  }

  point(event) {
    const box = this.canvas.getBoundingClientRect();
    const i = Math.floor(((event.clientX - box.left - LEFT) / this.inner.width) * this.xs.length);
    const j = Math.floor((1 - (event.clientY - box.top - TOP) / this.inner.height) * this.ys.length);
    if (i >= 0 && j >= 0 && i < this.xs.length && j < this.ys.length) this.tell(i, j);
  }

  tell(i, j) {
    this.at = [i, j];
    const found = this.cell(i, j);
    const p = found ? probability(found.p, found.lo, found.hi) : "not computed";
    this.told.textContent = `${this.state.x} ${compact(this.xs[i])}, ${this.state.y} ${compact(this.ys[j])}: P(${this.state.face}) = ${p}`;
    this.draw();
  }
}

function colour(share) {
  const at = Math.min(1, Math.max(0, share)) * (SCALE.length - 1);
  const low = Math.min(SCALE.length - 2, Math.floor(at));
  const part = (n, hex) => parseInt(SCALE[hex].slice(n, n + 2), 16);
  const mixed = [1, 3, 5].map((n) => Math.round(part(n, low) + (at - low) * (part(n, low + 1) - part(n, low))));
  return `rgb(${mixed.join(" ")})`;
}

/** The key of the colours. */
function scale([low, high]) {
  const bar = el("canvas", { width: 240, height: 12, "aria-hidden": "true" });
  const context = bar.getContext("2d");
  for (let x = 0; x < 240; x += 1) {
    context.fillStyle = colour(x / 239);
    context.fillRect(x, 0, 1, 12);
  }
  return [el("span", {}, compact(low)), bar, el("span", {}, compact(high))];
}
