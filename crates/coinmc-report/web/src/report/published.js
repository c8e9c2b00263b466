// Our P(side) beside published counts of the same launch.

import { compact, grouped, probability } from "../format.js";
import { el } from "../dom.js";
import { Table } from "../table.js";
import { section } from "./controls.js";

export function publishedSection(runs) {
  const rows = runs.flatMap((run) => run.data.published.counts.map((one) => ({ run, ...one })));
  if (!rows.length) return null;
  const text = (key) => (i) => probability(...rows[i][key]);
  const columns = [
    runs.length > 1 && { name: "run", title: "run", get: (i) => rows[i].run.name, show: String },
    { name: "point", title: "point", get: (i) => rows[i].point, show: String },
    { name: "ratio", title: "H/R", get: (i) => rows[i].ratio, show: compact },
    { name: "ours", title: "P(side), here", get: text("ours"), show: String },
    { name: "theirs", title: "published", get: text("theirs"), show: String },
    { name: "side", title: "side of tosses", get: (i) => `${grouped(rows[i].side)} of ${grouped(rows[i].tosses)}`, show: String },
    { name: "z", title: "z", doc: "Standard errors by which ours lies above.", get: (i) => rows[i].z, show: compact },
  ].filter(Boolean);
  const differs = [...new Set(rows.flatMap((row) => row.differs))];
  const caveat = "Agreement is not to be expected: Unity's 0.02 s step at 50 rad/s (1 rad) is not converged.";
  return section(
    "published",
    "Published counts",
    el("p", {}, `For this launch: ${runs[0].data.published.source}. ${caveat}`),
    differs.length > 0 && el("p", {}, `Not the published scene, it differs in: ${differs.join(", ")}.`),
    new Table({ caption: "Published counts beside these", columns, length: rows.length, file: "published.csv" }).node,
  );
}
