// From the sliders to a config.
"use strict";
globalThis.coinmc ??= {};

/** The choice of a surface by its own numbers. */
coinmc.OWN = "own";

/** A number as TOML writes it: with a point, so that it is no whole number. */
const real = (x) => (Number.isInteger(x) ? x.toFixed(1) : String(x));

/**
 * The config of a scene.
 *
 * @param {object} scene ratio, radius_m, surface (a material or OWN), restitution, friction,
 *   rolling_friction_m, launch, height_m (null: that of the launch), engine, seed, tosses
 */
coinmc.config = function (scene) {
  const lines = [`seed = ${scene.seed}`, "", "[coin]"];
  lines.push(`ratio = ${real(scene.ratio)}   # height over radius`);
  lines.push(`radius_m = ${real(scene.radius_m)}`, "", "[surface]");
  if (scene.surface === coinmc.OWN) {
    lines.push(`restitution = ${real(scene.restitution)}`, `friction = ${real(scene.friction)}`);
    if (scene.engine === "volumetric") {
      lines.push(`rolling_friction_m = ${real(scene.rolling_friction_m)}`);
      lines.push(`pivoting_friction_m = ${real(scene.rolling_friction_m)}`);
    }
  } else {
    lines.push(`material = "${scene.surface}"`);
  }
  lines.push("", "[launch]", `preset = "${scene.launch}"`);
  if (scene.height_m !== null) lines.push(`height_m = ${real(scene.height_m)}`);
  lines.push("", `[engine.${scene.engine}]`, "", "[stop]", `tosses = ${scene.tosses}`, "");
  return lines.join("\n");
};

/** The scene that the form shows. */
coinmc.sceneOf = function (form, launches) {
  const value = (name) => form.elements[name].value;
  const number = (name) => Number(value(name));
  const launch = launches.find(({ name }) => name === value("launch"));
  const height = number("height");
  return {
    ratio: round(2 ** number("ratio"), 3),
    radius_m: round(number("radius") / 1000, 5),
    surface: value("surface"),
    restitution: number("restitution"),
    friction: number("friction"),
    rolling_friction_m: round(number("rolling") / 1000, 6),
    launch: launch.name,
    height_m: height === launch.height_m ? null : height,
    engine: value("engine"),
    seed: Math.trunc(number("seed")),
    tosses: number("tosses"),
  };
};

/** x with this many digits after the point. */
function round(x, digits) {
  return Number(x.toFixed(digits));
}
