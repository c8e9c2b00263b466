// All points of the runs, as they stand in results.csv.

import { el } from "../dom.js";
import { compact, grouped } from "../format.js";
import { Table } from "../table.js";
import { section } from "./controls.js";

const SHOWN = new Set(["p_heads", "p_tails", "p_side", "p_side_lo", "p_side_hi", "p_same", "p_left", "tosses", "undecided", "stopped_by", "engine", "law"]);

export function dataSection(runs) {
  return section("data", "Data", runs.map((run) => part(run, runs.length > 1)));
}

function part(run, named) {
  const all = [...run.columns.values()].map((column) => described(run, column));
  const axes = new Set(run.data.axes.length ? run.data.axes : ["ratio"]);
  const few = all.filter(({ name }) => name === "point" || axes.has(name) || (SHOWN.has(name) && run.rows().some((row) => run.value(name, row) !== null)));
  const stem = run.name.split(/[\\/]/).filter(Boolean).pop() ?? "run";
  const table = new Table({ caption: `Points of ${run.name}`, columns: few, all, length: run.length, file: `${stem}.csv` });
  const input = el("input", { type: "checkbox", onchange: () => table.choose(input.checked ? all : few) });
  const word = run.data.thinned && el("p", { class: "warning" }, `${grouped(run.data.points)} points: this page shows ${run.data.thinned}. All are in results.csv of the run.`);
  return el("div", {}, named && el("h3", {}, run.name), word, el("div", { class: "controls" }, el("label", { class: "control" }, input, `all ${all.length} columns`)), table.node);
}

function described(run, { name, kind, unit, doc }) {
  const get = (row) => run.value(name, row) ?? null;
  const show = {
    u64: (x) => (x === null ? "–" : grouped(x)),
    f64: (x) => (name.startsWith("p_") && x !== null ? x.toFixed(6) : compact(x)),
  }[kind] ?? ((x) => (x === null ? "–" : String(x)));
  const title = unit && unit !== "1" ? `${name}, ${unit}` : name;
  return { name, title, doc: doc ?? "", get, show };
}
