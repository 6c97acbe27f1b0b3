// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Appended to a page by its test: makes it show two frames with each skin, and leaves the observations in the document.
'use strict';

const FRAMES = [0, 100];

/** Colours of the canvas, as it has just been drawn. */
function pixels(player) {
  player.stage.draw();
  const copy = document.createElement('canvas'), size = 200;
  copy.width = copy.height = size;
  const context = copy.getContext('2d', {willReadFrequently: true});
  context.drawImage(player.stage.canvas, 0, 0, size, size);
  return context.getImageData(0, 0, size, size).data;
}

function coloursIn(data) {
  const colours = new Set();
  for (let i = 0; i < data.length; i += 4) colours.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2]);
  return colours.size;
}

/** Share of the pixels that are clearly others. */
function difference(a, b) {
  let others = 0;
  for (let i = 0; i < a.length; i += 4) {
    others += Math.abs(a[i] - b[i]) + Math.abs(a[i + 1] - b[i + 1]) + Math.abs(a[i + 2] - b[i + 2]) > 30;
  }
  return others / (a.length / 4);
}

/** Whether all that bodies show now is between the header and the footer. */
function isClear(player) {
  const top = document.querySelector('header').getBoundingClientRect().bottom;
  const bottom = document.querySelector('footer').getBoundingClientRect().top, point = new THREE.Vector3();
  player.stage.camera.updateMatrixWorld();
  for (const body of player.stage.bodies) {
    for (let i = 0; i < body.positions.length; i += 3) {
      const [x, y] = player.stage.onCanvas(point.fromArray(body.positions, i));
      if (!(x >= 0 && x <= innerWidth && y >= top && y <= bottom)) return false;
    }
  }
  return true;
}

/** Of all bodies, one after the other, in the space of the frames. */
function positions(player) {
  const all = [];
  for (const body of player.stage.bodies) {
    for (let i = 0; i < body.positions.length; ++i) all.push(body.positions[i] + player.data.origin[i % 3]);
  }
  return all;
}

/** How a body is shaded as it starts. smooth: the share of edges, of those flatter than 45 degrees, across which
    normals do not change; agreement: the least cosine of the angle between a triangle and a normal at its corners. */
function shading({drawn, positions}) {
  const {triangles, index, normals} = drawn, vector = (array, v) => new THREE.Vector3().fromArray(array, 3 * v);
  const size = new THREE.Box3().setFromArray(positions).getSize(new THREE.Vector3()), unit = 1e-4 * size.length();
  const place = v => vector(positions, v).divideScalar(unit).round().toArray().join();
  const normalAt = corner => vector(normals, index[corner]).normalize(), edges = new Map();
  let flat = 0, smooth = 0, agreement = 1;
  for (let at = 0; at < triangles.length; at += 3) {
    const [a, b, c] = [0, 1, 2].map(k => vector(positions, triangles[at + k]));
    const face = b.sub(a).cross(c.sub(a)).normalize();
    for (let k = 0; k < 3; ++k) {
      const from = at + k, to = at + (k + 1) % 3, key = [place(triangles[from]), place(triangles[to])];
      agreement = Math.min(agreement, face.dot(normalAt(from)));
      const other = edges.get(key.reverse().join());
      edges.set(key.reverse().join(), {face, from, to});
      if (!other || other.face.dot(face) < Math.SQRT1_2) continue;
      ++flat;
      smooth += normalAt(from).dot(normalAt(other.to)) > 0.9999 && normalAt(to).dot(normalAt(other.from)) > 0.9999;
    }
  }
  return {flat, smooth: smooth / flat, agreement};
}

/** The page's floor alone, seen from above: bodies are there for their shadows, and not drawn. */
class FloorView {
  constructor(stage) {
    this.stage = stage;
    this.gl = stage.renderer.getContext();
    this.size = sizeOf(stage.bodies[0].positions);
    this.sun = stage.scene.children.find(child => child.isDirectionalLight);
    for (const solid of stage.solids) solid.visible = solid.material.alphaMap !== undefined && solid.renderOrder < 0;
    stage.setVisible(true, 'none');
    for (const {mesh} of stage.bodies) {
      for (const material of mesh.material) Object.assign(material, {colorWrite: false, depthWrite: false});
    }
    const {x, z} = stage.centre;
    stage.camera.position.set(x, stage.floorY + 4 * this.size, z);
    stage.camera.up.set(0, 0, -1);
    stage.camera.lookAt(x, stage.floorY, z);
  }

  /** The green of all pixels. */
  drawn(hasShadow) {
    const {gl, stage} = this, {drawingBufferWidth: width, drawingBufferHeight: height} = gl;
    this.sun.castShadow = hasShadow;
    stage.draw();
    const data = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
    return data.filter((value, i) => i % 4 === 1);
  }

  /** The share of the shadow that is neither light nor all dark; and its size, as a share of the picture. */
  shadow() {
    const light = this.drawn(false), shade = this.drawn(true).map((value, i) => light[i] - value);
    const dark = shade.reduce((most, value) => Math.max(most, value < 128 ? value : 0), 0);
    const all = shade.filter(value => value < 128 && value > 0.15 * dark);
    return {half: all.filter(value => value < 0.85 * dark).length / all.length, size: all.length / shade.length, dark};
  }

  /** How many lines cross a body's size of the floor, and how many of them are clear ones. */
  gridLines() {
    const {gl: {drawingBufferWidth: width, drawingBufferHeight: height}, stage, size} = this, samples = [];
    const pixels = this.drawn(false), z = (Math.floor(stage.centre.z / (0.1 * size)) + 0.5) * 0.1 * size;
    for (let k = 0; k <= 1000; ++k) {
      const x = stage.centre.x + size * (0.001 * k - 0.48);
      const point = new THREE.Vector3(x, stage.floorY, z).project(stage.camera);
      const column = Math.floor((1 + point.x) / 2 * width), row = Math.floor((1 + point.y) / 2 * height);
      samples.push(pixels[row * width + column]);
    }
    const floor = Math.max(...samples);
    const runsBelow = grey => samples.filter((value, k) => k > 0 && value < grey && samples[k - 1] >= grey).length;
    return {all: runsBelow(floor - 4), clear: runsBelow(floor - 14)};
  }
}

function report(player) {
  const found = {}, images = [], skin = document.getElementById('skin');
  player.play(false);
  for (const kind of ['linear', 'quadratic']) {
    skin.value = kind;
    for (const frame of FRAMES) {
      player.seek(frame / player.data.stride);
      found[`${kind}_${frame}`] = positions(player);
      images.push(pixels(player));
      found.clear = found.clear !== false && isClear(player);
    }
  }
  found.colours = coloursIn(images[0]);
  found.difference = difference(images[0], images[1]);
  document.getElementById('cage').value = 'all';
  document.getElementById('cage').onchange();
  found.cage = difference(images[3], pixels(player));
  found.outside = staysOutside(player.stage);
  const bar = document.querySelector('footer').getBoundingClientRect();
  found.fits = bar.left >= 0 && bar.right <= innerWidth && bar.bottom <= innerHeight &&
    document.documentElement.scrollWidth <= innerWidth;
  player.seek(0);
  found.shading = player.stage.bodies.map(shading);
  if (player.stage.solids.length > 0) {
    const view = new FloorView(player.stage);
    found.grid = view.gridLines();
    found.high = view.shadow();
    player.seek(player.data.moments - 1);
    found.low = view.shadow();
  }
  return found;
}

/** Whether the camera, led under the floor and into each obstacle, comes out on top. */
function staysOutside(stage) {
  const box = new THREE.Box3(), places = [stage.centre.clone().setY(stage.floorY - stage.radius)];
  for (const solid of stage.solids) places.push(box.setFromObject(solid).getCenter(new THREE.Vector3()));
  return places.length > 2 && places.every(place => {
    stage.camera.position.copy(place);
    stage.draw();
    return stage.camera.position.y > place.y && stage.camera.position.y >= stage.leastHeight(stage.camera.position);
  });
}

function leave(text) {
  const place = document.createElement('pre');
  place.id = 'report';
  place.textContent = text;
  document.body.append(place);
}

leave(JSON.stringify(report(window.player)));
