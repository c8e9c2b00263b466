// P(face) along any axis, with intervals and the closed form.

import { Chart } from "../chart.js";
import { el } from "../dom.js";
import { axisLabel, compact } from "../format.js";
import { Table } from "../table.js";
import { axisChoice, behind, faceChoice, heldChoices, section } from "./controls.js";
import { allAxes, curves, firstFixed, MOST_CURVES, ofFace } from "./model.js";

export function probabilitySection(runs) {
  const axes = allAxes(runs).filter(({ values }) => values.length > 1);
  if (!axes.length) return null;
  const along = (axes.find(({ name }) => name === "ratio") ?? axes[0]).name;
  const state = { face: "side", along, fixed: firstFixed(runs, along) };
  const chart = new Chart("Probability of a face along an axis, with intervals");
  const controls = el("div", { class: "controls" });
  const note = el("p", { class: "faint" });
  const table = el("div");
  const draw = () => {
    const all = curves(runs, state.along, state.fixed);
    const shown = all.slice(0, MOST_CURVES);
    chart.show(content(runs, shown, state));
    note.textContent = words(runs, all, shown);
    table.replaceChildren(numbers(shown, state));
  };
  const build = () => {
    const others = axes.filter(({ name }) => name !== state.along && runs.some((run) => run.isGrid));
    controls.replaceChildren(
      faceChoice(runs, state.face, (face) => ((state.face = face), draw())),
      axisChoice("Along", axes, state.along, (name) => {
        Object.assign(state, { along: name, fixed: firstFixed(runs, name) });
        build();
      }),
      ...heldChoices(others, state.fixed, draw),
    );
    draw();
  };
  build();
  return section("probability", "Probability", controls, chart.node, note, behind("The numbers", table));
}

function content(runs, shown, { face, along }) {
  const series = shown.map(({ run, rows, xs, order, label }) => {
    const found = order.map((i) => run.face(face, rows[i]));
    const exact = found.every((one) => one === null || one.lo === one.hi);
    const of = (end) => found.map((one) => (one === null ? null : one[end]));
    return { label, x: order.map((i) => xs[i]), y: of("p"), ...(exact ? {} : { lo: of("lo"), hi: of("hi") }) };
  });
  series.push(...closedForms(runs, shown, face, along));
  const levels = face === "side" ? [{ label: "1/3", y: 1 / 3 }] : [];
  const unit = runs[0].columns.get(along)?.unit;
  return { series, levels, xLabel: axisLabel(along, unit), yLabel: face === "left" ? "P(left the table)" : `P(${face})` };
}

/** Along the ratio a smooth curve, else one value for each point of the curves that have different ones. */
function closedForms(runs, shown, face, along) {
  const found = new Map();
  for (const run of runs.filter(({ data }) => data.rule)) {
    const { name, curve } = run.data.rule;
    const key = along === "ratio" ? name : `${name} ${run.number}`;
    if (found.has(key) || ofFace(face, 0) === null) continue;
    if (along === "ratio" && curve.ratio.length) {
      found.set(key, { label: name, plain: true, x: curve.ratio, y: curve.p_side.map((p) => ofFace(face, p)) });
    } else if (along !== "ratio") {
      const own = shown.find((one) => one.run === run);
      if (!own) continue;
      const x = own.order.map((i) => own.xs[i]);
      const ratio = shown.length > 1 ? `, ratio ${compact(run.value("ratio", own.rows[0]))}` : "";
      found.set(key, { label: name + ratio, plain: true, x, y: own.order.map((i) => run.rule(face, own.rows[i])) });
    }
  }
  return [...found.values()];
}

function words(runs, all, shown) {
  const confidence = [...new Set(runs.map(({ data }) => `${compact(100 * data.confidence)} %`))].join(" and ");
  const hidden = all.length - shown.length;
  const rest = hidden > 0 ? ` ${hidden} more curves are not drawn: hold a parameter above.` : "";
  return `Bars are ${confidence} intervals. Lines only join the points.${rest}`;
}

function numbers(shown, { face, along }) {
  const rows = shown.flatMap((curve) => curve.order.map((i) => ({ curve, row: curve.rows[i], x: curve.xs[i] })));
  const of = (row) => rows[row].curve.run.face(face, rows[row].row);
  const number = (name, title, get) => ({ name, title, get, show: compact });
  const columns = [
    { name: "curve", title: "curve", get: (i) => rows[i].curve.label, show: String },
    number(along, axisLabel(along), (i) => rows[i].x),
    {
      name: `p_${face}`,
      title: `P(${face})`,
      get: (i) => of(i)?.p ?? null,
      show: (p) => (p === null ? "–" : p.toFixed(6)),
    },
    number("lo", "from", (i) => of(i)?.lo ?? null),
    number("hi", "to", (i) => of(i)?.hi ?? null),
    number("closed_form", "closed form", (i) => rows[i].curve.run.rule(face, rows[i].row)),
    { name: "tosses", title: "tosses", get: (i) => rows[i].curve.run.value("tosses", rows[i].row), show: String },
  ];
  return new Table({ caption: `P(${face}) along ${along}`, columns, length: rows.length, file: `p-${face}.csv` }).node;
}
