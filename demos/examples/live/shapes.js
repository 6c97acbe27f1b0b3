// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Meshes by formula, for the page and for its workers: {positions, triangles, groups}, triangles counter-clockwise from
// outside. Groups name materials; without them a mesh has the colour of its body.

/** A cube of which each face is a grid, each point of it moved by `place`, from a cube of half side 1. */
function gridCube(steps, place) {
  const positions = [], triangles = [], known = new Map();
  const vertex = point => {
    const key = point.map(x => Math.round(1e6 * x)).join();
    if (!known.has(key)) {
      known.set(key, positions.length / 3);
      positions.push(...place(point));
    }
    return known.get(key);
  };
  for (let axis = 0; axis < 3; ++axis) {
    for (const side of [1, -1]) {
      const at = (i, j) => {
        const point = [0, 0, 0];
        point[axis] = side;
        point[(axis + 1) % 3] = 2 * i / steps - 1;
        point[(axis + 2) % 3] = side * (2 * j / steps - 1);
        return vertex(point);
      };
      for (let i = 0; i < steps; ++i) {
        for (let j = 0; j < steps; ++j) {
          const [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
          triangles.push(a, b, c, a, c, d);
        }
      }
    }
  }
  return {positions: Float64Array.from(positions), triangles: Int32Array.from(triangles)};
}

/** Triangles of nearly one size: the grid's lines are at equal angles. */
function ballMesh(radius, steps) {
  return gridCube(steps, point => {
    const p = point.map(x => Math.tan(x * Math.PI / 4)), length = Math.hypot(...p);
    return p.map(x => radius * x / length);
  });
}

function roundedBoxMesh(half, rounding, steps) {
  return gridCube(steps, point => {
    const inner = half.map(h => h - rounding);
    const p = point.map((x, k) => half[k] * Math.sin(x * Math.PI / 2)), core = p.map((x, k) =>
      Math.max(-inner[k], Math.min(inner[k], x)));
    const out = p.map((x, k) => x - core[k]), length = Math.hypot(...out) || 1;
    return core.map((x, k) => x + rounding * out[k] / length);
  });
}

/** Sharp edges, two triangles a side, as rigid boxes are drawn. */
function boxMesh(half) {
  return gridCube(1, point => point.map((x, k) => x * half[k]));
}

/** A torus about y, of which the tube's radius differs from one side to the other. */
function ringMesh(radius, thin, thick, around, across) {
  const positions = [], triangles = [];
  for (let i = 0; i < around; ++i) {
    const u = 2 * Math.PI * i / around, tube = thin + (thick - thin) * (0.5 + 0.5 * Math.cos(u));
    for (let j = 0; j < across; ++j) {
      const v = 2 * Math.PI * j / across, reach = radius + tube * Math.cos(v);
      positions.push(reach * Math.cos(u), tube * Math.sin(v), reach * Math.sin(u));
      const a = i * across + j, b = i * across + (j + 1) % across;
      const c = (i + 1) % around * across + j, d = (i + 1) % around * across + (j + 1) % across;
      triangles.push(a, b, c, b, d, c);
    }
  }
  return {positions: Float64Array.from(positions), triangles: Int32Array.from(triangles)};
}

/** A bar along x with a rounded square section, which gets round at its ends, and ridges along it. */
function barMesh(halfLength, halfWidth, rings, columns) {
  const positions = [-halfLength, 0, 0], triangles = [], RIDGES = 16;
  for (let ring = 1; ring < rings; ++ring) {
    const x = halfLength * (2 * ring / rings - 1), end = Math.min(1, (halfLength - Math.abs(x)) / (0.6 * halfWidth));
    const cap = Math.sqrt(Math.max(0.02, 1 - (1 - end) ** 2));
    for (let column = 0; column < columns; ++column) {
      const angle = 2 * Math.PI * column / columns, c = Math.cos(angle), s = Math.sin(angle);
      const radius = halfWidth * cap * (c ** 4 + s ** 4) ** -0.25 * (1 + 0.035 * Math.cos(RIDGES * angle));
      positions.push(x, radius * c, radius * s);
    }
  }
  positions.push(halfLength, 0, 0);
  const last = positions.length / 3 - 1, at = (ring, column) => 1 + (ring - 1) * columns + column % columns;
  for (let column = 0; column < columns; ++column) {
    triangles.push(0, at(1, column + 1), at(1, column));
    triangles.push(last, at(rings - 1, column), at(rings - 1, column + 1));
    for (let ring = 1; ring + 1 < rings; ++ring) {
      const a = at(ring, column), b = at(ring, column + 1), c = at(ring + 1, column), d = at(ring + 1, column + 1);
      triangles.push(a, b, c, b, d, c);
    }
  }
  return {positions: Float64Array.from(positions), triangles: Int32Array.from(triangles)};
}

/** A flat box, of which the surface has chequers: two groups, each with vertices of its own where they meet. */
function matMesh(half, steps, chequer) {
  const {positions, triangles} = gridCube(steps, point => point.map((x, k) => x * half[k]));
  const count = positions.length / 3;
  const light = [], dark = [];
  for (let t = 0; t < triangles.length; t += 3) {
    const square = [0, 2].map(k => {
      const sum = [0, 1, 2].reduce((total, corner) => total + positions[3 * triangles[t + corner] + k], 0);
      return Math.floor((sum / 3 + half[k]) / chequer - 1e-6);
    });
    ((square[0] + square[1]) % 2 ? dark : light).push(...triangles.subarray(t, t + 3));
  }
  return {
    positions: Float64Array.from([...positions, ...positions]),
    triangles: Int32Array.from([...light, ...dark.map(v => v + count)]),
    groups: [{first: 0, count: light.length / 3, material: 'mat'},
             {first: light.length / 3, count: dark.length / 3, material: 'mat_chequer'}],
  };
}
