// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The contents of the canvas: bodies, moving objects, obstacles, lights, and the camera.

const BACKGROUND = 0xf4f2ee;
/** For materials that the demos do not know, in turn. */
const PLAIN_COLOURS = [
  [0.42, 0.55, 0.68], [0.72, 0.58, 0.42], [0.50, 0.62, 0.45], [0.66, 0.48, 0.55], [0.62, 0.62, 0.60],
];
const FIRST_DIRECTION = [-0.20, 0.36, 1.0];
const SHINE = 0.5;  // of the materials' own, under these lights
const SUN_DIRECTION = [-0.45, 1.0, 0.45];
const NEAREST = 0.01;  // that is drawn, in radii of the viewed scene
const CLEARANCE = 2 * NEAREST;  // of the camera over the floor and obstacles

// Newer revisions of three.js have other names, and other defaults.

function setAttribute(geometry, name, array, size = 3) {
  const attribute = new THREE.BufferAttribute(array, size);
  geometry.setAttribute ? geometry.setAttribute(name, attribute) : geometry.addAttribute(name, attribute);
  return attribute;
}

/** Of the room beside what covers the canvas, the share that the first view fills. */
const FILL = 0.94;
/** So many moments, and points of each body and prop at each, stand for the whole run in the first view. */
const SEEN_MOMENTS = 60, SEEN_POINTS = 600;
/** Darker than the background, so that what lies on the floor does not seem to float; fades out so many radii away. */
const FLOOR_COLOUR = 0xd9d4ca, FLOOR_REACH = 5;

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
    if (model.cage && !model.skin) model.skin = new Skin(model.cage);  // bodies of one model share its data
    this.move(0);
    this.skin(false);
    this.drawn = new DrawnMesh(model.triangles, this.positions);
    const groups = model.groups.map(group => data.material ? {...group, material: data.material} : group);
    this.mesh = meshOf(this.drawn, groups, materials);
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

  /** Calls `use` with the coordinates of some of its nodes at a moment, at most about `most`. */
  eachPoint(moment, most, use) {
    this.move(moment);
    for (let i = 0, step = 3 * Math.ceil(this.nodeCount / most); i < this.nodes.length; i += step) {
      use(this.nodes[i], this.nodes[i + 1], this.nodes[i + 2]);
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
    this.corners = data.positions;
    this.mesh = rigidMesh(data, materials);
    this.mesh.matrixAutoUpdate = false;
  }

  /** Calls `use` with the coordinates of some of its points at a moment, at most about `most`. */
  eachPoint(moment, most, use) {
    const m = this.places.subarray(12 * moment, 12 * moment + 12), c = this.corners;
    for (let i = 0, step = 3 * Math.ceil(c.length / (3 * most)); i < c.length; i += step) {
      const along = k => m[k] * c[i] + m[3 + k] * c[i + 1] + m[6 + k] * c[i + 2] + m[9 + k];
      use(along(0), along(1), along(2));
    }
  }

  show(moment) {
    const before = 12 * Math.floor(moment), after = 12 * Math.ceil(moment), share = moment % 1;
    const at = i => this.places[before + i] + share * (this.places[after + i] - this.places[before + i]);
    for (let i = 0; i < 12; ++i) this.mesh.matrix.elements[4 * Math.floor(i / 3) + i % 3] = at(i);
    this.mesh.matrixWorldNeedsUpdate = true;
  }
}

/** Lines on the floor: a fine one every tenth of a body's size, a clear one every half. Each is at least a pixel wide,
    and fades where its neighbours are but a few pixels away, before they could make patterns. */
const GRID = `
  varying vec2 vGround;
  uniform float bodySize;
  float gridLines(float spacing, float width) {
    vec2 place = vGround / spacing, pixel = fwidth(place) + 1e-9;
    vec2 half_width = 0.5 * max(vec2(width / spacing), pixel);
    vec2 away = abs(fract(place - 0.5) - 0.5);
    vec2 cover = clamp((half_width - away) / pixel + 0.5, 0.0, 1.0) * (1.0 - smoothstep(0.08, 0.3, pixel));
    return max(cover.x, cover.y);
  }
`;
const GRID_SHADE = `
  diffuseColor.rgb *= 1.0 - max(0.055 * gridLines(0.1 * bodySize, 0.003 * bodySize),
                                0.13 * gridLines(0.5 * bodySize, 0.005 * bodySize));
`;

/** Has a material of the floor draw the grid. */
function drawGrid(material, bodySize) {
  material.extensions = {derivatives: true};
  material.onBeforeCompile = shader => {
    shader.uniforms.bodySize = {value: bodySize};
    shader.vertexShader = shader.vertexShader.replace('#include <common>', '#include <common>\nvarying vec2 vGround;')
      .replace('#include <begin_vertex>', '#include <begin_vertex>\nvGround = position.xz;');
    shader.fragmentShader = shader.fragmentShader.replace('#include <common>', '#include <common>\n' + GRID)
      .replace('#include <alphamap_fragment>', '#include <alphamap_fragment>\n' + GRID_SHADE);
  };
}

/** Soft shadows of a sun that is a disk: sharp where things touch, and the softer the farther away they are from what
    they shade. First the mean distance of what is between a point and the sun is searched around it, mostly nearby; by
    it the width of the half-shadow is known. Where the search finds nothing, or nothing but shadow, it is all that is
    done. What shades a point from aside must be the more above it: otherwise slopes would shade themselves. A real
    half-shadow loses nothing by it, as SLOPE is less than 1 / SUN_SIZE. Lengths are in widths of the shadow map. */
const SOFT_SHADOW = `
  #ifdef USE_SHADOWMAP
  const float SUN_SIZE = 0.11, WIDEST = 0.014, SHARPEST = 0.0008, DEPTH = SHADOW_DEPTH, SLACK = 0.0012, SLOPE = 3.0;
  vec2 aside(int k) { return vec2(cos(2.39996 * float(k)), sin(2.39996 * float(k))); }  // the golden angle
  float heightOver(sampler2D map, vec3 at, vec2 shift) {
    return DEPTH * (at.z - unpackRGBAToDepth(texture2D(map, at.xy + shift)));
  }
  float getShadow(sampler2D map, vec2 mapSize, float bias, float radius, vec4 coordinates) {
    vec3 at = coordinates.xyz / coordinates.w;
    if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
    float count = 0.0, sum = 0.0;
    for (int k = 0; k < 24; ++k) {
      float away = WIDEST * float(k) / 23.0, height = heightOver(map, at, away * aside(k));
      if (height > SLACK + SLOPE * away) { count += 1.0; sum += height; }
    }
    if (count < 0.5) return 1.0;
    if (count > 23.5) return 0.0;
    float width = clamp(SUN_SIZE * sum / count, SHARPEST, WIDEST), light = 0.0;
    vec2 next = vec2(1.0 / mapSize.x, 0.0);
    for (int k = 0; k < 32; ++k) {
      float away = width * sqrt((float(k) + 0.5) / 32.0);
      vec2 texel = (at.xy + away * aside(k)) * mapSize - 0.5, part = fract(texel);
      vec3 corner = vec3((floor(texel) + 0.5) / mapSize, at.z);
      vec4 heights = vec4(heightOver(map, corner, next.yy), heightOver(map, corner, next.xy),
                          heightOver(map, corner, next.yx), heightOver(map, corner, next.xx));
      vec4 lit = step(heights, vec4(SLACK + SLOPE * away));
      light += mix(mix(lit.x, lit.y, part.x), mix(lit.z, lit.w, part.x), part.y);
    }
    return light / 32.0;
  }
  #endif
`;

/** Puts them in the place of those of three.js, in revisions that have the function as it was. */
function useSoftShadows(depth) {
  const chunks = THREE.ShaderChunk, theirs = 'float getShadow( sampler2D shadowMap, vec2 shadowMapSize, ' +
    'float shadowBias, float shadowRadius, vec4 shadowCoord ) {';
  const before = chunks.shadowmap_pars_fragment;
  if (!before.includes(theirs)) return;
  chunks.shadowmap_pars_fragment = before.replace(theirs, theirs.replace('getShadow', 'plainShadow')) +
    SOFT_SHADOW.replace('SHADOW_DEPTH', depth.toFixed(3));
}

/** Opaque in the middle, nothing at the rim. */
function fadingTexture() {
  const size = 256, canvas = document.createElement('canvas');
  canvas.width = canvas.height = size;
  const context = canvas.getContext('2d');
  const fade = context.createRadialGradient(size / 2, size / 2, 0, size / 2, size / 2, size / 2);
  // An alpha map is read by its green.
  [[0, 255], [0.25, 235], [0.5, 140], [0.75, 40], [0.98, 0]].forEach(([at, grey]) =>
    fade.addColorStop(at, `rgb(${grey}, ${grey}, ${grey})`));
  context.fillStyle = fade;
  context.fillRect(0, 0, size, size);
  return new THREE.CanvasTexture(canvas);
}

class Stage {
  /** data: of a page; with a `renderer`, for a canvas that has one already */
  constructor(canvas, data) {
    this.canvas = canvas;
    this.renderer = data.renderer || makeRenderer(canvas);
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(BACKGROUND);
    const low = new THREE.Vector3(...data.focus.min), high = new THREE.Vector3(...data.focus.max);
    this.focus = new THREE.Box3(low, high);
    this.centre = this.focus.getCenter(new THREE.Vector3());
    this.radius = 0.5 * this.focus.getSize(new THREE.Vector3()).length();
    this.lastMoment = data.moments - 1;
    this.freeWidth = this.freeHeight = 1;  // as shares
    const materials = new Materials(data.materials);
    this.bodies = data.bodies.map(body => new Body(body, data.models[body.model], materials));
    this.props = data.props.map(prop => new Prop(prop, materials));
    for (const thing of [...this.bodies, ...this.props]) this.scene.add(thing.mesh);
    this.seen = this.seenPoints();
    for (const body of this.bodies) if (body.cage) this.scene.add(body.cage);
    this.solids = [];  // opaque obstacles, all of them convex
    this.floorY = -Infinity;
    if (data.obstacles) this.addObstacles(data.obstacles, materials);
    this.addLights();
    this.camera = new THREE.PerspectiveCamera(28, 1, NEAREST * this.radius, 100 * this.radius);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false;  // arrows are the player's
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.2;
    this.controls.addEventListener('start', () => this.untouched = false);
    this.resetView();
  }

  addLights() {
    this.scene.fog = new THREE.Fog(BACKGROUND);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0xcabeac, 0.64));
    const sun = new THREE.DirectionalLight(0xffffff, 0.45);
    sun.position.set(...SUN_DIRECTION).setLength(4 * this.radius).add(this.centre);
    sun.target.position.copy(this.centre);
    sun.castShadow = true;
    sun.shadow.mapSize.set(1024, 1024);
    sun.shadow.bias = -0.002;
    const reach = 1.6 * this.radius, near = 0.5 * this.radius, far = 8 * this.radius;
    Object.assign(sun.shadow.camera, {left: -reach, right: reach, bottom: -reach, top: reach, near, far});
    useSoftShadows((far - near) / (2 * reach));
    this.scene.add(sun, sun.target);
  }

  /** A mesh each, so that those that are seen through are drawn from the farthest to the nearest; only with them are
      there shadows, which would fall from one body on another that is not really beside it. */
  addObstacles(data, materials) {
    this.renderer.shadowMap.enabled = true;
    for (const group of data.groups) {
      const triangles = data.triangles.subarray(3 * group.first, 3 * (group.first + group.count));
      const whole = {first: 0, count: group.count, material: group.material};
      const mesh = rigidMesh({triangles, positions: data.positions, groups: [whole]}, materials);
      if (!mesh.material.some(material => material.transparent)) this.solids.push(mesh);
      if (group.material === 'floor') this.makeFloor(mesh);
      this.scene.add(mesh);
    }
  }

  /** A floor that fades into the background before it ends. It is drawn first, and hides what is below it as if it were
      opaque: hence it is not called transparent, which would have it drawn last. */
  makeFloor(mesh) {
    const {position} = mesh.geometry.attributes, places = new Float32Array(2 * position.count);
    mesh.geometry.computeBoundingBox();
    const {min, max} = mesh.geometry.boundingBox, {x, z} = this.centre;
    this.floorY = Math.max(this.floorY, max.y);
    const edge = Math.min(x - min.x, max.x - x, z - min.z, max.z - z);
    const reach = 2 * Math.max(this.radius, Math.min(edge, FLOOR_REACH * this.radius));
    for (let v = 0; v < position.count; ++v) {
      places[2 * v] = 0.5 + (position.getX(v) - x) / reach;
      places[2 * v + 1] = 0.5 + (position.getZ(v) - z) / reach;
    }
    setAttribute(mesh.geometry, 'uv', places, 2);
    mesh.material = new THREE.MeshLambertMaterial({color: FLOOR_COLOUR, alphaMap: fadingTexture(), dithering: true,
      blending: THREE.CustomBlending});
    const sizes = this.bodies.map(body => sizeOf(body.positions));
    drawGrid(mesh.material, sizes.length > 0 ? Math.max(...sizes) : this.radius);
    mesh.geometry.clearGroups();
    mesh.renderOrder = -1;
    mesh.castShadow = false;
  }

  /** direction: from what is looked at to the camera */
  resetView(direction = FIRST_DIRECTION) {
    this.untouched = true;
    const back = new THREE.Vector3(...direction).normalize();
    const right = new THREE.Vector3(0, 1, 0).cross(back).normalize(), up = back.clone().cross(right);
    const [x, y, z] = this.closestPlace(right, up, back);
    this.camera.position.set(0, 0, 0).addScaledVector(right, x).addScaledVector(up, y).addScaledVector(back, z);
    this.controls.target.copy(this.camera.position).addScaledVector(back, this.centre.dot(back) - z);
    this.controls.update();
  }

  /** Where the bodies and props are in the run: points, three numbers each. What a body does beyond the focus, as where
      a pile's last ones start to fall, is not waited for. */
  seenPoints() {
    const points = [], {min, max} = this.focus, p = new THREE.Vector3();
    const moments = Math.min(SEEN_MOMENTS, this.lastMoment + 1);
    for (let k = 0; k < moments; ++k) {
      const moment = moments === 1 ? 0 : Math.round(this.lastMoment * k / (moments - 1));
      for (const thing of [...this.bodies, ...this.props]) {
        thing.eachPoint(moment, SEEN_POINTS, (x, y, z) => {
          p.set(x, y, z);
          if (thing instanceof Body) p.clamp(min, max);
          points.push(p.x, p.y, p.z);
        });
      }
    }
    return points;
  }

  /** The place of the camera, along three directions, from which all these points are seen beside what covers the
      canvas: those at its sides give the least distance at which they fit, and the middle between them. */
  closestPlace(right, up, back) {
    const high = FILL * Math.tan(this.camera.fov * Math.PI / 360), p = new THREE.Vector3();
    const fit = (side, slope) => {
      let most = -Infinity, least = Infinity;
      for (let i = 0; i < this.seen.length; i += 3) {
        p.fromArray(this.seen, i);
        const across = p.dot(side), nearer = slope * p.dot(back);
        most = Math.max(most, across + nearer);
        least = Math.min(least, across - nearer);
      }
      return {middle: (most + least) / 2, away: (most - least) / (2 * slope)};
    };
    const across = fit(right, high * this.freeWidth * this.camera.aspect), along = fit(up, high * this.freeHeight);
    return [across.middle, along.middle, Math.max(across.away, along.away)];
  }

  /** top, bottom, right: pixels that are covered there. */
  resize(width, height, top, bottom, right = 0) {
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.freeHeight = Math.max(0.3, (height - top - bottom) / height);
    this.freeWidth = Math.max(0.3, (width - right) / width);
    this.camera.setViewOffset(width, height, Math.round(right / 2), Math.round((bottom - top) / 2), width, height);
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

  /** How high the camera must be where it is: over the floor, and over the obstacle that it is in. */
  leastHeight({x, y, z}) {
    const clearance = CLEARANCE * this.radius, ray = new THREE.Raycaster(), reach = 1000 * this.radius;
    const firstHit = (mesh, direction) => {
      ray.set(new THREE.Vector3(x, this.centre.y - direction * reach, z), new THREE.Vector3(0, direction, 0));
      const [hit] = ray.intersectObject(mesh);
      return hit && hit.point.y;
    };
    let least = this.floorY + clearance;
    for (const mesh of this.solids) {
      const top = firstHit(mesh, -1), bottom = firstHit(mesh, 1);
      if (y > bottom - clearance && y < top + clearance) least = Math.max(least, top + clearance);
    }
    return least;
  }

  /** The mouse may have led the camera into the floor or an obstacle, from where all is hidden or inside out. */
  liftCamera() {
    const {camera: {position}, controls: {target}} = this, least = this.leastHeight(position);
    if (position.y >= least && target.y >= this.floorY) return;
    position.y = Math.max(position.y, least);
    target.y = Math.max(target.y, this.floorY);
    this.camera.lookAt(target);
  }

  draw() {
    this.liftCamera();
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
