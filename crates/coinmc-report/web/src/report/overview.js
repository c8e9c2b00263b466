// Each run in a few lines, side by side.

import { el } from "../dom.js";
import { compact, count, grouped, probability } from "../format.js";
import { fairWords } from "./fair.js";

const STATUS = {
  complete: "finished",
  part: "a part of a run: merge the parts for the whole",
  short_of_target: "finished, but some points stopped short of their targets",
};

export function overview(runs) {
  return el("div", { class: "cards" }, runs.map(card));
}

function card(run) {
  const { data } = run;
  const isOpen = data.status === "interrupted";
  const status = isOpen
    ? `Unfinished: ${grouped(data.points_done)} of ${count(data.points, "point")} done. Run the same command again to go on.`
    : STATUS[data.status];
  const distinct = (name) => [...new Set(run.rows().map((row) => run.value(name, row)))].join(", ");
  const tosses = data.tosses > 0 ? `, ${grouped(data.tosses)} tosses` : "";
  const facts = [
    ["engine", `${distinct("engine")}, ${distinct("law")}`],
    ["points", count(data.points, "point") + tosses],
    ["fair coin", fairWords(run)],
    ["longest arm of an interval", arm(run)],
    ...(run.length === 1 ? ["heads", "tails", "side"].map((face) => [`P(${face})`, face1(run, face)]) : []),
  ].filter(([, value]) => value);
  return el(
    "div",
    { class: "card" },
    el("h2", {}, run.name),
    el("p", { class: isOpen || data.status === "short_of_target" ? "warning" : "faint", role: isOpen ? "status" : null }, status),
    data.thinned && el("p", { class: "warning" }, `${grouped(data.points)} points are too many for a page: it shows ${data.thinned}.`),
    el("dl", {}, facts.flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, value)])),
  );
}

function face1(run, face) {
  const found = run.face(face, 0);
  return found ? probability(found.p, found.lo, found.hi) : null;
}

function arm(run) {
  const arms = run.rows().flatMap((row) => ["heads", "tails", "side"].map((face) => {
    const found = run.face(face, row);
    return found ? (found.hi - found.lo) / 2 : 0;
  }));
  const most = arms.reduce((a, b) => Math.max(a, b), 0);
  return most > 0 ? `±${compact(most)} (${compact(100 * run.data.confidence)} %)` : "none: exact";
}
