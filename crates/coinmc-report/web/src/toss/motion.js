// How the coin moves between keyframes, in the same words as crates/coinmc-report/src/motion.rs: in flight by
// closed forms, which are exact at any instant, in contact by a cubic and the mean angular velocity. What
// lacks to the next keyframe is added evenly on the way. Nothing here touches the page.

/** Places of the numbers of a keyframe. */
const PLACE = 0, TURN = 3, VELOCITY = 7, SPIN = 10, SIZE = 13;
/** Codes of the modes of motion. */
export const FLIGHT = 0, STICKING = 1, SLIDING = 2;

/** The product of two quaternions (w, x, y, z). */
export function multiply(a, b) {
  return [
    a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
    a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
    a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
    a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
  ];
}

/** The rotation by a vector. */
export function rotation(x, y, z) {
  const angle = Math.hypot(x, y, z);
  if (!(angle > 0 && Number.isFinite(angle))) return [1, 0, 0, 0];
  const s = Math.sin(angle / 2) / angle;
  return [Math.cos(angle / 2), x * s, y * s, z * s];
}

const inverse = (q) => [q[0], -q[1], -q[2], -q[3]];

/** A share of a rotation, the short way round. */
function share(q, s) {
  const sign = q[0] < 0 ? -1 : 1;
  const sin = Math.hypot(q[1], q[2], q[3]);
  if (sin < 1e-12) return [1, 0, 0, 0];
  const by = (sign * 2 * Math.atan2(sin, q[0] * sign) * s) / sin;
  return rotation(q[1] * by, q[2] * by, q[3] * by);
}

/** A vector turned by a quaternion. */
export function turn(q, x, y, z) {
  const [w, a, b, c] = q;
  const u = 2 * (b * z - c * y), v = 2 * (c * x - a * z), t = 2 * (a * y - b * x);
  return [x + w * u + b * t - c * v, y + w * v + c * u - a * t, z + w * t + a * v - b * u];
}

/** The time in which a coin without drag would do what one with drag `k` does in `t`. */
const effective = (k, t) => (k > 0 ? -Math.expm1(-k * t) / k : t);

/** Numbers that were packed into 16 bits each. */
function unpacked({ least, steps, data }) {
  const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
  const share = (i) => bytes[2 * i] + 256 * bytes[2 * i + 1];
  return Array.from({ length: bytes.length / 2 }, (_, i) => least[i % SIZE] + steps[i % SIZE] * share(i));
}

export class Motion {
  /** The motion of a toss of the page's data. */
  constructor(scene, keys) {
    this.scene = scene;
    this.times = keys.time_s;
    this.kinds = Array.from(keys.kind, Number);
    this.modes = Array.from(keys.mode, Number);
    this.numbers = Array.isArray(keys.numbers) ? keys.numbers : unpacked(keys.numbers);
  }

  get duration() {
    return this.times[this.times.length - 1];
  }

  /** The last keyframe that is not later than `t`. */
  keyAt(t) {
    let low = 0, high = this.times.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.times[middle] <= t) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  part(key, at, size) {
    const start = key * SIZE + at;
    return this.numbers.slice(start, start + size);
  }

  /** The coin at time `t`: place, orientation, velocity, angular velocity, mode, keyframe. */
  at(t) {
    const key = this.keyAt(t);
    const mode = this.modes[key];
    const start = this.times[key];
    if (key + 1 === this.times.length || t <= start) return this.atKey(key);
    const h = this.times[key + 1] - start;
    const s = (t - start) / h;
    const moved = mode === FLIGHT ? this.flying(key, h, s) : this.touching(key, h, s);
    return { ...moved, mode, key };
  }

  /** The coin at a keyframe. */
  atKey(key) {
    return {
      place: this.part(key, PLACE, 3),
      turn: this.part(key, TURN, 4),
      velocity: this.part(key, VELOCITY, 3),
      spin: this.part(key, SPIN, 3),
      mode: this.modes[key],
      key,
    };
  }

  flying(key, h, s) {
    const now = this.flown(key, s * h);
    const end = this.flown(key, h);
    const next = this.part(key + 1, PLACE, 3);
    const rest = share(multiply(this.part(key + 1, TURN, 4), inverse(end.turn)), s);
    return {
      place: now.place.map((x, i) => x + (next[i] - end.place[i]) * s),
      turn: multiply(rest, now.turn),
      velocity: now.velocity,
      spin: now.spin,
    };
  }

  /** After `t` seconds of flight from a keyframe. */
  flown(key, t) {
    const { weight_m_s2: g, linear_drag_per_s: k, angular_drag_per_s: j } = this.scene;
    const p = this.part(key, PLACE, 3), v = this.part(key, VELOCITY, 3);
    const q = this.part(key, TURN, 4), w = this.part(key, SPIN, 3);
    const eased = effective(k, t);
    const fallen = k > 0 ? (t - eased) / k : 0.5 * t * t;
    const slowed = Math.exp(-k * t);
    const free = 1 - this.scene.axial_factor;
    const u = turn(q, 0, 0, 1);
    const axial = w[0] * u[0] + w[1] * u[1] + w[2] * u[2];
    const angle = effective(j, t);
    const by = w.map((x, i) => (x - u[i] * axial * free) * angle);
    const turned = rotation(...by);
    const spin = turn(turned, ...w).map((x) => x * Math.exp(-j * t));
    return {
      place: p.map((x, i) => x + v[i] * eased + g[i] * fallen),
      turn: multiply(multiply(turned, q), rotation(0, 0, axial * free * angle)),
      velocity: v.map((x, i) => x * slowed + g[i] * eased),
      spin,
    };
  }

  /** In sustained contact. */
  touching(key, h, s) {
    const [a, b] = [key, key + 1].map((k) => this.part(k, PLACE, 3));
    const [u, v] = [key, key + 1].map((k) => this.part(k, VELOCITY, 3));
    const [from, to] = [key, key + 1].map((k) => this.part(k, SPIN, 3));
    const q = this.part(key, TURN, 4);
    const mean = from.map((x, i) => ((x + to[i]) / 2) * h);
    const end = multiply(rotation(...mean), q);
    const rest = share(multiply(this.part(key + 1, TURN, 4), inverse(end)), s);
    const r = 1 - s;
    const cubic = (i) =>
      a[i] * r * r * (1 + 2 * s) + u[i] * h * s * r * r + b[i] * s * s * (3 - 2 * s) - v[i] * h * s * s * r;
    return {
      place: [cubic(0), cubic(1), cubic(2)],
      turn: multiply(rest, multiply(rotation(...mean.map((x) => x * s)), q)),
      velocity: u.map((x, i) => x * r + v[i] * s),
      spin: from.map((x, i) => x * r + to[i] * s),
    };
  }

  /** Mechanical energy per unit mass, J/kg, 0 for a point at rest in the middle of the surface. */
  energy(state) {
    const { axial_gyration_m2: a, transverse_gyration_m2: b, weight_m_s2: g } = this.scene;
    const u = turn(state.turn, 0, 0, 1);
    const [v, w] = [state.velocity, state.spin];
    const axial = w[0] * u[0] + w[1] * u[1] + w[2] * u[2];
    const all = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    const moving = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    const fallen = g.reduce((sum, x, i) => sum + x * state.place[i], 0);
    return 0.5 * (moving + b * (all - axial * axial) + a * axial * axial) - fallen;
  }

  /** The coin's lowest point; the middle of a face or line that is lowest as a whole. */
  lowest(state) {
    const { radius_m, height_m, rim_radius_m: r, rims_m } = this.scene;
    const u = turn(state.turn, 0, 0, 1);
    const across = Math.hypot(u[0], u[1]);
    if (rims_m) return lowestOfRims(rims_m, state.place, u, across);
    const up = Math.abs(u[2]) < 1e-9 ? 0 : Math.sign(u[2]) * (height_m / 2 - r);
    const out = across < 1e-9 ? 0 : (radius_m - r) / across;
    const p = state.place;
    return [
      p[0] - u[0] * up + u[0] * u[2] * out,
      p[1] - u[1] * up + u[1] * u[2] * out,
      p[2] - u[2] * up - across * across * out - r,
    ];
  }
}

/** The lowest point of either rim of a conical coin; of a coin on its edge, the middle of both. */
function lowestOfRims([heads, tails], p, u, across) {
  const point = ([radius, distance], end) => {
    const out = across < 1e-9 ? 0 : radius / across;
    const up = end * distance;
    return [
      p[0] + u[0] * up + u[0] * u[2] * out,
      p[1] + u[1] * up + u[1] * u[2] * out,
      p[2] + u[2] * up - across * across * out,
    ];
  };
  const [a, b] = [point(heads, 1), point(tails, -1)];
  if (Math.abs(a[2] - b[2]) < 1e-9 * heads[0]) return a.map((x, i) => (x + b[i]) / 2);
  return a[2] < b[2] ? a : b;
}
