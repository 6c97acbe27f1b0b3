// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Meshes for tests, as arrays and as files.

/** A closed tube along x, of arithmetic and square roots alone: the same numbers everywhere. */
export function tube({rings = 40, length = 2, radius = 0.3, around = 24} = {}) {
  const positions = [], triangles = [];
  const circle = squareCircle(around);
  for (let ring = 0; ring <= rings; ++ring) {
    for (const [y, z] of circle) positions.push(length * ring / rings, radius * y, radius * z);
  }
  const left = positions.length / 3;
  positions.push(0, 0, 0, length, 0, 0);
  for (let a = 0; a < around; ++a) {
    const next = (a + 1) % around, last = rings * around;
    for (let ring = 0; ring < rings; ++ring) {
      const v = ring * around;
      triangles.push(v + a, v + next, v + around + next, v + a, v + around + next, v + around + a);
    }
    triangles.push(left, next, a, left + 1, last + a, last + next);
  }
  return {positions: Float64Array.from(positions), triangles: Int32Array.from(triangles)};
}

/** Points of a square's sides, pushed out onto its circle. */
function squareCircle(count) {
  const points = [];
  for (let i = 0; i < count; ++i) {
    const side = Math.floor(4 * i / count), along = 2 * (4 * i % count) / count - 1;
    const [x, y] = [[1, along], [-along, 1], [-1, -along], [along, -1]][side];
    const length = Math.sqrt(x * x + y * y);
    points.push([x / length, y / length]);
  }
  return points;
}

const rows = (numbers, columns) => Array.from({length: numbers.length / columns}, (_, i) =>
  Array.from(numbers.slice(columns * i, columns * (i + 1))));

/** The bytes of a file of this format. */
export const files = {
  obj: ({positions, triangles}) => Buffer.from([
    ...rows(positions, 3).map(p => `v ${p.join(" ")}`),
    ...rows(triangles, 3).map(t => `f ${t.map(v => v + 1).join(" ")}`)].join("\n")),
  ply: ({positions, triangles}) => Buffer.from([
    "ply", "format ascii 1.0", `element vertex ${positions.length / 3}`, "property double x", "property double y",
    "property double z", `element face ${triangles.length / 3}`, "property list uchar int vertex_indices", "end_header",
    ...rows(positions, 3).map(p => p.join(" ")), ...rows(triangles, 3).map(t => `3 ${t.join(" ")}`), ""].join("\n")),
  off: ({positions, triangles}) => Buffer.from([
    "OFF", `${positions.length / 3} ${triangles.length / 3} 0`,
    ...rows(positions, 3).map(p => p.join(" ")), ...rows(triangles, 3).map(t => `3 ${t.join(" ")}`), ""].join("\n")),
  stl({positions, triangles}) {
    const bytes = Buffer.alloc(84 + 50 * triangles.length / 3);
    bytes.writeUInt32LE(triangles.length / 3, 80);
    triangles.forEach((vertex, i) => {
      for (let k = 0; k < 3; ++k) {
        bytes.writeFloatLE(positions[3 * vertex + k], 84 + 50 * Math.floor(i / 3) + 12 + 12 * (i % 3) + 4 * k);
      }
    });
    return bytes;
  },
  /** node: of the scene, with what else it has */
  glb({positions, triangles}, node = {}) {
    const points = Float32Array.from(positions), corners = Uint32Array.from(triangles);
    const content = Buffer.concat([Buffer.from(points.buffer), Buffer.from(corners.buffer)]);
    const column = k => rows(points, 3).map(p => p[k]);
    const scene = JSON.stringify({
      asset: {version: "2.0"}, scene: 0, scenes: [{nodes: [0]}], nodes: [{mesh: 0, ...node}],
      meshes: [{primitives: [{attributes: {POSITION: 0}, indices: 1}]}],
      buffers: [{byteLength: content.length}],
      bufferViews: [{buffer: 0, byteLength: points.byteLength},
        {buffer: 0, byteOffset: points.byteLength, byteLength: corners.byteLength}],
      accessors: [
        {bufferView: 0, componentType: 5126, count: points.length / 3, type: "VEC3",
          min: [0, 1, 2].map(k => Math.min(...column(k))), max: [0, 1, 2].map(k => Math.max(...column(k)))},
        {bufferView: 1, componentType: 5125, count: corners.length, type: "SCALAR"}],
    });
    const text = Buffer.from(scene.padEnd(Math.ceil(scene.length / 4) * 4));
    const chunk = (kind, body) => {
      const head = Buffer.alloc(8);
      head.writeUInt32LE(body.length, 0);
      head.write(kind, 4, "latin1");
      return Buffer.concat([head, body]);
    };
    const body = Buffer.concat([chunk("JSON", text), chunk("BIN\0", content)]);
    const head = Buffer.alloc(12);
    head.write("glTF", 0);
    head.writeUInt32LE(2, 4);
    head.writeUInt32LE(12 + body.length, 8);
    return Buffer.concat([head, body]);
  },
};
