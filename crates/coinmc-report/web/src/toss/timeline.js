// Energy and height of the lowest point over time, with the events and the time shown; one may pull it.

import { el, onResize } from "../dom.js";
import { compact, ticks } from "../format.js";
import { FLIGHT } from "./motion.js";
import { curveColour, DASHES, styleColour } from "../palette.js";

const LEFT = 62, RIGHT = 10, GAP = 20, ROW = 84, AXIS = 26, TOP = 8;
/** Points of a curve. */
const SAMPLES = 600;

export class Timeline {
  /** `set` is called with the time that the reader pulls it to. */
  constructor(tosses, duration, set) {
    this.tosses = tosses;
    this.duration = duration;
    this.set = set;
    this.time = 0;
    this.rows = [
      { title: "energy, J/kg", curves: tosses.map((toss) => curve(toss.motion, energyOf)) },
      { title: "height, mm", curves: tosses.map((toss) => curve(toss.motion, heightOf)) },
    ];
    this.canvas = el("canvas", {
      role: "img",
      "aria-label":
        "Energy and height of the lowest point over time. The slider below moves the time; the table of events has the numbers.",
    });
    this.height = TOP + this.rows.length * (ROW + GAP) - GAP + AXIS;
    this.node = el("div", { class: "timeline" }, this.canvas);
    this.canvas.style.height = `${this.height}px`;
    const pull = (event) => event.buttons && this.pull(event);
    this.canvas.addEventListener("pointerdown", (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      pull(event);
    });
    this.canvas.addEventListener("pointermove", pull);
    onResize(this.node, () => this.resize());
  }

  pull(event) {
    const x = event.clientX - this.canvas.getBoundingClientRect().left;
    const share = (x - LEFT) / (this.canvas.clientWidth - LEFT - RIGHT);
    this.set(share * this.duration);
  }

  show(time) {
    this.time = time;
    this.draw();
  }

  resize() {
    const scale = Math.min(2, devicePixelRatio);
    const width = this.node.clientWidth;
    if (!width) return;
    this.canvas.width = width * scale;
    this.canvas.height = this.height * scale;
    this.still = null;
    this.draw();
  }

  /** The curves are drawn once, onto a picture of their own; only the hand of the clock moves. */
  draw() {
    if (!this.canvas.width) return;
    this.still ??= this.drawn();
    const scale = Math.min(2, devicePixelRatio);
    const context = this.canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    context.drawImage(this.still, 0, 0);
    context.scale(scale, scale);
    const x = this.x(this.time);
    context.strokeStyle = styleColour("text");
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(x, TOP - 4);
    context.lineTo(x, this.height - AXIS + 4);
    context.stroke();
  }

  x(time) {
    const width = this.canvas.clientWidth - LEFT - RIGHT;
    return LEFT + (this.duration > 0 ? time / this.duration : 0) * width;
  }

  drawn() {
    const scale = Math.min(2, devicePixelRatio);
    const still = el("canvas", { width: this.canvas.width, height: this.canvas.height });
    const context = still.getContext("2d");
    context.scale(scale, scale);
    context.font = "12px system-ui, sans-serif";
    this.rows.forEach((row, n) => this.drawRow(context, row, TOP + n * (ROW + GAP)));
    this.drawEvents(context);
    this.drawAxis(context);
    return still;
  }

  drawRow(context, { title, curves }, top) {
    const all = curves.flatMap(({ values }) => values);
    const most = Math.max(...all, 1e-12);
    const y = (value) => top + ROW - (Math.max(0, value) / most) * (ROW - 14);
    context.fillStyle = styleColour("faint");
    context.strokeStyle = styleColour("line");
    context.lineWidth = 1;
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const tick of ticks(0, most, 3)) {
      context.beginPath();
      context.moveTo(LEFT, y(tick));
      context.lineTo(this.canvas.clientWidth - RIGHT, y(tick));
      context.stroke();
      context.fillText(compact(tick), LEFT - 6, y(tick));
    }
    context.textAlign = "left";
    context.fillStyle = styleColour("text");
    context.fillText(title, LEFT + 4, top + 5);
    curves.forEach(({ times, values }, n) => {
      context.strokeStyle = curves.length > 1 ? curveColour(n) : styleColour("accent");
      context.setLineDash(DASHES[n % DASHES.length]);
      context.lineWidth = 1.6;
      context.beginPath();
      times.forEach((t, i) => context[i ? "lineTo" : "moveTo"](this.x(t), y(values[i])));
      context.stroke();
    });
    context.setLineDash([]);
  }

  drawEvents(context) {
    const base = this.height - AXIS;
    this.tosses.forEach(({ motion, impacts }, n) => {
      context.strokeStyle = this.tosses.length > 1 ? curveColour(n) : styleColour("accent");
      context.lineWidth = 1;
      context.beginPath();
      for (const key of impacts) {
        const x = this.x(motion.times[key]);
        context.moveTo(x, base - 1);
        context.lineTo(x, base + 5);
      }
      context.stroke();
    });
  }

  drawAxis(context) {
    const base = this.height - AXIS;
    context.fillStyle = styleColour("faint");
    context.textBaseline = "top";
    context.textAlign = "center";
    const width = this.canvas.clientWidth - LEFT - RIGHT;
    for (const tick of ticks(0, this.duration, Math.max(2, Math.floor(width / 90)))) {
      const text = tick === 0 ? "0 s" : `${compact(tick)} s`;
      context.fillText(text, Math.min(this.x(tick), this.canvas.clientWidth - 22), base + 8);
    }
  }
}

const energyOf = (motion, state) => motion.energy(state);
const heightOf = (motion, state) => 1000 * motion.lowest(state)[2];

/** A curve that has both values at a jump. */
function curve(motion, of) {
  const times = [], values = [];
  const put = (t, state) => {
    times.push(t);
    values.push(of(motion, state));
  };
  const keys = motion.times.length;
  const every = Math.max(1, Math.floor(keys / (2 * SAMPLES)));
  for (let key = 0; key < keys; key += 1) {
    if (key % every && motion.kinds[key] === 0) continue;
    put(motion.times[key], motion.atKey(key));
    if (key + 1 === keys) break;
    const [from, to] = [motion.times[key], motion.times[key + 1]];
    const steps = motion.modes[key] === FLIGHT ? Math.ceil((SAMPLES * (to - from)) / motion.duration) : 1;
    for (let i = 1; i < steps; i += 1) {
      const t = from + ((to - from) * i) / steps;
      put(t, motion.at(t));
    }
  }
  return { times, values };
}
