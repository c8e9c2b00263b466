// How the tosses ended, as bars along an axis.

import { el, svg } from "../dom.js";
import { axisLabel, compact, grouped } from "../format.js";
import { curveColour, onTheme, outcomeColour } from "../palette.js";
import { Table } from "../table.js";
import { axisChoice, behind, section } from "./controls.js";

// Counts that add up to all tosses: name of the column, words, and the pattern of the bar.
const PARTS = [
  ["heads", "heads", "solid", 0],
  ["tails", "tails", "lines", 1],
  ["side_rested", "side: rested", "solid", 2],
  ["side_rolled", "side: rolled", "lines", 2],
  ["side_spun", "side: spun", "dots", 2],
  ["side", "side", "solid", 2],
  ["left", "left the table", "dots", 3],
  ["time_limit", "undecided: limit of time", "lines", null],
  ["never_settles", "undecided: forever", "solid", null],
  ["impact_limit", "undecided: limit of impacts", "dots", null],
  ["failed", "undecided: failed", "cross", null],
];

export function endingsSection(runs) {
  const tossed = runs.filter((run) => run.rows().some((row) => run.value("tosses", row) > 0));
  if (!tossed.length) return null;
  return section("endings", "How tosses ended", tossed.map((run) => part(run, tossed.length > 1)));
}

function part(run, named) {
  const axes = run.axes.filter(({ values }) => values.length > 1);
  const state = { along: (axes.find(({ name }) => name === "ratio") ?? axes[0])?.name };
  const bars = el("div");
  const table = el("div");
  const controls = el("div", { class: "controls" });
  const draw = () => {
    const groups = grouping(run, state.along);
    const shown = PARTS.filter(([name]) => groups.some(({ counts }) => counts[name] > 0));
    bars.replaceChildren(legend(shown), chart(groups, shown, state.along));
    table.replaceChildren(numbers(groups, shown, state.along));
  };
  if (axes.length > 1) controls.append(axisChoice("Along", axes, state.along, (name) => ((state.along = name), draw())));
  draw();
  onTheme(draw);
  const summed = axes.length > 1 && el("p", { class: "faint" }, "All points with the same value are counted together.");
  return el("div", {}, named && el("h3", {}, run.name), controls, bars, summed, behind("The numbers", table));
}

/** Counts for each value of an axis, or of all. */
function grouping(run, along) {
  const groups = new Map();
  for (const row of run.rows()) {
    const value = along ? run.value(along, row) : "all";
    if (!groups.has(value)) groups.set(value, { value, tosses: 0, counts: {} });
    const group = groups.get(value);
    group.tosses += run.value("tosses", row);
    const known = ["side_rested", "side_rolled", "side_spun"].some((name) => run.value(name, row) > 0);
    for (const [name] of PARTS) {
      // the side is told by how the coin came there, where that is known
      const counts = name === "side" ? !known : !name.startsWith("side_") || known;
      if (counts) group.counts[name] = (group.counts[name] ?? 0) + (run.value(name, row) ?? 0);
    }
  }
  return [...groups.values()].sort((a, b) => a.value - b.value);
}

const colourOf = (n) => (n === null ? outcomeColour("undecided") : curveColour(n));

/** A bar of a pattern, in SVG. */
function pattern(id, kind, colour) {
  const shapes = {
    solid: [],
    lines: [svg("path", { d: "M-1 1 l2 -2 M0 6 l6 -6 M5 7 l2 -2", stroke: "#ffffff", "stroke-width": 1.4 })],
    dots: [svg("circle", { cx: 3, cy: 3, r: 1.3, fill: "#ffffff" })],
    cross: [svg("path", { d: "M0 0 l6 6 M6 0 l-6 6", stroke: "#ffffff", "stroke-width": 1 })],
  }[kind];
  return svg("pattern", { id, width: 6, height: 6, patternUnits: "userSpaceOnUse" }, svg("rect", { width: 6, height: 6, fill: colour }), shapes);
}

const patternId = (name) => `pattern-${name}`;

function patterns(shown) {
  return svg("defs", {}, shown.map(([name, , kind, colour]) => pattern(patternId(name), kind, colourOf(colour))));
}

function legend(shown) {
  const entries = shown.map(([name, words, , ]) => {
    const swatch = svg("svg", { width: 16, height: 12, "aria-hidden": "true" }, svg("rect", { width: 16, height: 12, fill: `url(#${patternId(name)})` }));
    return el("span", {}, swatch, words);
  });
  return el("div", { class: "legend flat" }, entries);
}

/** Most bars of the picture; the table has them all. */
const MOST = 40;

function chart(groups, shown, along) {
  const every = Math.ceil(groups.length / MOST);
  const rows = groups.filter((_, i) => i % every === 0);
  const height = 18;
  const bars = rows.map(({ value, tosses, counts }, i) => {
    let x = 0;
    const parts = shown.map(([name, words]) => {
      const width = tosses > 0 ? (100 * (counts[name] ?? 0)) / tosses : 0;
      const title = svg("title", {}, `${words}: ${grouped(counts[name] ?? 0)} of ${grouped(tosses)}`);
      const bar = svg("rect", { x: `${x}%`, y: 0, width: `${width}%`, height: height - 3, fill: `url(#${patternId(name)})` }, title);
      x += width;
      return bar;
    });
    const label = along ? compact(value) : "all";
    return el("div", { class: "bar-row" }, el("span", { class: "bar-label" }, label), svg("svg", { width: "100%", height, role: "img", "aria-label": `${label}: see the numbers` }, i === 0 && patterns(shown), parts));
  });
  const title = along ? axisLabel(along) : "all tosses";
  const thinned = every > 1 && el("p", { class: "faint" }, `Every ${every}. value is drawn; the table has all.`);
  return el("div", { class: "bars" }, el("div", { class: "faint" }, title), bars, thinned);
}

function numbers(groups, shown, along) {
  const share = (name) => (i) => (groups[i].tosses ? (groups[i].counts[name] ?? 0) / groups[i].tosses : null);
  const columns = [
    along && { name: along, title: axisLabel(along), get: (i) => groups[i].value, show: compact },
    { name: "tosses", title: "tosses", get: (i) => groups[i].tosses, show: grouped },
    ...shown.flatMap(([name, words]) => [
      { name, title: words, get: (i) => groups[i].counts[name] ?? 0, show: grouped },
      { name: `share_${name}`, title: "share", get: share(name), show: (p) => (p === null ? "–" : `${(100 * p).toFixed(2)} %`) },
    ]),
  ].filter(Boolean);
  return new Table({ caption: "How tosses ended", columns, length: groups.length, file: "endings.csv" }).node;
}
