// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors

const kRigidOptions = {mass: 0, position: [0, 0, 0], rotation: [0, 0, 0, 1], velocity: [0, 0, 0],
  angularVelocity: [0, 0, 0], friction: 0.5, kinematic: false};
/** Errors after which the step has been made. */
const kAfterStep = ["NonFinite", "TopologyChanged"];
const kCauses = ["contact", "friction", "joints", "total"];
const kStages = ["prediction", "rigidSearch", "softSearch", "rows", "system", "other", "surfaces", "total"];

class World extends Thing {
  constructor(instance, handle) {
    super(instance, handle);
    Object.assign(this.hidden, {bodies: [], rigidBodies: [], springs: [], time: 0});
  }
  leave() {
    for (const list of ["springs", "bodies", "rigidBodies"]) {
      for (const thing of [...this.hidden[list]].reverse()) thing.delete();
    }
  }

  step(dt = 1 / 60, substeps = 4) {
    try {
      const made = this.core.step(own(this), numberOf(dt, "dt"), wholeNumberOf(substeps, "substeps"));
      this.hidden.time += dt;
      return made;
    } catch (error) {
      if (kAfterStep.includes(error.code)) this.hidden.time += dt;
      throw error;
    }
  }
  get times() {
    const numbers = this.view(Float64Array, this.core.times(own(this)));
    return Object.fromEntries(kStages.map((stage, i) => [stage, numbers[i]]));
  }
  get time() {
    return this.hidden.time;
  }

  addPlane(options) {
    const {normal, offset, friction} = optionsOf(options, {normal: [0, 1, 0], offset: 0, friction: 0.5});
    return this.keepRigid(this.core.addPlane(own(this), normal, offset, friction));
  }
  addBox(halfExtents, options) {
    return this.addRigid("addBox", options, vectorOf(halfExtents, "halfExtents"));
  }
  addSphere(radius, options) {
    return this.addRigid("addSphere", options, numberOf(radius, "radius"));
  }
  addCapsule(radius, height, options) {
    return this.addRigid("addCapsule", options, numberOf(radius, "radius"), numberOf(height, "height"));
  }
  addCylinder(radius, height, options) {
    return this.addRigid("addCylinder", options, numberOf(radius, "radius"), numberOf(height, "height"));
  }
  addConvexHull(points, options) {
    const arrays = [doubles(numbersOf(points, "points", 3))];
    return this.withMemory(arrays, at => this.addRigid("addConvexHull", options, at));
  }
  addMesh(mesh, options) {
    return this.addRigid("addMesh", options, handleIn(this.hidden.instance, mesh, Mesh, "mesh"));
  }
  addRigid(add, options, ...shape) {
    const rigid = optionsOf(options, kRigidOptions);
    return this.keepRigid(this.core[add](own(this), ...shape, rigid));
  }
  addBody(cage, mesh, options) {
    const {pinned, nodeMasses, stiffnessScale, ...soft} = optionsOf(options, this.hidden.instance.bodyOptions);
    wholeNumberOf(soft.maxIterations, "maxIterations");
    const cageHandle = handleIn(this.hidden.instance, cage, Cage, "cage");
    const meshHandle = mesh === null ? null : handleIn(this.hidden.instance, mesh, Mesh, "mesh");
    return this.withMemory([indices(pinned), doubles(nodeMasses), doubles(stiffnessScale)], (...at) => {
      const handle = this.core.addBody(own(this), cageHandle, meshHandle, soft, ...at);
      return this.keep("bodies", new Body(this.hidden.instance, handle, this, {cage, mesh}));
    });
  }

  get bodies() {
    return [...this.hidden.bodies];
  }
  get rigidBodies() {
    return [...this.hidden.rigidBodies];
  }
  poses() {
    return this.view(Float32Array, this.core.poses(own(this)));
  }

  raycast(start, end) {
    const hit = this.core.raycast(own(this), vectorOf(start, "start"), vectorOf(end, "end"));
    return hit.body < 0 ? null : {...hit, body: this.hidden.bodies[hit.body]};
  }
  addSpring(hit, options) {
    const {stiffness, dampingRatio, maxForce} = optionsOf(options, {stiffness: NaN, dampingRatio: 0, maxForce: NaN});
    const body = this.bodyOf(hit);
    const handle = this.core.addSpring(body, hit.triangle, hit.weights, stiffness, dampingRatio, maxForce);
    return this.keep("springs", new Spring(this.hidden.instance, handle, this, {body: hit.body}));
  }
  applyImpulse(hit, impulse) {
    this.core.applyImpulse(this.bodyOf(hit), hit.triangle, hit.weights, vectorOf(impulse, "impulse"));
  }

  forcesOn(thing, other) {
    const places = [...this.placesOf(thing, "thing"), ...this.placesOf(other ?? null, "other", true)];
    const numbers = this.copy(Float64Array, this.core.forcesOn(own(this), ...places));
    const at = i => numbers.slice(i, i + 3);
    return Object.fromEntries(kCauses.map((cause, i) => [cause, {force: at(6 * i), torque: at(6 * i + 3)}]));
  }

  save(into) {
    const memory = into === undefined ? undefined : bytesOf(into, "into");
    const state = this.view(Uint8Array, this.core.save(own(this)));
    if (memory === undefined) return state.slice();
    if (memory.length < state.length) {
      throw new TetskinError("SizeMismatch", `into: ${memory.length} bytes, but the snapshot has ${state.length}`);
    }
    memory.set(state);
    return memory.subarray(0, state.length);
  }
  restore(snapshot) {
    this.withBytes(bytesOf(snapshot, "snapshot"), (at, count) => this.core.restore(own(this), at, count));
  }
  shiftOrigin(origin) {
    this.core.shiftOrigin(own(this), vectorOf(origin, "origin"));
  }

  /** The handles of a soft and of a rigid body, one of which is null. */
  placesOf(thing, name, mayMiss = false) {
    if (mayMiss && thing === null) return [null, null];
    if (!(thing instanceof Body || thing instanceof RigidBody)) throw invalid(`${name}: must be a Body or a RigidBody`);
    const handle = handleOf(thing, Member, name);
    if (thing.hidden.world !== this) throw new TetskinError("NotInWorld", `${name}: is in another world`);
    return thing instanceof Body ? [handle, null] : [null, handle];
  }
  keep(list, thing) {
    this.hidden[list].push(thing);
    return thing;
  }
  keepRigid(handle) {
    return this.keep("rigidBodies", new RigidBody(this.hidden.instance, handle, this, {}));
  }
  /** The handle of a hit's body; checks the hit first. */
  bodyOf(hit) {
    own(this);
    if (hit === null || typeof hit !== "object") throw invalid("hit: must be what raycast returns, and not null");
    const body = handleOf(hit.body, Body, "hit.body");
    if (hit.body.hidden.world !== this) throw new TetskinError("NotInWorld", "hit: its body is in another world");
    wholeNumberOf(hit.triangle, "hit.triangle");
    vectorOf(hit.weights, "hit.weights");
    return body;
  }
}
properties(World, {
  gravity: [kVector, "gravity", "setGravity"],
  snapshotSize: [kNumber, "snapshotSize"],
  hash: [kWords, "hash"],
});

/** An object that a world keeps in a list. */
class Member extends Thing {
  constructor(instance, handle, world, others) {
    super(instance, handle);
    Object.assign(this.hidden, {world}, others);
  }
  forget(list) {
    const all = this.hidden.world.hidden[list];
    all.splice(all.indexOf(this), 1);
  }
}

class Spring extends Member {
  leave(handle) {
    this.core.releaseSpring(handle);
    this.forget("springs");
  }
  get body() {
    return this.hidden.body;
  }
  setTarget(target) {
    this.core.setTarget(own(this), vectorOf(target, "target"));
  }
  setStiffness(stiffness) {
    this.core.setStiffness(own(this), numberOf(stiffness, "stiffness"));
  }
  setMaxForce(force) {
    this.core.setMaxForce(own(this), numberOf(force, "force"));
  }
}
properties(Spring, {
  position: [kVector, "springPosition"],
  force: [kVector, "springForce"],
  stretch: [kNumber, "springStretch"],
});

class RigidBody extends Member {
  leave(handle) {
    this.core.removeRigidBody(handle);
    this.forget("rigidBodies");
  }
  applyImpulse(impulse, at) {
    const push = vectorOf(impulse, "impulse");
    const centre = this.core.rigidPosition(own(this));
    this.core.applyRigidImpulse(own(this), push, vectorOf(at ?? centre, "at").map((x, k) => x - centre[k]));
  }
}
properties(RigidBody, {
  position: [kVector, "rigidPosition", "setRigidPosition"],
  rotation: [kQuaternion, "rigidRotation", "setRigidRotation"],
  velocity: [kVector, "rigidVelocity", "setRigidVelocity"],
  angularVelocity: [kVector, "rigidAngularVelocity", "setRigidAngularVelocity"],
  friction: [kNumber, "rigidFriction", "setRigidFriction"],
  restitution: [kNumber, "rigidRestitution", "setRigidRestitution"],
  mass: [kNumber, "rigidMass"],
  kinematic: [kBoolean, "rigidKinematic"],
});

/** A muscle of a body, which keeps it. */
class Muscle {
  #body;
  #number;
  constructor(body, number) {
    this.#body = body;
    this.#number = number;
  }
  get activation() {
    return this.#body.core.activation(own(this.#body), this.#number);
  }
  set activation(activation) {
    this.#body.core.setActivation(own(this.#body), this.#number, numberOf(activation, "activation"));
  }
}

class Body extends Member {
  leave(handle) {
    for (const spring of [...this.hidden.world.hidden.springs]) {
      if (spring.body === this) spring.delete();
    }
    this.core.removeBody(handle);
    this.forget("bodies");
  }
  get cage() {
    return this.hidden.cage;
  }
  get mesh() {
    return this.hidden.mesh;
  }
  get nodeCount() {
    return this.core.bodyNodes(own(this)).count / 3;
  }
  get velocities() {
    return this.view(Float32Array, this.core.bodyVelocities(own(this)));
  }
  set velocities(velocities) {
    const arrays = [doubles(numbersOf(velocities, "velocities", 3))];
    this.withMemory(arrays, at => this.core.setBodyVelocities(own(this), at));
  }
  setGravity(gravity) {
    if (gravity === null) {
      this.core.followWorldGravity(own(this));
    } else {
      this.core.setBodyGravity(own(this), vectorOf(gravity, "gravity"));
    }
  }
  setPinned(nodes, pinned = true) {
    booleanOf(pinned, "pinned");
    this.withMemory([indices(numbersOf(nodes, "nodes"))], at => this.core.setPinned(own(this), at, pinned));
  }
  setPinnedPositions(nodes, positions) {
    numbersOf(nodes, "nodes");
    numbersOf(positions, "positions", 3);
    this.withMemory([indices(nodes), doubles(positions)], (...places) => {
      this.core.setPinnedPositions(own(this), ...places);
    });
  }
  transform(position, rotation = [0, 0, 0, 1]) {
    this.core.transform(own(this), vectorOf(position, "position"), vectorOf(rotation, "rotation", 4));
  }
  setGas(pressure, outside = 0) {
    this.core.setGas(own(this), numberOf(pressure, "pressure"), numberOf(outside, "outside"));
  }
  setPressureSurface(mesh) {
    const handle = mesh === null ? null : handleIn(this.hidden.instance, mesh, Mesh, "mesh");
    this.core.setPressureSurface(own(this), handle);
  }
  reset() {
    this.core.resetBody(own(this));
  }
  setPlasticity(plasticity) {
    if (plasticity === null) return this.core.endPlasticity(own(this));
    const {yieldStress, ...known} = plasticity ?? {};
    const {hardening, flowRate, largest} = optionsOf(known, {hardening: 0, flowRate: NaN, largest: NaN});
    const stresses = typeof yieldStress === "number" ? [yieldStress] : numbersOf(yieldStress, "yieldStress");
    this.withMemory([doubles(stresses)], at => this.core.setPlasticity(own(this), at, hardening, flowRate, largest));
  }
  resetPlasticFlow() {
    this.core.resetPlasticFlow(own(this));
  }
  setGrowth(growth) {
    const numbers = typeof growth === "number" ? [growth] : numbersOf(growth, "growth");
    this.withMemory([doubles(numbers)], at => this.core.setGrowth(own(this), at));
  }
  setStiffnessScale(factors) {
    this.withMemory([doubles(numbersOf(factors, "factors"))], at => this.core.setStiffnessScale(own(this), at));
  }
  setDampingScale(factors) {
    this.withMemory([doubles(numbersOf(factors, "factors"))], at => this.core.setDampingScale(own(this), at));
  }
  setElasticLaw(law, coefficients = {}, tets = null) {
    const {c2, c3} = optionsOf(coefficients, {c2: 0, c3: 0});
    const some = tets === null ? [] : numbersOf(tets, "tets");
    if (tets !== null && some.length === 0) return;
    this.withMemory([indices(some)], at => this.core.setElasticLaw(own(this), String(law), c2, c3, at));
  }
  addFibres(tets, directions, stiffness, tensionOnly = false) {
    const arrays = [indices(numbersOf(tets, "tets")), doubles(numbersOf(directions, "directions", 3))];
    this.withMemory(arrays, (...places) => this.core.addFibres(own(this), ...places, numberOf(stiffness, "stiffness"),
      booleanOf(tensionOnly, "tensionOnly")));
  }
  addMuscle(tets, fibres, stress = 3e5, lengthFactors = []) {
    const arrays = [indices(numbersOf(tets, "tets")), doubles(numbersOf(fibres, "fibres", 3)),
      doubles(numbersOf(lengthFactors, "lengthFactors", 2))];
    return new Muscle(this, this.withMemory(arrays, (...places) => {
      return this.core.addMuscle(own(this), ...places, numberOf(stress, "stress"));
    }));
  }
  applyRadialImpulse(centre, radius, strength) {
    return this.core.applyRadialImpulse(own(this), vectorOf(centre, "centre"), numberOf(radius, "radius"),
      numberOf(strength, "strength"));
  }
}
properties(Body, {
  nodes: [viewOf(Float32Array), "bodyNodes"],
  positions: [viewOf(Float32Array), "bodyPositions"],
  normals: [viewOf(Float32Array), "bodyNormals"],
  bounds: [copyOf(Float64Array), "bodyBounds"],
  pinned: [copyOf(Uint8Array), "pinned"],
  visible: [kBoolean, "visible", "setVisible"],
  plasticStrains: [copyOf(Float64Array), "plasticStrains"],
  asleep: [kBoolean, "asleep"],
  mass: [kNumber, "bodyMass"],
  youngsModulus: [kNumber, "youngsModulus", "setYoungsModulus"],
  relativeStiffness: [kNumber, "relativeStiffness"],
  poissonRatio: [kNumber, "poissonRatio", "setPoissonRatio"],
  stiffnessDamping: [kNumber, "stiffnessDamping", "setStiffnessDamping"],
  pressure: [kNumber, "pressure", "setPressure"],
  volume: [kNumber, "bodyVolume"],
  friction: [kNumber, "bodyFriction", "setBodyFriction"],
  restitution: [kNumber, "bodyRestitution", "setBodyRestitution"],
});
