// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The page: scenes, controls, time. The worker simulates; a picture asks for the frames that are due since the last
// one, and draws those that have come.

const element = id => document.getElementById(id);
const withCommas = number => number.toLocaleString('en');

const TETS = [100, 300, 600, 1000, 2000, 3000, 5000];
/** Frames that a picture asks for at most: on slower machines time goes slower. */
const MOST_FRAMES = 3;
const REWOUND = 600;
/** Of a mesh that is dropped: its cage, and the longest file that is read. */
const DROPPED_TETS = 800, LONGEST_FILE = 400e6;
const SECONDS_OF_NOTICE = 7;

const STAGES = {
  prediction: 'elasticity', rigidSearch: 'search, rigid', softSearch: 'search, soft', rows: 'contact rows',
  system: 'contact solve', other: 'Bullet', bones: 'bones', page: 'snapshots, hash',
};

/** Settings as the page's address has them: what each may be, by its text. */
const numberFrom = (least, most) => text => {
  const number = text === '' ? NaN : Number(text);
  return number >= least && number <= most ? number : undefined;
};
const oneOf = (...values) => text => values.find(value => String(value) === text);
const ADDRESSED = {
  stiffness: numberFrom(10, 1000), damping: numberFrom(0.001, 0.2), gravity: numberFrom(0, 20),
  yield: numberFrom(0.1, 100), activation: numberFrom(0, 1), pressure: numberFrom(0, 4000),
  tets: oneOf(0, ...TETS), elements: oneOf('linear', 'quadratic'), skin: oneOf('linear', 'quadratic'),
  forces: oneOf(false, true),
};
const PAUSE_OF_ADDRESS = 400;  // milliseconds after the last change: browsers refuse to be told often

/** What a person can do about an error. what: has failed; cure: where there is too little memory for it */
function sentenceOf(error, what, cure = 'Choose fewer tets') {
  if (error.code === 'OutOfMemory') {
    return `${what} needs more memory than this page has. ${cure}, or close other pages.`;
  }
  if (error.code === 'Unsupported') {
    return 'This page needs WebAssembly with SIMD, which this browser does not offer: Chrome or Edge from 95, ' +
      'Firefox from 113, Safari from 16.4 have it.';
  }
  // Readers call every file "file": the line number after it stays.
  const [, place, message] = /^(?:file\.\w+(:\d+)?: )?([^]*)$/.exec(error.message);
  return `${what}${place || ''}: ${message}`;
}

class Live {
  constructor() {
    this.settings = {...USUAL};
    this.tool = 'hold';
    this.playing = true;
    this.due = 0;
    this.draws = true;  // false: frames to come will replace this one
    this.errors = [];
    this.opened = 0;
    this.data = JSON.parse(element('model').textContent);
    this.workerText = element('module').textContent + '\n' + element('worker').textContent;
    const stopped = text => this.fail(`The simulation has stopped: ${text} Load the page again.`);
    this.port = new Port(this.workerText, stopped);
    this.hands = new Hands(element('canvas'), this);
    this.makeScenes();
    this.listen();
    this.scene = this.readAddress();
    this.work(`${SCENES[this.scene].title}: loading`);
    this.showSettings();
  }

  /** Shows the first scene. Returns null, or the sentence that tells why not. */
  async start() {
    const zipped = Uint8Array.from(atob(this.data.zipped), c => c.charCodeAt(0));
    const started = this.port.ask('start', {model: this.data.serpent, zipped, materials: this.data.materials});
    const opened = Promise.all([started, this.open(this.scene)]);
    opened.catch(() => {});  // until it is waited for: the worker is at work while WebGL starts
    const reason = whyNot();
    if (reason) {
      this.port.end();
      showTrouble(reason);
      return reason;
    }
    this.renderer = makeRenderer(element('canvas'));
    await opened;
    this.run();
    return null;
  }

  // --- The address

  /** Takes the settings that the page's address has, as in #twist&stiffness=100; the scene that it names. */
  readAddress() {
    const words = new URLSearchParams(location.hash.slice(1));
    Object.assign(this.settings, USUAL);
    for (const [name, valueOf] of Object.entries(ADDRESSED)) {
      const value = words.has(name) ? valueOf(words.get(name)) : undefined;
      if (value !== undefined) this.settings[name] = value;
    }
    this.skinIsChosen = words.has('skin');
    return Object.keys(SCENES).find(name => words.has(name)) || 'serpent';
  }

  /** Has the address open this scene with these settings. */
  writeAddress() {
    clearTimeout(this.addressing);
    this.addressing = setTimeout(() => {
      const changed = Object.keys(ADDRESSED).filter(name => name === 'skin' ? this.skinIsChosen
        : isSettingOf(this.scene, name) && this.settings[name] !== USUAL[name]);
      const textOf = value => typeof value === 'number' ? Number(value.toPrecision(3)) : value;
      const words = [this.scene, ...changed.map(name => `${name}=${textOf(this.settings[name])}`)].join('&');
      try {
        history.replaceState(null, '', `#${words}`);
      } catch {}  // if a browser forbids it, the page continues without
    }, PAUSE_OF_ADDRESS);
  }

  // --- Scenes

  makeScenes() {
    for (const [name, {title}] of Object.entries(SCENES)) {
      const button = document.createElement('button');
      button.textContent = title;
      button.dataset.scene = name;
      button.onclick = () => this.change(name);
      element('scenes').append(button);
    }
    for (const tets of [0, ...TETS]) {
      element('tets').append(new Option(tets ? withCommas(tets) : 'usual', tets));
    }
  }

  /** Another scene; what fails leaves the one that there is. */
  async change(name) {
    try {
      await this.open(name);
    } catch (error) {
      this.tell(sentenceOf(error, 'This scene'));
    }
  }

  async open(name) {
    const number = ++this.opened;
    this.work(`${SCENES[name].title}: loading`);
    if (!this.skinIsChosen) this.settings.skin = SCENES[name].skin || USUAL.skin;
    try {
      const scene = await this.port.ask('open', {name, settings: this.settings});
      if (number === this.opened) this.show(scene);
    } finally {
      if (number === this.opened && this.drawn) this.work(null);
    }
  }

  show(scene) {
    if (this.stage) this.stage.dispose();
    this.hands.held = null;
    this.description = scene;
    this.scene = scene.name;
    this.meanTimes = this.counted = null;
    this.tell(null);
    this.ofScene = {tets: scene.tets, triangles: scene.triangles};
    this.stage = new LiveStage(element('canvas'), scene, this.data.materials, this.renderer);
    this.stage.setLook(this.look());
    for (const button of element('scenes').children) {
      button.toggleAttribute('aria-current', button.dataset.scene === scene.name);
      if (button.dataset.scene === scene.name) button.scrollIntoView({block: 'nearest', inline: 'center'});
    }
    this.resize();
    this.take(scene.state);
    this.showFacts();
    this.showSettings();
    this.writeAddress();
  }

  showFacts() {
    const {tets, triangles} = this.description;
    element('facts').textContent = `${withCommas(triangles)} triangles in ${withCommas(tets)} tets`;
  }

  // --- Time

  run() {
    let before = performance.now();
    const loop = now => {
      this.advance(Math.min(0.1, Math.max(0, now - before) / 1000));
      before = now;
      this.hands.update();
      this.draw();
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
  }

  advance(seconds) {
    if (!this.playing || !this.stage) return;
    this.due = Math.min(MOST_FRAMES, this.due + seconds * 60);
    if (this.asking || this.due < 1) return;
    const frames = Math.floor(this.due);
    this.due -= frames;
    this.ask('step', {frames});
  }

  /** Asks the worker for something that is answered by a frame, and shows it, unless there is another scene by then. */
  async ask(type, data) {
    const {stage} = this;
    this.asking = true;
    try {
      const state = await this.port.ask(type, data);
      if (stage && stage === this.stage) this.take(state);
      return state;
    } catch (error) {
      this.play(false);
      this.tell(sentenceOf(error, 'The simulation'));
      this.errors.push(error.message);
      return null;
    } finally {
      this.asking = false;
    }
  }

  take(state) {
    this.state = state;
    this.stage.show(state);
    if (state.trouble) this.tell(state.trouble);
    const {frame, first} = state, slider = element('slider');
    slider.min = first;
    slider.max = frame;
    if (!this.sliding) slider.value = frame;
    element('clock').textContent = `${(frame / 60).toFixed(1)} s`;
    this.showFigures(state);
    this.changed = true;
  }

  showFigures({times, milliseconds, hash, compared, frame, bodies, timed}) {
    const now = performance.now(), all = {...times, step: milliseconds}, mean = this.meanTimes || {...all};
    if (timed) {
      for (const [stage, ms] of Object.entries(all)) mean[stage] += 0.1 * (ms - mean[stage]);
      this.meanTimes = mean;
    }
    if (this.playing && now - (this.figuresAt || 0) < 200) return;
    this.figuresAt = now;
    const rows = Object.entries(STAGES).map(([stage, text]) => `<tr><td>${text}<td>${mean[stage].toFixed(2)} ms`);
    const asleep = bodies.filter(body => body.asleep).length;
    rows.push(`<tr class="sum"><td>a frame, in all<td>${mean.step.toFixed(2)} ms`,
      `<tr><td>frames per second, of 60<td>${this.rateAt(now, frame)}`,
      `<tr><td>frame<td>${withCommas(frame)}`,
      `<tr><td>bodies at rest<td>${asleep} of ${bodies.length}`);
    element('figures').innerHTML = rows.join('');
    element('hash').textContent = `state ${hash}`;
    this.showNative(compared);
  }

  /** Frames that were shown per second, of the last half second or so in which time went on. */
  rateAt(now, frame) {
    const {since = now, from = frame} = this.counted || {}, seconds = (now - since) / 1000;
    if (seconds >= 0.5 && this.playing && frame > from) this.rate = Math.round((frame - from) / seconds);
    if (seconds >= 0.5 || !this.counted || !this.playing) this.counted = {since: now, from: frame};
    return this.rate || '';
  }

  /** compared: {frame, hash}, the last state to compare with that of the library in C++; null: none */
  showNative(compared) {
    const hashes = this.data.native[this.description.name], line = element('native');
    const native = compared && hashes && hashes[compared.frame / COMPARED_EVERY - 1];
    line.hidden = !native;
    if (!native) return;
    const {frame, hash} = compared, isEqual = hash === native;
    line.classList.toggle('differs', !isEqual);
    line.textContent = isEqual ? `frame ${frame}: ${hash}, in C++ the same` : `frame ${frame}: ${hash}, in C++ ${native}`;
  }

  play(playing) {
    this.playing = playing;
    this.due = 0;
    element('play').classList.toggle('playing', playing);
  }

  step() {
    this.play(false);
    return this.ask('step', {frames: 1});
  }

  rewind(frames) { return this.ask('rewind', {frames}); }
  async reset() {
    this.meanTimes = null;
    const state = await this.ask('reset');
    if (!state) return null;
    Object.assign(this.description, this.ofScene);  // without what was dropped
    this.showFacts();
    return state;
  }

  /** What is seen again, though no time has passed. */
  refresh() {
    return this.playing ? null : this.ask('step', {frames: 0});
  }

  // --- Controls

  look() {
    return {surface: element('surface').checked, cage: element('cage').value, cut: Number(element('cut').value)};
  }

  showSettings() {
    const {stiffness, damping, gravity, yield: stress, activation, pressure} = this.settings;
    const {tets, elements, skin, forces} = this.settings, texts = {
      stiffness: [Math.log10(stiffness), stiffness.toFixed(0)], damping: [Math.log10(damping), damping.toPrecision(1)],
      gravity: [gravity, gravity.toFixed(1)], yield: [Math.log10(stress), String(Number(stress.toPrecision(2)))],
      activation: [activation, activation.toFixed(2)], pressure: [pressure, pressure.toFixed(0)],
    };
    for (const [id, [value, text]] of Object.entries(texts)) {
      element(id).value = value;
      element(id).nextElementSibling.textContent = text;
      element(id).parentElement.hidden = !isSettingOf(this.scene, id);
    }
    Object.entries({tets, elements, skin}).forEach(([id, value]) => element(id).value = value);
    element('forces').checked = forces;
    element('play').classList.toggle('playing', this.playing);
    for (const button of element('tools').children) {
      button.setAttribute('aria-checked', button.dataset.tool === this.tool);
    }
    element('cuts').hidden = element('cage').value !== 'tets';
  }

  /** Settings that a running world takes. */
  set(settings) {
    Object.assign(this.settings, settings);
    this.skinIsChosen = this.skinIsChosen || 'skin' in settings;
    this.showSettings();
    this.writeAddress();
    this.ask('set', settings);
  }

  listen() {
    const tenTo = id => 10 ** Number(element(id).value);
    element('stiffness').oninput = () => this.set({stiffness: tenTo('stiffness')});
    element('damping').oninput = () => this.set({damping: tenTo('damping')});
    element('yield').oninput = () => this.set({yield: tenTo('yield')});
    for (const id of ['gravity', 'activation', 'pressure']) {
      element(id).oninput = () => this.set({[id]: Number(element(id).value)});
    }
    element('skin').onchange = () => this.set({skin: element('skin').value});
    element('forces').onchange = () => this.set({forces: element('forces').checked});
    for (const id of ['tets', 'elements']) {
      element(id).onchange = () => {
        this.settings.tets = Number(element('tets').value);
        this.settings.elements = element('elements').value;
        this.change(this.description.name);
      };
    }
    for (const id of ['surface', 'cage', 'cut']) element(id).oninput = () => this.relook();
    element('play').onclick = () => this.play(!this.playing);
    element('step').onclick = () => this.step();
    element('restart').onclick = () => this.reset();
    element('back').onclick = () => this.rewind(REWOUND);
    element('view').onclick = () => this.resetView();
    element('full').onclick = () => this.toggleFullScreen();
    element('full').hidden = !document.fullscreenEnabled;
    element('settings').onclick = () => this.showPanel(element('panel').hidden);
    element('file').onchange = ({target}) => {
      if (target.files[0]) this.drop(target.files[0]);
      target.value = '';
    };
    for (const button of element('tools').children) button.onclick = () => this.choose(button.dataset.tool);
    this.listenToSlider();
    this.listenToFiles();
    window.addEventListener('resize', () => this.resize());
    window.addEventListener('hashchange', () => this.change(this.readAddress()));
    window.addEventListener('keydown', event => this.key(event));
    for (const what of ['pointerdown', 'wheel', 'keydown']) {
      window.addEventListener(what, () => element('hint').classList.add('gone'), {passive: true, once: true});
    }
    // A clicked element leaves the space bar to the page.
    document.addEventListener('click', ({detail, target}) => {
      if (detail > 0 && target.tagName === 'BUTTON') target.blur();
    });
    for (const list of document.querySelectorAll('select')) list.addEventListener('change', () => list.blur());
    this.showPanel(innerWidth > 720 && innerHeight > 520);
    window.addEventListener('error', ({message}) => this.errors.push(message));
    window.addEventListener('unhandledrejection',
      ({reason}) => this.errors.push(String(reason && reason.message || reason)));
  }

  /** Back to a frame of the last ten seconds, as the slider is moved; one question at a time. */
  listenToSlider() {
    const slider = element('slider');
    const follow = async () => {
      if (this.sliding) return;
      this.sliding = true;
      this.play(false);
      while (Number(slider.value) < this.state.frame) {
        const before = this.state.frame;
        await this.rewind(before - Number(slider.value));
        if (this.state.frame === before) break;
      }
      this.sliding = false;
    };
    slider.oninput = follow;
  }

  listenToFiles() {
    const over = event => {
      event.preventDefault();
      document.body.classList.add('drop');
    };
    const leave = () => document.body.classList.remove('drop');
    window.addEventListener('dragover', over);
    window.addEventListener('dragleave', event => event.relatedTarget || leave());
    window.addEventListener('drop', event => {
      event.preventDefault();
      leave();
      if (event.dataTransfer.files[0]) this.drop(event.dataTransfer.files[0]);
    });
  }

  choose(tool) {
    this.tool = tool;
    this.showSettings();
  }

  relook() {
    this.showSettings();
    if (this.stage) this.stage.setLook(this.look());
    this.changed = true;
  }

  showPanel(shown) {
    element('panel').hidden = !shown;
    element('settings').setAttribute('aria-expanded', shown);
    if (this.stage) this.resize();
  }

  toggleFullScreen() {
    if (!document.fullscreenEnabled) return;
    if (document.fullscreenElement) document.exitFullscreen();
    else document.documentElement.requestFullscreen().catch(() => {});  // where a browser forbids it
  }

  resetView() {
    if (this.stage) this.stage.resetView();
    this.changed = true;
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target.tagName === 'SELECT') return;
    const next = list => {
      list.selectedIndex = (list.selectedIndex + 1) % list.options.length;
      list.dispatchEvent(new Event(list.id === 'skin' ? 'change' : 'input'));
    };
    const names = Object.keys(SCENES), actions = {
      ' ': () => this.play(!this.playing),
      ArrowRight: () => this.step(), ArrowLeft: () => this.rewind(event.shiftKey ? 60 : 10),
      Backspace: () => this.rewind(REWOUND), Home: () => this.reset(), v: () => this.resetView(),
      s: () => element('surface').click(), a: () => element('forces').click(),
      c: () => next(element('cage')), q: () => next(element('skin')),
      h: () => this.choose('hold'), p: () => this.hands.act('push'), b: () => this.hands.act('ball'),
      m: () => this.showPanel(element('panel').hidden), f: () => this.toggleFullScreen(),
    };
    names.forEach((name, k) => actions[k + 1] = () => this.change(name));
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    const pressed = ['BUTTON', 'INPUT', 'SUMMARY'].includes(event.target.tagName);
    const isTheirs = pressed && (event.key === ' ' || event.key.startsWith('Arrow') || event.key === 'Home');
    if (!action || !this.stage || isTheirs) return;
    event.preventDefault();
    action();
  }

  // --- A mesh that is dropped

  /** Reads it and makes its cage in a worker of its own, whose memory is given back afterwards. */
  async drop(file) {
    if (this.cages) return this.tell('Another mesh is being read.');
    this.tell(null);
    if (file.size > LONGEST_FILE) {
      const [has, most] = [file.size, LONGEST_FILE].map(bytes => Math.round(bytes / 1e6));
      return this.tell(`${file.name} has ${has} MB; this page reads up to ${most}.`);
    }
    const formats = element('file').accept.split(',');
    if (!formats.some(format => file.name.toLowerCase().endsWith(format))) {
      return this.tell(`${file.name} is none of what this page reads: ${formats.join(', ')}.`);
    }
    const cages = this.cages = new Port(this.workerText, () => {});
    try {
      this.work(`${file.name}: reading`, 0, () => cages.end());
      await cages.ask('start');
      const bytes = new Uint8Array(await file.arrayBuffer());
      const made = await cages.ask('makeCage', {bytes, name: file.name, tets: DROPPED_TETS}, {
        transfer: [bytes.buffer],
        progress: ({stage, fraction}) => this.work(`${file.name}: ${stage}`, fraction, () => cages.end()),
      });
      await this.add(made);
    } catch (error) {
      if (error.code !== 'Cancelled') this.tell(sentenceOf(error, file.name, 'Take fewer triangles'));
    } finally {
      cages.end();
      this.cages = null;
      this.work(null);
    }
  }

  async add({mesh, cage, triangles, tets}) {
    const {stage} = this, transfer = [mesh.buffer, cage.buffer];
    const {model, body, state} = await this.port.ask('add', {mesh, cage}, {transfer});
    if (stage !== this.stage) return;
    stage.models[model.number] = model;
    stage.addBody(body);
    this.description.triangles += triangles;
    this.description.tets += tets;
    this.showFacts();
    this.take(state);
  }

  // --- What is told

  /** A sentence, for some seconds; null: none any more. */
  tell(sentence) {
    element('notice').textContent = sentence;
    element('notice').hidden = sentence === null;
    clearTimeout(this.noticed);
    this.noticed = setTimeout(() => element('notice').hidden = true, 1000 * SECONDS_OF_NOTICE);
  }

  /** text: what is going on; null: nothing. fraction: done; without it, nobody knows */
  work(text, fraction, cancel) {
    const box = element('work'), [label, bar, button] = box.children;
    box.hidden = text === null;
    if (text === null) return;
    label.textContent = text;
    fraction === undefined ? bar.removeAttribute('value') : bar.value = fraction;
    button.hidden = !cancel;
    button.onclick = cancel || null;
  }

  fail(sentence) {
    this.errors.push(sentence);
    this.play(false);
    showTrouble(sentence);
  }

  // --- Pictures

  resize() {
    const {innerWidth: width, innerHeight: height} = window;
    const top = document.querySelector('header').getBoundingClientRect().bottom;
    const footer = document.querySelector('footer').getBoundingClientRect();
    const panel = element('panel').getBoundingClientRect(), isShown = panel.width > 0;
    const isBeside = isShown && panel.width < 0.5 * width, isBelow = isShown && !isBeside;
    const bottom = height - (isBelow ? panel.top : footer.top), right = isBeside ? width - panel.left : 0;
    element('hint').style.right = `${right}px`;
    if (this.stage) this.stage.resize(width, height, top, bottom, right);
    this.changed = true;
  }

  draw() {
    if (!this.stage || !this.draws) return;
    if (this.stage.controls.update()) this.changed = true;
    if (!this.changed) return;
    this.changed = false;
    this.stage.draw();
    if (!this.drawn) this.reveal();
  }

  /** Waits for the first picture: where the processor draws, its shaders take seconds, and the canvas is black. */
  reveal() {
    const context = this.renderer.getContext();
    context.readPixels(0, 0, 1, 1, context.RGBA, context.UNSIGNED_BYTE, new Uint8Array(4));
    this.drawn = true;
    element('canvas').classList.add('drawn');
    this.work(null);
  }
}

/** Where the page cannot go on: what is left is what can be done about it. */
function showTrouble(sentence) {
  element('trouble').textContent = sentence;
  element('trouble').hidden = false;
  element('work').hidden = true;
  if (!window.live || !window.live.stage) {
    for (const part of ['footer', 'aside', 'header']) document.querySelector(part).hidden = true;
    element('hint').hidden = true;
  }
}

/** Why the page cannot start, in a sentence; or null. */
function whyNot() {
  const canvas = document.createElement('canvas'), context = canvas.getContext('webgl');
  const cure = 'Open it in another browser, or turn on hardware acceleration in this one\u2019s settings and load it ' +
    'again.';
  if (!context) return `This page draws with WebGL, which this browser does not offer. ${cure}`;
  const units = context.getParameter(context.MAX_VERTEX_TEXTURE_IMAGE_UNITS);
  if (!context.getExtension('OES_texture_float') || units === 0) {
    return `This page bends surfaces by floating-point textures, which WebGL does not offer here. ${cure}`;
  }
  const lost = context.getExtension('WEBGL_lose_context');
  if (lost) lost.loseContext();
  if (typeof WebAssembly !== 'object' || typeof DecompressionStream !== 'function') {
    return sentenceOf({code: 'Unsupported'});
  }
  return null;
}
