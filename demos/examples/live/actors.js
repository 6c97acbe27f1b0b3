// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The objects of a running scene: bodies that the graphics card skins by the bones of each frame; rigid bodies; and the
// stage with both.

/** To the camera of the first view where the room is narrow: what is long is seen more from its end, and larger. */
const NARROW_DIRECTION = [0.75, 0.7, 1.0];
/** Of forces: the length of one that is a body's weight, in radii of the scene, and the longest. */
const WEIGHT_LENGTH = 0.25, LONGEST_ARROW = 1.0, ARROW_COLOUR = 0xf26522;
const CAGE_COLOUR = 0xe0661a, TETS_COLOUR = 0xf0b487;

/** Has a material leave out what is on one side of a plane in rest space. cut: uniforms {axis, at} */
function cutByRest(material, cut) {
  const before = material.onBeforeCompile;
  material.onBeforeCompile = shader => {
    before(shader);
    Object.assign(shader.uniforms, cut);
    shader.vertexShader = 'varying float vRest;\nuniform vec3 cutAxis;\n' + shader.vertexShader.replace(
      '#include <begin_vertex>', '#include <begin_vertex>\nvRest = dot(cutAxis, position);');
    shader.fragmentShader = 'varying float vRest;\nuniform float cutAt;\n' + shader.fragmentShader.replace(
      'void main() {', 'void main() {\n  if (vRest < cutAt) discard;');
  };
}

/** What shadows are drawn with: like `carryNormals` of the recipe, without normals, which that shader has not. */
function bonesOfShadow() {
  const material = new THREE.MeshDepthMaterial({depthPacking: THREE.RGBADepthPacking});
  Object.assign(material, {skinning: true, defines: {GRADIENTS: ''}});
  material.onBeforeCompile = shader => {
    shader.vertexShader = shader.vertexShader.replace('#include <skinning_vertex>', `
      #ifdef GRADIENTS
      transformed += (skinWeight.x * boneMatX + skinWeight.y * boneMatY + skinWeight.z * boneMatZ +
        skinWeight.w * boneMatW)[3].xyz;
      #else
      #include <skinning_vertex>
      #endif`);
  };
  return material;
}

/** The tets beyond a plane in rest space: which triangles bound them. */
function trianglesOfTets(tets, isIn) {
  const faces = new Map(), corners = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
  for (let t = 0; t < tets.length; t += 4) {
    if (!isIn(t)) continue;
    for (const face of corners) {
      const nodes = face.map(k => tets[t + k]), key = [...nodes].sort((a, b) => a - b).join();
      faces.has(key) ? faces.delete(key) : faces.set(key, nodes);
    }
  }
  return Uint32Array.from([...faces.values()].flat());
}

function edgesOfTriangles(triangles) {
  const edges = new Map();
  for (let i = 0; i < triangles.length; ++i) {
    const a = triangles[i], b = triangles[i % 3 === 2 ? i - 2 : i + 1];
    edges.set(`${Math.min(a, b)},${Math.max(a, b)}`, [a, b]);
  }
  return Uint32Array.from([...edges.values()].flat());
}

/** A soft body: its surface, skinned by bones, and its cage. */
class SoftActor {
  constructor({colour}, model) {
    this.model = model;
    this.nodes = new Float32Array(model.restNodes);
    this.cut = {cutAxis: {value: new THREE.Vector3(...longestAxis(model.restNodes))}, cutAt: {value: -1e9}};
    this.mesh = this.makeSurface(new THREE.Color(colour));
    this.edges = this.makeLines();
    this.solid = this.makeSolid();
    this.parts = [this.mesh, this.edges, this.solid];
  }

  makeSurface(colour) {
    const {model} = this, geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(model.index, 1));
    setAttribute(geometry, 'position', model.positions);
    setAttribute(geometry, 'normal', model.normals);
    geometry.setAttribute('color', new THREE.BufferAttribute(model.colours, 3, true));
    const gloss = SHINE * 0.2;
    const material = new THREE.MeshPhongMaterial({color: colour, vertexColors: THREE.VertexColors,
      side: THREE.DoubleSide, shadowSide: THREE.DoubleSide,
      specular: new THREE.Color(gloss, gloss, gloss), shininess: 30});
    const mesh = boneMesh(geometry, material, model.bones, model.weights, model.boneCount, true);
    mesh.customDepthMaterial = bonesOfShadow();
    for (const one of [material, mesh.customDepthMaterial]) cutByRest(one, this.cut);
    mesh.castShadow = mesh.receiveShadow = true;
    this.skin = 'linear';
    return mesh;
  }

  makeLines() {
    const geometry = new THREE.BufferGeometry();
    setAttribute(geometry, 'position', this.nodes);
    const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({color: CAGE_COLOUR}));
    lines.frustumCulled = lines.visible = false;
    return lines;
  }

  makeSolid() {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', this.edges.geometry.attributes.position);
    const material = new THREE.MeshPhongMaterial({color: TETS_COLOUR, flatShading: true, side: THREE.DoubleSide,
      specular: 0x111111, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1});
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = mesh.visible = false;
    mesh.castShadow = mesh.receiveShadow = true;
    return mesh;
  }

  /** Bones of the linear surface have gradients, those of the quadratic one are whole maps: another shader each. */
  setSkin(skin) {
    if (skin === this.skin) return;
    this.skin = skin;
    for (const material of [this.mesh.material, this.mesh.customDepthMaterial]) {
      material.defines = {...material.defines};
      delete material.defines.GRADIENTS;
      if (skin === 'linear') material.defines.GRADIENTS = '';
      material.needsUpdate = true;
    }
  }

  show({bones, nodes}, skin) {
    this.setSkin(skin);
    this.mesh.setBones(bones);
    this.nodes.set(nodes);
    this.edges.geometry.attributes.position.needsUpdate = true;
  }

  /** cage: 'none', 'outer', 'all' or 'tets', of which the share `cut` is shown and the surface beyond it */
  setVisible(surface, cage, cut) {
    this.mesh.visible = surface;
    this.edges.visible = cage !== 'none';
    this.solid.visible = cage === 'tets';
    const {model} = this;
    this.cut.cutAt.value = -1e9;
    if (cage === 'all') this.setIndices(this.edges, model.edges);
    if (cage === 'outer') this.setIndices(this.edges, edgesOfTriangles(model.boundary));
    if (cage !== 'tets') return;
    const {x, y, z} = this.cut.cutAxis.value, along = n => x * model.restNodes[3 * n] + y * model.restNodes[3 * n + 1] +
      z * model.restNodes[3 * n + 2];
    let low = Infinity, high = -Infinity;
    for (let n = 0; n < model.restNodes.length / 3; ++n) {
      low = Math.min(low, along(n));
      high = Math.max(high, along(n));
    }
    const at = low + cut * (high - low);
    const centreOf = t => [0, 1, 2, 3].reduce((sum, k) => sum + along(model.tets[t + k]), 0) / 4;
    const triangles = trianglesOfTets(model.tets, t => centreOf(t) < at);
    this.cut.cutAt.value = at;
    this.setIndices(this.solid, triangles);
    this.setIndices(this.edges, edgesOfTriangles(triangles));
  }

  setIndices({geometry}, indices) {
    geometry.setIndex(new THREE.BufferAttribute(indices, 1));
  }

  dispose() {
    for (const {geometry, material} of this.parts) geometry.dispose(), material.dispose();
    this.mesh.customDepthMaterial.dispose();
    const {boneTexture} = this.mesh.skeleton;
    if (boneTexture) boneTexture.dispose();
  }
}

/** A unit vector along the longest side of the box around points. */
function longestAxis(points) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  points.forEach((x, i) => {
    low[i % 3] = Math.min(low[i % 3], x);
    high[i % 3] = Math.max(high[i % 3], x);
  });
  const sides = low.map((x, k) => high[k] - x), most = Math.max(...sides), axis = sides.indexOf(most);
  return [0, 1, 2].map(k => Number(k === axis));
}

/** Something rigid that moves. */
class RigidActor {
  constructor(shape, materials) {
    this.mesh = rigidMesh(shapeMesh(shape), materials);
    this.radius = shape.radius;
    this.mesh.matrixAutoUpdate = false;
    this.scale = new THREE.Vector3(1, 1, 1);
  }

  show(poses, k) {
    const position = new THREE.Vector3().fromArray(poses, 7 * k);
    const turn = new THREE.Quaternion().fromArray(poses, 7 * k + 3);
    this.mesh.matrix.compose(position, turn, this.scale);
    this.mesh.matrixWorldNeedsUpdate = true;
  }

  dispose() { this.mesh.geometry.dispose(); }
}

/** What stage.js draws a rigid body from. */
function shapeMesh({kind, halfExtents, radius, material}) {
  const {positions, triangles} = kind === 'box' ? boxMesh(halfExtents) : ballMesh(radius, radius > 1 ? 32 : 14);
  return {positions: Float32Array.from(positions), triangles: Uint32Array.from(triangles),
    groups: [{first: 0, count: triangles.length / 3, material}]};
}

/** Everything that is fixed, as one mesh with groups. */
function obstaclesOf(rigids) {
  const positions = [], triangles = [], groups = [];
  for (const rigid of rigids.filter(({fixed}) => fixed)) {
    const mesh = shapeMesh(rigid), first = positions.length / 3, p = new THREE.Vector3();
    const turn = new THREE.Quaternion(...rigid.rotation), at = new THREE.Vector3(...rigid.position);
    groups.push({first: triangles.length / 3, count: mesh.triangles.length / 3, material: rigid.material});
    for (let i = 0; i < mesh.positions.length; i += 3) {
      p.fromArray(mesh.positions, i).applyQuaternion(turn).add(at);
      positions.push(p.x, p.y, p.z);
    }
    for (const v of mesh.triangles) triangles.push(first + v);
  }
  return groups.length > 0 && {positions: Float32Array.from(positions), triangles: Uint32Array.from(triangles), groups};
}

function boxOf([min, max]) {
  return new THREE.Box3(new THREE.Vector3(...min), new THREE.Vector3(...max));
}

function cornersOf({min, max}) {
  const points = [];
  for (let k = 0; k < 8; ++k) points.push(k & 1 ? min.x : max.x, k & 2 ? min.y : max.y, k & 4 ? min.z : max.z);
  return points;
}

/** The stage of a scene that the worker runs. */
class LiveStage extends Stage {
  /** scene: the worker's description; renderer: one for all scenes */
  constructor(canvas, scene, materials, renderer) {
    const [min, max] = scene.focus, focus = {min, max};
    const obstacles = obstaclesOf(scene.rigids);
    super(canvas, {focus, moments: 1, materials, bodies: [], models: [], props: [], obstacles, renderer});
    if (scene.narrow) this.narrow = boxOf(scene.narrow);
    this.materials = new Materials(materials);
    this.models = [];
    this.soft = [];
    this.rigid = [];  // in the world's order; null: fixed
    this.rigidCount = scene.rigids.length;
    this.look = {surface: true, cage: 'none', cut: 0.5};
    for (const rigid of scene.rigids) this.rigid.push(rigid.fixed ? null : this.addRigid(rigid));
    for (const model of scene.models) this.models[model.number] = model;
    for (const body of scene.bodies) this.addBody(body);
    this.ballRadius = 0.06 * this.radius;
    this.marker = this.makeMarker();
    this.arrows = [];
    this.show(scene.state);
  }

  resetView() {
    const isNarrow = this.freeWidth * this.camera.aspect < 0.8 * this.freeHeight;
    this.seen = cornersOf(isNarrow && this.narrow || this.focus);
    super.resetView(isNarrow ? NARROW_DIRECTION : FIRST_DIRECTION);
  }

  seenPoints() { return cornersOf(this.focus); }

  addRigid(shape) {
    const actor = new RigidActor(shape, this.materials);
    this.scene.add(actor.mesh);
    return actor;
  }

  addBody(body) {
    const actor = new SoftActor(body, this.models[body.model]);
    actor.setVisible(this.look.surface, this.look.cage, this.look.cut);
    this.soft.push(actor);
    this.scene.add(...actor.parts);
  }

  /** Where a body is held. */
  makeMarker() {
    const geometry = new THREE.SphereBufferGeometry(0.012 * this.radius, 16, 12);
    const material = new THREE.MeshBasicMaterial({color: 0xf26522, depthTest: false, transparent: true});
    const marker = new THREE.Mesh(geometry, material);
    marker.renderOrder = 10;
    marker.visible = false;
    this.scene.add(marker);
    return marker;
  }

  /** state: the worker's, of one frame */
  show(state) {
    while (this.soft.length > state.bodies.length) this.removeBody(this.soft.pop());
    state.bodies.forEach((body, k) => this.soft[k] && this.soft[k].show(body, state.skin));
    while (this.rigid.length < this.rigidCount + state.balls) {
      this.rigid.push(this.addRigid({kind: 'ball', radius: this.ballRadius, material: 'heavy_ball'}));
    }
    this.rigid.forEach((actor, k) => {
      if (!actor) return;
      actor.mesh.visible = k < this.rigidCount + state.balls;
      if (actor.mesh.visible) actor.show(state.poses, k);
    });
    this.showForces(state.forces);
    this.marker.visible = Boolean(state.held);
    if (state.held) this.marker.position.fromArray(state.held);
  }

  /** forces: six numbers each, a point and a vector, whose arrow ends at the point; drawn over everything */
  showForces(forces) {
    while (6 * this.arrows.length < forces.length) {
      const arrow = new THREE.ArrowHelper(new THREE.Vector3(0, 1, 0), new THREE.Vector3(), 1, ARROW_COLOUR);
      for (const {material} of [arrow.line, arrow.cone]) Object.assign(material, {depthTest: false, transparent: true});
      arrow.line.renderOrder = arrow.cone.renderOrder = 9;
      this.arrows.push(arrow);
      this.scene.add(arrow);
    }
    this.arrows.forEach((arrow, k) => {
      arrow.visible = 6 * k < forces.length;
      if (!arrow.visible) return;
      const along = new THREE.Vector3().fromArray(forces, 6 * k + 3), weights = along.length();
      const length = this.radius * Math.min(LONGEST_ARROW, WEIGHT_LENGTH * weights);
      arrow.setDirection(along.normalize());
      arrow.setLength(length, Math.min(0.5 * length, 0.08 * this.radius), 0.05 * this.radius);
      arrow.position.fromArray(forces, 6 * k).addScaledVector(along, -length);
    });
  }

  removeBody(actor) {
    this.scene.remove(...actor.parts);
    actor.dispose();
  }

  setLook(look) {
    Object.assign(this.look, look);
    for (const actor of this.soft) actor.setVisible(this.look.surface, this.look.cage, this.look.cut);
  }

  /** A ray from the camera through a pixel of the canvas: {from, to, direction} */
  rayThrough(x, y) {
    const {clientWidth, clientHeight} = this.canvas, ray = new THREE.Raycaster();
    this.camera.updateMatrixWorld();
    ray.setFromCamera(new THREE.Vector2(2 * x / clientWidth - 1, 1 - 2 * y / clientHeight), this.camera);
    const {origin, direction} = ray.ray, to = origin.clone().addScaledVector(direction, 40 * this.radius);
    return {from: origin.toArray(), to: to.toArray(), direction};
  }

  /** Where the ray through a pixel meets the plane through a point that faces the camera. */
  onPlane(x, y, point) {
    const {from, direction} = this.rayThrough(x, y), facing = this.camera.getWorldDirection(new THREE.Vector3());
    const origin = new THREE.Vector3(...from), away = new THREE.Vector3(...point).sub(origin).dot(facing);
    return origin.addScaledVector(direction, away / direction.dot(facing)).toArray();
  }

  dispose() {
    this.controls.dispose();
    for (const actor of this.soft) actor.dispose();
    this.scene.traverse(thing => {
      if (thing.geometry) thing.geometry.dispose();
      for (const material of [].concat(thing.material || [])) {
        if (material.alphaMap) material.alphaMap.dispose();
        material.dispose();
      }
      if (thing.shadow && thing.shadow.map) thing.shadow.map.dispose();
    });
    this.scene.dispose && this.scene.dispose();
  }
}
