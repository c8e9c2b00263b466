// Where P(side) crosses 1/3.

import { el } from "../dom.js";
import { axisLabel, compact, decimalsFor, places } from "../format.js";
import { Table } from "../table.js";
import { section } from "./controls.js";

export function fairSection(runs) {
  const tables = runs.flatMap((run) => run.data.fair.map((fair) => table(run, fair, runs.length > 1)));
  const references = comparisons(runs);
  if (!tables.length && !references) return null;
  const none = !tables.length && el("p", {}, "P(side) does not cross 1/3 between the points of these runs.");
  return section("fair", "Fair coin: P(side) = 1/3", tables, none, references);
}

function table(run, { along, found, crossings }, named) {
  const arms = crossings.filter(({ lo, hi }) => lo !== null && hi > lo).map(({ lo, hi }) => (hi - lo) / 2);
  const decimals = arms.length ? decimalsFor(Math.min(...arms)) : 4;
  const fixed = (x) => (x === null ? "beyond the sweep" : x.toFixed(decimals));
  const others = crossings[0].at.map(([name]) => name);
  const columns = [
    ...others.map((name, n) => ({ name, title: axisLabel(name), get: (i) => crossings[i].at[n][1], show: compact })),
    { name: along, title: `fair ${along === "ratio" ? "H/R" : axisLabel(along)}`, get: (i) => crossings[i].value, show: fixed },
    { name: "lo", title: "from", get: (i) => crossings[i].lo, show: fixed },
    { name: "hi", title: "to", get: (i) => crossings[i].hi, show: fixed },
    { name: "rising", title: "P(side)", get: (i) => crossings[i].rising, show: (up) => (up ? "rises" : "falls") },
  ];
  const confidence = `${compact(100 * crossings[0].confidence)} %`;
  const title = `${named ? `${run.name}: a` : "A"}long ${axisLabel(along)}`;
  const cut = found > crossings.length ? ` The first ${crossings.length} of ${found} are listed.` : "";
  const made = new Table({ caption: title, columns, length: crossings.length, file: `fair-${along}.csv` });
  return el("div", {}, el("h3", {}, title), el("p", { class: "faint" }, `From and to: ${confidence} interval, that of the interpolation included.${cut}`), made.node);
}

function comparisons(runs) {
  const words = new Map();
  for (const { data } of runs) {
    if (data.rule) words.set(data.rule.name, data.rule.fair_ratio.toFixed(4));
    for (const { source, ratio, half_width } of data.published.fair_ratios) words.set(source, `${ratio} ± ${half_width}`);
  }
  if (!words.size) return null;
  const items = [...words].map(([source, ratio]) => el("li", {}, `${ratio}: ${source}`));
  return el("div", {}, el("h3", {}, "For comparison, fair H/R"), el("ul", {}, items));
}

/** The first fair ratio of a run in words, if it has one. */
export function fairWords(run) {
  const fair = run.data.fair.find(({ along }) => along === "ratio") ?? run.data.fair[0];
  if (!fair) return null;
  const { value, lo, hi, at } = fair.crossings[0];
  const decimals = lo !== null && hi > lo ? decimalsFor((hi - lo) / 2) : 4;
  const interval = lo === null || hi === null ? "" : ` [${lo.toFixed(decimals)}, ${hi.toFixed(decimals)}]`;
  const more = fair.found > 1 ? `, and ${fair.found - 1} more` : "";
  const name = fair.along === "ratio" ? "H/R" : axisLabel(fair.along);
  return `${name} = ${value.toFixed(decimals)}${interval}${at.length ? ` at ${places(at)}` : ""}${more}`;
}
