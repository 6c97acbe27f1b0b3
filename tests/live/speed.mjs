// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Plays a scene in Node by the module for JavaScript, as native.cpp plays it natively, and prints the same lines.
//   node speed.mjs MODULE SCENE FRAMES [--fast]   MODULE: tetskin.js of the npm package; SCENE: of describe.js
import {readFileSync} from 'node:fs';
import {resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

const [module, path, frames, ...options] = process.argv.slice(2);
if (!(Number(frames) > 0)) {
  console.error('usage: node speed.mjs MODULE SCENE FRAMES [--fast]');
  process.exit(2);
}
const {load} = await import(pathToFileURL(resolve(module)));
const tetskin = await load();
const world = tetskin.createWorld({deterministic: !options.includes('--fast')});
const meshes = {};

/** Two counts, positions of three 64-bit floats, triangles of three 32-bit integers. */
function readMesh(file) {
  const bytes = readFileSync(file), view = new DataView(bytes.buffer, bytes.byteOffset), vertices = view.getInt32(0, true);
  const positions = Float64Array.from({length: 3 * vertices}, (_, i) => view.getFloat64(8 + 8 * i, true));
  const triangles = Int32Array.from({length: 3 * view.getInt32(4, true)},
    (_, i) => view.getInt32(8 + 24 * vertices + 4 * i, true));
  return tetskin.createMesh(positions, triangles);
}

function rigidOptions(numbers) {
  return {mass: numbers[0], position: numbers.slice(1, 4), rotation: numbers.slice(4, 8), friction: numbers[8]};
}

const add = {
  mesh([name, file]) { meshes[name] = readMesh(file); },
  box(words) {
    const numbers = words.map(Number);
    world.addBox(numbers.slice(0, 3), rigidOptions(numbers.slice(3)));
  },
  sphere(words) {
    const numbers = words.map(Number);
    world.addSphere(numbers[0], rigidOptions(numbers.slice(1)));
  },
  body([name, ...words]) {
    const numbers = words.map(Number), contact = words[12], cage = tetskin.createCage(meshes[name], {targetTets: numbers[0]});
    world.addBody(cage, meshes[name], {
      position: numbers.slice(1, 4), rotation: numbers.slice(4, 8), mass: numbers[8], relativeStiffness: numbers[9],
      stiffnessDamping: numbers[10], friction: numbers[11], softContact: contact === 'soft', selfContact: contact === 'self',
    });
  },
};
for (const line of readFileSync(path, 'utf8').trim().split('\n')) {
  const [kind, ...words] = line.split(' ');
  add[kind](words);
}

const times = [];
for (let frame = 0; frame < Number(frames); ++frame) {
  const began = performance.now();
  world.step();
  times.push(performance.now() - began);
  if ((frame + 1) % 30 === 0) console.log(`hash ${frame + 1} ${world.hash}`);
}
times.sort((a, b) => a - b);
console.log(`tets ${world.bodies.reduce((sum, {cage}) => sum + cage.tetCount, 0)}`);
console.log(`milliseconds ${times[times.length >> 1].toFixed(3)}`);
