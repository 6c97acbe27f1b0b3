// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A program without the libraries of recent editions, whose compiler reads all of the module's types.
import {load} from "tetskin";
import type {Body, Mesh} from "tetskin";

export async function lowest(file: Uint8Array): Promise<number> {
  const tetskin = await load(), mesh: Mesh = tetskin.readMesh(file, "obj");
  const world = tetskin.createWorld({recordForces: true});
  const solver = {solverTolerance: 1e-3, maxIterations: 50};
  const body: Body = world.addBody(tetskin.createCage(mesh), mesh, {margin: 0.01, ...solver});
  world.step();
  const up: number | undefined = world.forcesOn(body, world.addPlane()).contact.force[1];
  mesh[Symbol.dispose]();
  return body.bounds[1]! + (up ?? 0);
}
