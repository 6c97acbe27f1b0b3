// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Appended to a page by its test: has it show two frames with each skin, and leaves in the document what was seen.
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
