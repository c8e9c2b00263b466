// Choices that several plots share: the face, the axis, and what to hold.

import { choice, el, slider } from "../dom.js";
import { axisLabel, compact } from "../format.js";
import { commonValue, FACES } from "./model.js";

/** The choice of a face, of those that any run knows. */
export function faceChoice(runs, face, change) {
  const known = FACES.filter((name) => runs.some((run) => run.hasFace(name)));
  const text = (name) => ({ same: "same side as at launch", left: "left the table" })[name] ?? name;
  return choice("Face", known.map((name) => [name, text(name)]), face, change);
}

export function axisChoice(label, axes, value, change) {
  return choice(label, axes.map(({ name, unit }) => [name, axisLabel(name, unit)]), value, change);
}

/** For each axis: each of its values, or one that is held. */
export function heldChoices(axes, fixed, change) {
  return axes.map(({ name, unit, values }) => {
    const options = [["", "each value"], ...values.map((value) => [String(value), compact(value)])];
    const now = name in fixed ? String(fixed[name]) : "";
    return choice(axisLabel(name, unit), options, now, (chosen) => {
      if (chosen === "") delete fixed[name];
      else fixed[name] = Number(chosen);
      change();
    });
  });
}

/** For each axis a slider over its values. */
export function heldSliders(runs, axes, fixed, change) {
  return axes.map(({ name, unit, values }) => {
    fixed[name] ??= commonValue(runs, { name, values });
    return slider(axisLabel(name, unit), values, values.indexOf(fixed[name]), compact, (at) => {
      fixed[name] = values[at];
      change();
    });
  });
}

/** A table that hides behind a plot until it is wanted. */
export function behind(title, table) {
  return el("details", {}, el("summary", {}, title), table);
}

/** A section with its heading. */
export function section(id, title, ...children) {
  return el("section", { id, "aria-labelledby": `${id}-title` }, el("h2", { id: `${id}-title` }, title), children);
}
