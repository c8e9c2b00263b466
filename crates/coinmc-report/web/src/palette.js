// Colours after Okabe & Ito, which colour-blind readers can tell apart; markers and dashes, so that nobody
// has to. Darker pages get the lighter of each pair.

const PAIRS = [
  ["#0072b2", "#56a8e0"],
  ["#b84e00", "#f08a3c"],
  ["#00805c", "#2fc79a"],
  ["#a3467a", "#e09fc4"],
  ["#8a6100", "#e6b93c"],
  ["#1b7f9e", "#7fd0ea"],
  ["#555555", "#bbbbbb"],
  ["#4b3fa0", "#a59bef"],
];

export const MARKERS = ["circle", "square", "triangle", "diamond", "down", "plus", "cross", "ring"];
export const DASHES = [[], [7, 3], [2, 3], [9, 3, 2, 3], [12, 4], [4, 2], [1, 2], [6, 2, 1, 2, 1, 2]];

const FACES = { heads: 0, tails: 1, side: 2, left: 3 };

export function isDark() {
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
}

/** The colour of the curve of this number. */
export function curveColour(n) {
  return PAIRS[n % PAIRS.length][isDark() ? 1 : 0];
}

/** The colour of a face or another outcome. */
export function outcomeColour(name) {
  if (name in FACES) return curveColour(FACES[name]);
  return isDark() ? "#8a8a86" : "#85857f";
}

/** A colour of the page's style by the name of its variable. */
export function styleColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Calls back whenever the page turns light or dark. */
export function onTheme(callback) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", callback);
  document.addEventListener("coinmc-theme", callback);
}

/** Turns the page light or dark. */
export function toggleTheme() {
  document.documentElement.dataset.theme = isDark() ? "light" : "dark";
  document.dispatchEvent(new Event("coinmc-theme"));
}

/** Draws a marker around a point. */
export function drawMarker(context, marker, x, y, size) {
  const r = size / 2;
  context.beginPath();
  if (marker === "circle" || marker === "ring") context.arc(x, y, r, 0, 7);
  else if (marker === "square") context.rect(x - r * 0.9, y - r * 0.9, r * 1.8, r * 1.8);
  else if (marker === "plus" || marker === "cross") crossed(context, marker, x, y, r);
  else {
    const corners = {
      triangle: [[0, -1.15], [1.05, 0.8], [-1.05, 0.8]],
      down: [[0, 1.15], [1.05, -0.8], [-1.05, -0.8]],
      diamond: [[0, -1.25], [1.1, 0], [0, 1.25], [-1.1, 0]],
    }[marker];
    corners.forEach(([a, b], i) => context[i ? "lineTo" : "moveTo"](x + a * r, y + b * r));
    context.closePath();
  }
  if (marker === "plus" || marker === "cross" || marker === "ring") context.stroke();
  else context.fill();
}

function crossed(context, marker, x, y, r) {
  const [a, b] = marker === "plus" ? [r, 0] : [r * 0.75, r * 0.75];
  context.moveTo(x - a, y - b);
  context.lineTo(x + a, y + b);
  context.moveTo(x + b, y - a);
  context.lineTo(x - b, y + a);
}
