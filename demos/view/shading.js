// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Normals for drawing: smooth, also across vertices that coincide, except at creases. Creases are found once, at a
// body's start: an edge that became one while its body bends would flicker.

/** Cosine of the angle between two faces from which their edge is a crease. */
const CREASE = Math.cos(50 * Math.PI / 180);
/** Vertices so near to each other, as a share of the mesh's size, are at one place: those of a seam that are in
    different tets differ by the rounding of the nodes. */
const SAME_PLACE = 2e-5;

/** Largest side of the box around points. */
function sizeOf(positions) {
  let size = 0;
  for (let k = 0; k < 3; ++k) {
    let low = Infinity, high = -Infinity;
    for (let i = k; i < positions.length; i += 3) {
      low = Math.min(low, positions[i]);
      high = Math.max(high, positions[i]);
    }
    size = Math.max(size, high - low);
  }
  return size;
}

/** By vertex: a number that vertices at one place share, the first one of them. */
function placesOf(positions) {
  const near = SAME_PLACE * sizeOf(positions), cell = 16 * near || 1;
  const cells = new Map(), places = new Uint32Array(positions.length / 3);
  const isNear = (v, w) => [0, 1, 2].every(k => Math.abs(positions[3 * v + k] - positions[3 * w + k]) <= near);
  const cellOf = (v, k, shift) => Math.floor((positions[3 * v + k] + shift) / cell);
  /** The first place near a vertex: in its cell, or beyond a side of the cell that is near. */
  const placeNear = v => {
    for (let x = cellOf(v, 0, -near); x <= cellOf(v, 0, near); ++x) {
      for (let y = cellOf(v, 1, -near); y <= cellOf(v, 1, near); ++y) {
        for (let z = cellOf(v, 2, -near); z <= cellOf(v, 2, near); ++z) {
          const found = (cells.get(`${x},${y},${z}`) || []).find(w => isNear(v, w));
          if (found !== undefined) return found;
        }
      }
    }
    return v;
  };
  for (let v = 0; v < places.length; ++v) {
    places[v] = placeNear(v);
    if (places[v] !== v) continue;
    const key = [0, 1, 2].map(k => cellOf(v, k, 0)).join();
    if (!cells.has(key)) cells.set(key, []);
    cells.get(key).push(v);
  }
  return places;
}

/** Adds the area vector of a triangle to three sums of one array, whose places `to` names from `at` on. */
function addAreaVector(positions, triangles, at, sums, to) {
  const a = 3 * triangles[at], b = 3 * triangles[at + 1], c = 3 * triangles[at + 2];
  const px = positions[a], py = positions[a + 1], pz = positions[a + 2];
  const ux = positions[b] - px, uy = positions[b + 1] - py, uz = positions[b + 2] - pz;
  const vx = positions[c] - px, vy = positions[c + 1] - py, vz = positions[c + 2] - pz;
  const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
  for (let corner = 0; corner < 3; ++corner) {
    const sum = 3 * to[at + corner];
    sums[sum] += x;
    sums[sum + 1] += y;
    sums[sum + 2] += z;
  }
}

/** Unit normal of each corner's triangle, three numbers a corner. */
function cornerNormals(positions, triangles) {
  const normals = new Float32Array(3 * triangles.length);
  const itself = Uint32Array.from(triangles, (v, corner) => corner);  // beyond 65535, whatever holds the vertices
  for (let at = 0; at < triangles.length; at += 3) addAreaVector(positions, triangles, at, normals, itself);
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
    for (let k = 0; k < 3; ++k) normals[i + k] /= length;
  }
  return normals;
}

/** The corners around each place, one place after the other. */
function cornersByPlace(triangles, places) {
  const corners = Array.from(triangles, (v, corner) => corner);
  return corners.sort((a, b) => places[triangles[a]] - places[triangles[b]]);
}

/** By corner: a number that the corners share that have one normal. */
function smoothGroups(positions, triangles) {
  const places = placesOf(positions), normals = cornerNormals(positions, triangles);
  const corners = cornersByPlace(triangles, places), groups = new Int32Array(triangles.length).fill(-1);
  const joined = (a, b) => {
    let cosine = 0;
    for (let k = 0; k < 3; ++k) cosine += normals[3 * a + k] * normals[3 * b + k];
    return cosine > CREASE;
  };
  const placeAt = i => places[triangles[corners[i]]];
  let count = 0;
  for (let first = 0, end; first < corners.length; first = end) {
    for (end = first; end < corners.length && placeAt(end) === placeAt(first);) ++end;
    for (let i = first; i < end; ++i) {
      if (groups[corners[i]] >= 0) continue;
      const open = [corners[i]];
      groups[corners[i]] = count;
      while (open.length > 0) {
        const from = open.pop();
        for (let j = first; j < end; ++j) {
          if (groups[corners[j]] >= 0 || !joined(from, corners[j])) continue;
          groups[corners[j]] = count;
          open.push(corners[j]);
        }
      }
      ++count;
    }
  }
  return {groups, count};
}

/** A mesh as it is drawn: each vertex as often as it has normals. */
class DrawnMesh {
  /** positions: by which creases are found */
  constructor(triangles, positions) {
    const {groups, count} = smoothGroups(positions, triangles);
    const known = new Map(), sources = [], drawnGroups = [];
    this.index = new Uint32Array(triangles.length);
    for (let corner = 0; corner < triangles.length; ++corner) {
      const key = groups[corner] * (positions.length / 3) + triangles[corner];
      if (!known.has(key)) {
        known.set(key, sources.length);
        sources.push(triangles[corner]);
        drawnGroups.push(groups[corner]);
      }
      this.index[corner] = known.get(key);
    }
    this.triangles = triangles;
    this.cornerGroups = groups;
    this.sources = Uint32Array.from(sources);
    this.groups = Uint32Array.from(drawnGroups);
    this.sums = new Float32Array(3 * count);
    this.positions = new Float32Array(3 * sources.length);
    this.normals = new Float32Array(3 * sources.length);
  }

  /** Normals need not be of unit length: the shader sees to that. */
  update(positions) {
    this.sums.fill(0);
    for (let at = 0; at < this.triangles.length; at += 3) {
      addAreaVector(positions, this.triangles, at, this.sums, this.cornerGroups);
    }
    for (let v = 0; v < this.sources.length; ++v) {
      const from = 3 * this.sources[v], sum = 3 * this.groups[v];
      for (let k = 0; k < 3; ++k) {
        this.positions[3 * v + k] = positions[from + k];
        this.normals[3 * v + k] = this.sums[sum + k];
      }
    }
  }
}
