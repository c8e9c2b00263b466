// Runs, their columns and axes, and the curves that their points make.

import { compact, places } from "../format.js";

export const FACES = ["side", "heads", "tails", "same", "left"];

export class Run {
  constructor(data, number) {
    this.data = data;
    this.number = number;
    this.columns = new Map(data.columns.map((column) => [column.name, column]));
    this.length = Math.max(0, ...data.columns.map(({ values }) => values?.length ?? 0), data.columns.length ? 1 : 0);
    this.axes = data.axes.map((name) => this.axis(name));
    this.isGrid = this.axes.reduce((n, axis) => n * axis.values.length, 1) === this.length;
  }

  get name() {
    return this.data.name;
  }

  value(name, row) {
    const column = this.columns.get(name);
    if (!column) return null;
    return column.values ? column.values[row] : column.all;
  }

  rows() {
    return Array.from({ length: this.length }, (_, row) => row);
  }

  axis(name) {
    const found = new Set(this.rows().map((row) => this.value(name, row)));
    const values = [...found].filter((x) => x !== null).sort((a, b) => a - b);
    return { name, unit: this.columns.get(name)?.unit, values };
  }

  /** P(face) at a row with its interval; null where it is not known. */
  face(face, row) {
    const p = this.value(`p_${face}`, row);
    if (p === null) return null;
    return { p, lo: this.value(`p_${face}_lo`, row), hi: this.value(`p_${face}_hi`, row) };
  }

  hasFace(face) {
    return this.rows().some((row) => this.value(`p_${face}`, row) !== null);
  }

  /** The closed form for a face at a row. */
  rule(face, row) {
    const side = this.data.rule?.rows[row];
    return side === null || side === undefined ? null : ofFace(face, side);
  }
}

/** From P(side) of a closed form, which treats heads and tails alike, to that of a face. */
export function ofFace(face, side) {
  if (face === "side") return side;
  return face === "heads" || face === "tails" ? (1 - side) / 2 : null;
}

/** Every axis of any of the runs, once. */
export function allAxes(runs) {
  const axes = new Map();
  for (const axis of runs.flatMap((run) => run.axes)) {
    const values = new Set([...(axes.get(axis.name)?.values ?? []), ...axis.values]);
    axes.set(axis.name, { ...axis, values: [...values].sort((a, b) => a - b) });
  }
  return [...axes.values()];
}

/**
 * The rows of runs as curves along an axis: one for each run and each combination of the other axes, of which
 * `fixed` (name to value) leaves only those with that value.
 */
export function curves(runs, along, fixed) {
  const found = new Map();
  for (const run of runs) {
    const others = run.axes.filter(({ name }) => name !== along && run.isGrid);
    for (const row of run.rows()) {
      const x = run.value(along, row);
      if (x === null) continue;
      const at = others.map(({ name }) => [name, run.value(name, row)]);
      if (at.some(([name, value]) => name in fixed && fixed[name] !== value)) continue;
      const key = JSON.stringify([run.number, at]);
      if (!found.has(key)) found.set(key, { run, at, rows: [], xs: [] });
      found.get(key).rows.push(row);
      found.get(key).xs.push(x);
    }
  }
  const all = [...found.values()];
  for (const curve of all) {
    curve.order = curve.xs.map((_, i) => i).sort((a, b) => curve.xs[a] - curve.xs[b]);
    curve.label = label(curve, runs.length > 1, fixed);
  }
  return all;
}

function label({ run, at }, named, fixed) {
  const free = at.filter(([name]) => !(name in fixed));
  const words = [named && run.name, free.length && places(free)].filter(Boolean);
  return words.join(": ") || run.value("engine", 0) || run.name;
}

/** `3: ratio 1.5, restitution 0.3`: a point in words. */
export function pointLabel(run, row) {
  const at = run.axes.map(({ name }) => [name, run.value(name, row)]);
  return at.length ? places(at) : `ratio ${compact(run.value("ratio", row))}`;
}

/** Most curves of a plot. */
export const MOST_CURVES = 8;

/** A value of an axis to hold at first: in the middle of those that most runs have. */
export function commonValue(runs, { name, values }) {
  const having = (value) => runs.filter((run) => run.axes.some((axis) => axis.name === name && axis.values.includes(value))).length;
  const most = Math.max(...values.map(having));
  const common = values.filter((value) => having(value) === most);
  return common[Math.floor((common.length - 1) / 2)];
}

/** Values to fix at first, so that a plot along an axis has few enough curves. */
export function firstFixed(runs, along) {
  const fixed = {};
  const axes = allAxes(runs).filter(({ name }) => name !== along);
  const gridded = runs.some((run) => run.isGrid);
  let number = runs.length * axes.reduce((n, axis) => n * axis.values.length, 1);
  for (const axis of [...axes].sort((a, b) => b.values.length - a.values.length)) {
    if (number <= MOST_CURVES || !gridded) break;
    fixed[axis.name] = commonValue(runs, axis);
    number /= axis.values.length;
  }
  return fixed;
}
