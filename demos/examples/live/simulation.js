// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A scene that runs in the worker: its world, held and thrown objects, and snapshots of the last ten seconds.

const SUBSTEPS = 4;
/** Of the module's stages, those that the page shows; the others are with what is left of a frame. */
const TIMED = ['prediction', 'rigidSearch', 'softSearch', 'rows', 'system', 'other'];
/** Frames between two snapshots, and how many frames and bytes of them are kept. */
const KEEP_EVERY = 10, KEPT_FRAMES = 600, KEPT_BYTES = 64e6;
const MOST_THROWN = 12, THROWN_MASS = 0.5;
/** Longest side of a body that is dropped on the page. */
const DROPPED_SIZE = 1.0;
/** Forces are shown from here on, in a body's weights. */
const LEAST_FORCE = 0.03;
/** Up to so many triangles, it touches other soft bodies: to prepare 20,000 takes a second, while time stands. */
const MOST_SOFT_TRIANGLES = 40000;

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];

/** What is drawn of a mesh in its cage, and its palettes. Shared by the bodies that have both. */
class Model {
  /** groups: with colours, {first, count, colour}; or null */
  constructor(module, mesh, cage, groups, number) {
    Object.assign(this, {module, mesh, cage, groups, number, palettes: {}});
  }

  /** Bones of the surface as it is skinned: 'linear', with gradients, or 'quadratic'. */
  palette(skin) {
    if (!this.palettes[skin]) {
      const options = {interpolation: skin, gradients: skin === 'linear', layout: 'columns'};
      this.palettes[skin] = this.module.createPalette(this.cage, this.mesh, options);
    }
    return this.palettes[skin];
  }

  /** For the page, once: vertices as often as they have normals; all arrays are new. */
  description() {
    const positions = Float32Array.from(this.mesh.positions), triangles = Uint32Array.from(this.mesh.triangles);
    const drawn = new DrawnMesh(triangles, positions), palette = this.palette('linear');
    drawn.update(positions);
    const count = drawn.sources.length, bones = new Uint16Array(4 * count), weights = new Float32Array(4 * count);
    const ofVertex = {bones: palette.vertexBones(), weights: palette.vertexWeights()};
    drawn.sources.forEach((v, k) => {
      bones.set(ofVertex.bones.subarray(4 * v, 4 * v + 4), 4 * k);
      weights.set(ofVertex.weights.subarray(4 * v, 4 * v + 4), 4 * k);
    });
    return {
      number: this.number, index: drawn.index, positions: drawn.positions, normals: drawn.normals, bones, weights,
      colours: this.colours(drawn), boneCount: palette.boneCount, triangleCount: this.mesh.triangleCount,
      vertexCount: this.mesh.vertexCount, restNodes: Float32Array.from(this.cage.nodes),
      tets: Uint32Array.from(this.cage.tets), edges: Uint32Array.from(this.cage.edges()),
      boundary: Uint32Array.from(this.cage.boundaryFaces()),
    };
  }

  /** Three bytes for each drawn vertex. */
  colours(drawn) {
    const colours = new Uint8Array(3 * drawn.sources.length).fill(255);
    for (const {first, count, colour} of this.groups || []) {
      for (let corner = 3 * first; corner < 3 * (first + count); ++corner) {
        colours.set(colour.map(share => Math.round(255 * share)), 3 * drawn.index[corner]);
      }
    }
    return colours;
  }

  delete() {
    for (const palette of Object.values(this.palettes)) palette.delete();
  }
}

/** Meshes and cages that scenes have asked for: switching back to a scene takes no time. */
class Shelf {
  constructor(module, serpent, materials) {
    Object.assign(this, {module, serpent, materials, meshes: new Map(), cages: new Map()});
  }

  mesh(name) {
    if (!this.meshes.has(name)) {
      const shape = name === 'serpent' ? this.serpent : SHAPES[name]();
      const mesh = this.module.createMesh(shape.positions, shape.triangles);
      const coloured = group => ({...group, colour: this.materials[group.material].colour});
      const groups = shape.groups && shape.groups.map(coloured);
      this.meshes.set(name, {mesh, groups, shape});
    }
    return this.meshes.get(name);
  }

  cage(name, tets, quadratic) {
    const key = `${name} ${tets} ${quadratic}`;
    if (!this.cages.has(key)) {
      const {mesh, shape} = this.mesh(name), targetTets = quadratic ? Math.ceil(tets / 8) : tets;
      let cage = shape.cage ? this.cageOf(shape.cage(targetTets)) : this.module.createCage(mesh, {
        targetTets, duplicateElements: !quadratic,  // those have no quadratic ones
        stiffness: shape.stiffness, density: shape.density});
      if (quadratic) {
        const coarse = cage;
        cage = this.module.refineQuadratic(coarse);
        coarse.delete();
      }
      this.cages.set(key, cage);
      if (this.cages.size > 12) this.forgetOldest();
    }
    return this.cages.get(key);
  }

  cageOf({nodes, tets}) { return this.module.cageOfTets(nodes, tets); }

  forgetOldest() {
    const [key] = this.cages.keys();
    this.cages.get(key).delete();
    this.cages.delete(key);
  }
}

/** What scenes are built with. */
class Builder {
  constructor(simulation) {
    this.simulation = simulation;
    this.settings = simulation.settings;
    this.world = simulation.world;
  }

  get stiffness() { return this.settings.stiffness; }

  /** The number of tets that is wished for, or the scene's own. */
  tets(usual) { return this.settings.tets || usual; }

  /** options: the module's, and damping, a share of that which is set; gravity: its own; pinned: by rest position;
      yields: whether it flows as the setting says */
  addBody(name, tets, options, colour = '#ffffff') {
    const {simulation, settings} = this, {damping = 1, gravity, pinned, yields = false, ...others} = options;
    const model = simulation.modelOf(name, tets);
    const all = {
      relativeStiffness: settings.stiffness, stiffnessDamping: damping * settings.damping, visible: false, ...others,
    };
    if (pinned) all.pinned = this.nodesWhere(model.cage, pinned);
    const body = this.world.addBody(model.cage, model.mesh, all);
    if (gravity === 0) body.setGravity([0, 0, 0]);
    const part = {name, body, model, colour, damping, yields, softer: all.relativeStiffness / settings.stiffness};
    part.modulusOfOne = body.youngsModulus / all.relativeStiffness;
    simulation.parts.push(part);
    simulation.applyYield(part);
    return body;
  }

  /** mask: the painted one, of its tets; curve: of its fibres; stress: in the units of the stiffness */
  addMuscle(body, mask, curve, stress) {
    const {module, shelf, parts} = this.simulation;
    const {model, name, modulusOfOne} = parts.find(part => part.body === body);
    const shares = module.spreadMap(model.cage, model.mesh, shelf.mesh(name).shape.masks[mask]).tets;
    const tets = [...shares.keys()].filter(t => shares[t] >= 0.5);
    return body.addMuscle(tets, module.fibresAlong(model.cage, tets, curve), stress * modulusOfOne);
  }

  nodesWhere(cage, chosen) {
    const nodes = [], {nodes: rest} = cage;
    for (let n = 0; n < rest.length / 3; ++n) if (chosen(rest.subarray(3 * n, 3 * n + 3))) nodes.push(n);
    return nodes;
  }

  restNodes(body) { return Float64Array.from(body.cage.nodes); }

  pinnedOf(body) {
    const nodes = [];
    body.pinned.forEach((pinned, n) => pinned && nodes.push(n));
    return nodes;
  }

  addBox(halfExtents, options, material) {
    return this.addRigid(this.world.addBox(halfExtents, options), {kind: 'box', halfExtents}, options, material);
  }

  addSphere(radius, options, material) {
    return this.addRigid(this.world.addSphere(radius, options), {kind: 'ball', radius}, options, material);
  }

  addRigid(rigid, shape, options, material) {
    const {position, rotation = [0, 0, 0, 1], mass = 0, kinematic = false} = options;
    this.simulation.rigids.push({...shape, material, position, rotation, fixed: mass === 0 && !kinematic});
    return rigid;
  }

  beforeFrame(script) { this.simulation.script = script; }
}

class Simulation {
  /** name: of SCENES; settings: as USUAL */
  constructor(module, shelf, name, settings) {
    Object.assign(this, {module, shelf, name, settings: {...settings}});
    this.world = module.createWorld({gravity: [0, -settings.gravity, 0], deterministic: true, recordForces: true});
    this.parts = [];    // soft bodies
    this.rigids = [];   // descriptions of the scene's, in the world's order
    this.thrown = [];   // balls, after those
    this.throws = 0;    // at all
    this.models = [];
    this.script = null;
    this.held = null;   // {hit, spring, target}
    this.frame = 0;
    this.touched = !this.isUsual();  // by hands or settings: from here on it differs from a native run
    this.compared = null;            // {frame, hash}, the last one to compare with a native run
    this.spent = null;  // on frames that `state` has not reported yet: {frames, all, stages}, milliseconds
    this.times = Object.fromEntries([...TIMED, 'bones', 'page'].map(stage => [stage, 0]));
    this.milliseconds = 0;
    this.kept = [];     // snapshots, the oldest first
    this.spare = [];    // memory of former ones
    SCENES[name].build(new Builder(this));
    this.dropped = this.parts.length;  // from here on, bodies that were dropped on the page
    this.start = this.snapshot();
    this.keep();
  }

  delete() {
    this.world.delete();
    for (const model of this.models) model.delete();
  }

  modelOf(name, tets) {
    const {mesh, groups} = this.shelf.mesh(name);
    const cage = this.shelf.cage(name, tets, this.settings.elements === 'quadratic');
    return this.models.find(model => model.cage === cage && model.mesh === mesh) || this.addModel(mesh, cage, groups);
  }

  addModel(mesh, cage, groups) {
    const model = new Model(this.module, mesh, cage, groups, this.models.length);
    this.models.push(model);
    return model;
  }

  // --- Time

  step(frames) {
    const began = performance.now(), stages = TIMED.map(() => 0);
    for (let k = 0; k < frames; ++k) {
      if (this.script) this.script(this.frame + 1);
      this.world.step(FRAME, SUBSTEPS);
      const {times} = this.world;
      TIMED.forEach((stage, i) => stages[i] += times[stage]);
      ++this.frame;
      if (this.frame % KEEP_EVERY === 0) this.keep();
      if (this.frame % COMPARED_EVERY === 0 && !this.touched) this.compared = {frame: this.frame, hash: this.world.hash};
    }
    if (frames > 0) this.spent = {frames, all: performance.now() - began, stages};
  }

  /** Everything that tells whether a snapshot can be restored, beside it. */
  snapshot() {
    const size = this.world.snapshotSize, at = this.spare.findIndex(memory => memory.length >= size);
    const memory = at < 0 ? new Uint8Array(Math.ceil(1.1 * size)) : this.spare.splice(at, 1)[0];
    return {
      frame: this.frame, memory, bytes: this.world.save(memory), thrown: this.thrown.length,
      held: this.held && {hit: this.held.hit, target: this.held.target}, settings: JSON.stringify(this.settings),
      touched: this.touched,
    };
  }

  keep() {
    this.kept.push(this.snapshot());
    const isOld = () => this.frame - this.kept[0].frame > KEPT_FRAMES || this.keptBytes() > KEPT_BYTES;
    while (this.kept.length > 1 && isOld()) this.forget(this.kept.shift());
  }

  forget(snapshot) {
    if (this.spare.length < 4) this.spare.push(snapshot.memory);
  }

  keptBytes() {
    return this.kept.reduce((sum, {memory}) => sum + memory.length, 0);
  }

  /** Back by so many frames, or as far as there are snapshots; to the bit, if nobody has touched anything since. */
  rewind(frames) {
    const wanted = Math.max(this.kept[0].frame, this.frame - frames);
    while (this.kept.length > 1 && this.kept[this.kept.length - 1].frame > wanted) this.forget(this.kept.pop());
    this.restore(this.kept[this.kept.length - 1]);
    this.step(wanted - this.frame);
  }

  /** Whether a mesh was dropped: then `start` is a snapshot of another world, and the scene has to be made again. */
  get hasDropped() { return this.parts.length > this.dropped; }

  reset() {
    this.letGo();
    this.restore(this.start);
    for (const snapshot of this.kept.splice(0)) this.forget(snapshot);
    this.keep();
  }

  /** The world gets the balls and the spring that it had then; the spring lets go where it has been taken back. */
  restore(snapshot) {
    this.letGo();
    for (const ball of this.thrown.splice(snapshot.thrown)) ball.delete();
    const spring = snapshot.held && this.world.addSpring(snapshot.held.hit);
    this.world.restore(snapshot.bytes);
    if (spring) spring.delete();
    this.frame = snapshot.frame;
    this.touched = snapshot.touched || !this.isUsual();
    if (this.compared && this.compared.frame > this.frame) this.compared = null;
    if (snapshot.settings !== JSON.stringify(this.settings)) this.applySettings();
  }

  // --- Settings

  /** Those that a running world takes. */
  set(settings) {
    Object.assign(this.settings, settings);
    this.touched = this.touched || !this.isUsual();
    this.applySettings();
  }

  /** But for what changes nothing that is simulated. */
  isUsual() {
    return Object.keys(USUAL).every(name => ['skin', 'forces'].includes(name) || !isSettingOf(this.name, name) ||
      this.settings[name] === USUAL[name]);
  }

  applySettings() {
    const {stiffness, damping, gravity} = this.settings;
    this.world.gravity = [0, -gravity, 0];
    for (const part of this.parts) {
      part.body.youngsModulus = part.modulusOfOne * part.softer * stiffness;
      part.body.stiffnessDamping = part.damping * damping;
      this.applyYield(part);
    }
  }

  applyYield({body, modulusOfOne, yields}) {
    const yieldStress = this.settings.yield * modulusOfOne;
    if (yields) body.setPlasticity({yieldStress, hardening: 0.2 * yieldStress});
  }

  // --- Hands

  /** Takes hold of the surface that the first of some rays meets; null where none meets any. */
  pick({rays}) {
    this.letGo();
    const hit = rays.reduce((found, {from, to}) => found || this.world.raycast(from, to), null);
    if (!hit) return null;
    this.touched = true;
    this.held = {hit, spring: this.world.addSpring(hit), target: [...hit.point]};
    return {point: [...hit.point], distance: hit.distance};
  }

  drag(target) {
    if (!this.held) return;
    this.held.target = target;
    this.held.spring.setTarget(target);
  }

  letGo() {
    if (this.held) this.held.spring.delete();
    this.held = null;
  }

  /** Pushes the surface around where a ray meets it, away from the eye. */
  push({from, to, strength}) {
    const hit = this.world.raycast(from, to);
    if (!hit) return null;
    this.touched = true;
    const length = Math.hypot(...to.map((x, k) => x - from[k])), along = to.map((x, k) => (x - from[k]) / length);
    const radius = 0.35, centre = hit.point.map((x, k) => x - 0.4 * radius * along[k]);
    hit.body.applyRadialImpulse(centre, radius, strength * hit.body.mass);
    return [...hit.point];
  }

  /** The oldest is thrown again where there are many. */
  throwBall({position, velocity, radius}) {
    this.touched = true;
    const place = this.throws++ % MOST_THROWN;
    if (this.thrown.length === MOST_THROWN) {
      Object.assign(this.thrown[place], {position, velocity, angularVelocity: [0, 0, 0]});
      return;
    }
    this.thrown.push(this.world.addSphere(radius, {mass: THROWN_MASS, position, velocity, friction: 0.6}));
  }

  /** A body that was dropped on the page. The world before it does not come back. */
  add({mesh: meshBytes, cage: cageBytes}) {
    this.letGo();
    this.touched = true;
    const mesh = this.module.meshFromBytes(meshBytes), cage = this.module.cageFromBytes(cageBytes);
    const model = this.addModel(mesh, cage, null), {settings} = this;
    const body = this.world.addBody(cage, mesh, {
      relativeStiffness: settings.stiffness, stiffnessDamping: settings.damping, visible: false, mass: 1,
      position: [0, 0.2 + this.top(), 0], softContact: mesh.triangleCount <= MOST_SOFT_TRIANGLES,
    });
    const modulusOfOne = body.youngsModulus / settings.stiffness;
    const part = {body, model, colour: '#7089a8', damping: 1, softer: 1, modulusOfOne};
    this.parts.push(part);
    for (const snapshot of this.kept.splice(0)) this.forget(snapshot);
    this.keep();
    return {model: model.description(), body: {model: model.number, colour: part.colour}};
  }

  /** The highest node of all. */
  top() {
    let top = 0;
    for (const {body} of this.parts) {
      const {nodes} = body;
      for (let i = 1; i < nodes.length; i += 3) top = Math.max(top, nodes[i]);
    }
    return top;
  }

  // --- What the page is told

  description() {
    return {
      name: this.name, title: SCENES[this.name].title, focus: SCENES[this.name].focus,
      narrow: SCENES[this.name].narrow, settings: this.settings,
      models: this.models.map(model => model.description()),
      bodies: this.parts.map(({model, colour}) => ({model: model.number, colour})), rigids: this.rigids,
      tets: this.parts.reduce((sum, {model}) => sum + model.cage.tetCount, 0),
      triangles: this.parts.reduce((sum, {model}) => sum + model.mesh.triangleCount, 0),
    };
  }

  /** What is drawn of this frame; all arrays are new. timed: whether it tells the milliseconds of new frames */
  state() {
    const began = performance.now(), {skin} = this.settings;
    const bodies = this.parts.map(({body, model}) =>
      ({bones: model.palette(skin).update(body).slice(), nodes: body.nodes.slice(), asleep: body.asleep}));
    const bones = performance.now() - began;
    const state = {
      frame: this.frame, first: this.kept[0].frame, hash: this.world.hash, compared: this.compared, skin, bodies,
      poses: this.world.poses().slice(), forces: this.settings.forces ? this.forces() : [],
      balls: this.thrown.length, held: this.held && [...this.held.spring.position], timed: this.spent !== null,
    };
    if (this.spent) this.tellTimes(this.spent, bones, performance.now() - began);
    return {...state, times: this.times, milliseconds: this.milliseconds};
  }

  /** Of each thing that a soft body touches, where its force on that body passes by the body's middle, and the force
      in the body's weights: six numbers each. */
  forces() {
    const arrows = [];
    for (const {body} of this.parts) {
      const {nodes, nodeCount} = body, middle = [0, 0, 0], weight = 9.81 * body.mass;
      nodes.forEach((x, i) => middle[i % 3] += x / nodeCount);
      for (const other of [...this.world.rigidBodies, ...this.world.bodies]) {
        if (other === body) continue;
        const {force, torque} = this.world.forcesOn(body, other).total, square = dot(force, force);
        if (square < (LEAST_FORCE * weight) ** 2) continue;
        const arm = cross(force, torque);
        arrows.push(...middle.map((x, k) => x + arm[k] / square), ...force.map(x => x / weight));
      }
    }
    return Float32Array.from(arrows);
  }

  /** Of each of the frames that were made, by stage; what is left of a frame is scripts, snapshots and hashes. */
  tellTimes({frames, all, stages}, bones, told) {
    const whole = (all + told) / frames, shares = [...stages, bones].map(milliseconds => milliseconds / frames);
    const rest = shares.reduce((left, share) => left - share, whole);
    this.times = Object.fromEntries([...TIMED, 'bones', 'page'].map((stage, i) => [stage, [...shares, rest][i]]));
    this.milliseconds = whole;
    this.spent = null;
  }

  memory() {
    const spare = this.spare.reduce((sum, {length}) => sum + length, 0);
    return {module: this.module.memoryBytes, snapshots: this.keptBytes() + spare};
  }

  /** The highest vertex at rest of the first body, which is the serpent's horn: where it is now. */
  horn() {
    const [{body, model}] = this.parts, {positions} = model.mesh;
    let top = 0;
    for (let v = 0; v < positions.length / 3; ++v) if (positions[3 * v + 1] > positions[3 * top + 1]) top = v;
    body.visible = true;
    const point = [...body.positions.slice(3 * top, 3 * top + 3)], bounds = body.bounds;
    body.visible = false;
    return {point, size: Math.max(...[0, 1, 2].map(k => bounds[3 + k] - bounds[k]))};
  }
}
