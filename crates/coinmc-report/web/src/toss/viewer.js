// A toss, or several at once, to turn about: picture, clock, time line and events.

import { choice, el } from "../dom.js";
import { count, places } from "../format.js";
import { curveColour, onTheme } from "../palette.js";
import { Clock } from "./clock.js";
import { eventTable, markEvent } from "./events.js";
import { Motion } from "./motion.js";
import { Stage } from "./stage.js";
import { Timeline } from "./timeline.js";

const SPEEDS = [1, 0.5, 0.25, 0.1, 0.02];
const LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWX";

/** A toss of the page's data, ready to be shown. */
export function prepare(toss, kinds) {
  const motion = new Motion(toss.scene, toss.keys);
  const impact = kinds.indexOf("impact");
  const impacts = motion.kinds.flatMap((kind, key) => (kind === impact ? [key] : []));
  const at = places(toss.at ?? []);
  const label = [toss.name, at].filter(Boolean).join(", ");
  return { ...toss, motion, impacts, label };
}

export class Viewer {
  /** A view of prepared tosses; `autoplay` unless the reader wants less motion. */
  constructor(tosses, kinds, { autoplay = false } = {}) {
    this.tosses = tosses;
    this.kinds = kinds;
    this.duration = Math.max(...tosses.map(({ motion }) => motion.duration));
    this.clock = new Clock({
      duration: this.duration,
      impacts: strong(tosses),
      window: this.window(),
      tick: (time) => this.show(time),
      state: (playing) => this.said(playing),
    });
    this.timeline = new Timeline(tosses, this.duration, (time) => this.jump(time));
    this.node = el("div", { class: "viewer" }, this.picture(), this.controls(), this.timeline.node, this.lists());
    this.node.addEventListener("keydown", (event) => this.key(event));
    onTheme(() => this.recolour());
    this.show(0);
    // the page first, then the picture, once it stands in the page
    requestAnimationFrame(() => setTimeout(() => this.begin()));
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (autoplay && !calm) this.clock.play();
  }

  /** How far around an impact time runs slowly: about the time in which a coin topples. */
  window() {
    const { radius_m, height_m, weight_m_s2 } = this.tosses[0].scene;
    return 0.8 * Math.sqrt(Math.hypot(radius_m, height_m / 2) / Math.max(1e-3, Math.hypot(...weight_m_s2)));
  }

  picture() {
    this.canvas = el("canvas", {
      tabindex: 0,
      role: "application",
      "aria-label": `${this.tosses.map((toss) => `${toss.label}: ${toss.outcome}`).join("; ")}. In three dimensions: arrow keys turn, plus and minus zoom, Home resets, space plays.`,
    });
    this.legend = el("div", { class: "legend" }, this.tosses.map((toss, n) => this.entry(toss, n)));
    this.readout = el("div", { class: "readout", "aria-hidden": "true" });
    return el("div", { class: "stage" }, this.canvas, this.legend, this.readout);
  }

  entry(toss, n) {
    const several = this.tosses.length > 1;
    const swatch = el("span", { class: "swatch", "aria-hidden": "true" }, several ? LETTERS[n] : "");
    swatch.style.background = several ? curveColour(n) : "transparent";
    const ends = `${toss.outcome}, ${count(toss.impacts.length, "impact")}`;
    return el("div", {}, several && swatch, `${toss.label}: ${ends}`, !toss.complete && " (recorded in part)");
  }

  controls() {
    this.button = el("button", { type: "button", class: "primary", onclick: () => this.clock.toggle() }, "Play");
    this.slider = el("input", {
      type: "range",
      min: 0,
      max: 1000,
      step: 1,
      value: 0,
      "aria-label": "Time",
      oninput: () => this.jump((this.slider.value / 1000) * this.duration),
    });
    const speeds = SPEEDS.map((speed) => [String(speed), speed === 1 ? "real time" : `1/${1 / speed}`]);
    const checkbox = (text, checked, change) => {
      const input = el("input", { type: "checkbox", checked, onchange: () => change(input.checked) });
      return el("label", { class: "control" }, input, text);
    };
    const reset = () => this.stage?.orbit.reset();
    return el(
      "div",
      { class: "controls" },
      el("div", { class: "scrub" }, this.button, this.slider),
      choice("Speed", speeds, "1", (value) => (this.clock.speed = Number(value))),
      checkbox("slower around impacts", true, (on) => (this.clock.slows = on)),
      checkbox("follow the coin", true, (on) => this.follow(on)),
      el("button", { type: "button", onclick: reset }, "Reset view"),
    );
  }

  lists() {
    this.tables = this.tosses.map((toss) => eventTable(toss, this.kinds, (time) => this.jump(time)));
    return this.tables.map((table, n) =>
      el(
        "details",
        { open: this.tosses.length === 1 },
        el("summary", {}, `Events${this.tosses.length > 1 ? ` of ${LETTERS[n]}: ${this.tosses[n].label}` : ""}`),
        table,
      ),
    );
  }

  jump(time) {
    this.clock.pause();
    this.clock.set(time);
  }

  follow(on) {
    if (!this.stage) return;
    this.stage.follows = on;
    this.show(this.clock.time);
  }

  said(playing) {
    this.button.textContent = playing ? "Pause" : "Play";
  }

  key(event) {
    const typed = ["INPUT", "SELECT", "BUTTON", "SUMMARY"].includes(event.target.tagName);
    if (event.key !== " " || typed) return;
    event.preventDefault();
    this.clock.toggle();
  }

  /** Shows the tosses at a time. */
  show(time) {
    this.stage?.show(time);
    this.timeline.show(time);
    this.slider.value = this.duration > 0 ? Math.round((1000 * time) / this.duration) : 0;
    this.slider.setAttribute("aria-valuetext", `${time.toFixed(3)} seconds`);
    this.readout.textContent = `${time.toFixed(3)} s`;
    this.tables.forEach((table, n) => markEvent(table, this.tosses[n].motion, time));
  }

  begin() {
    if (!this.canvas.isConnected) return;
    try {
      this.stage = new Stage(this.canvas, this.tosses);
      this.stage.show(this.clock.time);
    } catch {
      const sorry = "This browser draws no three-dimensional pictures (WebGL): the time line and the events are below.";
      this.canvas.replaceWith(el("p", { class: "sorry" }, sorry));
    }
  }

  recolour() {
    this.stage?.recolour(this.clock.time);
    this.timeline.resize();
    this.legend.replaceChildren(...this.tosses.map((toss, n) => this.entry(toss, n)));
  }

  /** Stops what runs, before the view is taken from the page. */
  close() {
    this.clock.pause();
    this.stage?.gl.getExtension("WEBGL_lose_context")?.loseContext();
  }
}

/** Times of impacts of some strength: rattling would slow down the rest for ever. */
function strong(tosses) {
  const times = tosses.flatMap(({ motion, impacts }) => {
    const speeds = impacts.map((key) => approach(motion, key));
    const most = Math.max(...speeds, 0);
    return impacts.filter((_, i) => speeds[i] > 0.08 * most).map((key) => motion.times[key]);
  });
  return times.sort((a, b) => a - b);
}

/** How much of its velocity the coin changed. */
function approach(motion, key) {
  if (key === 0) return 0;
  const before = motion.part(key - 1, 7, 3), after = motion.part(key, 7, 3);
  return Math.hypot(...after.map((x, i) => x - before[i]));
}
