// A toss on a canvas: the coin over the surface, played, held and scrubbed.
"use strict";
globalThis.coinmc ??= {};

/** Points around the rim. */
const RIM = 48;
const [TIME, X, Y, Z, W, QX, QY, QZ, ENERGY] = [0, 1, 2, 3, 4, 5, 6, 7, 8];

/** The state at a time, between the two states around it. */
coinmc.stateAt = function (states, time) {
  let [low, high] = [0, states.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (states[middle][TIME] <= time) low = middle;
    else high = middle;
  }
  const [a, b] = [states[low], states[high]];
  const share = b[TIME] > a[TIME] ? Math.min((time - a[TIME]) / (b[TIME] - a[TIME]), 1) : 1;
  // both quaternions q and −q are the same rotation: the nearer is meant
  const dot = [W, QX, QY, QZ].reduce((sum, i) => sum + a[i] * b[i], 0);
  const mixed = a.map((x, i) => x + share * ((i >= W && i <= QZ && dot < 0 ? -b[i] : b[i]) - x));
  const length = Math.hypot(mixed[W], mixed[QX], mixed[QY], mixed[QZ]) || 1;
  return mixed.map((x, i) => (i >= W && i <= QZ ? x / length : x));
};

/** The point p of the coin in the laboratory. */
function placed(state, [x, y, z]) {
  const [w, a, b, c] = state.slice(W, QZ + 1);
  const [u, v, t] = [
    2 * (b * z - c * y),
    2 * (c * x - a * z),
    2 * (a * y - b * x),
  ];
  return [
    state[X] + x + w * u + b * t - c * v,
    state[Y] + y + w * v + c * u - a * t,
    state[Z] + z + w * t + a * v - b * u,
  ];
}

/** A player of tosses; what it needs of the page is the canvas and who is told of the time. */
coinmc.Player = class {
  constructor(canvas, told) {
    this.canvas = canvas;
    this.told = told;
    this.speed = 0.2;
    this.time = 0;
    this.playing = false;
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  /** Shows another toss, from its launch. */
  show(motion, playing) {
    this.motion = motion;
    this.time = 0;
    this.highest = Math.max(...motion.states.map((state) => state[Z]), motion.radius_m);
    this.play(playing);
    this.draw();
  }

  play(playing) {
    const begins = playing && !this.playing;
    this.playing = playing;
    if (playing && this.time >= this.motion.duration_s) this.time = 0;
    if (!begins) return;
    this.last = performance.now();
    const frame = (now) => {
      if (!this.playing) return;
      this.seek(this.time + ((now - this.last) / 1000) * this.speed);
      this.last = now;
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.motion.duration_s);
    if (this.time >= this.motion.duration_s) this.playing = false;
    this.draw();
    this.told(this.time, this.playing);
  }

  draw() {
    const { canvas, motion } = this;
    if (!motion || !canvas.clientWidth) return;
    const density = devicePixelRatio;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    canvas.width = width * density;
    canvas.height = height * density;
    const pen = canvas.getContext("2d");
    pen.scale(density, density);
    const colour = (name) => getComputedStyle(canvas).getPropertyValue(name);
    const state = coinmc.stateAt(motion.states, this.time);
    const view = this.view(state, height);
    this.ground(pen, view, state, colour);
    pen.lineWidth = 1;
    pen.lineJoin = "round";
    for (const [points, fill] of this.faces(state, view)) {
      pen.beginPath();
      for (const [x, y] of points) pen.lineTo(x, y);
      pen.closePath();
      pen.fillStyle = colour(fill);
      pen.fill();
      pen.strokeStyle = colour(fill.startsWith("--side") ? fill : "--ink");
      pen.stroke();
    }
    this.ruler(pen, state, height, colour);
  }

  /** A camera slightly above the coin, which follows it; near the surface it stands still. */
  view(state, height) {
    const { radius_m, height_m } = this.motion;
    const reach = Math.hypot(radius_m, height_m / 2);
    const scale = height / (6 * reach);
    const [sin, cos] = [Math.sin(0.35), Math.cos(0.35)];
    const standing = height - 1.7 * reach * scale;
    const ground = Math.max(standing, 0.45 * height + state[Z] * cos * scale);
    return ([x, y, z]) => [
      this.canvas.clientWidth / 2 + (x - state[X]) * scale,
      ground - (z * cos + (y - state[Y]) * sin) * scale,
    ];
  }

  /** How high the coin is, on a ruler at the left. */
  ruler(pen, state, height, colour) {
    const [top, bottom] = [14, height - 14];
    const y = bottom - (Math.max(state[Z], 0) / this.highest) * (bottom - top);
    pen.strokeStyle = colour("--soft");
    pen.strokeRect(14, top, 0, bottom - top);
    pen.fillStyle = colour("--ink");
    pen.fillRect(9, y - 1.5, 11, 3);
    pen.font = "13px system-ui, sans-serif";
    const text = `${(state[Z] * 100).toFixed(state[Z] < 0.1 ? 2 : 1)} cm`;
    pen.fillText(text, 24, Math.min(Math.max(y + 4, 14), height - 6));
  }

  ground(pen, view, state, colour) {
    const { radius_m: r } = this.motion;
    pen.fillStyle = colour("--ground");
    const [, horizon] = view([0, state[Y] + 6 * r, 0]);
    pen.fillRect(0, horizon, this.canvas.clientWidth, this.canvas.clientHeight);
    // lines across, which move past: the surface is seen to stay where it is
    pen.strokeStyle = colour("--line");
    pen.lineWidth = 1;
    pen.beginPath();
    const step = 4 * r;
    const from = Math.floor((state[X] - 40 * r) / step);
    for (let i = from; i < from + 20; i++) {
      const [x0, y0] = view([i * step, state[Y] + 6 * r, 0]);
      const [x1, y1] = view([i * step, state[Y] - 6 * r, 0]);
      pen.moveTo(x0, y0);
      pen.lineTo(x1, y1);
    }
    pen.stroke();
    // the shadow: straight below
    const rim = Array.from({ length: RIM }, (_, i) => {
      const angle = (2 * Math.PI * i) / RIM;
      return view([state[X] + r * Math.cos(angle), state[Y] + r * Math.sin(angle), 0]);
    });
    pen.beginPath();
    for (const [x, y] of rim) pen.lineTo(x, y);
    pen.closePath();
    pen.fillStyle = colour("--shadow");
    pen.fill();
  }

  /** What is seen of the coin, the farthest first: polygons and the names of their colours. */
  faces(state, view) {
    const { radius_m: r, height_m: h } = this.motion;
    const ring = (radius, z) =>
      Array.from({ length: RIM }, (_, i) => {
        const angle = (2 * Math.PI * i) / RIM;
        return view(placed(state, [radius * Math.cos(angle), radius * Math.sin(angle), z]));
      });
    const [top, bottom] = [ring(r, h / 2), ring(r, -h / 2)];
    const seen = [];
    for (let i = 0; i < RIM; i++) {
      const j = (i + 1) % RIM;
      const wall = [top[i], top[j], bottom[j], bottom[i]];
      if (turned(wall) < 0) seen.push([wall, i % 4 < 2 ? "--side" : "--side-2"]);
    }
    if (turned(top) > 0) {
      seen.push([top, "--heads"]);
      // a bar on heads shows how it turns about its axis
      const bar = [[0.3, 0.08], [0.85, 0.08], [0.85, -0.08], [0.3, -0.08]];
      seen.push([bar.map(([x, y]) => view(placed(state, [x * r, y * r, h / 2]))), "--paper"]);
    }
    if (turned(bottom) < 0) seen.push([bottom, "--tails"]);
    return seen;
  }
};

/** Twice the area of a polygon; its sign says which of its sides faces the viewer. */
function turned(points) {
  let area = 0;
  points.forEach(([x, y], i) => {
    const [u, v] = points[(i + 1) % points.length];
    area += u * y - x * v;
  });
  return area;
}

coinmc.ENERGY = ENERGY;
