// Triangles of a coin, and of a ribbon on the ground.

const AROUND = 72;

/** A coin with rounded or sharp rims: positions, normals, and triangles. */
export function coin(radius, height, rim, rims) {
  const profile = rims ? frustum(rims) : outline(radius, height / 2, rim);
  const position = [], normal = [], index = [];
  for (const [r, z, outward, up] of profile) {
    for (let i = 0; i <= AROUND; i += 1) {
      const angle = (2 * Math.PI * i) / AROUND;
      const c = Math.cos(angle), s = Math.sin(angle);
      position.push(r * c, r * s, z);
      normal.push(outward * c, outward * s, up);
    }
  }
  const row = AROUND + 1;
  for (let k = 0; k + 1 < profile.length; k += 1) {
    // two rings at one place only change the normal
    if (profile[k][0] === profile[k + 1][0] && profile[k][1] === profile[k + 1][1]) continue;
    for (let i = 0; i < AROUND; i += 1) {
      const a = k * row + i, b = a + row;
      index.push(a, b, a + 1, a + 1, b, b + 1);
    }
  }
  return {
    position: new Float32Array(position),
    normal: new Float32Array(normal),
    index: new Uint16Array(index),
  };
}

/** From the middle of heads to that of tails: radius, height, and the normal's parts out and up. */
function outline(radius, half, rim) {
  const rings = [[0, half, 0, 1], [radius - rim, half, 0, 1]];
  const steps = rim > 0 ? 8 : 1;
  for (const side of [1, -1]) {
    const arc = [];
    for (let i = 0; i <= steps; i += 1) {
      const angle = (Math.PI / 2) * (1 - i / steps);
      const c = Math.cos(angle), s = Math.sin(angle);
      if (rim > 0) arc.push([radius - rim + rim * c, side * (half - rim + rim * s), c, side * s]);
    }
    if (rim === 0) arc.push([radius, side * half, 1, 0]);
    rings.push(...(side > 0 ? arc : arc.reverse()));
  }
  rings.push([radius - rim, -half, 0, -1], [0, -half, 0, -1]);
  return rings;
}

/** The same of a conical edge: from radius and distance from the centre of heads and of tails. */
function frustum([[heads, above], [tails, below]]) {
  const length = Math.hypot(above + below, heads - tails);
  const [outward, up] = [(above + below) / length, (tails - heads) / length];
  return [
    [0, above, 0, 1], [heads, above, 0, 1], [heads, above, outward, up],
    [tails, -below, outward, up], [tails, -below, 0, -1], [0, -below, 0, -1],
  ];
}

/** A ribbon along points on the ground, of some width, a little above it. */
export function ribbon(points, width, above) {
  const position = [], index = [];
  for (let i = 0; i + 1 < points.length; i += 1) {
    const [ax, ay] = points[i], [bx, by] = points[i + 1];
    const length = Math.hypot(bx - ax, by - ay);
    if (!(length > 0)) continue;
    const x = (-(by - ay) / length) * (width / 2), y = ((bx - ax) / length) * (width / 2);
    const first = position.length / 3;
    position.push(ax + x, ay + y, above, ax - x, ay - y, above, bx + x, by + y, above, bx - x, by - y, above);
    index.push(first, first + 1, first + 2, first + 2, first + 1, first + 3);
  }
  return { position: new Float32Array(position), index: new Uint32Array(index) };
}

/** Small rings on the ground, one around each point. */
export function rings(points, radius, above) {
  const position = [], index = [], around = 20;
  for (const [x, y] of points) {
    const first = position.length / 3;
    for (let i = 0; i <= around; i += 1) {
      const angle = (2 * Math.PI * i) / around;
      for (const r of [radius, radius * 0.6]) {
        position.push(x + r * Math.cos(angle), y + r * Math.sin(angle), above);
      }
      if (i < around) {
        const a = first + 2 * i;
        index.push(a, a + 1, a + 2, a + 2, a + 1, a + 3);
      }
    }
  }
  return { position: new Float32Array(position), index: new Uint32Array(index) };
}
