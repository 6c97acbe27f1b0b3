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

/** Where a field of signed distances, negative inside, is 0: one vertex for each cell that the surface crosses, at the
    mean of its crossings (naive surface nets). low, high: a box around it; step: the cells' side. */
function fieldMesh(distance, low, high, step) {
  const counts = low.map((x, k) => Math.ceil((high[k] - x) / step) + 1), strides = [1, counts[0], counts[0] * counts[1]];
  const placeOf = n => counts.map((count, k) => low[k] + step * (Math.floor(n / strides[k]) % count));
  const values = Float64Array.from({length: strides[2] * counts[2]}, (_, n) => distance(placeOf(n)));
  const positions = [], triangles = [], vertices = new Map();
  const offsets = Array.from({length: 8}, (_, c) => (c & 1) * strides[0] + (c >> 1 & 1) * strides[1] + (c >> 2) * strides[2]);
  const vertexOf = cell => {  // of the cell above this corner
    if (!vertices.has(cell)) {
      const sum = [0, 0, 0, 0];
      for (let a = 0; a < 8; ++a) {
        for (let k = 0; k < 3; ++k) {
          const b = a | 1 << k, [from, to] = [values[cell + offsets[a]], values[cell + offsets[b]]];
          if (a === b || from < 0 === to < 0) continue;
          for (let axis = 0; axis < 3; ++axis) sum[axis] += axis === k ? from / (from - to) : a >> axis & 1;
          ++sum[3];
        }
      }
      vertices.set(cell, positions.length / 3);
      positions.push(...placeOf(cell).map((x, k) => x + step * sum[k] / sum[3]));
    }
    return vertices.get(cell);
  };
  values.forEach((value, n) => {
    for (let k = 0; k < 3; ++k) {
      if (value < 0 === values[n + strides[k]] < 0) continue;
      const u = strides[(k + 1) % 3], v = strides[(k + 2) % 3];
      const [a, b, c, d] = [n - u - v, n - v, n, n - u].map(vertexOf);
      triangles.push(...value < 0 ? [a, b, c, a, c, d] : [a, c, b, a, d, c]);
    }
  });
  return {positions: Float64Array.from(positions), triangles: Int32Array.from(triangles)};
}

/** A rod between two points, of other radii at its ends and, by `bulge`, in its middle: its signed distance. */
function rod([a, b, c], to, atFrom, atTo, bulge = 0) {
  const [u, v, w] = [to[0] - a, to[1] - b, to[2] - c], square = u * u + v * v + w * w;
  return ([x, y, z]) => {
    const t = Math.max(0, Math.min(1, ((x - a) * u + (y - b) * v + (z - c) * w) / square));
    const radius = atFrom + t * (atTo - atFrom) + 4 * bulge * t * (1 - t);
    return Math.hypot(x - a - t * u, y - b - t * v, z - c - t * w) - radius;
  };
}

/** parts: by name of their material, {rods, stiffness, density}, blended where they meet. Each vertex is painted as the
    part that is nearest; `masks` tells by name which are. */
function paintedRodsMesh(parts, low, high, step, blend) {
  const names = Object.keys(parts);
  const distances = point => names.map(name => Math.min(...parts[name].rods.map(distance => distance(point))));
  const mesh = fieldMesh(point => {
    const sum = distances(point).reduce((total, x) => total + Math.exp(-x / blend), 0);
    return -blend * Math.log(sum);
  }, low, high, step);
  const {positions, triangles} = mesh, partOf = new Uint8Array(positions.length / 3).map((_, v) => {
    const all = distances([...positions.subarray(3 * v, 3 * v + 3)]);
    return all.indexOf(Math.min(...all));
  });
  const sorted = [], groups = [];
  names.forEach((material, part) => {
    const first = sorted.length / 3;
    for (let t = 0; t < triangles.length; t += 3) {
      if (partOf[triangles[t]] === part) sorted.push(...triangles.subarray(t, t + 3));
    }
    groups.push({first, count: sorted.length / 3 - first, material});
  });
  const painted = of => Float64Array.from(partOf, part => parts[names[part]][of]);
  const masks = {};
  names.forEach((name, part) => masks[name] = Float64Array.from(partOf, own => Number(own === part)));
  return {positions, triangles: Int32Array.from(sorted), groups, masks, stiffness: painted('stiffness'),
    density: painted('density')};
}

/** A tyre about y, with blocks on its tread. `cage` makes the wall, of one layer of prisms. */
function tyreMesh(ring, outer, inner, along, around) {
  const pointOf = (i, j, radius) => {
    const reach = ring + radius * Math.cos(2 * Math.PI * j), turn = 2 * Math.PI * i;
    return [reach * Math.cos(turn), radius * Math.sin(2 * Math.PI * j), reach * Math.sin(turn)];
  };
  const grid = (rows, columns, visit) => {
    for (let i = 0; i < rows; ++i) {
      for (let j = 0; j < columns; ++j) {
        const at = (di, dj) => (i + di) % rows * columns + (j + dj) % columns;
        visit(i, j, at(0, 0), at(1, 0), at(0, 1), at(1, 1));
      }
    }
  };
  const positions = [], triangles = [];
  grid(along, around, (i, j, a, b, c, d) => {
    const tread = Math.cos(2 * Math.PI * j / around) > 0.35 && (i + (j > around / 2 ? 2 : 0)) % 4 < 2 ? 0.016 : 0;
    positions.push(...pointOf(i / along, j / around, outer + tread));
    triangles.push(a, c, b, b, c, d);
  });
  const cage = count => {
    const rows = Math.max(12, Math.round(Math.sqrt(count / 6 * 16 / 7)));
    const columns = Math.max(6, Math.round(count / 6 / rows)), nodes = [], tets = [], up = rows * columns;
    for (const radius of [inner, outer]) {
      grid(rows, columns, (i, j) => nodes.push(...pointOf(i / rows, j / columns, radius)));
    }
    grid(rows, columns, (i, j, a, b, c, d) => {
      for (const face of [[a, b, d], [a, d, c]]) {
        const [p, q, r] = face.sort((x, y) => x - y);  // cuts of sides that prisms share begin at the lower node
        tets.push(p, q, r, r + up, p, q, q + up, r + up, p, p + up, q + up, r + up);
      }
    });
    return {nodes, tets};
  };
  return {positions: Float64Array.from(positions), triangles: Int32Array.from(triangles), cage};
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
