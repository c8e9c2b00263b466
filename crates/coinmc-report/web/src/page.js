// What every page has: its data, its head, and the switch between light and dark.

import { el } from "./dom.js";
import { toggleTheme } from "./palette.js";

/** The data of the page. */
export function pageData() {
  return JSON.parse(document.getElementById("data").textContent);
}

/** The head of a page: title, words below it, and the switch. */
export function head(title, ...words) {
  return el(
    "header",
    {},
    el("div", { class: "bar" }, el("h1", {}, title), el("button", { type: "button", onclick: toggleTheme }, "Light or dark")),
    words.filter(Boolean).map((word) => el("p", { class: "lead" }, word)),
  );
}

/** The config of the tosses, and where they come from. */
export function configBelow(data) {
  return el(
    "details",
    {},
    el("summary", {}, data.configs.length > 1 ? "Configs" : "Config"),
    el("p", { class: "faint" }, `Tossed by coinmc ${data.program}. The same config repeats these tosses, bit by bit.`),
    data.configs.map((config) => el("pre", { tabindex: 0 }, config)),
  );
}
