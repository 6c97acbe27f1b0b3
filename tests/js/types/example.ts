// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A program that uses all kinds of things of the module, for the compiler to check. It is not run.
import {load, TetskinError, version} from "tetskin";
import type {Body, BodyOptions, Cage, ErrorCode, Hit, Mesh, Palette, Tetskin, World} from "tetskin";

const soft: BodyOptions = {position: [0, 1, 0], relativeStiffness: 80, normals: "recomputed", pinned: [1, 2, 3]};

async function cageInWorker(bytes: Uint8Array): Promise<Uint8Array> {
  const tetskin: Tetskin = await load();
  using mesh = tetskin.readMesh(bytes, "dragon.glb");
  using cage = tetskin.createCage(mesh, {targetTets: 1000, progress: fraction => fraction < 1});
  return cage.toBytes();
}

function draw(palette: Palette, body: Body): Float32Array {
  const bones: Float32Array = palette.update(body);
  const which: Uint16Array = palette.vertexBones(), weights: Float32Array = palette.vertexWeights();
  return bones.length > which.length + weights.length ? bones : body.positions;
}

function drag(world: World, from: Float32Array, to: readonly number[]): number {
  const hit: Hit | null = world.raycast(from, to);
  if (hit === null) return 0;
  const spring = world.addSpring(hit, {stiffness: 20});
  spring.setTarget(hit.point);
  world.applyImpulse(hit, [0, 1, 0]);
  return spring.stretch;
}

export async function main(file: ArrayBuffer): Promise<string> {
  const tetskin = await load(), seen = tetskin.memoryVersion;
  try {
    const cage: Cage = tetskin.cageFromBytes(await cageInWorker(new Uint8Array(file)));
    const mesh: Mesh = tetskin.readMesh(file, "glb");
    const map: Float64Array = tetskin.loadVertexMap(file, "glb", "_STIFFNESS");
    const nodes: Float64Array = tetskin.spreadMap(cage, mesh, map, {mean: "geometric"}).nodes;
    const fibres: Float64Array = tetskin.fibresAlong(tetskin.paintCage(cage, mesh, {stiffness: map}), [0], nodes);
    const world = tetskin.createWorld({gravity: new Float32Array([0, -9.81, 0]), deterministic: true});
    const ground = world.addPlane({friction: 1}), ball = world.addSphere(0.5, {mass: 2, velocity: [1, 0, 0]});
    const body = world.addBody(cage, mesh, soft);
    ball.position = [0, 1, 0];
    const height: number | undefined = ball.position[1];
    body.velocities = new Float64Array(3 * body.nodeCount);
    body.youngsModulus *= 2;
    body.setPressureSurface(mesh);
    body.addMuscle([0], fibres);
    world.gravity = [0, -1, 0];
    const snapshot: Uint8Array = world.save(new Uint8Array(world.snapshotSize));
    for (let frame = 0; frame < 60; ++frame) world.step(1 / 60, 4);
    world.restore(snapshot);
    draw(tetskin.createPalette(cage, mesh, {interpolation: "quadratic"}), body);
    const stages: number = world.times.prediction + world.times.surfaces;

    // @ts-expect-error: no such option
    world.addSphere(1, {weight: 3});
    // @ts-expect-error: no such interpolation
    tetskin.createPalette(cage, mesh, {interpolation: "cubic"});
    // @ts-expect-error: a mesh, or null, is needed
    world.addBody(cage);
    // @ts-expect-error: arrays of a mesh are not replaced
    mesh.positions = new Float64Array(3);
    // @ts-expect-error: no such mean
    tetskin.spreadMap(cage, mesh, map, {mean: "harmonic"});
    // @ts-expect-error: a mesh, or null, is needed
    body.setPressureSurface();
    // @ts-expect-error: a cage is no mesh
    tetskin.createCage(cage);
    // @ts-expect-error: things are made by what load returns
    new World();

    ground.delete();
    world[Symbol.dispose]();
    return `${version} ${world.hash} ${drag(world, new Float32Array(3), [0, 1, 0])} ${height} ${stages} ${seen}`;
  } catch (error) {
    if (!(error instanceof TetskinError)) throw error;
    const code: ErrorCode = error.code;
    if (code === "Malformed" || code === "OutOfMemory") return error.message;
    // @ts-expect-error: no such code
    if (code === "Broken") return "";
    throw error;
  }
}
