// Numbers and names as people read them.

const NAMES = {
  ratio: "H/R, height over radius",
  restitution: "restitution e",
  friction: "friction μ",
  height_m: "height of the centre, m",
  tilt_deg: "tilt of the heads normal from the vertical, °",
  tilt_rad: "tilt of the heads normal from the vertical, rad",
  vx_m_s: "velocity along x, m/s",
  vy_m_s: "velocity along y, m/s",
  vz_m_s: "upward velocity, m/s",
  wx_rad_s: "spin about x, rad/s",
  wy_rad_s: "spin about y, rad/s",
  wz_rad_s: "spin about z, rad/s",
};

const SUFFIXES = [
  "_per_s", "_kg_m2", "_rad_s", "_m_s2", "_m_s", "_rad", "_deg", "_kg", "_m2", "_m", "_s",
];

/** The label of an axis: the name of its column in words, with its unit. */
export function axisLabel(name, unit) {
  if (NAMES[name]) return NAMES[name];
  const suffix = SUFFIXES.find((end) => name.endsWith(end)) ?? "";
  const words = name.slice(0, name.length - suffix.length).replaceAll("_", " ");
  return unit && unit !== "1" ? `${words}, ${unit}` : words;
}

/** Four digits, without needless zeros. */
export function compact(x) {
  if (x === null || x === undefined || Number.isNaN(x)) return "–";
  if (!Number.isFinite(x)) return x > 0 ? "∞" : "−∞";
  if (x === 0) return "0";
  const size = Math.abs(x);
  const text =
    size >= 1e6 || size < 1e-4
      ? x.toExponential(3).replace(/\.?0+e/, "e").replace("e+", "e")
      : String(Number(x.toPrecision(4)));
  return text.replace("-", "−");
}

/** A whole number, its digits in groups. */
export function grouped(n) {
  return String(Math.round(n)).replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

/** `1 point`, `2 points`. */
export function count(n, noun) {
  return `${grouped(n)} ${noun}${n === 1 ? "" : "s"}`;
}

/** Decimals that show two digits of `error`. */
export function decimalsFor(error) {
  if (!(error > 0)) return 6;
  return Math.min(9, Math.max(0, 1 - Math.floor(Math.log10(error))));
}

/** A probability with its interval: `0.3312 [0.3295, 0.3329]`; without one where it is exact. */
export function probability(p, lo, hi) {
  if (p === null || p === undefined) return "–";
  const decimals = decimalsFor((hi - lo) / 2);
  if (!(hi > lo)) return `${p.toFixed(6)} exact`;
  return `${p.toFixed(decimals)} [${lo.toFixed(decimals)}, ${hi.toFixed(decimals)}]`;
}

/** `ratio 1.5, restitution 0.3`. */
export function places(at) {
  return at.map(([name, value]) => `${name} ${compact(value)}`).join(", ");
}

/** Round values that divide a range into about `parts`. */
export function ticks(from, to, parts) {
  const rough = (to - from) / Math.max(1, parts);
  if (!(rough > 0)) return [from];
  const ten = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((n) => n * ten).find((n) => n >= rough * 0.999);
  const found = [];
  for (let i = Math.ceil(from / step - 1e-9); i * step <= to + step * 1e-9; i += 1) {
    found.push(Number((i * step).toPrecision(12)));
  }
  return found;
}
