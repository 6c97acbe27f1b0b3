// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The page's workers: one simulates, another makes the cages of meshes that are dropped on the page. After the module's
// and the other scripts, in one file. Each message {id, type, data} is answered by {id, answer} or {id, error}, in
// order.

let simulation = null, api = null, shelf = null;

/** The serpent as make_page.mjs packs it: see `pack` there. */
async function unpackSerpent({vertices, triangles, box, groups}, zipped) {
  const stream = new Blob([zipped]).stream().pipeThrough(new DecompressionStream('gzip'));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer()), plane = 3 * vertices;
  const positions = new Float64Array(plane), corners = new Int32Array(3 * triangles);
  for (let axis = 0; axis < 3; ++axis) {
    for (let v = 0, word = 0; v < vertices; ++v) {
      const at = axis * vertices + v;
      word = (word + bytes[at] + 256 * bytes[plane + at]) & 65535;
      positions[3 * v + axis] = box.min[axis] + (box.max[axis] - box.min[axis]) * word / 65535;
    }
  }
  let at = 2 * plane, corner = 0;
  for (let i = 0; i < corners.length; ++i) {
    let number = 0, shift = 0;
    do number |= (bytes[at] & 127) << shift, shift += 7; while (bytes[at++] & 128);
    corner += number & 1 ? -(number + 1 >> 1) : number >> 1;
    corners[i] = corner;
  }
  return {positions, triangles: corners, groups};
}

/** Another size and place for a mesh that was dropped: its longest side is that of a body here, and it stands on 0. */
function placed(mesh) {
  const {bounds, positions} = mesh, size = Math.max(...[0, 1, 2].map(k => bounds[3 + k] - bounds[k]));
  const scale = DROPPED_SIZE / size, shift = [0, 1, 2].map(k => k === 1 ? bounds[1] : (bounds[k] + bounds[3 + k]) / 2);
  const moved = Float64Array.from(positions, (x, i) => scale * (x - shift[i % 3]));
  return api.createMesh(moved, mesh.triangles.slice());
}

/** To frame 0, without what was dropped on the page. */
function restart() {
  if (!simulation.hasDropped) return simulation.reset();
  const next = new Simulation(api, shelf, simulation.name, simulation.settings);
  simulation.delete();
  simulation = next;
}

const ACTIONS = {
  async start({model, zipped, materials}) {
    api = await load();
    if (model) shelf = new Shelf(api, await unpackSerpent(model, zipped), materials);
    return {memory: api.memoryBytes};
  },
  open({name, settings}) {
    const next = new Simulation(api, shelf, name, settings);
    if (simulation) simulation.delete();
    simulation = next;
    return {...simulation.description(), state: simulation.state()};
  },
  step({frames}) {
    try {
      simulation.step(frames);
    } catch (error) {
      if (error.code !== 'NonFinite') throw error;
      restart();
      return {...simulation.state(), trouble: 'The simulation became unstable, and begins again.'};
    }
    return simulation.state();
  },
  set(settings) { simulation.set(settings); return simulation.state(); },
  pick(rays) { return simulation.pick(rays); },
  drag({target}) { simulation.drag(target); },
  letGo() { simulation.letGo(); },
  push(ray) { return simulation.push(ray); },
  throwBall(ball) { simulation.throwBall(ball); },
  rewind({frames}) { simulation.rewind(frames); return simulation.state(); },
  reset() { restart(); return simulation.state(); },
  add(body) { return {...simulation.add(body), state: simulation.state()}; },
  horn() { return simulation.horn(); },
  memory() { return simulation.memory(); },
  /** Milliseconds of each of so many frames, as they come without waiting for the page. */
  time({frames}) {
    const all = [];
    for (let k = 0; k < frames; ++k) {
      const began = performance.now();
      simulation.step(1);
      simulation.state();
      all.push(performance.now() - began);
    }
    return all;
  },
  /** Of the second worker: a mesh file in, mesh and cage out. */
  makeCage({bytes, name, tets}, progress) {
    progress({stage: 'reading', fraction: 0});
    const read = api.readMesh(bytes, name), mesh = placed(read);
    read.delete();
    progress({stage: 'cage', fraction: 0});
    let told = 0;
    const cage = api.createCage(mesh, {targetTets: tets, progress: fraction => {
      if (fraction - told < 0.02) return;
      told = fraction;
      progress({stage: 'cage', fraction});
    }});
    return {mesh: mesh.toBytes(), cage: cage.toBytes(), triangles: mesh.triangleCount, tets: cage.tetCount};
  },
};

/** Buffers of all arrays in an answer, which the page gets without a copy. */
function buffersIn(value, found = new Set()) {
  if (ArrayBuffer.isView(value)) {
    found.add(value.buffer);
  } else if (value && typeof value === 'object') {
    for (const part of Object.values(value)) buffersIn(part, found);
  }
  return found;
}

function plainError(error) {
  const code = error && error.code || (error instanceof RangeError ? 'OutOfMemory' : 'Failed');
  return {code, message: String(error && error.message || error), stack: error && error.stack};
}

let last = Promise.resolve();
self.onmessage = ({data: {id, type, data}}) => {
  last = last.then(async () => {
    try {
      const answer = await ACTIONS[type](data || {}, progress => self.postMessage({id, progress}));
      self.postMessage({id, answer}, [...buffersIn(answer)]);
    } catch (error) {
      self.postMessage({id, error: plainError(error)});
    }
  });
};
