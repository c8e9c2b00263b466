// The picture: coins, ground, paths and marks, drawn by OGL.

import { Camera, Geometry, Mat4, Mesh, Program, Renderer, Transform } from "ogl";
import { onResize } from "../dom.js";
import { curveColour, outcomeColour, styleColour } from "../palette.js";
import * as geometry from "./geometry.js";
import { FLIGHT, SLIDING, STICKING } from "./motion.js";
import { Orbit } from "./orbit.js";
import * as shaders from "./shaders.js";
import { Sharpness } from "./sharpness.js";

/** About as many points has a path. */
const PATH = 1000;
/** Sizes of a coin from which it is followed, and how much more for each height above the ground. */
const NEAR = 11, HIGH = 0.22;

export class Stage {
  /** A picture of tosses on a canvas. Throws where the browser has no WebGL. */
  constructor(canvas, tosses) {
    this.canvas = canvas;
    this.tosses = tosses;
    const dpr = Math.min(2, devicePixelRatio);
    this.renderer = new Renderer({ canvas, webgl: 1, antialias: true, dpr });
    this.sharpness = new Sharpness((share) => {
      this.renderer.dpr = dpr * share;
      this.resize();
    });
    this.gl = this.renderer.gl;
    if (!this.gl) throw new Error("no WebGL");
    this.camera = new Camera(this.gl, { fov: 32, near: 0.001, far: 1000 });
    this.camera.up.set(0, 0, 1);
    this.follows = true;
    this.stale = false;
    this.orbit = new Orbit(canvas, () => this.redraw());
    this.measure();
    this.build();
    onResize(canvas.parentElement, () => this.resize());
    this.resize();
  }

  /** How large everything is, and where. */
  measure() {
    const size = ({ scene }) => Math.hypot(scene.radius_m, scene.height_m / 2);
    this.size = Math.max(...this.tosses.map((toss) => size(toss)));
    const low = [Infinity, Infinity, 0], high = [-Infinity, -Infinity, 0];
    for (const { motion } of this.tosses) {
      for (let key = 0; key < motion.times.length; key += 1) {
        motion.part(key, 0, 3).forEach((x, i) => {
          low[i] = Math.min(low[i], x);
          high[i] = Math.max(high[i], x);
        });
      }
    }
    const middle = low.map((x, i) => (x + high[i]) / 2);
    const span = Math.max(...low.map((x, i) => high[i] - x)) + 4 * this.size;
    this.middle = middle;
    this.span = span;
    this.orbit.reach = 1.9 * span;
    this.orbit.target = middle;
  }

  build() {
    this.scene = new Transform();
    this.gl.clearColor(...rgb(styleColour("stage")), 1);
    this.ground();
    this.coins = this.tosses.map((toss, n) => this.coin(toss, n));
    this.tosses.forEach((toss, n) => this.paths(toss, n));
  }

  program(vertex, fragment, uniforms, options = {}) {
    const values = Object.fromEntries(Object.entries(uniforms).map(([name, value]) => [name, { value }]));
    return new Program(this.gl, { vertex, fragment, uniforms: values, cullFace: false, ...options });
  }

  add(data, program, options = {}) {
    const attributes = Object.fromEntries(
      Object.entries(data).map(([name, values]) => [name, { size: name === "index" ? 1 : 3, data: values }]),
    );
    const mesh = new Mesh(this.gl, {
      geometry: new Geometry(this.gl, attributes),
      program,
      frustumCulled: false,
      ...options,
    });
    mesh.setParent(this.scene);
    return mesh;
  }

  ground() {
    const reach = Math.max(3 * this.span, 40 * this.size);
    const [x, y] = this.middle;
    const corners = [[-1, -1], [1, -1], [-1, 1], [1, 1]].flatMap(([a, b]) => [x + a * reach, y + b * reach, 0]);
    const program = this.program(
      shaders.groundVertex,
      shaders.groundFragment,
      {
        uGround: rgb(styleColour("ground")),
        uLine: rgb(styleColour("ground-line")),
        uMiddle: [x, y],
        uReach: reach,
        uSpacing: 10 ** Math.round(Math.log10(this.size * 1.5)),
        uTable: this.tosses[0].scene.table_radius_m ?? 0,
      },
      { transparent: true },
    );
    const data = { position: new Float32Array(corners), index: new Uint16Array([0, 1, 2, 2, 1, 3]) };
    this.add(data, program, { renderOrder: -1 });
  }

  coin(toss, n) {
    const { radius_m, height_m, rim_radius_m, rims_m } = toss.scene;
    const data = geometry.coin(radius_m, height_m, rim_radius_m, rims_m);
    const several = this.tosses.length > 1;
    const body = this.add(
      data,
      this.program(shaders.coinVertex, shaders.coinFragment, {
        uHeads: rgb(outcomeColour("heads")),
        uTails: rgb(outcomeColour("tails")),
        uSide: rgb("#c9b27c"),
        uTint: rgb(several ? curveColour(n) : "#8d7a4a"),
        uEye: [0, 0, 0],
        uRadius: radius_m,
        uAbove: rims_m ? rims_m[0][1] : height_m / 2,
        uBelow: rims_m ? rims_m[1][1] : height_m / 2,
      }),
    );
    const shadow = this.add(
      { position: data.position, index: data.index },
      this.program(shaders.shadowVertex, shaders.plainFragment, {
        uColour: rgb(styleColour("shadow")),
        uAlpha: 1,
        uAbove: 2e-4 * this.span,
      }),
    );
    const contact = this.add(
      geometry.rings([[0, 0]], 0.16 * this.size, 0),
      this.program(shaders.plainVertex, shaders.plainFragment, { uColour: rgb(styleColour("text")), uAlpha: 1 }),
    );
    return { body, shadow, contact };
  }

  /** The way of the centre, that of the contact point, and a ring at each impact. */
  paths(toss, n) {
    const { motion } = toss;
    const several = this.tosses.length > 1;
    const colour = rgb(several ? curveColour(n) : styleColour("accent"));
    const plain = (uAlpha, transparent) =>
      this.program(shaders.plainVertex, shaders.plainFragment, { uColour: colour, uAlpha }, { transparent });
    const times = sampled(motion, PATH);
    const way = times.flatMap((t) => motion.at(t).place);
    const line = { position: new Float32Array(way) };
    this.add(line, plain(0.55, true), { mode: this.gl.LINE_STRIP });
    const above = 6e-4 * this.span;
    for (const points of touching(motion, times)) {
      this.add(geometry.ribbon(points, 0.05 * this.size, above), plain(1, false));
    }
    const impacts = toss.impacts.map((key) => motion.lowest(motion.atKey(key)));
    if (impacts.length) this.add(geometry.rings(impacts, 0.09 * this.size, 2 * above), plain(1, false));
  }

  /** Shows all coins at a time. */
  show(time) {
    const places = this.tosses.map(({ motion }, n) => {
      const state = motion.at(Math.min(time, motion.duration));
      const [w, x, y, z] = state.turn;
      const matrix = new Mat4().fromQuaternion([x, y, z, w]);
      matrix[12] = state.place[0];
      matrix[13] = state.place[1];
      matrix[14] = state.place[2];
      for (const mesh of [this.coins[n].body, this.coins[n].shadow]) {
        mesh.matrixAutoUpdate = false;
        mesh.matrix.copy(matrix);
        mesh.worldMatrixNeedsUpdate = true;
      }
      const { contact } = this.coins[n];
      contact.visible = state.mode === STICKING || state.mode === SLIDING;
      const [across, along] = motion.lowest(state);
      contact.position.set(across, along, 1.5e-3 * this.span);
      return state.place;
    });
    this.aim(places);
    this.redraw();
  }

  /** Looks at the coins, from further away the higher and the further apart they are; or at everything. */
  aim(places) {
    if (!this.follows) {
      this.orbit.target = this.middle;
      this.orbit.reach = 1.9 * this.span;
      return;
    }
    const middle = [0, 1, 2].map((i) => places.reduce((sum, place) => sum + place[i], 0) / places.length);
    const apart = Math.max(...places.map((place) => Math.hypot(...place.map((x, i) => x - middle[i]))));
    const high = Math.max(0, middle[2]);
    this.orbit.target = [middle[0], middle[1], 0.97 * high];
    this.orbit.reach = NEAR * this.size + HIGH * high + 4 * apart;
  }

  /** Draws at the next frame, once however often it is asked for. */
  redraw() {
    if (this.stale || !this.scene) return;
    this.stale = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.stale = false;
    const began = performance.now();
    this.sharpness.frame(began);
    const eye = this.orbit.eye();
    const distance = this.orbit.distance;
    this.camera.near = distance / 100;
    this.camera.far = 20 * (distance + this.span);
    this.camera.perspective();
    this.camera.position.set(...eye);
    this.camera.lookAt(this.orbit.target);
    this.coins.forEach(({ body }) => (body.program.uniforms.uEye.value = eye));
    this.renderer.render({ scene: this.scene, camera: this.camera });
    // for whoever measures: work of the last frame, ms
    this.canvas.dataset.frameMs = (performance.now() - began).toFixed(2);
  }

  resize() {
    const box = this.canvas.parentElement.getBoundingClientRect();
    if (!(box.width > 0 && box.height > 0)) return;
    this.renderer.setSize(box.width, box.height);
    this.camera.perspective({ aspect: box.width / box.height });
    this.redraw();
  }

  /** Draws in the colours of the page, which have changed. */
  recolour(time) {
    this.build();
    this.show(time);
  }
}

/** Times at which a path is drawn. */
function sampled(motion, most) {
  const times = [];
  for (let key = 0; key + 1 < motion.times.length; key += 1) {
    const [from, to] = [motion.times[key], motion.times[key + 1]];
    const share = (to - from) / motion.duration;
    const steps = motion.modes[key] === FLIGHT ? Math.ceil(Math.min(60, 4 + most * share)) : 2;
    for (let i = 0; i < steps && to > from; i += 1) times.push(from + ((to - from) * i) / steps);
  }
  times.push(motion.duration);
  return times;
}

/** The ways of the contact point, one for each time in contact. */
function touching(motion, times) {
  const ways = [];
  let way = [];
  for (const t of times) {
    const state = motion.at(t);
    if (state.mode === STICKING || state.mode === SLIDING) way.push(motion.lowest(state));
    else if (way.length) {
      ways.push(way);
      way = [];
    }
  }
  if (way.length) ways.push(way);
  return ways.filter((points) => points.length > 1);
}

/** `#0072b2` as three numbers from 0 to 1. */
function rgb(hex) {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
}
