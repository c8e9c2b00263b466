// A map of basins: the outcome over two quantities of the launch. A pixel that is chosen shows its toss.

import { el, onResize } from "../dom.js";
import { axisLabel, compact, ticks } from "../format.js";
import { onTheme, outcomeColour, styleColour } from "../palette.js";
import { prepare, Viewer } from "./viewer.js";

const LEFT = 64, BOTTOM = 46, TOP = 8, RIGHT = 14;
const OUTCOMES = ["heads", "tails", "side", "left"];

export class BasinMap {
  constructor(map, kinds) {
    this.map = map;
    this.kinds = kinds;
    [this.x, this.y] = map.sides;
    this.at = this.first();
    this.canvas = el("canvas", {
      tabindex: 0,
      role: "application",
      "aria-label": `Outcome over ${axisLabel(this.x.name)} and ${axisLabel(this.y.name)}. Arrow keys choose a pixel, whose toss is shown below.`,
      onkeydown: (event) => this.key(event),
      onclick: (event) => this.click(event),
    });
    this.told = el("p", { role: "status" });
    this.below = el("div");
    this.node = el("div", { class: "map" }, this.legend(), el("div", { class: "plot" }, this.canvas), this.told, this.below);
    onResize(this.canvas.parentElement, () => this.draw());
    onTheme(() => this.draw());
  }

  /** The first pixel on the side, which is what people look for, or in the middle. */
  first() {
    const side = this.map.pixels.findIndex(({ outcome }) => outcome === "side");
    if (side >= 0) return side;
    const [x, y] = [this.x.pixels, this.y.pixels];
    return Math.floor(y / 2) * x + Math.floor(x / 2);
  }

  legend() {
    const shares = new Map();
    for (const { outcome } of this.map.pixels) shares.set(outcome, (shares.get(outcome) ?? 0) + 1);
    const all = this.map.pixels.length;
    const entries = [...shares].sort((a, b) => b[1] - a[1]).map(([outcome, n]) => {
      const swatch = el("span", { class: "swatch", "aria-hidden": "true" }, mark(outcome));
      swatch.style.background = outcomeColour(outcome);
      return el("span", {}, swatch, `${outcome} ${((100 * n) / all).toFixed(1)} %`);
    });
    return el("div", { class: "legend flat" }, entries);
  }

  draw() {
    const box = this.canvas.parentElement;
    const width = box.clientWidth;
    if (!width) return;
    const height = Math.round(Math.min(0.75 * width, 520));
    const scale = Math.min(2, devicePixelRatio);
    Object.assign(this.canvas, { width: width * scale, height: height * scale });
    this.canvas.style.height = `${height}px`;
    this.inner = { width: width - LEFT - RIGHT, height: height - TOP - BOTTOM };
    const context = this.canvas.getContext("2d");
    context.scale(scale, scale);
    this.map.pixels.forEach(({ outcome }, i) => {
      const [x, y, w, h] = this.box(i);
      context.fillStyle = outcomeColour(outcome);
      // whole pixels of the screen, so that no seams show
      const [left, top] = [Math.floor(x), Math.floor(y)];
      context.fillRect(left, top, Math.ceil(x + w) - left, Math.ceil(y + h) - top);
      if (outcome === "side" && w > 5 && h > 5) {
        context.fillStyle = styleColour("page");
        context.fillRect(x + w / 2 - 1, y + h / 2 - 1, 2, 2);
      }
    });
    this.axes(context);
    const [x, y, w, h] = this.box(this.at);
    context.lineWidth = 3;
    context.strokeStyle = "#ffffff";
    context.strokeRect(x - 2, y - 2, w + 4, h + 4);
    context.lineWidth = 1.5;
    context.strokeStyle = "#000000";
    context.strokeRect(x - 2, y - 2, w + 4, h + 4);
  }

  axes(context) {
    const { width, height } = this.inner;
    context.font = "12px system-ui, sans-serif";
    context.fillStyle = styleColour("text");
    const ends = (side) => [Math.min(side.from, side.to), Math.max(side.from, side.to)];
    const share = (side, value) => (value - side.from) / (side.to - side.from);
    context.textAlign = "center";
    context.textBaseline = "top";
    for (const tick of ticks(...ends(this.x), width / 80)) {
      context.fillText(compact(tick), LEFT + share(this.x, tick) * width, TOP + height + 6);
    }
    context.fillText(axisLabel(this.x.name), LEFT + width / 2, TOP + height + 25);
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const tick of ticks(...ends(this.y), height / 50)) {
      context.fillText(compact(tick), LEFT - 6, TOP + (1 - share(this.y, tick)) * height);
    }
    context.save();
    context.translate(12, TOP + height / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText(axisLabel(this.y.name), 0, 0);
    context.restore();
  }

  /** Where a pixel is drawn: left, top, width, height. */
  box(pixel) {
    const w = this.inner.width / this.x.pixels, h = this.inner.height / this.y.pixels;
    const column = pixel % this.x.pixels, row = Math.floor(pixel / this.x.pixels);
    return [LEFT + column * w, TOP + this.inner.height - (row + 1) * h, w, h];
  }

  click(event) {
    const box = this.canvas.getBoundingClientRect();
    const across = (event.clientX - box.left - LEFT) / this.inner.width;
    const up = 1 - (event.clientY - box.top - TOP) / this.inner.height;
    if (across < 0 || across >= 1 || up < 0 || up >= 1) return;
    const column = Math.floor(across * this.x.pixels), row = Math.floor(up * this.y.pixels);
    this.choose(row * this.x.pixels + column, true);
  }

  key(event) {
    const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const step = steps[event.key];
    if (!step) return;
    event.preventDefault();
    const column = (this.at % this.x.pixels) + step[0];
    const row = Math.floor(this.at / this.x.pixels) + step[1];
    if (column < 0 || column >= this.x.pixels || row < 0 || row >= this.y.pixels) return;
    this.choose(row * this.x.pixels + column, false);
  }

  /** Shows the toss of a pixel. */
  choose(pixel, autoplay) {
    this.at = pixel;
    const found = this.map.pixels[pixel];
    const value = (side, place) => side.from + ((place + 0.5) * (side.to - side.from)) / side.pixels;
    const column = pixel % this.x.pixels, row = Math.floor(pixel / this.x.pixels);
    const at = [[this.x.name, value(this.x, column)], [this.y.name, value(this.y, row)]];
    const toss = { name: "", at, scene: this.map.scene, complete: true, ...found };
    const prepared = prepare(toss, this.kinds);
    this.told.textContent = `${prepared.label}: ${found.outcome}`;
    this.viewer?.close();
    this.viewer = new Viewer([prepared], this.kinds, { autoplay });
    this.below.replaceChildren(this.viewer.node);
    this.viewer.show(0);
    this.draw();
  }
}

/** A sign for an outcome, for readers without colour. */
function mark(outcome) {
  return OUTCOMES.includes(outcome) ? outcome[0].toUpperCase() : "?";
}
