// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Starts the page, and offers it to tests and to the console of a browser as `tetskinLive`:
//
//   ready             a promise: the first scene is shown. Resolves to null, or to the sentence that is shown instead
//   scenes            names
//   state()           {scene, frame, first, hash, compared, playing, tets, triangles, bodies, balls, held, milliseconds,
//                     times}. first: the earliest frame that there is to go back to; compared: {frame, hash} that is
//                     shown beside the native one; times: milliseconds by stage
//   errors            sentences of all errors so far
//   open(name, settings)   opens a scene, paused, with these settings changed: {stiffness, damping, gravity, yield,
//                     activation, pressure, tets, elements: 'linear' or 'quadratic', skin: likewise, forces}; others
//                     stay
//   play(playing)     has time go on, or stop
//   step(frames)      so many frames; the page draws the last
//   rewind(frames)    back by so many
//   reset()           to frame 0
//   horn()            of the first body, the vertex that was highest at rest: {world, screen, size}; screen: pixels of
//                     the page, size: the body's, world
//   onScreen(point)   pixels of the page, of a point in the world
//   look({surface, cage, cut})  as the panel: cage is 'none', 'outer', 'all' or 'tets'
//   drop(name, bytes) as if a file was dropped; resolves when it is a body, or refused with a sentence (`notice`)
//   notice()          the sentence that is shown, or ''
//   throwBall(x, y), push(x, y)  at pixels of the page; time stops
//   memory()          bytes: {module, snapshots, heap}; heap: of the page's scripts, where the browser tells
//   time(frames)      milliseconds of each of so many frames in the worker, which makes them one after the other, with
//                     the bones and the hash
//
// All but `state`, `errors`, `scenes` and `notice` return promises; those of frames resolve to the state then.
'use strict';

/** Until the page is seen, or is not looked at. */
const seen = () => new Promise(resolve => {
  requestAnimationFrame(() => setTimeout(resolve));
  setTimeout(resolve, 200);
});

async function startLive() {
  window.live = new Live();
  await seen();
  try {
    return await window.live.start();
  } catch (error) {
    const sentence = sentenceOf(error, 'The page', 'Load it again');
    window.live.fail(sentence);
    return sentence;
  }
}

/** Waits for the frame that the page has asked for, so that answers come in the order of questions. */
async function quietly(live) {
  live.play(false);
  while (live.asking) await new Promise(resolve => setTimeout(resolve, 5));
}

const FRAMES_AT_ONCE = 20;

window.tetskinLive = {
  ready: startLive(),
  scenes: Object.keys(SCENES),
  get errors() { return window.live ? window.live.errors : []; },
  state() {
    const {description, state, playing} = window.live;
    const {frame, first, hash, compared, balls, held, milliseconds, times} = state;
    const {name: scene, tets, triangles} = description;
    return {scene, tets, triangles, frame, first, hash, compared, playing,
      bodies: state.bodies.length, balls, held, milliseconds, times};
  },
  async open(name, settings = {}) {
    const {live} = window;
    await quietly(live);
    Object.assign(live.settings, settings);
    live.skinIsChosen = live.skinIsChosen || 'skin' in settings;
    live.showSettings();
    await live.open(name);
    return this.state();
  },
  async play(playing) { window.live.play(playing); },
  async step(frames = 1) {
    const {live} = window;
    await quietly(live);
    live.draws = false;
    try {
      for (let left = frames; left > 0; left -= FRAMES_AT_ONCE) {
        await live.ask('step', {frames: Math.min(left, FRAMES_AT_ONCE)});
      }
    } finally {
      live.draws = true;
    }
    return this.state();
  },
  async rewind(frames) {
    await quietly(window.live);
    await window.live.rewind(frames);
    return this.state();
  },
  async reset() {
    await quietly(window.live);
    await window.live.reset();
    return this.state();
  },
  async horn() {
    const {point, size} = await window.live.port.ask('horn');
    return {world: point, screen: await this.onScreen(point), size};
  },
  async onScreen(point) {
    const {stage} = window.live;
    stage.camera.updateMatrixWorld();
    return stage.onCanvas(new THREE.Vector3(...point));
  },
  async look({surface = true, cage = 'none', cut = 0.5}) {
    element('surface').checked = surface;
    element('cage').value = cage;
    element('cut').value = cut;
    window.live.relook();
  },
  async drop(name, bytes) { await window.live.drop(new File([bytes], name)); },
  notice() { return element('notice').hidden ? '' : element('notice').textContent; },
  async throwBall(x, y) { return this.act('ball', x, y); },
  async push(x, y) { return this.act('push', x, y); },
  async act(tool, x, y) {
    await quietly(window.live);
    window.live.hands.at = [x, y];
    await window.live.hands.act(tool);
    return this.state();
  },
  async memory() {
    const {module, snapshots} = await window.live.port.ask('memory');
    return {module, snapshots, heap: performance.memory ? performance.memory.usedJSHeapSize : undefined};
  },
  async time(frames) {
    await quietly(window.live);
    return window.live.port.ask('time', {frames});
  },
};
