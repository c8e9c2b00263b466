// What the answers took.

import { Chart } from "../chart.js";
import { choice, el } from "../dom.js";
import { axisLabel, compact, count, grouped } from "../format.js";
import { axisChoice, section } from "./controls.js";
import { allAxes, curves, firstFixed, MOST_CURVES } from "./model.js";

const MEASURES = [
  ["tosses", "tosses of a point"],
  ["impacts_per_toss", "impacts of a toss"],
  ["contact_steps_per_toss", "steps in contact of a toss"],
  ["rel_error_side", "relative error of P(side)"],
  ["evaluations", "evaluations of an integral"],
];

export function costSection(runs) {
  const totals = el("ul", {}, runs.map((run) => el("li", {}, total(run, runs.length > 1))));
  const axes = allAxes(runs).filter(({ values }) => values.length > 1);
  const known = MEASURES.filter(([name]) => runs.some((run) => run.rows().some((row) => run.value(name, row) > 0)));
  if (!axes.length || !known.length) return section("cost", "Cost", totals);
  const along = (axes.find(({ name }) => name === "ratio") ?? axes[0]).name;
  const first = known.find(([name]) => name === "impacts_per_toss") ?? known[0];
  const state = { measure: first[0], along };
  const chart = new Chart("What the points took, along an axis");
  const draw = () => {
    const shown = curves(runs, state.along, firstFixed(runs, state.along)).slice(0, MOST_CURVES);
    const series = shown.map(({ run, rows, xs, order, label }) => ({
      label,
      x: order.map((i) => xs[i]),
      y: order.map((i) => run.value(state.measure, rows[i])),
    }));
    const yLabel = known.find(([name]) => name === state.measure)[1];
    chart.show({ series, xLabel: axisLabel(state.along, runs[0].columns.get(state.along)?.unit), yLabel });
  };
  const controls = el(
    "div",
    { class: "controls" },
    choice("Show", known, state.measure, (name) => ((state.measure = name), draw())),
    axisChoice("Along", axes, state.along, (name) => ((state.along = name), draw())),
  );
  draw();
  return section("cost", "Cost", totals, controls, chart.node);
}

function total(run, named) {
  const sum = (name) => run.rows().reduce((all, row) => all + (run.value(name, row) ?? 0), 0);
  const impacts = run.rows().reduce((all, row) => all + (run.value("impacts_per_toss", row) ?? 0) * run.value("tosses", row), 0);
  const words = [`${grouped(run.data.tosses)} tosses`];
  if (impacts > 0) words.push(`${compact(impacts / sum("tosses"))} impacts a toss on average`);
  if (sum("pilot_tosses") > 0) words.push(`${grouped(sum("pilot_tosses"))} tosses of pilots, not counted`);
  if (sum("evaluations") > 0) words.push(count(sum("evaluations"), "evaluation"));
  return (named ? `${run.name}: ` : "") + words.join(", ");
}
