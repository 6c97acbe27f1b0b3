// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What is on the canvas: bodies, things that move, obstacles, lights, and the camera.

const BACKGROUND = 0xf4f2ee;
/** For materials that the demos do not know, in turn. */
const PLAIN_COLOURS = [
  [0.42, 0.55, 0.68], [0.72, 0.58, 0.42], [0.50, 0.62, 0.45], [0.66, 0.48, 0.55], [0.62, 0.62, 0.60],
];
const FIRST_DIRECTION = [-0.20, 0.36, 1.0];  // from what is looked at to the camera
const SHINE = 0.5;  // of the materials' own, under these lights
const SUN_DIRECTION = [-0.45, 1.0, 0.45];

// Newer revisions of three.js have other names, and other defaults.

function setAttribute(geometry, name, array) {
  const attribute = new THREE.BufferAttribute(array, 3);
  geometry.setAttribute ? geometry.setAttribute(name, attribute) : geometry.addAttribute(name, attribute);
  return attribute;
}

/** Boxes are seldom full to their corners. */
const FILL = 0.88;

/** Colours as they are given, and lights whose intensities are shares. */
function makeRenderer(canvas) {
  if (THREE.ColorManagement) THREE.ColorManagement.enabled = false;
  const renderer = new THREE.WebGLRenderer({canvas, antialias: true});
  if ('outputColorSpace' in renderer) renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
  if ('useLegacyLights' in renderer) renderer.useLegacyLights = true;
  renderer.shadowMap.type = THREE.PCFSoftShadowMap;
  return renderer;
}

/** Makes materials by name, each once. */
class Materials {
  constructor(known) {
    this.known = known;
    this.made = new Map();
  }

  named(name) {
    if (!this.made.has(name)) this.made.set(name, this.make(name));
    return this.made.get(name);
  }

  make(name) {
    const plain = {colour: PLAIN_COLOURS[this.made.size % PLAIN_COLOURS.length], shine: 0.1, opacity: 1};
    const {colour, shine, opacity} = this.known[name] || plain, gloss = SHINE * shine;
    return new THREE.MeshPhongMaterial({
      color: new THREE.Color(...colour), specular: new THREE.Color(gloss, gloss, gloss), shininess: 30,
      transparent: opacity < 1, opacity, depthWrite: opacity === 1, shadowSide: THREE.DoubleSide,
    });
  }
}

/** A three.js mesh of a drawn one, in the materials of its groups. */
function meshOf(drawn, groups, materials) {
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(new THREE.BufferAttribute(drawn.index, 1));
  setAttribute(geometry, 'position', drawn.positions);
  setAttribute(geometry, 'normal', drawn.normals);
  groups.forEach((group, k) => geometry.addGroup(3 * group.first, 3 * group.count, k));
  const mesh = new THREE.Mesh(geometry, groups.map(group => materials.named(group.material)));
  mesh.frustumCulled = false;  // its box changes
  mesh.castShadow = mesh.receiveShadow = true;
  return mesh;
}

function rigidMesh(data, materials) {
  const drawn = new DrawnMesh(data.triangles, data.positions);
  drawn.update(data.positions);
  const mesh = meshOf(drawn, data.groups, materials);
  mesh.castShadow = mesh.receiveShadow = !mesh.material.some(material => material.transparent);
  return mesh;
}

/** A deformable body: its nodes between two moments, its surface, its cage. */
class Body {
  constructor(data, model, materials) {
    this.data = data;
    this.model = model;
    this.nodeCount = model.cage ? model.cage.nodes : model.vertices;
    this.nodes = new Float32Array(3 * this.nodeCount);
    this.positions = model.cage ? new Float32Array(3 * model.vertices) : this.nodes;
    if (model.cage && !model.skin) model.skin = new Skin(model.cage);  // bodies of one model share what it works with
    this.move(0);
    this.skin(false);
    this.drawn = new DrawnMesh(model.triangles, this.positions);
    this.mesh = meshOf(this.drawn, model.groups, materials);
    for (const material of this.mesh.material) material.side = THREE.DoubleSide;  // surfaces may be open
    this.cage = model.cage ? this.makeCage(model.cage.edges) : null;
  }

  makeCage(edges) {
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(edges.ends, 1));
    setAttribute(geometry, 'position', this.nodes);
    const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({color: 0xe0661a}));
    lines.frustumCulled = false;
    return lines;
  }

  /** Nodes at a moment, or between two. */
  move(moment) {
    const {nodes, data: {box, nodes: words}} = this, count = nodes.length;
    const before = count * Math.floor(moment), after = count * Math.ceil(moment), share = moment % 1;
    for (let i = 0; i < count; ++i) {
      const low = box.min[i % 3], step = (box.max[i % 3] - low) / 65535;
      const word = words[before + i];
      nodes[i] = low + step * (word + share * (words[after + i] - word));
    }
  }

  /** Positions of the surface; `quadratic` where the body leaves the choice. */
  skin(quadratic) {
    if (!this.model.skin) return;
    this.model.skin.update(this.nodes, this.data.skin ? this.data.skin === 'quadratic' : quadratic, this.positions);
  }

  show(moment, quadratic) {
    this.move(moment);
    this.skin(quadratic);
    this.drawn.update(this.positions);
    for (const name of ['position', 'normal']) this.mesh.geometry.attributes[name].needsUpdate = true;
    if (this.cage) this.cage.geometry.attributes.position.needsUpdate = true;
  }

  /** A point above it, for its label. */
  top() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < this.nodes.length; ++i) {
      low[i % 3] = Math.min(low[i % 3], this.nodes[i]);
      high[i % 3] = Math.max(high[i % 3], this.nodes[i]);
    }
    return new THREE.Vector3((low[0] + high[0]) / 2, high[1], (low[2] + high[2]) / 2);
  }
}

/** Something rigid that moves. */
class Prop {
  constructor(data, materials) {
    this.places = data.places;
    this.mesh = rigidMesh(data, materials);
    this.mesh.matrixAutoUpdate = false;
  }

  show(moment) {
    const before = 12 * Math.floor(moment), after = 12 * Math.ceil(moment), share = moment % 1;
    const at = i => this.places[before + i] + share * (this.places[after + i] - this.places[before + i]);
    for (let i = 0; i < 12; ++i) this.mesh.matrix.elements[4 * Math.floor(i / 3) + i % 3] = at(i);
    this.mesh.matrixWorldNeedsUpdate = true;
  }
}

class Stage {
  constructor(canvas, data) {
    this.canvas = canvas;
    this.renderer = makeRenderer(canvas);
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(BACKGROUND);
    const low = new THREE.Vector3(...data.focus.min), high = new THREE.Vector3(...data.focus.max);
    this.focus = new THREE.Box3(low, high);
    this.centre = this.focus.getCenter(new THREE.Vector3());
    this.radius = 0.5 * this.focus.getSize(new THREE.Vector3()).length();
    const materials = new Materials(data.materials);
    this.bodies = data.bodies.map(body => new Body(body, data.models[body.model], materials));
    this.props = data.props.map(prop => new Prop(prop, materials));
    for (const thing of [...this.bodies, ...this.props]) this.scene.add(thing.mesh);
    for (const body of this.bodies) if (body.cage) this.scene.add(body.cage);
    if (data.obstacles) this.addObstacles(data.obstacles, materials);
    this.addLights();
    this.camera = new THREE.PerspectiveCamera(28, 1, 0.01 * this.radius, 100 * this.radius);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false;  // arrows are the player's
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.2;
    this.controls.addEventListener('start', () => this.untouched = false);
    this.resetView();
  }

  addLights() {
    this.scene.fog = new THREE.Fog(BACKGROUND);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0xb8aa98, 0.6));
    const sun = new THREE.DirectionalLight(0xffffff, 0.48);
    sun.position.set(...SUN_DIRECTION).setLength(4 * this.radius).add(this.centre);
    sun.target.position.copy(this.centre);
    sun.castShadow = true;
    sun.shadow.mapSize.set(2048, 2048);
    sun.shadow.bias = -0.002;
    const reach = 1.6 * this.radius;
    Object.assign(sun.shadow.camera, {left: -reach, right: reach, bottom: -reach, top: reach,
      near: 0.5 * this.radius, far: 8 * this.radius});
    this.scene.add(sun, sun.target);
  }

  /** A mesh each, so that those that are seen through are drawn from the farthest to the nearest; only with them are
      there shadows, which would fall from one body on another that is not really beside it. */
  addObstacles(data, materials) {
    this.renderer.shadowMap.enabled = true;
    for (const group of data.groups) {
      const triangles = data.triangles.subarray(3 * group.first, 3 * (group.first + group.count));
      const whole = {first: 0, count: group.count, material: group.material};
      this.scene.add(rigidMesh({triangles, positions: data.positions, groups: [whole]}, materials));
    }
  }

  resetView() {
    this.untouched = true;
    this.controls.target.copy(this.centre);
    this.camera.position.set(...FIRST_DIRECTION).setLength(this.distance()).add(this.centre);
    this.controls.update();
  }

  /** From which the whole focus is seen, in the first direction, beside what covers the canvas. */
  distance() {
    const back = new THREE.Vector3(...FIRST_DIRECTION).normalize();
    const right = new THREE.Vector3(0, 1, 0).cross(back).normalize(), up = back.clone().cross(right);
    const high = Math.tan(this.camera.fov * Math.PI / 360);
    const free = this.free || {width: 1, height: 1}, aspect = this.camera.aspect;
    const {min, max} = this.focus;
    let distance = 0;
    for (let k = 0; k < 8; ++k) {
      const corner = new THREE.Vector3((k & 1 ? max : min).x, (k & 2 ? max : min).y, (k & 4 ? max : min).z);
      corner.sub(this.centre);
      const across = FILL * Math.abs(corner.dot(right)) / (high * aspect * free.width);
      const along = FILL * Math.abs(corner.dot(up)) / (high * free.height);
      distance = Math.max(distance, corner.dot(back) + Math.max(across, along));
    }
    return distance;
  }

  /** top, bottom: pixels that are covered there. */
  resize(width, height, top, bottom) {
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.free = {width: 0.94, height: Math.max(0.3, (height - top - bottom) / height)};
    this.camera.setViewOffset(width, height, 0, Math.round((bottom - top) / 2), width, height);
    if (this.untouched) this.resetView();
  }

  show(moment, quadratic) {
    for (const body of this.bodies) body.show(moment, quadratic);
    for (const prop of this.props) prop.show(moment);
  }

  /** cages: 'none', 'outer' or 'all' */
  setVisible(surfaces, cages) {
    for (const {mesh, cage, model} of this.bodies) {
      mesh.visible = surfaces;
      if (!cage) continue;
      cage.visible = cages !== 'none';
      cage.geometry.setDrawRange(0, cages === 'outer' ? 2 * model.cage.edges.outer : Infinity);
    }
  }

  draw() {
    const away = this.camera.position.distanceTo(this.controls.target);
    Object.assign(this.scene.fog, {near: away + 2 * this.radius, far: away + 10 * this.radius});
    this.renderer.render(this.scene, this.camera);
  }

  /** Where a point is on the canvas, in pixels. */
  onCanvas(point) {
    const {x, y} = point.project(this.camera);
    return [(1 + x) / 2 * this.canvas.clientWidth, (1 - y) / 2 * this.canvas.clientHeight];
  }
}
