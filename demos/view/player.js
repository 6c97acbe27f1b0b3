// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Time, and the page's controls.

const element = id => document.getElementById(id);

class Player {
  constructor(data) {
    this.data = data;
    this.stage = new Stage(element('canvas'), data);
    this.moment = 0;
    this.playing = false;
    this.changed = true;
    this.labels = this.stage.bodies.map(body => this.makeLabel(body));
    this.setTexts();
    this.listen();
    this.resize();
    this.select();
    this.seek(0);
  }

  setTexts() {
    const {title, facts, skin, moments, bodies} = this.data;
    document.title = title || 'tetskin';
    element('title').textContent = title;
    element('facts').textContent = facts.join(' \u00b7 ');
    element('slider').max = moments - 1;
    for (const player of document.querySelectorAll('.player')) player.hidden = moments === 1;
    element('cages').hidden = bodies.every(body => !this.data.models[body.model].cage);
    element('skin').value = skin;
    element('skins').hidden = bodies.every(body => body.skin !== '' || !this.data.models[body.model].cage);
  }

  makeLabel(body) {
    const label = document.createElement('span');
    label.textContent = body.data.label;
    label.hidden = label.textContent === '';
    element('labels').append(label);
    return label;
  }

  listen() {
    element('play').onclick = () => this.play(!this.playing);
    element('slider').oninput = event => {
      this.play(false);
      this.seek(Number(event.target.value));
    };
    for (const id of ['surface', 'cage', 'skin']) element(id).onchange = () => this.select();
    for (const list of document.querySelectorAll('select')) list.addEventListener('change', () => list.blur());
    // A clicked element leaves the space bar to the player.
    document.querySelector('footer').addEventListener('click', event => {
      if (event.detail > 0 && event.target.tagName !== 'SELECT') event.target.blur();
    });
    element('reset').onclick = () => this.resetView();
    for (const what of ['pointerdown', 'wheel', 'keydown', 'touchstart']) {
      window.addEventListener(what, () => element('hint').classList.add('gone'), {passive: true, once: true});
    }
    window.addEventListener('resize', () => this.resize());
    window.addEventListener('keydown', event => this.key(event));
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target.tagName === 'SELECT') return;
    const step = (event.shiftKey ? 10 : 1) / this.data.stride, cage = element('cage'), skin = element('skin');
    const next = list => {
      list.selectedIndex = (list.selectedIndex + 1) % list.options.length;
      this.select();
    };
    const actions = {
      ' ': () => this.play(!this.playing),
      ArrowLeft: () => this.step(-step), ArrowRight: () => this.step(step),
      ArrowDown: () => this.step(-10 * step), ArrowUp: () => this.step(10 * step),
      Home: () => this.seek(0), End: () => this.seek(this.data.moments - 1),
      r: () => this.resetView(), c: () => next(cage), q: () => next(skin),
      s: () => element('surface').click(),
    };
    const action = actions[event.key], pressed = ['BUTTON', 'INPUT'].includes(event.target.tagName);
    if (!action || (event.key === ' ' && pressed && event.target.type !== 'range')) return;
    event.preventDefault();
    action();
  }

  play(playing) {
    this.playing = playing;
    element('play').classList.toggle('playing', playing);
  }

  step(moments) {
    this.play(false);
    this.seek(Math.max(0, Math.min(this.data.moments - 1, this.moment + moments)));
  }

  /** moment: from 0 to the last kept one, and between them */
  seek(moment) {
    this.moment = moment;
    this.stage.show(moment, element('skin').value === 'quadratic');
    const frame = moment * this.data.stride;
    element('slider').value = Math.round(moment);
    element('clock').textContent = `frame ${Math.round(frame)} \u00b7 ${(frame / this.data.rate).toFixed(2)} s`;
    this.changed = true;
  }

  select() {
    this.stage.setVisible(element('surface').checked, element('cage').value);
    this.seek(this.moment);
  }

  resetView() {
    this.stage.resetView();
    this.changed = true;
  }

  resize() {
    const {innerWidth: width, innerHeight: height} = window;
    const top = document.querySelector('header').getBoundingClientRect().bottom;
    const footer = document.querySelector('footer').getBoundingClientRect();
    element('hint').style.bottom = `${height - footer.top + 6}px`;
    const bottom = height - element('hint').getBoundingClientRect().top;  // above the footer
    this.stage.resize(width, height, top, bottom);
    this.changed = true;
  }

  /** seconds: since the last call */
  advance(seconds) {
    if (!this.playing) return;
    const last = this.data.moments - 1, rate = this.data.rate / this.data.stride * Number(element('speed').value);
    const moment = this.moment + rate * seconds;
    this.seek(moment > last ? 0 : moment);
  }

  draw() {
    if (this.stage.controls.update()) this.changed = true;
    if (!this.changed) return;
    this.changed = false;
    this.stage.draw();
    this.labels.forEach((label, k) => this.placeLabel(label, this.stage.bodies[k]));
  }

  placeLabel(label, body) {
    if (label.hidden) return;
    const [x, y] = this.stage.onCanvas(body.top());
    label.style.transform = `translate(${x}px, ${y - 10}px) translate(-50%, -100%)`;
  }

  run() {
    let before = performance.now();
    const loop = now => {
      this.advance(Math.min(0.1, Math.max(0, now - before) / 1000));
      before = now;
      this.draw();
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
  }
}

function hasWebGl() {
  const canvas = document.createElement('canvas');
  return Boolean(canvas.getContext('webgl2') || canvas.getContext('webgl'));
}

/** Without WebGL there is nothing to control: what is left is what can be done about it. */
function showTrouble() {
  const {title} = readData();
  document.title = element('title').textContent = title;
  document.querySelector('footer').hidden = element('hint').hidden = true;
  element('trouble').textContent = 'This page draws with WebGL, which this browser does not offer. ' +
    'Open it in another browser, or turn on hardware acceleration in this one\u2019s settings and load it again.';
  element('trouble').hidden = false;
}

/** Plays, or shows one frame: view.html#frame=100. */
function start() {
  const player = new Player(readData()), frame = /^#frame=(\d+)$/.exec(location.hash);
  if (frame) {
    player.seek(Math.min(player.data.moments - 1, Number(frame[1]) / player.data.stride));
  } else {
    player.play(player.data.moments > 1);
  }
  player.run();
  return player;
}

if (hasWebGl()) {
  window.player = start();
} else {
  showTrouble();
}
