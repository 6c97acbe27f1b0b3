// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A world: objects that fall, are held, thrown, picked, saved and deleted.
import assert from "node:assert/strict";
import {test} from "node:test";

import {failure, load, TetskinError} from "./module.mjs";
import {tube} from "./shapes.mjs";

const tetskin = await load();
const shape = tube();
const mesh = tetskin.createMesh(shape.positions, shape.triangles);
const cage = tetskin.createCage(mesh, {targetTets: 300});

const lowest = numbers => numbers.reduce((least, x, i) => i % 3 === 1 ? Math.min(least, x) : least, Infinity);
const steps = (world, count) => { for (let i = 0; i < count; ++i) world.step(); };

function drop(options = {}) {
  const world = tetskin.createWorld({deterministic: true});
  world.addPlane();
  return {world, body: world.addBody(cage, mesh, {position: [0, 0.8, 0], ...options})};
}

test("a body falls, and lies on its surface", () => {
  const {world, body} = drop({normals: "recomputed"});
  assert.equal(world.step(1 / 60, 4), 4);
  steps(world, 239);
  assert.ok(Math.abs(lowest(body.positions)) < 0.01);
  assert.equal(body.normals.length, body.positions.length);
  assert.deepEqual(body.bounds.map(Math.fround)[1], lowest(body.positions));
  assert.ok(Math.abs(world.time - 4) < 1e-9);
  assert.ok(body.mass > 0 && body.nodeCount === cage.nodeCount);
});

test("a hidden surface is not computed until it is shown, and the body moves alike", () => {
  const {world, body} = drop({visible: false}), seen = drop();
  const before = body.positions.slice();
  steps(world, 60);
  steps(seen.world, 60);
  assert.equal(world.hash, seen.world.hash);
  assert.deepEqual(body.positions, before);
  body.visible = true;
  assert.deepEqual(body.positions, seen.body.positions);
});

test("bones of a body draw its surface", () => {
  const {world, body} = drop();
  steps(world, 60);
  const palette = tetskin.createPalette(cage, mesh), bones = palette.update(body);
  assert.deepEqual(palette.update(body.nodes), bones);
  const which = palette.vertexBones(), weights = palette.vertexWeights();
  for (let v = 0; v < mesh.vertexCount; v += 11) {
    for (let row = 0; row < 3; ++row) {
      let sum = mesh.positions[3 * v + row];
      for (let i = 0; i < 4; ++i) sum += weights[4 * v + i] * bones[12 * which[4 * v + i] + 4 * row + 3];
      assert.ok(Math.abs(sum - body.positions[3 * v + row]) < 1e-5);
    }
  }
});

test("rigid bodies of all shapes fall, fly, and rest", () => {
  const world = tetskin.createWorld();
  world.addPlane({offset: -1, friction: 1});
  const hull = [1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1];
  const thrown = world.addSphere(0.2, {mass: 2, position: [0, 5, 10], velocity: [3, 0, 0], angularVelocity: [0, 1, 0]});
  world.addBox([0.2, 0.3, 0.4], {mass: 1, position: [0, 1, 0]});
  world.addCapsule(0.2, 0.5, {mass: 1, position: [3, 1, 0]});
  world.addCylinder(0.2, 0.5, {mass: 1, position: [6, 1, 0]});
  world.addConvexHull(hull, {mass: 1, position: [9, 1, 0], rotation: [0, 0, 2, 0]});
  world.addMesh(mesh, {position: [0, -3, 0]});
  assert.equal(thrown.mass, 2);
  world.step();
  assert.ok(Math.abs(thrown.velocity[0] - 3) < 1e-6 && Math.abs(thrown.angularVelocity[1] - 1) < 1e-3);
  steps(world, 239);
  assert.ok(thrown.position[0] > 2);
  const poses = world.poses();
  assert.equal(poses.length, 7 * world.rigidBodies.length);
  assert.deepEqual([...poses.subarray(7, 10)], [...thrown.position]);
  for (const rigid of world.rigidBodies.slice(1, 6)) assert.ok(rigid.position[1] > -1 && rigid.position[1] < 0.5);
  thrown.position = [0, 2, 0];
  thrown.rotation = [0, 1, 0, 1];
  thrown.velocity = [0, 0, 1];
  thrown.angularVelocity = [0, 0, 0];
  thrown.friction = 0.1;
  thrown.applyImpulse([0, 0, 2]);
  assert.deepEqual([...thrown.position], [0, 2, 0]);
  assert.ok(Math.abs(thrown.rotation[1] - Math.SQRT1_2) < 1e-6 && Math.abs(thrown.friction - 0.1) < 1e-6);
  assert.ok(Math.abs(thrown.velocity[2] - 2) < 1e-6);
  thrown.applyImpulse([0, 0, 1], [0, 2.2, 0]);
  assert.ok(thrown.angularVelocity[0] > 0.1);
});

test("kinematic bodies grip a body, and lift it", () => {
  const {world, body} = drop();
  steps(world, 60);
  const fingers = [-1, 1].map(side => ({side, rigid: world.addBox([0.2, 0.3, 0.1],
    {position: [1, 0.3, 0.6 * side], kinematic: true, friction: 1})}));
  assert.ok(fingers.every(({rigid}) => rigid.kinematic));
  for (let frame = 0; frame < 180; ++frame) {
    for (const {side, rigid} of fingers) {
      rigid.position = [1, 0.3 + Math.max(0, frame - 60) / 100, side * Math.max(0.33, 0.6 - frame / 100)];
    }
    world.step();
  }
  assert.ok(lowest(body.positions) > 0.3);
});

test("pinned nodes stay, and are wrung by hand", () => {
  const left = [...Array(cage.nodeCount).keys()].filter(node => cage.nodes[3 * node] < 0.2);
  const world = tetskin.createWorld();
  const body = world.addBody(cage, mesh, {pinned: left, relativeStiffness: 100});
  assert.equal(body.pinned.reduce((sum, one) => sum + one, 0), left.length);
  const rest = body.nodes.slice();
  steps(world, 60);
  for (const node of left) assert.equal(body.nodes[3 * node + 1], rest[3 * node + 1]);
  assert.ok(lowest(body.positions) < -0.31);
  const targets = left.flatMap(node => [rest[3 * node], -rest[3 * node + 2], rest[3 * node + 1]]);
  for (let frame = 0; frame < 30; ++frame) {
    body.setPinnedPositions(left, targets);
    world.step();
  }
  assert.ok(Math.abs(body.nodes[3 * left[0] + 1] + rest[3 * left[0] + 2]) < 1e-5);
  body.setPinned(left, false);
  assert.equal(body.pinned.reduce((sum, one) => sum + one, 0), 0);
  steps(world, 60);
  assert.ok(body.bounds[4] < -1);
  assert.throws(() => body.setPinnedPositions(left, targets), failure("InvalidOption", /not pinned/));
  assert.throws(() => body.setPinned([cage.nodeCount]), failure("IndexOutOfRange"));
});

test("a ray picks the surface, and a spring draws it to the pointer", () => {
  const {world, body} = drop();
  steps(world, 120);
  assert.equal(world.raycast([9, 5, 0], [9, -5, 0]), null);
  const hit = world.raycast([1.5, 5, 0], [1.5, -5, 0]);
  assert.equal(hit.body, body);
  assert.ok(Math.abs(hit.point[0] - 1.5) < 1e-5 && Math.abs(hit.distance - (5 - hit.point[1])) < 1e-5);
  assert.ok(hit.normal[1] > 0.9 && Math.abs(hit.weights[0] + hit.weights[1] + hit.weights[2] - 1) < 1e-5);
  const spring = world.addSpring(hit);
  spring.setStiffness(20);
  spring.setMaxForce(1e6);
  for (let frame = 1; frame <= 120; ++frame) {
    spring.setTarget([1.5, hit.point[1] + Math.min(1, frame / 60), 0]);
    world.step();
  }
  assert.ok(spring.stretch < 0.02 * 2 && Math.abs(spring.position[1] - hit.point[1] - 1) < 0.04);
  assert.ok(spring.force[1] > 0 && spring.body === body);
  spring.delete();
  steps(world, 120);
  assert.ok(Math.abs(lowest(body.positions)) < 0.02);
  assert.throws(() => spring.setTarget([0, 0, 0]), failure("Deleted"));
});

test("impulses push", () => {
  const {world, body} = drop();
  world.gravity = [0, 0, 0];
  assert.deepEqual([...world.gravity], [0, 0, 0]);
  const hit = world.raycast([1, 5, 0], [1, -5, 0]);
  world.applyImpulse(hit, [0, 0, 2 * body.mass]);
  assert.ok(body.applyRadialImpulse([1, 0.2, 0], 1, body.mass) > 0);
  assert.equal(body.applyRadialImpulse([1, 50, 0], 1, 1), 0);
  steps(world, 10);
  assert.ok(body.bounds[2] > -0.2 && body.bounds[4] > 1.15);
  body.velocities = new Float32Array(3 * body.nodeCount);
  assert.ok(body.velocities.every(x => x === 0));
  body.transform([0, 10, 0]);
  assert.ok(body.bounds[1] > 10);
});

test("a body goes back to its start, elsewhere in its motion, and along with its world", () => {
  const {world, body} = drop(), start = body.nodes.slice();
  const afterSteps = () => (steps(world, 20), body.nodes.slice());
  const first = afterSteps();
  body.reset();
  assert.deepEqual(body.nodes, start);
  assert.deepEqual(afterSteps(), first);
  world.gravity = [0, 0, 0];
  body.velocities = new Float32Array(3 * body.nodeCount).map((_, k) => (k % 3 === 0 ? 2 : 0));
  body.transform([0, 50, 0], [0, 0, Math.SQRT1_2, Math.SQRT1_2]);
  for (let n = 0; n < body.nodeCount; ++n) {
    assert.ok(Math.abs(body.velocities[3 * n + 1] - 2) < 1e-4, "velocities turn along");
  }
  const before = body.nodes.slice();
  world.shiftOrigin([4, 2, -8]);
  before.forEach((x, k) => assert.ok(Math.abs(body.nodes[k] + [4, 2, -8][k % 3] - x) < 1e-5));
  assert.throws(() => world.shiftOrigin([1, 2]), {code: "InvalidArgument"});
});

test("forces on bodies and on what they touch are told by cause", () => {
  const world = tetskin.createWorld({recordForces: true}), ground = world.addBox([5, 0.5, 5], {position: [0, -0.5, 0]});
  const body = world.addBody(cage, mesh, {position: [0, 0.35, 0]}), ball = world.addSphere(0.1, {position: [0, 9, 0]});
  steps(world, 120);
  const weight = 9.81 * body.mass, {contact, friction, joints, total} = world.forcesOn(body);
  assert.ok(Math.abs(contact.force[1] / weight - 1) < 0.02, `${contact.force[1]} for ${weight}`);
  assert.deepEqual([...joints.force, ...joints.torque], [0, 0, 0, 0, 0, 0]);
  for (let k = 0; k < 3; ++k) {
    assert.ok(Math.abs(total.force[k] - contact.force[k] - friction.force[k]) < 1e-5 * weight);
    assert.ok(Math.abs(world.forcesOn(ground, body).total.force[k] + total.force[k]) < 1e-5 * weight);
  }
  assert.deepEqual(world.forcesOn(body, ground), world.forcesOn(body));
  assert.deepEqual([...world.forcesOn(ball).total.force], [0, 0, 0]);
  const other = drop();
  assert.throws(() => other.world.forcesOn(other.body), failure("NotAdded", /^recordForces:/));
  assert.throws(() => world.forcesOn(other.body), failure("NotInWorld", /^thing:/));
  assert.throws(() => world.forcesOn(body, mesh), failure("InvalidArgument", /^other:/));
  ball.delete();
  assert.throws(() => world.forcesOn(body, ball), failure("Deleted", /^other:/));
});

test("forces are recorded without a change of the run", () => {
  const hashes = [false, true].map(recordForces => {
    const world = tetskin.createWorld({deterministic: true, recordForces});
    world.addPlane();
    world.addBody(cage, mesh, {position: [0, 0.4, 0]});
    steps(world, 60);
    return world.hash;
  });
  assert.equal(hashes[0], hashes[1]);
});

test("margin, solverTolerance and maxIterations are those of C++", () => {
  const lowestAfter = options => {
    const world = tetskin.createWorld({deterministic: true});
    world.addPlane();
    const body = world.addBody(cage, mesh, {position: [0, 0.5, 0], ...options});
    steps(world, 60);
    return [lowest(body.nodes), world.hash];
  };
  const [, usual] = lowestAfter({});
  assert.equal(lowestAfter({solverTolerance: 5e-3, maxIterations: 100})[1], usual);
  assert.notEqual(lowestAfter({solverTolerance: 1e-6})[1], usual);
  assert.notEqual(lowestAfter({maxIterations: 1})[1], usual);
  const [near, far] = [0.01, 0.2].map(margin => lowestAfter({surfaceContact: false, margin})[0]);
  assert.ok(Math.abs(near - 0.01) < 0.02 && Math.abs(far - 0.2) < 0.02, `${near}, ${far}`);
});

test("nodeMasses, stiffnessScale, outside and maxDistance are those of C++", () => {
  const world = tetskin.createWorld(), each = new Array(cage.nodeCount).fill(0.5);
  const soft = tetskin.createWorld().addBody(cage, mesh, {nodeMasses: each, outside: "barycentric"});
  assert.ok(Math.abs(soft.mass - 0.5 * cage.nodeCount) < 1e-3);
  const stiffnessScale = new Float64Array(cage.tetCount).fill(2);
  assert.equal(world.addBody(cage, mesh, {stiffnessScale}).mass, world.addBody(cage, mesh).mass);
  assert.throws(() => world.addBody(cage, mesh, {stiffnessScale: [1]}), failure("SizeMismatch", /./));
  assert.throws(() => world.addBody(cage, mesh, {nodeMasses: [1]}), failure("SizeMismatch", /./));
  assert.throws(() => world.addBody(cage, mesh, {maxDistance: -1}), failure("InvalidOption", /./));
  assert.throws(() => world.addBody(cage, mesh, {outside: "far"}), failure("InvalidArgument", /^outside: /));
  assert.equal(world.bodies.length, 2);
});

test("recomputed normals stay split at edges of more than hardEdgeDegrees", () => {
  const corners = [...shape.triangles].flatMap(vertex => [0, 1, 2].map(axis => 3 * vertex + axis));
  // Triangles take turns: all normals along x, or all along y: 90 degrees at many edges.
  const normals = corners.map((i, k) => k % 9 % 3 === 0 ? 1 : 0);
  for (let k = 9; k < normals.length; k += 18) for (let n = 0; n < 9; ++n) normals[k + n] = n % 3 === 1 ? 1 : 0;
  const facets = tetskin.createMesh(corners.map(i => shape.positions[i]), shape.triangles.map((_, corner) => corner),
    {normals});
  const world = tetskin.createWorld(), own = tetskin.createCage(facets, {targetTets: 300});
  const normalsOf = (of, options) =>
    [...world.addBody(of === mesh ? cage : own, of, {normals: "recomputed", ...options}).normals];
  const seamless = normalsOf(mesh), split = normalsOf(facets), joined = normalsOf(facets, {hardEdgeDegrees: 180});
  const furthest = numbers => Math.max(...corners.map((i, k) => Math.abs(numbers[k] - seamless[i])));
  assert.ok(furthest(split) > 0.05 && furthest(joined) < 1e-4, `${furthest(split)}, ${furthest(joined)}`);
  assert.deepEqual(normalsOf(facets, {hardEdgeDegrees: 5}), split);
  assert.throws(() => normalsOf(facets, {hardEdgeDegrees: -1}), failure("InvalidOption", /hardEdgeDegrees/));
});

test("materials change while it runs", () => {
  const {world, body} = drop({youngsModulus: 1e4, mass: 5});
  assert.ok(Math.abs(body.mass - 5) < 1e-3 && Math.abs(body.youngsModulus - 1e4) < 1e-6);
  Object.assign(body, {youngsModulus: 2e4, poissonRatio: 0.4, stiffnessDamping: 0.1, friction: 0.25});
  assert.deepEqual([body.youngsModulus, body.poissonRatio], [2e4, 0.4]);
  assert.deepEqual([body.stiffnessDamping, body.friction], [0.1, 0.25]);
  body.setGravity([0, 1, 0]);
  steps(world, 30);
  assert.ok(body.bounds[1] > 0.5);
  body.setGravity(null);
  steps(world, 30);
  assert.ok(body.relativeStiffness > 0);
  const {volume} = body;
  body.pressure = 500;
  assert.ok(body.pressure === 500 && volume > 0);
  body.setGas(1000, 1e5);
  assert.ok(Math.abs(body.pressure - 1000) < 1);
  body.pressure = 0;
  const refused = {pressure: 1e30, youngsModulus: -1, poissonRatio: 0.5, stiffnessDamping: -1, friction: 2};
  for (const [name, value] of Object.entries(refused)) {
    const before = body[name];
    assert.throws(() => { body[name] = value; }, failure("InvalidOption"));
    assert.equal(body[name], before);
  }
});

test("restitution is read and set, of soft and rigid bodies", () => {
  const {world, body} = drop({restitution: 0.75});
  const ball = world.addSphere(0.1, {mass: 1});
  assert.deepEqual([body.restitution, world.addBody(cage, mesh).restitution, ball.restitution], [0.75, 0, 0]);
  for (const thing of [body, ball]) {
    for (const restitution of [0, 1, 0.25]) {
      thing.restitution = restitution;
      assert.equal(thing.restitution, restitution);
    }
    for (const restitution of [-0.1, 1.1]) {
      assert.throws(() => { thing.restitution = restitution; }, failure("InvalidOption", /^restitution: .*0 to 1/));
    }
    assert.throws(() => { thing.restitution = NaN; }, failure("InvalidArgument", /^restitution: must be a number/));
    assert.equal(thing.restitution, 0.25);
  }
});

test("bodies with soft contact meet each other", () => {
  const world = tetskin.createWorld();
  world.addPlane();
  for (const height of [0.35, 1.1]) world.addBody(cage, mesh, {position: [0, height, 0], softContact: true});
  steps(world, 120);
  const [below, above] = world.bodies.map(({bounds}) => bounds);  // one lies on the other, or beside it
  assert.ok(above[4] > below[4] + 0.2 || above[1] > 0.1 || Math.abs(above[2] - below[2]) > 0.3);
  assert.ok(world.times.softSearch > 0);
});

test("a snapshot goes on to the last bit, here and in another instance", async () => {
  const {world, body} = drop();
  world.addSphere(0.2, {mass: 3, position: [1, 2, 0]});
  steps(world, 50);
  const memory = new Uint8Array(2 * world.snapshotSize), snapshot = world.save(memory);
  assert.equal(snapshot.length, world.snapshotSize);
  assert.equal(snapshot.buffer, memory.buffer);
  assert.deepEqual(world.save(), snapshot);
  steps(world, 50);
  const end = world.hash, nodes = body.nodes.slice();
  world.restore(snapshot);
  steps(world, 50);
  assert.equal(world.hash, end);
  assert.deepEqual(body.nodes, nodes);
  const other = await load(), again = other.createWorld({deterministic: true});
  again.addPlane();
  again.addBody(other.cageFromBytes(cage.toBytes()), other.meshFromBytes(mesh.toBytes()), {position: [0, 0.8, 0]});
  assert.throws(() => again.restore(snapshot), failure("SnapshotMismatch"));
  again.addSphere(0.2, {mass: 3, position: [1, 2, 0]});
  again.restore(snapshot);
  steps(again, 50);
  assert.equal(again.hash, end);
  assert.throws(() => world.restore(snapshot.slice(0, 99)), failure("Malformed"));
  assert.throws(() => world.save(new Uint8Array(10)), failure("SizeMismatch"));
  assert.equal(world.hash, end);
});

test("time goes on with a step that was made, though it throws, and with no other that does", () => {
  const {world} = drop(), {core} = world.hidden.instance, {step} = core;
  assert.throws(() => world.step(-1), failure("InvalidArgument"));
  assert.equal(world.time, 0);
  for (const code of ["NonFinite", "TopologyChanged"]) {
    core.step = () => { throw new TetskinError(code, "after the step"); };
    try {
      assert.throws(() => world.step(0.5), failure(code));
    } finally {
      core.step = step;
    }
  }
  assert.equal(world.time, 1);
});

test("milliseconds of the stages add up", () => {
  const {world} = drop();
  steps(world, 100);
  const {total, ...stages} = world.times;
  assert.deepEqual(Object.keys(stages),
    ["prediction", "rigidSearch", "softSearch", "rows", "system", "other", "surfaces"]);
  const sum = Object.values(stages).reduce((a, b) => a + b, 0);
  assert.ok(total > 0 && Math.abs(sum - total) <= 0.02 * total + 1e-6);
});

test("views are of the module's memory, and a version tells when it has grown", async () => {
  const own = await load();
  const first = own.createMesh(shape.positions, shape.triangles), view = first.positions, version = own.memoryVersion;
  assert.equal(view.buffer.byteLength, own.memoryBytes);
  own.createCage(first, {targetTets: 60000});
  assert.ok(own.memoryVersion > version && own.memoryBytes > 2 ** 24);
  assert.equal(view.length, 0);
  assert.deepEqual(first.positions, shape.positions);
  const now = own.memoryVersion;
  assert.equal(own.memoryVersion, now);
});

test("3,000 steps and snapshots take no more memory", () => {
  const {world} = drop();
  const snapshot = world.save();
  steps(world, 60);
  const before = tetskin.memoryBytes;
  for (let i = 0; i < 3000; ++i) {
    world.step(1 / 60, 1);
    if (i % 3 === 0) world.restore(snapshot);  // 40 MB of snapshots in all
    world.raycast([1, 5, 0], [1, -5, 0]);
  }
  assert.equal(tetskin.memoryBytes, before);
});

test("what is deleted is gone, with what hangs on it", () => {
  const {world, body} = drop();
  const rigid = world.addSphere(0.1, {mass: 1});
  const spring = world.addSpring(world.raycast([1, 5, 0], [1, -5, 0]));
  rigid.delete();
  assert.equal(world.rigidBodies.length, 1);
  body.delete();
  assert.ok(spring.deleted && body.deleted && world.bodies.length === 0);
  assert.throws(() => body.nodes, failure("Deleted"));
  const second = world.addBody(cage, mesh, {position: [0, 1, 0]});
  world[Symbol.dispose ?? Symbol.for("Symbol.dispose")]();
  assert.ok(world.deleted && second.deleted);
  assert.throws(() => world.step(), failure("Deleted", /World/));
  world.delete();
});

test("what could not be deleted is there, and is deleted later", () => {
  const {world, body} = drop(), {core} = world.hidden.instance, {removeBody} = core, rest = world.addSphere(0.1);
  core.removeBody = () => { throw new RangeError("no memory"); };
  try {
    assert.throws(() => body.delete(), RangeError);
  } finally {
    core.removeBody = removeBody;
  }
  assert.ok(!body.deleted && world.bodies[0] === body && body.nodes.length > 0);
  body.delete();
  assert.ok(body.deleted && world.bodies.length === 0 && world.rigidBodies.includes(rest));
  world.step();
});

test("all can be deleted where there is no memory left", async () => {
  const own = await load(), one = own.createMesh(shape.positions, shape.triangles);
  const few = own.createCage(one, {targetTets: 100}), world = own.createWorld(), {core} = world.hidden.instance;
  world.addPlane();
  const body = world.addBody(few, one, {position: [0, 1, 0]}), ball = world.addSphere(0.1, {mass: 1});
  world.step();
  const spring = world.addSpring(world.raycast([1, 9, 0], [1, -9, 0])), {grow} = WebAssembly.Memory.prototype;
  WebAssembly.Memory.prototype.grow = () => { throw new RangeError("full"); };
  try {
    for (let size = 1 << 24; size >= 8; size >>= 1) while (core._malloc(size) !== 0);
    for (const thing of [ball, body, world, few, one]) thing.delete();
  } finally {
    WebAssembly.Memory.prototype.grow = grow;
  }
  assert.ok(spring.deleted && world.deleted);
});

test("where memory ends within a call, it is said, and all goes on to the same bits", async () => {
  const calls = {
    addBody: ({world, few, one}) => world.addBody(few, one, {position: [0, 3, 0]}),
    softContact: ({world, few, one}) => world.addBody(few, one, {position: [0, 3, 0], softContact: true}),
    addSphere: ({world}) => world.addSphere(0.2, {mass: 1, position: [0, 3, 0]}),
    addSpring: ({world}) => world.addSpring(world.raycast([1, 9, 0], [1, -9, 0])),
    save: ({world}) => world.save(),
    nodes: ({body}) => body.nodes,
    report: ({few}) => few.report,
  };
  const {grow} = WebAssembly.Memory.prototype, said = {};
  const own = await load(), one = own.createMesh(shape.positions, shape.triangles);
  const few = own.createCage(one, {targetTets: 60}), {core} = own.hidden.instance;
  for (const [name, call] of Object.entries(calls)) {
    for (let room = 1024; room < 3e6 && said[name] !== "made"; room *= 3) {  // an error needs some, too
      const taken = [], [{world, body}, other] = [0, 1].map(() => {
        const world = own.createWorld({deterministic: true});
        world.addPlane();
        return {world, body: world.addBody(few, one, {position: [0, 0.4, 0]})};
      });
      for (const one of [world, other.world]) steps(one, 4);
      const hole = core._malloc(room);
      WebAssembly.Memory.prototype.grow = () => { throw new RangeError("full"); };
      try {
        for (let size = 1 << 24; size >= 8; size >>= 1) for (let at; (at = core._malloc(size)) !== 0;) taken.push(at);
        core._free(hole);
        call({world, body, few, one});
        said[name] = "made";
      } catch (error) {
        assert.ok(failure("OutOfMemory")(error), `${name}, ${room}: ${error}`);
        said[name] ??= "refused";
      } finally {
        WebAssembly.Memory.prototype.grow = grow;
      }
      for (const at of taken) core._free(at);
      if (said[name] === "made") continue;
      assert.deepEqual([world.bodies.length, world.rigidBodies.length], [1, 1], `${name}, ${room}`);
      for (const one of [world, other.world]) steps(one, 20);
      assert.equal(world.hash, other.world.hash, `${name}, ${room}`);
      for (const one of [world, other.world]) one.delete();
    }
    assert.ok(said[name], name);
  }
});

test("worlds that come and go leave no memory behind", () => {
  const once = () => {
    const {world} = drop();
    world.addSphere(0.1, {mass: 1});
    world.step();
    world.delete();
  };
  for (let i = 0; i < 10; ++i) once();
  const before = tetskin.memoryBytes;
  for (let i = 0; i < 100; ++i) once();
  assert.equal(tetskin.memoryBytes, before);
});

test("a body without a mesh has no surface", () => {
  const world = tetskin.createWorld();
  world.addPlane();
  const body = world.addBody(cage, null, {position: [0, 1, 0]});
  assert.equal(body.mesh, null);
  assert.throws(() => body.positions, failure("Unbound"));
  assert.throws(() => world.addBody(cage, null, {softContact: true}), failure("Unbound"));
  steps(world, 60);
  assert.ok(lowest(body.nodes) < 0.4);
});

test("bad arguments are named, and the world stays as it was", () => {
  const {world, body} = drop();
  const other = drop();
  const hit = world.raycast([1, 5, 0], [1, -5, 0]), before = world.hash;
  const refused = [
    [() => world.step(-1), "InvalidArgument", /dt/],
    [() => world.step(1n), "InvalidArgument", /dt/],
    [() => world.step(NaN), "InvalidArgument", /dt/],
    [() => world.step(1 / 60, 0), "InvalidArgument", /substeps/],
    [() => world.step(1 / 60, 1.5), "InvalidArgument", /substeps/],
    [() => world.addBox([1, 1]), "InvalidArgument", /halfExtents/],
    [() => world.addBox([1, -1, 1]), "InvalidArgument", /^halfExtents/],
    [() => world.addSphere(Infinity), "InvalidArgument", /radius/],
    [() => world.addSphere(1, {weight: 5}), "InvalidArgument", /weight/],
    [() => world.addSphere(1, {mass: -1}), "InvalidArgument", /mass/],
    [() => world.addSphere(1, {position: [0, 0, Infinity]}), "NonFinite", /position/],
    [() => world.addSphere(1, {rotation: [0, 0, 0, 0]}), "InvalidOption", /rotation/],
    [() => world.addMesh(mesh, {mass: 1}), "InvalidArgument", /mass/],
    [() => world.addConvexHull([0, 0, 0, 1, 1, 1]), "Empty", /points/],
    [() => world.addPlane({normal: [0, 0, 0]}), "InvalidArgument", /normal/],
    [() => world.addBody(cage), "InvalidArgument", /mesh/],
    [() => world.addBody(mesh, mesh), "InvalidArgument", /cage/],
    [() => world.addBody(cage, mesh, {poissonRatio: 0.7}), "InvalidOption", /./],
    [() => world.addBody(cage, mesh, {friction: 2}), "InvalidOption", /^friction: .*0 to 1/],
    [() => world.addBody(cage, mesh, {restitution: -0.1}), "InvalidOption", /^restitution: .*0 to 1/],
    [() => world.addBody(cage, mesh, {restitution: 1.1}), "InvalidOption", /^restitution: .*0 to 1/],
    [() => world.addBody(cage, mesh, {restitution: NaN}), "InvalidArgument", /^restitution: must be a number/],
    [() => world.addBody(cage, mesh, {margin: -1}), "InvalidOption", /^margin/],
    [() => world.addBody(cage, mesh, {solverTolerance: 1}), "InvalidOption", /tolerance/],
    [() => world.addBody(cage, mesh, {maxIterations: 1.5}), "InvalidArgument", /maxIterations/],
    [() => world.addBody(cage, mesh, {pinned: [1n]}), "InvalidArgument", /^pinned/],
    [() => world.addSphere(1n), "InvalidArgument", /radius/],
    [() => world.addSphere(1, {position: new BigInt64Array(3)}), "InvalidArgument", /position/],
    [() => { body.visible = 1; }, "InvalidArgument", /^visible/],
    [() => body.setPinned([true, false]), "InvalidArgument", /^nodes: .* 0 is a boolean/],
    [() => body.setPinned([0], 1), "InvalidArgument", /^pinned/],
    [() => world.addBody(cage, mesh, {interpolation: 3}), "InvalidArgument", /interpolation/],
    [() => world.addBody(cage, mesh, {pinned: [-1]}), "IndexOutOfRange", /node -1/],
    [() => { body.velocities = [1, 2, 3]; }, "SizeMismatch", /velocities/],
    [() => { world.gravity = [0, 0]; }, "InvalidArgument", /gravity/],
    [() => world.addSpring(null), "InvalidArgument", /hit/],
    [() => world.addSpring({...hit, triangle: -5}), "IndexOutOfRange", /triangle/],
    [() => world.addSpring({...hit, weights: [5, 5, 5]}), "InvalidOption", /./],
    [() => world.addSpring(hit, {stiffness: -1}), "InvalidOption", /./],
    [() => other.world.addSpring(hit), "NotInWorld", /./],
    [() => world.raycast([0, 0, 0]), "InvalidArgument", /end/],
    [() => world.restore("snapshot"), "InvalidArgument", /snapshot/],
    [() => body.applyRadialImpulse([0, 0, 0], -1, 1), "InvalidOption", /./],
  ];
  for (const [call, code, words] of refused) assert.throws(call, failure(code, words), call.toString());
  assert.equal(world.hash, before);
  assert.equal(world.bodies.length, 1);
  assert.equal(world.rigidBodies.length, 1);
});

test("the surface under pressure is the visible one, another one, or that of the tets", () => {
  const body = tetskin.createWorld({gravity: [0, 0, 0]}).addBody(cage, mesh), visible = body.volume;
  const volumeOf = ({positions: x, triangles}) => {
    let sum = 0;
    for (let t = 0; t < triangles.length; t += 3) {
      const [a, b, c] = [0, 1, 2].map(k => x.subarray(3 * triangles[t + k], 3 * triangles[t + k] + 3));
      for (let k = 0, l = 1, m = 2; k < 3; [k, l, m] = [k + 1, m, k]) sum += a[k] * (b[l] * c[m] - b[m] * c[l]);
    }
    return Math.abs(sum) / 6;
  };
  const near = (value, expected, by) => assert.ok(Math.abs(value / expected - 1) < by, `${value}, not ${expected}`);
  const {positions, triangles} = tube({radius: 0.15, rings: 20}), inner = tetskin.createMesh(positions, triangles);
  near(visible, volumeOf(mesh), 1e-5);
  body.setGas(100);
  body.setPressureSurface(inner);
  near(body.volume, volumeOf(inner), 1e-5);
  near(body.pressure, 100, 1e-6);
  body.setPressureSurface(null);
  const boundary = cage.boundaryFaces();
  near(body.volume, volumeOf({positions: cage.nodes, triangles: boundary}), 1e-5);
  body.setPressureSurface(mesh);
  near(body.volume, visible, 1e-9);
  const open = tetskin.createMesh(positions, triangles.subarray(3));
  assert.throws(() => body.setPressureSurface(open), failure("InvalidOption", /not closed/));
  assert.throws(() => body.setPressureSurface(), failure("InvalidArgument", /mesh/));
  near(body.volume, visible, 1e-9);
});

test("tets grow, contract and flow", () => {
  const world = tetskin.createWorld({gravity: [0, 0, 0], deterministic: true});
  const body = world.addBody(cage, mesh, {youngsModulus: 1e5, stiffnessDamping: 0.02});
  const tets = body.plasticStrains.length, length = () => body.bounds[3] - body.bounds[0], before = length();
  assert.equal(tets, cage.tetCount);
  body.setGrowth(1.2);
  steps(world, 240);
  assert.ok(Math.abs(length() / before - 1.2) < 0.01);
  body.setGrowth(new Float64Array(tets).fill(1));
  steps(world, 240);
  assert.ok(Math.abs(length() / before - 1) < 0.01);
  const muscle = body.addMuscle(Array.from({length: tets}, (_, t) => t), [1, 0, 0], 3e4);
  assert.equal(muscle.activation, 0);
  muscle.activation = 0.5;
  steps(world, 240);
  assert.ok(length() < 0.93 * before);
  muscle.activation = 0;
  steps(world, 240);
  const long = body.addMuscle(Array.from({length: tets}, (_, t) => t), [1, 0, 0], 3e4, [0.5, 0, 0.8, 1, 0.9, 0]);
  long.activation = 1;
  steps(world, 240);
  assert.ok(Math.abs(length() / before - 1) < 0.01, "beyond its curve it does not pull");
  long.activation = 0;
  body.setPlasticity({yieldStress: 100, hardening: 10, largest: 0.3});
  body.velocities = body.nodes.map((x, i) => i % 3 === 0 ? 10 * x : 0);
  steps(world, 60);
  assert.ok(Math.max(...body.plasticStrains) > 0.01);
  body.resetPlasticFlow();
  body.setPlasticity(null);
  assert.deepEqual([...new Set(body.plasticStrains)], [0]);
  const refused = (call, code, words) => assert.throws(call, failure(code, words));
  const snapshot = world.save();
  body.setStiffnessScale(new Float64Array(tets).fill(4));
  assert.notDeepEqual(world.save(), snapshot);
  refused(() => body.setStiffnessScale([1]), "SizeMismatch", /stiffnessScale/);
  refused(() => body.setStiffnessScale(new Float64Array(tets)), "InvalidOption", /1e-6 to 1e6/);
  refused(() => body.setStiffnessScale(4), "InvalidArgument", /factors/);
  body.setDampingScale(new Float64Array(tets).fill(0));
  refused(() => body.setDampingScale(new Float64Array(tets).fill(-1)), "InvalidOption", /0 or more/);
  refused(() => body.addFibres([0], [1, 0, 0], 0), "InvalidOption", /stiffness of fibres/);
  body.addFibres([0, 1], [1, 0, 0], 1e5, true);
  body.setElasticLaw("yeoh", {c2: 0.1, c3: 0.01});
  body.setElasticLaw("neo-hookean", {}, [0, 1]);
  body.setElasticLaw("corotated", {}, []);
  steps(world, 2);
  refused(() => body.setElasticLaw("yeoh", {c2: -1}), "InvalidOption", /at least 0.05/);
  refused(() => body.setElasticLaw("rubber"), "InvalidArgument", /neo-hookean/);
  refused(() => body.setElasticLaw("yeoh", {c4: 1}), "InvalidArgument", /no c4/);
  refused(() => body.addMuscle([0], [1, 0, 0], 1e4, [1, 1, 1, 1]), "InvalidOption", /lengthFactors/);
  refused(() => body.setGrowth(0), "InvalidOption", /0.05 to 20/);
  refused(() => body.setPlasticity({yieldStress: 1, speed: 2}), "InvalidArgument", /no speed/);
  refused(() => body.setPlasticity({}), "InvalidArgument", /yieldStress/);
  refused(() => body.addMuscle([tets], [1, 0, 0]), "IndexOutOfRange", /does not exist/);
  refused(() => { muscle.activation = 2; }, "InvalidOption", /0 to 1/);
});
