// A plot of curves with intervals, drawn by uPlot; markers, dashes and intervals are our own.

import uPlot from "uplot";
import { el, onResize } from "./dom.js";
import { compact } from "./format.js";
import { curveColour, DASHES, drawMarker, MARKERS, onTheme, styleColour } from "./palette.js";

const FONT = "12px system-ui, sans-serif";

/**
 * `series`: label, x, y, and if known lo and hi, each a list; `plain` is a line without markers, `band` shows
 * its interval as an area. `levels`: label and y of horizontal lines.
 */
export class Chart {
  constructor(label) {
    this.label = label;
    this.box = el("div", { class: "chart", role: "img", "aria-label": label });
    this.legend = el("div", { class: "legend flat" });
    this.readout = el("div", { class: "chart-readout faint", "aria-hidden": "true" }, "\u00a0");
    this.node = el("div", {}, this.legend, this.box, this.readout);
    onResize(this.box, () => this.fit());
    onTheme(() => this.build());
  }

  show(content) {
    this.content = content;
    this.build();
  }

  fit() {
    const width = Math.floor(this.box.clientWidth);
    if (!width || !this.content) return;
    if (this.plot) this.plot.setSize({ width, height: this.height(width) });
    else this.build();
  }

  height(width) {
    return Math.round(Math.min(430, Math.max(240, 0.58 * width)));
  }

  build() {
    const width = Math.floor(this.box.clientWidth);
    if (!this.content || !width) return;
    const { series, levels = [] } = this.content;
    this.plot?.destroy();
    const data = joined(series);
    this.plot = new uPlot(this.options(width, data), data, this.box);
    this.legend.replaceChildren(
      ...series.map((one, n) => entry(one, n)),
      ...levels.map((level) => entry({ ...level, level: true }, 0)),
    );
  }

  options(width, data) {
    const { series, xLabel, yLabel, logX = false, yRange } = this.content;
    const axis = (label, size) => ({
      label,
      size,
      font: FONT,
      labelFont: FONT,
      labelSize: 22,
      stroke: styleColour("text"),
      grid: { stroke: styleColour("line"), width: 1 },
      ticks: { stroke: styleColour("line"), width: 1, size: 5 },
      values: (_, splits) => splits.map((x) => (x === null ? "" : compact(x))),
    });
    return {
      width,
      height: this.height(width),
      padding: [10, 16, 0, 0],
      legend: { show: false },
      cursor: { drag: { x: false, y: false }, points: { show: false }, y: false },
      scales: {
        x: { time: false, distr: logX ? 3 : 1, range: (_, a, b) => spread(a, b, logX) },
        y: { range: () => yRange ?? extent(series, this.content.levels ?? []) },
      },
      axes: [{ ...axis(xLabel, 38), ...(logX ? { splits: (_, __, a, b) => decades(a, b), filter: (_, splits) => splits } : {}) }, axis(yLabel, 58)],
      series: [
        {},
        ...series.map((one, n) => ({
          stroke: colourOf(one, n),
          width: one.width ?? 1.75,
          dash: one.plain ? [3, 3] : DASHES[n % DASHES.length],
          points: { show: false },
          spanGaps: true,
        })),
      ],
      hooks: {
        drawSeries: [(plot, n) => n > 0 && this.drawSeries(plot, series[n - 1], n - 1)],
        draw: [(plot) => this.drawLevels(plot)],
        setCursor: [(plot) => this.tell(plot, data)],
      },
    };
  }

  drawSeries(plot, one, n) {
    if (one.plain && !one.band) return;
    const context = plot.ctx;
    context.save();
    context.beginPath();
    context.rect(plot.bbox.left - 8, plot.bbox.top, plot.bbox.width + 16, plot.bbox.height);
    context.clip();
    context.strokeStyle = colourOf(one, n);
    context.fillStyle = colourOf(one, n);
    context.lineWidth = 1.5 * devicePixelRatio;
    const px = one.x.map((x) => plot.valToPos(x, "x", true));
    const py = (y) => plot.valToPos(y, "y", true);
    if (one.band) band(context, one, px, py);
    else marks(context, one, n, px, py);
    context.restore();
  }

  drawLevels(plot) {
    const context = plot.ctx;
    context.save();
    context.strokeStyle = styleColour("faint");
    context.lineWidth = devicePixelRatio;
    context.setLineDash([2 * devicePixelRatio, 4 * devicePixelRatio]);
    for (const { y } of this.content.levels ?? []) {
      const at = plot.valToPos(y, "y", true);
      if (!(at >= plot.bbox.top && at <= plot.bbox.top + plot.bbox.height)) continue;
      context.beginPath();
      context.moveTo(plot.bbox.left, at);
      context.lineTo(plot.bbox.left + plot.bbox.width, at);
      context.stroke();
    }
    context.restore();
  }

  tell(plot, data) {
    const { idx } = plot.cursor;
    if (idx === null || idx === undefined) {
      this.readout.textContent = "\u00a0";
      return;
    }
    const x = data[0][idx];
    const words = this.content.series.map((one) => {
      const at = one.x.indexOf(x);
      if (at < 0 || one.y[at] === null) return null;
      const ends = one.lo ? ` [${compact(one.lo[at])}, ${compact(one.hi[at])}]` : "";
      return `${one.label}: ${compact(one.y[at])}${ends}`;
    });
    this.readout.textContent = `${this.content.xLabel} ${compact(x)}: ${words.filter(Boolean).join("; ") || "–"}`;
  }
}

function band(context, one, px, py) {
  context.globalAlpha = 0.22;
  context.beginPath();
  px.forEach((x, i) => context[i ? "lineTo" : "moveTo"](x, py(one.hi[i])));
  for (let i = px.length - 1; i >= 0; i -= 1) context.lineTo(px[i], py(one.lo[i]));
  context.fill();
}

function marks(context, one, n, px, py) {
  // so many markers would be a wall
  const size = (px.length > 120 ? 4 : 8) * devicePixelRatio;
  px.forEach((x, i) => {
    if (one.y[i] === null) return;
    if (one.lo) {
      context.beginPath();
      context.moveTo(x, py(one.lo[i]));
      context.lineTo(x, py(one.hi[i]));
      context.stroke();
    }
    drawMarker(context, MARKERS[n % MARKERS.length], x, py(one.y[i]), size);
  });
}

/** Curves over all their x, as uPlot wants them. */
function joined(series) {
  const xs = [...new Set(series.flatMap(({ x }) => x))].sort((a, b) => a - b);
  const place = new Map(xs.map((x, i) => [x, i]));
  const columns = series.map(({ x, y }) => {
    const column = new Array(xs.length).fill(null);
    x.forEach((value, i) => (column[place.get(value)] = y[i]));
    return column;
  });
  return [xs, ...columns];
}

function spread(a, b, logarithmic) {
  if (a === null || b === null) return [0, 1];
  if (logarithmic) return a === b ? [a / 2, a * 2] : [a / 1.15, b * 1.15];
  const pad = a === b ? Math.abs(a) * 0.1 || 1 : 0.03 * (b - a);
  return [a - pad, b + pad];
}

/** 1, 2 and 5 times powers of ten. */
function decades(from, to) {
  const found = [];
  for (let ten = 10 ** Math.floor(Math.log10(from)); ten <= to; ten *= 10) {
    found.push(...[1, 2, 5].map((n) => n * ten).filter((x) => x >= from && x <= to));
  }
  return found.length > 9 ? found.filter((x) => Number.isInteger(Math.log10(x))) : found;
}

/** From 0, or a little below the least, to a little above the most. */
function extent(series, levels) {
  const all = series.flatMap(({ y, lo, hi }) => [...y, ...(lo ?? []), ...(hi ?? [])]).filter((x) => x !== null);
  const values = [...all, ...levels.map(({ y }) => y)];
  if (!values.length) return [0, 1];
  const low = Math.min(...values), high = Math.max(...values);
  const pad = 0.06 * (high - low) || 0.1 * Math.abs(high) || 1;
  return [low >= 0 && low - pad < 0.25 * high ? 0 : low - pad, high + pad];
}

const colourOf = (one, n) => (one.plain ? styleColour("faint") : curveColour(n));

/** A line of the legend, with its dash and marker. */
function entry(one, n) {
  const scale = devicePixelRatio;
  const canvas = el("canvas", { width: 34 * scale, height: 14 * scale, "aria-hidden": "true" });
  const context = canvas.getContext("2d");
  context.scale(scale, scale);
  context.strokeStyle = one.level ? styleColour("faint") : colourOf(one, n);
  context.fillStyle = context.strokeStyle;
  context.lineWidth = 1.75;
  const dash = one.level ? [2, 4] : one.plain ? [3, 3] : DASHES[n % DASHES.length];
  context.setLineDash(dash);
  context.beginPath();
  context.moveTo(0, 7);
  context.lineTo(34, 7);
  context.stroke();
  context.setLineDash([]);
  if (!one.level && !one.plain) drawMarker(context, MARKERS[n % MARKERS.length], 17, 7, 8);
  return el("span", {}, canvas, one.label);
}
