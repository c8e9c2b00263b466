// Where the numbers come from, and how to have them again.

import { copyButton, download, el } from "../dom.js";
import { compact, count, grouped } from "../format.js";
import { section } from "./controls.js";

export function provenanceSection(runs) {
  return section("provenance", "Provenance", runs.map((run) => part(run, runs.length > 1)));
}

function part(run, named) {
  const { data } = run;
  const command = "coinmc run config.toml";
  const facts = [
    ["seed", `${data.seed}${data.paired ? ", shared by all points" : ""}`],
    ["plan", data.plan_hash],
    ["program", `coinmc ${data.program_version}`],
    ["confidence of intervals", `${100 * data.confidence} %`],
    ["points", grouped(data.points)],
    ...manifest(data.manifest),
    ...(data.made_by ?? []).map((made) => ["made by", maker(made)]),
  ];
  const list = el("dl", {}, facts.flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, value)]));
  return el(
    "div",
    {},
    named && el("h3", {}, run.name),
    list,
    el("p", {}, "The same counts again: save the config below as config.toml, and"),
    el("div", { class: "controls" }, el("code", {}, command), copyButton(command, "command")),
    el(
      "details",
      {},
      el("summary", {}, "Config, with every default spelled out"),
      el(
        "div",
        { class: "controls" },
        copyButton(data.config, "config"),
        el("button", { type: "button", onclick: () => download("config.toml", "application/toml", data.config) }, "Download config.toml"),
      ),
      el("pre", { tabindex: 0 }, data.config),
    ),
  );
}

/** A build on a machine, and what it did. */
function maker(made) {
  const of = [`coinmc ${made.build}`, made.cpu, `${made.lanes} lanes`];
  const time = made.processor_s ?? made.wall_s;
  return `${of.join(", ")}: ${count(made.chunks, "chunk")}, ${compact(time)} s of ${made.processor_s === null ? "its threads" : "processor time"}`;
}

/** What else the run directory tells, whatever it is. */
function manifest(found) {
  const told = new Set(["format", "plan_hash", "program_version"]);
  const value = (x) => (Array.isArray(x) ? x.map(value).join(", ") : typeof x === "object" && x ? JSON.stringify(x) : String(x));
  return Object.entries(found ?? {}).filter(([name]) => !told.has(name)).map(([name, x]) => [name.replaceAll("_", " "), value(x)]);
}
