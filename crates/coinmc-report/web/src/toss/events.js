// The events of a toss as a table; each leads to its time.

import { el } from "../dom.js";
import { compact } from "../format.js";
import { turn } from "./motion.js";

/** Events listed at first: tosses that rattle have thousands. */
const SHOWN = 60;

/** The table of events. `jump` is called with a time; `kinds` names the codes. */
export function eventTable(toss, kinds, jump) {
  const { motion } = toss;
  const keys = motion.kinds.map((kind, key) => [kind, key]).filter(([kind]) => kind !== 0);
  const body = el("tbody");
  const more = el("p", { class: "faint" });
  const fill = (shown) => {
    body.replaceChildren(...shown.map(([kind, key]) => row(motion, kinds[kind], key, jump)));
  };
  fill(keys.slice(0, SHOWN));
  if (keys.length > SHOWN) {
    const all = el("button", { type: "button", onclick: () => (fill(keys), more.remove()) }, `Show all ${keys.length}`);
    more.append(`The first ${SHOWN} of ${keys.length} events. `, all);
  }
  const heads = ["time, s", "event", "height, mm", "speed, m/s", "tilt, °", "energy, J/kg"];
  return el(
    "div",
    {},
    el(
      "div",
      { class: "scroll", tabindex: 0, role: "region", "aria-label": `Events of ${toss.label}` },
      el(
        "table",
        { class: "events" },
        el("caption", { class: "hidden" }, `Events of ${toss.label}`),
        el("thead", {}, el("tr", {}, heads.map((head) => el("th", { scope: "col" }, head)))),
        body,
      ),
    ),
    more,
  );
}

function row(motion, kind, key, jump) {
  const state = motion.atKey(key);
  const time = motion.times[key];
  const up = turn(state.turn, 0, 0, 1)[2];
  const tilt = (Math.acos(Math.min(1, Math.abs(up))) * 180) / Math.PI;
  const cells = [
    1000 * motion.lowest(state)[2],
    Math.hypot(...state.velocity),
    tilt,
    motion.energy(state),
  ];
  const shown = time.toFixed(4);
  const button = el(
    "button",
    { type: "button", class: "link", onclick: () => jump(time), "aria-label": `go to ${kind} at ${shown} seconds` },
    shown,
  );
  const near = (x) => (Math.abs(x) < 1e-6 ? "0" : compact(x));
  return el(
    "tr",
    { "data-key": key },
    el("td", {}, button),
    el("th", { scope: "row" }, kind.replace("_", "-")),
    cells.map((x) => el("td", {}, near(x))),
  );
}

/** Marks the event that was last at a time. */
export function markEvent(table, motion, time) {
  const key = motion.keyAt(time);
  let found = null;
  for (const row of table.querySelectorAll("tr[data-key]")) {
    if (Number(row.dataset.key) <= key) found = row;
    else break;
  }
  if (found === table.current) return;
  table.current?.removeAttribute("aria-current");
  found?.setAttribute("aria-current", "true");
  table.current = found;
}
