// Some tosses of the runs, to turn about.

import { el } from "../dom.js";
import { prepare, Viewer } from "../toss/viewer.js";
import { section } from "./controls.js";

export function tossesSection(runs, kinds) {
  const named = runs.length > 1;
  const all = runs.flatMap((run) =>
    run.data.samples.map((toss) => {
      const prepared = prepare(toss, kinds);
      return { ...prepared, label: named ? `${run.name}, ${prepared.label}` : prepared.label };
    }),
  );
  if (!all.length) return null;
  const chosen = new Set([0]);
  const below = el("div");
  let viewer = null;
  const show = () => {
    viewer?.close();
    const shown = all.filter((_, i) => chosen.has(i));
    if (!shown.length) return below.replaceChildren(el("p", { class: "faint" }, "Choose a toss."));
    viewer = new Viewer(shown, kinds);
    below.replaceChildren(viewer.node);
    viewer.show(0);
  };
  const boxes = all.map((toss, i) => {
    const input = el("input", {
      type: "checkbox",
      checked: chosen.has(i),
      onchange: () => {
        if (input.checked) chosen.add(i);
        else chosen.delete(i);
        show();
      },
    });
    return el("label", { class: "control" }, input, `${toss.label}: ${toss.outcome}`);
  });
  const group = el("fieldset", { class: "controls" }, el("legend", {}, "Tosses shown together"), boxes);
  // begun when it comes into view: most readers want the numbers first
  const seen = new IntersectionObserver((entries) => {
    if (!entries.some(({ isIntersecting }) => isIntersecting)) return;
    seen.disconnect();
    show();
  }, { rootMargin: "200px" });
  below.className = "viewer-place";
  seen.observe(below);
  return section("tosses", "Tosses in three dimensions", group, below);
}
