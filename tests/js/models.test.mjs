// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Meshes and cages: read, made, handed over, refused.
import assert from "node:assert/strict";
import {test} from "node:test";

import {failure, load} from "./module.mjs";
import {files, tube} from "./shapes.mjs";

const tetskin = await load();
const shape = tube();
const mesh = tetskin.createMesh(shape.positions, shape.triangles);

test("a mesh of arrays has what was given", () => {
  assert.equal(mesh.vertexCount, shape.positions.length / 3);
  assert.equal(mesh.triangleCount, shape.triangles.length / 3);
  assert.deepEqual(mesh.positions, shape.positions);
  assert.deepEqual(mesh.triangles, shape.triangles);
  assert.deepEqual(mesh.normals, new Float32Array(0));
  assert.deepEqual([...mesh.bounds].map(x => Math.round(1e6 * x) / 1e6), [0, -0.3, -0.3, 2, 0.3, 0.3]);
});

test("normals at rest look outwards", () => {
  const normals = mesh.restNormals(), {positions} = mesh;
  for (let v = 24; v < mesh.vertexCount - 26; ++v) {  // not the caps
    const [y, z] = positions.subarray(3 * v + 1, 3 * v + 3);
    assert.ok(normals[3 * v + 1] * y + normals[3 * v + 2] * z > 0.29, `vertex ${v}`);
  }
});

test("given normals and texture coordinates are kept", () => {
  const one = tetskin.createMesh([0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, 2],
    {normals: [0, 0, 1, 0, 0, 1, 0, 0, 1], texcoords: new Float32Array([0, 0, 1, 0, 0, 1])});
  assert.deepEqual([...one.normals], [0, 0, 1, 0, 0, 1, 0, 0, 1]);
  assert.deepEqual([...one.texcoords], [0, 0, 1, 0, 0, 1]);
  const copy = tetskin.meshFromBytes(one.toBytes());
  assert.deepEqual([...copy.texcoords], [0, 0, 1, 0, 0, 1]);
  assert.deepEqual([...copy.normals], [0, 0, 1, 0, 0, 1, 0, 0, 1]);
});

for (const format of Object.keys(files)) {
  test(`a ${format} file is read from its bytes`, () => {
    const read = tetskin.readMesh(files[format](shape), `Tube.${format.toUpperCase()}`);
    assert.equal(read.triangleCount, mesh.triangleCount);
    if (format !== "stl") assert.deepEqual(read.triangles, shape.triangles);  // which has three vertices per triangle
    const corner = 3 * read.triangles[100], expected = 3 * shape.triangles[100];
    for (let k = 0; k < 3; ++k) {
      const difference = Math.abs(read.positions[corner + k] - shape.positions[expected + k]);
      assert.ok(format === "stl" || format === "glb" ? difference < 1e-7 : difference === 0);
    }
  });

  test(`a damaged ${format} file is refused, and the next one is read`, () => {
    const whole = files[format](shape);
    assert.throws(() => tetskin.readMesh(whole.subarray(0, whole.length >> 1), format), ({code, message}) =>
      ["Malformed", "IndexOutOfRange", "Empty"].includes(code) && message.includes(`file.${format}`));
    assert.equal(tetskin.readMesh(whole, format).triangleCount, mesh.triangleCount);
  });
}

test("a glb that its node mirrors has its outside outside", () => {
  const volume = ({positions, triangles}) => {
    let sum = 0;
    for (let t = 0; t < triangles.length; t += 3) {
      const [a, b, c] = [0, 1, 2].map(k => positions.subarray(3 * triangles[t + k], 3 * triangles[t + k] + 3));
      for (let k = 0, l = 1, m = 2; k < 3; [k, l, m] = [k + 1, m, k]) sum += a[k] * (b[l] * c[m] - b[m] * c[l]);
    }
    return sum / 6;
  };
  const whole = volume(mesh);
  assert.ok(whole > 0.5);
  for (const scale of [[-1, 1, 1], [1, -1, 1], [-1, -1, -1], [-1, -1, 1]]) {
    const mirrored = tetskin.readMesh(files.glb(shape, {scale}), "glb");
    assert.ok(Math.abs(mirrored.positions[3 * 500] - scale[0] * mesh.positions[3 * 500]) < 1e-6);
    assert.ok(Math.abs(volume(mirrored) / whole - 1) < 1e-6, `${scale}`);
    assert.equal(tetskin.createCage(mirrored, {targetTets: 100}).vertexTets.length, mesh.vertexCount);
  }
});

test("formats that are not read are named", () => {
  assert.throws(() => tetskin.readMesh(new Uint8Array(100), "dragon.fbx"), failure("UnsupportedFormat", /fbx/));
  assert.throws(() => tetskin.readMesh(new Uint8Array(100), "../x/y"), failure("UnsupportedFormat"));
  assert.throws(() => tetskin.readMesh("v 0 0 0", "obj"), failure("InvalidArgument", /Uint8Array/));
});

test("a cage holds its mesh, and is the same each time", () => {
  const fractions = [];
  const cage = tetskin.createCage(mesh, {targetTets: 500, progress: fraction => { fractions.push(fraction); }});
  assert.ok(cage.tetCount > 450 && cage.tetCount < 550);
  assert.equal(cage.tets.length, 4 * cage.tetCount);
  assert.equal(cage.vertexTets.length, mesh.vertexCount);
  assert.match(cage.report, /tets/);
  assert.ok(fractions.length > 2 && fractions.every((f, i) => f >= 0 && f <= 1 && (i === 0 || f >= fractions[i - 1])));
  const again = tetskin.createCage(mesh, {targetTets: 500});
  assert.deepEqual(again.nodes, cage.nodes);
  assert.deepEqual(again.tets, cage.tets);
  assert.equal(cage.edges().length % 2, 0);
  assert.ok(cage.boundaryFaces().every(node => node >= 0 && node < cage.nodeCount));
});

test("maps are painted on a cage's mesh", () => {
  const factors = Array.from({length: mesh.vertexCount}, (_, v) => mesh.positions[3 * v] > 0 ? 4 : 1);
  const options = {targetTets: 500}, plain = tetskin.createCage(mesh, options);
  const cage = tetskin.createCage(mesh, {...options, stiffness: factors, density: Float32Array.from(factors)});
  assert.deepEqual(cage.nodes, plain.nodes);
  assert.equal(plain.paintedStiffness.length, 0);
  assert.equal(cage.paintedStiffness.length, cage.tetCount);
  assert.ok(Math.min(...cage.paintedStiffness) === 1 && Math.abs(Math.max(...cage.paintedStiffness) - 4) < 1e-9);
  const sum = masses => masses.reduce((a, b) => a + b);
  assert.ok(sum(cage.masses) > 1.2 * sum(plain.masses));
  const ones = tetskin.createCage(mesh, {...options, stiffness: factors.map(() => 1)});
  assert.deepEqual(ones.masses, plain.masses);
  assert.equal(ones.paintedStiffness.length, 0);
  assert.throws(() => tetskin.createCage(mesh, {density: [1, 2]}), failure("SizeMismatch"));
  assert.throws(() => tetskin.createCage(mesh, {density: factors.map(() => 0)}), failure("InvalidOption"));
});

test("progress cancels by false, and what it throws is thrown", () => {
  assert.throws(() => tetskin.createCage(mesh, {progress: () => false}), failure("Cancelled"));
  assert.throws(() => tetskin.createCage(mesh, {progress() { throw new RangeError("mine"); }}), RangeError);
  assert.ok(tetskin.createCage(mesh, {targetTets: 100, progress() {}}).tetCount > 50);
});

test("a cage is handed over to another instance by its bytes", async () => {
  const cage = tetskin.createCage(mesh, {targetTets: 300});
  const other = await load();
  const copy = other.cageFromBytes(cage.toBytes());
  assert.deepEqual([...copy.nodes], [...cage.nodes]);
  assert.deepEqual(copy.toBytes(), cage.toBytes());
  assert.equal(copy.report, cage.report);
  assert.throws(() => tetskin.createWorld().addBody(copy, null), failure("InvalidArgument", /another instance/));
  assert.throws(() => tetskin.createWorld({sleepAfter: -1}), failure("InvalidOption", /at least 0/));
  assert.throws(() => tetskin.createWorld({impactParts: 0}), failure("InvalidOption", /impactParts/));
  assert.throws(() => tetskin.createWorld({impactParts: 2.5}), failure("InvalidArgument", /impactParts/));
});

test("the bytes of a mesh keep its groups", () => {
  const text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng first\nf 1 2 3\ng second\nf 1 3 4\n";
  const bytes = tetskin.readMesh(Buffer.from(text), "obj").toBytes();
  for (const name of ["first", "second"]) assert.ok(Buffer.from(bytes).includes(name), name);
  assert.deepEqual(tetskin.meshFromBytes(bytes).toBytes(), bytes);
});

test("bytes that are damaged, cut short or of something else are refused", () => {
  const bytes = tetskin.createCage(mesh, {targetTets: 100}).toBytes();
  for (const broken of [bytes.slice(0, 100), new Uint8Array(0), mesh.toBytes()]) {
    assert.throws(() => tetskin.cageFromBytes(broken), failure("Malformed"));
  }
  for (let at = 0; at < bytes.length; at += 997) {
    const changed = bytes.slice();
    changed[at] ^= 4;
    assert.throws(() => tetskin.cageFromBytes(changed), failure("Malformed"));
  }
  assert.throws(() => tetskin.meshFromBytes(bytes), failure("Malformed"));
});

test("cages are calibrated, scaled, made quadratic, or made of tets", () => {
  const cage = tetskin.createCage(mesh, {targetTets: 60});
  assert.notDeepEqual(tetskin.calibrate(cage, {modeCount: 3}).toBytes(), cage.toBytes());
  assert.throws(() => tetskin.calibrate(cage, {progress: () => false}), failure("Cancelled"));
  assert.equal(cage.scaled(2).nodes[5], 2 * cage.nodes[5]);
  assert.equal(tetskin.refineQuadratic(cage).quadraticTet.length, 8 * cage.tetCount);
  assert.equal(tetskin.cageOfTets(cage.nodes, cage.tets).tetCount, cage.tetCount);
});

test("a painted map is read from the bytes of a file", () => {
  const ply = Buffer.from("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n" +
    "property float z\nproperty uchar red\nproperty float quality\nelement face 1\n" +
    "property list uchar int vertex_indices\nend_header\n0 0 0 255 0.5\n1 0 0 0 2\n0 1 0 51 -3\n3 0 1 2\n");
  assert.deepEqual([...tetskin.loadVertexMap(ply, "ply", "quality")], [0.5, 2, -3]);
  assert.deepEqual([...tetskin.loadVertexMap(ply, "arm.PLY", "red")].map(x => Math.round(1e6 * x) / 1e6), [1, 0, 0.2]);
  const obj = new TextEncoder().encode("v 0 0 0 1 0 0.25\nv 1 0 0 0 1 0.5\nv 0 1 0 0 0 1\nf 1 2 3\n");
  assert.deepEqual([...tetskin.loadVertexMap(obj, "obj", "blue")], [0.25, 0.5, 1]);
  assert.throws(() => tetskin.loadVertexMap(ply, "ply", "stiffness"), failure("InvalidOption", /quality/));
  assert.throws(() => tetskin.loadVertexMap(ply, "ply"), failure("InvalidArgument", /^name/));
  assert.throws(() => tetskin.loadVertexMap(files.stl(shape), "stl", "red"), failure("UnsupportedFormat"));
  assert.throws(() => tetskin.loadVertexMap(ply.subarray(0, 200), "ply", "red"), failure("Malformed", /file\.ply/));
});

test("maps are spread over a cage, and painted on it", () => {
  const cage = tetskin.createCage(mesh, {targetTets: 500}), {nodes, tets} = cage, before = cage.toBytes();
  const values = mesh.positions.filter((_, i) => i % 3 === 0).map(x => x < 1 ? 1 : 100);
  const spread = tetskin.spreadMap(cage, mesh, values);
  const geometric = tetskin.spreadMap(cage, mesh, values, {mean: "geometric"});
  assert.deepEqual([spread.tets.length, spread.nodes.length], [cage.tetCount, cage.nodeCount]);
  let between = 0;
  spread.tets.forEach((value, t) => {
    const ends = [0, 1, 2, 3].map(k => nodes[3 * tets[4 * t + k]]);
    if (Math.max(...ends) < 0.9) assert.equal(value, 1);
    if (Math.min(...ends) > 1.1) assert.equal(value, 100);
    if (value > 10 && value < 90) assert.ok(geometric.tets[t] < value && ++between);
  });
  assert.ok(between > 0);
  const painted = tetskin.paintCage(cage, mesh, {stiffness: values, density: values});
  const made = tetskin.createCage(mesh, {targetTets: 500, stiffness: values, density: values});
  assert.deepEqual([painted.paintedStiffness, painted.masses], [made.paintedStiffness, made.masses]);
  assert.notDeepEqual(painted.masses, cage.masses);
  assert.deepEqual(cage.toBytes(), before);
  const ones = new Float64Array(mesh.vertexCount).fill(1);
  assert.equal(tetskin.paintCage(painted, mesh, {stiffness: ones}).paintedStiffness.length, 0);
  assert.throws(() => tetskin.spreadMap(cage, mesh, [1]), failure("SizeMismatch"));
  assert.throws(() => tetskin.spreadMap(cage, mesh, values, {mean: "harmonic"}), failure("InvalidArgument", /mean/));
  const zeros = values.map(x => x - 1);
  assert.throws(() => tetskin.spreadMap(cage, mesh, zeros, {mean: "geometric"}), failure("InvalidOption"));
  assert.throws(() => tetskin.paintCage(cage, mesh, {density: [1, 2]}), failure("SizeMismatch", /density/));
  assert.throws(() => tetskin.paintCage(cage, mesh, {density: zeros}), failure("InvalidOption", /density/));
  assert.deepEqual(tetskin.paintCage(cage, mesh, {damping: ones}).toBytes(), before);
  const damped = tetskin.paintCage(cage, mesh, {damping: zeros});
  assert.deepEqual([damped.paintedStiffness.length, damped.masses], [0, cage.masses], "damping is painted alone");
  assert.notDeepEqual(damped.toBytes(), before);
  assert.throws(() => tetskin.paintCage(cage, mesh, {damping: zeros.map(x => x - 1)}),
    failure("InvalidOption", /damping/));
  assert.throws(() => tetskin.paintCage(mesh, cage, {}), failure("InvalidArgument", /cage/));
});

test("fibres follow a curve", () => {
  const cage = tetskin.createCage(mesh, {targetTets: 100}), all = Array.from({length: cage.tetCount}, (_, t) => t);
  const middle = t => [0, 1, 2, 3].reduce((sum, k) => sum + cage.nodes[3 * cage.tets[4 * t + k]] / 4, 0);
  const fibres = tetskin.fibresAlong(cage, all, [0, 0, 0, 1, 0, 0, 1, 9, 0]);  // along x, and then along y
  assert.equal(fibres.length, 3 * all.length);
  for (const t of all) {
    if (middle(t) < 0.7) assert.deepEqual([...fibres.subarray(3 * t, 3 * t + 3)], [1, 0, 0]);
  }
  assert.deepEqual([...tetskin.fibresAlong(cage, [3], [0, 0, 0, 0, -2, 0])], [0, -1, 0]);
  assert.throws(() => tetskin.fibresAlong(cage, all, [0, 0, 0]), failure("InvalidOption", /two points/));
  for (const none of [-1, cage.tetCount]) {
    assert.throws(() => tetskin.fibresAlong(cage, [none], [0, 0, 0, 1, 0, 0]), failure("IndexOutOfRange", /tets/));
  }
});

test("bones at rest leave the mesh where it is", () => {
  const cage = tetskin.createCage(mesh, {targetTets: 100});
  for (const interpolation of ["linear", "quadratic"]) {
    const palette = tetskin.createPalette(cage, mesh, {interpolation});
    assert.equal(palette.boneCount, cage.nodeCount);
    const bones = palette.update(cage.nodes), which = palette.vertexBones(), weights = palette.vertexWeights();
    for (let v = 0; v < mesh.vertexCount; v += 7) {
      for (let row = 0; row < 3; ++row) {
        let sum = 0;
        for (let i = 0; i < 4; ++i) {
          const at = 12 * which[4 * v + i] + 4 * row;
          const point = [...mesh.positions.subarray(3 * v, 3 * v + 3), 1];
          for (let k = 0; k < 4; ++k) sum += weights[4 * v + i] * bones[at + k] * point[k];
        }
        assert.ok(Math.abs(sum - mesh.positions[3 * v + row]) < 1e-5);
      }
    }
  }
});

/** Takes memory until the next larger piece makes it grow. Takes what memory there is where it cannot. */
function fill(instance, least = 64) {
  const {core} = instance.hidden.instance, before = instance.memoryBytes, {grow} = WebAssembly.Memory.prototype;
  WebAssembly.Memory.prototype.grow = () => { throw new RangeError("full"); };
  try {
    for (let size = 1 << 24; size >= least; size >>= 1) while (core._malloc(size) !== 0);
  } finally {
    WebAssembly.Memory.prototype.grow = grow;
  }
  assert.equal(instance.memoryBytes, before);
}

test("arguments may be views of the module's own memory, also where the call makes it grow", async () => {
  const own = await load(), small = own.createMesh(shape.positions, shape.triangles);
  const of = own.createCage(small, {targetTets: 300}), world = own.createWorld(), body = world.addBody(of, small);
  const all = Array.from({length: of.nodeCount}, (_, node) => node), palette = own.createPalette(of, small);
  body.setPinned(all);
  const calls = {
    positionsBefore: () => own.createMesh(small.positions.map(x => 2 * x), small.triangles).triangles,
    positions: () => own.createMesh(small.positions, small.triangles).positions,
    normals: () => own.createMesh(shape.positions, small.triangles, {normals: small.positions}).normals,
    texcoords: () => own.createMesh(shape.positions, shape.triangles,
      {texcoords: small.positions.subarray(0, 2 * small.vertexCount)}).texcoords,
    tets: () => own.cageOfTets(of.nodes, of.tets).tets,
    pinned: () => body.setPinnedPositions(all, body.nodes) ?? body.pinned,
    velocities: () => { body.velocities = body.nodes; return body.pinned; },
    hull: () => world.addConvexHull(small.positions).position,
    bones: () => palette.update(body.nodes),
    pinnedFromTheStart: () => world.addBody(of, small, {pinned: of.tets.subarray(0, 4)}).pinned,
    bytes: () => own.readMesh(own.hidden.instance.view(Uint8Array, file), "obj").triangles,
  };
  const text = files.obj(shape), file = {at: own.hidden.instance.core._malloc(text.length), count: text.length};
  own.hidden.instance.view(Uint8Array, file).set(text);
  for (const [name, call] of Object.entries(calls)) {
    const expected = call().slice(), before = own.memoryVersion;
    for (let k = 0; k < 5 && own.memoryVersion === before; ++k) {  // the call itself is to make memory grow
      fill(own);
      assert.deepEqual(call().slice(), expected, name);
    }
    assert.ok(own.memoryVersion > before, `${name}: memory has not grown`);
  }
});

test("a view that has lost its memory is refused, not taken for an empty array", async () => {
  const own = await load(), one = own.createMesh(shape.positions, shape.triangles), {triangles} = one;
  own.createCage(one, {targetTets: 60000});
  assert.equal(triangles.length, 0);
  assert.throws(() => own.createMesh(one.positions, triangles), failure("InvalidArgument", /^triangles: its memory/));
  const bytes = one.toBytes();
  structuredClone(bytes.buffer, {transfer: [bytes.buffer]});
  assert.throws(() => own.meshFromBytes(bytes), failure("InvalidArgument", /^bytes: .*transferred/));
  assert.equal(own.createMesh(one.positions, new Int32Array(0)).triangleCount, 0);
});

test("what tells the progress may delete what is in use", async () => {
  const own = await load(), one = own.createMesh(shape.positions, shape.triangles);
  const expected = own.createCage(one, {targetTets: 300});
  const cage = own.createCage(one, {targetTets: 300, progress: () => one.delete()});
  assert.deepEqual(cage.nodes, expected.nodes);
  const calibrated = own.calibrate(expected, {modeCount: 3});
  const other = own.calibrate(cage, {modeCount: 3, progress: () => cage.delete()});
  assert.ok(one.deleted && cage.deleted);
  assert.deepEqual(other.nodes, calibrated.nodes);
  assert.equal(own.createMesh(shape.positions, shape.triangles).triangleCount, mesh.triangleCount);
});

test("bad arguments are named, and nothing is made", () => {
  const cage = tetskin.createCage(mesh, {targetTets: 100});
  const refused = [
    [() => tetskin.createMesh([0, 0], [0, 1, 2]), "InvalidArgument", /positions/],
    [() => tetskin.createMesh("abc", []), "InvalidArgument", /positions/],
    [() => tetskin.createMesh([0, 0, 0], [0, 1, 2]), "IndexOutOfRange", /vertex 1/],
    [() => tetskin.createMesh([0, 0, 0], [0, 1.5, 0]), "InvalidArgument", /whole/],
    [() => tetskin.createMesh([0, NaN, 0], [0, 0, 0]), "NonFinite", /./],
    [() => tetskin.createMesh([], []), "Empty", /./],
    [() => tetskin.createMesh(new BigInt64Array(9), [0, 1, 2]), "InvalidArgument", /positions/],
    [() => tetskin.createMesh([0n, 0, 0], [0, 0, 0]), "InvalidArgument", /^positions: .* 0 is a bigint/],
    [() => tetskin.createMesh([0, null, 0], [0, 0, 0]), "InvalidArgument", /^positions: .* 1 is/],
    [() => tetskin.createMesh([0, "1", 0], [0, 0, 0]), "InvalidArgument", /^positions: .* 1 is a string/],
    [() => tetskin.createMesh([0, 0, 0], [0, 0n, 0]), "InvalidArgument", /^triangles: .* 1 is a bigint/],
    [() => tetskin.createMesh({length: 3}, [0, 0, 0]), "InvalidArgument", /^positions/],
    [() => tetskin.createCage(mesh, {progress: 5}), "InvalidArgument", /^progress: must be a function/],
    [() => tetskin.createCage(mesh, {toString: 5}), "InvalidArgument", /there is no toString/],
    [() => tetskin.createCage(mesh, {targetTets: 100n}), "InvalidArgument", /targetTets/],
    [() => tetskin.createMesh([0, 0, 0], [0, 0, 0], {normals: [1]}), "SizeMismatch", /normals/],
    [() => tetskin.createCage({}), "InvalidArgument", /mesh/],
    [() => tetskin.createCage(cage), "InvalidArgument", /mesh/],
    [() => tetskin.createCage(mesh, {tets: 5}), "InvalidArgument", /targetTets/],
    [() => tetskin.createCage(mesh, {targetTets: 0}), "InvalidOption", /targetTets/],
    [() => tetskin.createCage(mesh, {targetTets: "many"}), "InvalidArgument", /targetTets/],
    [() => tetskin.createPalette(cage, mesh, {interpolation: "cubic"}), "InvalidArgument", /interpolation/],
    [() => tetskin.createPalette(cage, mesh).update([1, 2, 3]), "SizeMismatch", /nodes/],
    [() => tetskin.calibrate(cage, {poissonRatio: 0.6}), "InvalidOption", /./],
    [() => cage.scaled(-1), "InvalidArgument", /scale/],
    [() => tetskin.cageOfTets([0, 0, 0], [0, 0, 0, 1]), "IndexOutOfRange", /./],
  ];
  for (const [call, code, words] of refused) assert.throws(call, failure(code, words), call.toString());
});

test("what is made of a mesh outlives it", () => {
  const own = tetskin.createMesh(shape.positions, shape.triangles);
  const cage = tetskin.createCage(own, {targetTets: 100}), bytes = cage.toBytes();
  own.delete();
  own.delete();
  assert.ok(own.deleted);
  assert.throws(() => own.positions, failure("Deleted"));
  assert.throws(() => tetskin.createCage(own), failure("Deleted"));
  assert.deepEqual(cage.toBytes(), bytes);
});

test("where memory ends, it is said, and the instance goes on", async () => {
  const {grow} = WebAssembly.Memory.prototype;
  const small = await load();
  const one = small.createMesh(shape.positions, shape.triangles);
  const large = Buffer.alloc(30_000_000, "v 0 0 0\n");
  WebAssembly.Memory.prototype.grow = () => { throw new RangeError("as on a small phone"); };
  try {
    assert.throws(() => small.createCage(one, {targetTets: 100_000}), failure("OutOfMemory", /fewer tets/));
    assert.throws(() => small.readMesh(large, "obj"), failure("OutOfMemory"));
    const cage = small.createCage(one, {targetTets: 100});
    const world = small.createWorld();
    world.addBody(cage, one);
    world.step();
    assert.equal(small.memoryVersion, 0);
  } finally {
    WebAssembly.Memory.prototype.grow = grow;
  }
  assert.ok(small.createCage(one, {targetTets: 20_000}).tetCount > 18_000);
});
