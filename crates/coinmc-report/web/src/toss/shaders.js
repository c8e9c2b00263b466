// What the graphics card computes. Faces differ by pattern, not only by colour: heads has rings, tails has
// stripes, the side is reeded.

export const coinVertex = `
attribute vec3 position, normal;
uniform mat4 modelMatrix, viewMatrix, projectionMatrix;
varying vec3 vNormal, vPlace, vWorld;
void main() {
  vPlace = position;
  vNormal = mat3(modelMatrix) * normal;
  vec4 world = modelMatrix * vec4(position, 1.0);
  vWorld = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

export const coinFragment = `
precision highp float;
uniform vec3 uHeads, uTails, uSide, uTint, uEye;
uniform float uRadius, uAbove, uBelow;
varying vec3 vNormal, vPlace, vWorld;
float line(float x, float width) {
  float d = abs(fract(x) - 0.5);
  return smoothstep(width, width + 0.06, d);
}
void main() {
  float r = length(vPlace.xy) / uRadius;
  float angle = atan(vPlace.y, vPlace.x);
  bool face = vPlace.z > 0.999 * uAbove || -vPlace.z > 0.999 * uBelow;
  vec3 colour = uSide * mix(0.72, 1.0, line(angle * 48.0 / 6.2832, 0.25));
  if (!face) {
    // a mark that shows how far the coin has rolled
    if (abs(angle) < 0.09) colour = uTint;
  } else if (vPlace.z > 0.0) {
    colour = uHeads * mix(0.62, 1.0, line(r * 3.0, 0.12));
    if (r < 0.16) colour = uHeads * 0.55;
  } else {
    colour = uTails * mix(0.62, 1.0, line(vPlace.x / uRadius * 3.0, 0.16));
  }
  if (face && r > 0.9) colour = uTint;
  vec3 n = normalize(vNormal);
  vec3 sun = normalize(vec3(0.35, -0.45, 0.82));
  vec3 eye = normalize(uEye - vWorld);
  if (dot(n, eye) < 0.0) n = -n;
  float light = 0.6 + 0.36 * max(dot(n, sun), 0.0) + 0.12 * n.z;
  float shine = pow(max(dot(n, normalize(sun + eye)), 0.0), 40.0) * 0.35;
  gl_FragColor = vec4(colour * light + shine, 1.0);
}`;

/** The coin pressed flat onto the ground. */
export const shadowVertex = `
attribute vec3 position;
uniform mat4 modelMatrix, viewMatrix, projectionMatrix;
uniform float uAbove;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  world.xy -= world.z * vec2(0.35, -0.45) / 0.82 * 0.25;
  world.z = uAbove;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

export const plainVertex = `
attribute vec3 position;
uniform mat4 modelMatrix, viewMatrix, projectionMatrix;
void main() { gl_Position = projectionMatrix * viewMatrix * modelMatrix * vec4(position, 1.0); }`;

export const plainFragment = `
precision highp float;
uniform vec3 uColour;
uniform float uAlpha;
void main() { gl_FragColor = vec4(uColour, uAlpha); }`;

export const groundVertex = `
attribute vec3 position;
uniform mat4 viewMatrix, projectionMatrix;
varying vec2 vPlace;
void main() {
  vPlace = position.xy;
  gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
}`;

export const groundFragment = `
#extension GL_OES_standard_derivatives : enable
precision highp float;
uniform vec3 uGround, uLine;
uniform vec2 uMiddle;
uniform float uSpacing, uReach, uTable;
varying vec2 vPlace;
float grid(vec2 at) {
  vec2 d = abs(fract(at - 0.5) - 0.5) / fwidth(at);
  return 1.0 - min(min(d.x, d.y), 1.0);
}
void main() {
  float away = length(vPlace - uMiddle) / uReach;
  float fade = 1.0 - smoothstep(0.55, 1.0, away);
  if (uTable > 0.0 && length(vPlace) > uTable) discard;
  float lines = max(0.35 * grid(vPlace / uSpacing), 0.9 * grid(vPlace / (10.0 * uSpacing)));
  gl_FragColor = vec4(mix(uGround, uLine, lines), fade);
}`;
