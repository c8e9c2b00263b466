// How the estimate of a point came about, chunk by chunk.

import { Chart } from "../chart.js";
import { choice, el } from "../dom.js";
import { compact, grouped } from "../format.js";
import { Table } from "../table.js";
import { behind, section } from "./controls.js";
import { pointLabel } from "./model.js";

const FACES = ["heads", "tails", "side"];

export function convergenceSection(runs) {
  const told = runs.filter(({ data }) => data.history.some(({ tosses }) => tosses.length > 1));
  if (!told.length) return null;
  const state = { run: told[0], place: 0, face: "side" };
  const chart = new Chart("The estimate of a point against the number of tosses, with its interval");
  const controls = el("div", { class: "controls" });
  const table = el("div");
  const draw = () => {
    const history = state.run.data.history[state.place];
    chart.show(content(history, state.face));
    table.replaceChildren(numbers(history, state.face));
  };
  const build = () => {
    const rows = state.run.rows();
    const rowOf = (point) => rows.find((row) => state.run.value("point", row) === point) ?? 0;
    const points = state.run.data.history.map(({ point }, i) => [String(i), `${point}: ${pointLabel(state.run, rowOf(point))}`]);
    const runChoice = choice("Run", told.map((run, i) => [String(i), run.name]), String(told.indexOf(state.run)), (i) => {
      Object.assign(state, { run: told[Number(i)], place: 0 });
      build();
    });
    controls.replaceChildren(
      ...(told.length > 1 ? [runChoice] : []),
      choice("Point", points, String(state.place), (i) => ((state.place = Number(i)), draw())),
      choice("Face", FACES.map((face) => [face, face]), state.face, (face) => ((state.face = face), draw())),
    );
    draw();
  };
  build();
  const note = "The interval that each number of tosses would have had by itself (Wilson). A run that stops at targets asks more of its last one.";
  return section("convergence", "Convergence", controls, chart.node, el("p", { class: "faint" }, note), behind("The numbers", table));
}

function content({ tosses, faces }, face) {
  const { p, lo, hi } = faces[FACES.indexOf(face)];
  const last = p[p.length - 1];
  return {
    series: [{ label: `P(${face}) so far`, x: tosses, y: p, lo, hi, band: true }],
    levels: [{ label: `at the end: ${compact(last)}`, y: last }],
    xLabel: "tosses",
    yLabel: `P(${face})`,
    logX: true,
  };
}

function numbers({ tosses, faces }, face) {
  const found = faces[FACES.indexOf(face)];
  const number = (name) => ({ name, title: name === "p" ? `P(${face})` : name, get: (i) => found[name][i], show: (x) => x.toFixed(6) });
  const columns = [{ name: "tosses", title: "tosses", get: (i) => tosses[i], show: grouped }, number("p"), number("lo"), number("hi")];
  return new Table({ caption: `P(${face}) against tosses`, columns, length: tosses.length, file: "convergence.csv" }).node;
}
