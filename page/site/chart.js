// The probabilities of the faces as bars with their intervals.
"use strict";
globalThis.coinmc ??= {};

/** The closed form for a coin that lands without a bounce, turning about a horizontal diameter. */
coinmc.arcRule = (ratio) => (2 / Math.PI) * Math.atan(ratio / 2);

/** A probability and its half width, to the digits that the half width leaves. */
coinmc.written = function ({ p, lo, hi }) {
  const half = (hi - lo) / 2;
  const digits = Math.min(Math.max(1 - Math.floor(Math.log10(half || 1e-6)), 2), 6);
  return `${p.toFixed(digits)} ± ${half.toFixed(digits)}`;
};

/** A whole number with thin spaces between its thousands. */
coinmc.grouped = (n) => String(Math.round(n)).replace(/\B(?=(\d{3})+$)/g, "\u2009");

/** Shows an estimate in the rows of the table; `arc` is the arc rule's P(side). */
coinmc.showFaces = function (table, faces, arc) {
  for (const [face, found] of Object.entries(faces)) {
    const row = table.querySelector(`[data-face=${face}]`);
    row.querySelector(".number").textContent = coinmc.written(found);
    row.querySelector(".limits").textContent = `${found.lo.toFixed(4)} to ${found.hi.toFixed(4)}`;
    const bar = row.querySelector(".bar");
    bar.style.setProperty("--p", found.p);
    bar.style.setProperty("--lo", found.lo);
    bar.style.setProperty("--hi", found.hi);
  }
  const bar = table.querySelector("[data-face=side] .bar");
  bar.style.setProperty("--arc", arc);
};
