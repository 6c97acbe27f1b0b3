// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The scenes, in the worker. Each fills a world by a Builder. The actions of its script in a frame depend only on the
// frame's number, so that a restored world continues as before.

const FRAME = 1 / 60;
/** What the sliders say where nothing else is asked for. tets: 0, the scene's own number. */
const USUAL = {stiffness: 50, damping: 0.02, gravity: 9.81, yield: 1, activation: 0.5, pressure: 1500, tets: 0,
  elements: 'linear', skin: 'linear', forces: false};
/** Frames between two states that native_hashes.json has. */
const COMPARED_EVERY = 30;

/** From 0 to 1 while t goes from one time to another. */
function eased(from, to, t) {
  const x = Math.max(0, Math.min(1, (t - from) / (to - from)));
  return x * x * (3 - 2 * x);
}

/** Numbers that look random and are the same in each run. */
function* scattered(seed) {
  for (let state = seed;;) {
    state = (state * 1103515245 + 12345) % 2147483648;
    yield state / 2147483648 - 0.5;
  }
}

function aboutZ(angle) {
  return [0, 0, Math.sin(angle / 2), Math.cos(angle / 2)];
}

function aboutX(angle) {
  return [Math.sin(angle / 2), 0, 0, Math.cos(angle / 2)];
}

function quaternion(axis, angle) {
  const length = Math.hypot(...axis), s = Math.sin(angle / 2) / length;
  return [...axis.map(x => s * x), Math.cos(angle / 2)];
}

function addFloor(builder) {
  builder.addBox([10, 1, 10], {position: [0, -1, 0], friction: 1}, 'floor');
}

/** Four walls that are seen through. */
function addWalls(builder, inner, height) {
  const thick = 0.05, middle = inner + thick;
  for (const side of [-1, 1]) {
    builder.addBox([thick, height / 2, inner + 2 * thick], {position: [side * middle, height / 2, 0]}, 'wall');
    builder.addBox([inner, height / 2, thick], {position: [0, height / 2, side * middle]}, 'wall');
  }
}

function addSerpent(builder) {
  addFloor(builder);
  builder.addBox([1.2, 0.5, 2], {position: [-1.4, -0.35, 0], rotation: aboutZ(-0.3), friction: 1}, 'ramp');
  builder.addSphere(1.2, {position: [0.6, -0.9, 0], friction: 1}, 'dome');
  builder.addBody('serpent', builder.tets(1000), {position: [0, 0.9, 0], mass: 1, selfContact: true});
}

const HEAP_COLOURS = ['#c8553d', '#3d7ea6', '#e0a030', '#588157', '#8e5572', '#d08c60', '#4a6fa5', '#b5838d'];

function addHeap(builder) {
  addFloor(builder);
  addWalls(builder, 1.1, 0.8);
  const random = scattered(7), next = () => random.next().value;
  const kinds = ['ring', 'ball', 'ring', 'cube', 'ball', 'ring', 'cube', 'ball'];
  kinds.forEach((kind, k) => {
    const layer = Math.floor(k / 4), corner = k % 4, away = 0.56;
    const x = (corner % 2 ? away : -away) + 0.06 * next(), z = (corner < 2 ? away : -away) + 0.06 * next();
    const position = [x, 0.55 + 0.95 * layer, z];
    const rotation = quaternion([next(), next(), next() + 0.01], 3 * next());
    builder.addBody(kind, Math.max(20, Math.round(builder.tets(1000) / 8)),
      {position, rotation, mass: 1, softContact: true}, HEAP_COLOURS[k]);
  });
}

function addPit(builder) {
  addFloor(builder);
  addWalls(builder, 1.06, 0.62);
  builder.addBody('mat', builder.tets(800), {
    position: [0, 0.205, 0], mass: 20, sampleSpacing: 0.12,
    relativeStiffness: builder.stiffness / 3, pinned: p => p[1] < -0.19,
  });
  const random = scattered(3), next = () => random.next().value;
  builder.addSphere(0.26, {mass: 30, position: [0.25, 0.85, 0.1], friction: 0.6}, 'heavy_ball');
  for (let k = 0; k < 24; ++k) {
    const [i, j, layer] = [k % 4, Math.floor(k / 4) % 3, Math.floor(k / 12)];
    const position = [0.45 * (i - 1.5) + 0.05 * next(), 1.5 + 0.4 * layer, 0.6 * (j - 1) + 0.05 * next()];
    builder.addSphere(0.1, {mass: 0.4, position, friction: 0.6}, 'ball');
  }
}

/** Seconds at which the gripper closes, lifts, carries, lowers and opens, and begins again. */
const GRIP = {close: 0.6, lift: 1.4, carry: 2.6, lower: 3.8, open: 5.0, end: 6.2};
const BALL_RADIUS = 0.5, OPEN = 0.75, CLOSED = 0.47, LIFTED = 0.7, CARRIED = 0.7;

/** Where the gripper is after so many seconds: half the width between its fingers, its height, its way to the right. */
function gripperAt(seconds) {
  const round = Math.floor(seconds / GRIP.end), t = seconds - round * GRIP.end, back = round % 2 === 1;
  const half = OPEN + (CLOSED - OPEN) * (eased(GRIP.close, GRIP.lift, t) - eased(GRIP.open, GRIP.end, t));
  const up = LIFTED * (eased(GRIP.lift, GRIP.carry, t) - eased(GRIP.lower, GRIP.open, t));
  const way = eased(GRIP.carry, GRIP.lower, t);
  return {half, up, across: CARRIED * ((back ? 1 - way : way) - 0.5) * 2};
}

function addGripper(builder) {
  addFloor(builder);
  builder.addBody('soft_ball', builder.tets(600), {position: [-CARRIED, BALL_RADIUS + 0.005, 0], mass: 1, friction: 1},
    '#c8553d');
  const at = gripperAt(0), options = {kinematic: true, friction: 1};
  const fingers = [-1, 1].map(side => builder.addBox([0.09, 0.55, 0.3],
    {...options, position: [at.across + side * (at.half + 0.09), 0.65, 0]}, 'finger'));
  const carriage = builder.addBox([0.95, 0.07, 0.16], {...options, position: [at.across, 1.3, 0]}, 'carriage');
  const arm = builder.addBox([0.07, 2, 0.07], {...options, position: [at.across, 3.37, 0]}, 'carriage');
  builder.beforeFrame(frame => {
    const {half, up, across} = gripperAt(frame * FRAME);
    fingers.forEach((finger, k) => finger.position = [across + (k ? 1 : -1) * (half + 0.09), 0.65 + up, 0]);
    carriage.position = [across, 1.3 + up, 0];
    arm.position = [across, 3.37 + up, 0];
  });
}

function addStack(builder) {
  addFloor(builder);
  const colours = ['#3d7ea6', '#e0a030', '#588157', '#c8553d'];
  colours.forEach((colour, k) => {
    builder.addBody('cushion', Math.max(20, Math.round(builder.tets(1200) / 4)),
      {position: [0.02 * (k % 2), 0.265 + 0.525 * k, 0.01 * (k % 3)], mass: 1, softContact: true, friction: 1}, colour);
  });
}

const BAR = {half: 1.6, width: 0.34, held: 0.16, turn: 2 * Math.PI, period: 8};

function addTwist(builder) {
  const centre = [0, 1.2, 0];
  const [, plate] = [-1, 1].map(side => builder.addBox([0.06, 0.42, 0.42],
    {kinematic: true, position: [side * (BAR.half + 0.08), centre[1], 0]}, 'pole'));
  const body = builder.addBody('bar', builder.tets(600), {
    position: centre, mass: 1, damping: 0.2, gravity: 0,
    pinned: p => Math.abs(p[0]) > BAR.half - BAR.held,
  }, '#3f6fae');
  const rest = builder.restNodes(body), turned = [...builder.pinnedOf(body)].filter(n => rest[3 * n] > 0);
  builder.beforeFrame(frame => {
    const t = frame * FRAME % BAR.period, half = BAR.period / 2;
    const angle = BAR.turn * (eased(0.3, 0.85 * half, t) - eased(half + 0.3, 1.85 * half, t));
    const c = Math.cos(angle), s = Math.sin(angle), positions = [];
    for (const n of turned) {
      const [x, y, z] = rest.subarray(3 * n, 3 * n + 3);
      positions.push(centre[0] + x, centre[1] + c * y - s * z, centre[2] + s * y + c * z);
    }
    body.setPinnedPositions(turned, positions);
    plate.rotation = quaternion([1, 0, 0], angle);
  });
}

const CLAY = {half: [0.72, 0.2, 0.45], slope: 0.7, thumb: 0.2, deep: 0.26, away: 0.25, period: 1.5,
  places: [[-0.42, 0.58], [0.02, 0.34], [0.42, 0.58], [1.1, 0.3]]};

/** A block leans on a board. A thumb presses three dents into it, and waits beside it. */
function addClay(builder) {
  addFloor(builder);
  const {half, thumb, deep, away, period, places} = CLAY, c = Math.cos(CLAY.slope), s = Math.sin(CLAY.slope);
  const place = (x, above, up) => [x, 0.2 + c * above + s * up, 0.5 + s * above - c * up];
  const rotation = aboutX(CLAY.slope), last = places.length - 1, front = 2 * half[1] + thumb;
  builder.addBox([0.82, 0.05, 0.55], {position: place(0, -0.055, 0.51), rotation, friction: 1}, 'ramp');
  builder.addBox([0.82, 0.12, 0.04], {position: place(0, 0.015, -0.045), rotation, friction: 1}, 'ramp');
  builder.addBox([0.5, 0.32, 0.05], {position: [0, 0.32, -0.32]}, 'ramp');
  builder.addBody('clay', builder.tets(1500), {position: place(0, half[1] + 0.003, half[2]), rotation, mass: 8, friction: 1,
    damping: 0.1, yields: true}, '#b06a45');
  const ball = builder.addSphere(thumb, {kinematic: true, position: place(0, front + away, 0.5)}, 'pole');
  builder.beforeFrame(frame => {
    const k = Math.min(Math.floor(frame * FRAME / period), last), t = frame * FRAME - k * period;
    const way = eased(0, 0.4, t), pressed = k < last ? eased(0.4, 0.9, t) - eased(1.0, 1.5, t) : 0;
    const [x, up] = places[k].map((to, axis) => to + (1 - way) * ((places[k - 1] || [0, 0.5])[axis] - to));
    ball.position = place(x, front + away - (away + deep) * pressed, up);
  });
}

/** Of the arm: its bones, its weight, and its muscle, whose fibres run from the first point to the second. */
const ARM = {
  top: 1.75, muscle: [[0.2, 1.6, 0], [0.42, 0.74, 0]],
  rods: () => ({
    ivory: {stiffness: 200, density: 1, rods: [
      rod([0, 1.75, 0], [0, 0.82, 0], 0.075, 0.075), rod([0, 1.66, 0], [0.2, 1.64, 0], 0.075, 0.05),
      rod([0.08, 0.7, 0], [1, 0.7, 0], 0.075, 0.055)]},
    cube: {stiffness: 1, density: 1, rods: [rod([0, 0.78, 0], [0.05, 0.72, 0], 0.085, 0.085)]},
    muscle: {stiffness: 1, density: 1, rods: [rod(...ARM.muscle, 0.045, 0.045, 0.06)]},
    heavy_ball: {stiffness: 200, density: 8, rods: [rod([1, 0.7, -0.2], [1, 0.7, 0.2], 0.05, 0.05),
      ...[-1, 1].map(side => rod([1, 0.7, 0.2 * side], [1, 0.7, 0.24 * side], 0.13, 0.13))]},
  }),
};

/** An upper arm that is held, a forearm with a weight, and a muscle between them. */
function addMuscle(builder) {
  addFloor(builder);
  builder.addBox([0.12, 0.04, 0.12], {position: [0, ARM.top + 0.125, 0]}, 'pole');
  const body = builder.addBody('arm', builder.tets(1000), {mass: 4, pinned: p => p[1] > ARM.top - 0.15 && p[0] < 0.08});
  const muscle = builder.addMuscle(body, 'muscle', ARM.muscle.flat(), 100), {settings} = builder;
  builder.beforeFrame(() => {
    const wanted = settings.activation - muscle.activation;
    if (wanted !== 0) muscle.activation += Math.max(-0.02, Math.min(0.02, wanted));
  });
}

const TYRE = {ring: 0.6, outer: 0.2, inner: 0.165, limp: 0.75, filled: 2};

/** A pump fills a tyre, and keeps the amount of gas in it, which would have the pressure that is set in its first
    volume. */
function addTyre(builder) {
  addFloor(builder);
  const body = builder.addBody('tyre', builder.tets(1500), {
    position: [0, TYRE.outer + 0.005, 0], mass: 30, relativeStiffness: builder.stiffness / 10, damping: 1.5, friction: 1,
  }, '#5c6069');
  builder.addBox([0.8, 0.06, 0.28], {mass: 30, position: [0, 2 * TYRE.outer + 0.08, 0], friction: 1}, 'ball');
  body.setPressureSurface(null);  // the inner wall: the visible one is outside
  const first = body.volume, {settings} = builder, most = USUAL.pressure * first * FRAME / TYRE.filled;
  builder.beforeFrame(frame => {
    const has = body.pressure * body.volume, wanted = settings.pressure * first - has;
    if (frame * FRAME < TYRE.limp || Math.abs(wanted) < 0.01 * most) return;
    body.setGas((has + Math.max(-most, Math.min(most, wanted))) / body.volume);
  });
}

/** In the order of the page's row. focus: the box that the first view fits; narrow: likewise, where the screen is
    narrow; skin: 'linear' where nothing is said; own: a setting that it alone has. */
const SCENES = {
  serpent: {title: 'Serpent on ramp and dome', build: addSerpent, tets: 1000, focus: [[-1.35, 0, -0.9], [1.5, 1.7, 1]],
    narrow: [[-0.9, 0, -0.6], [1.1, 1.6, 0.7]]},
  heap: {title: 'Heap of eight', build: addHeap, tets: 1000, focus: [[-1.2, 0, -1.2], [1.2, 1.6, 1.2]]},
  pit: {title: 'Ball pit on a mat', build: addPit, tets: 800, focus: [[-1.15, 0, -1.15], [1.15, 1.2, 1.15]]},
  gripper: {title: 'Gripper', build: addGripper, tets: 600, focus: [[-1.75, 0, -0.5], [1.75, 2.05, 0.5]]},
  stack: {title: 'Stack of four', build: addStack, tets: 1200, focus: [[-0.8, 0, -0.5], [0.8, 2.2, 0.5]]},
  twist: {title: 'Twisted bar', build: addTwist, tets: 600, focus: [[-1.7, 0.75, -0.45], [1.7, 1.65, 0.45]],
    skin: 'quadratic'},
  clay: {title: 'Clay', build: addClay, tets: 1500, focus: [[-0.85, 0, -0.35], [0.95, 1.05, 0.65]], own: 'yield',
    skin: 'quadratic'},
  muscle: {title: 'Muscle', build: addMuscle, tets: 1000, focus: [[-0.2, 0.3, -0.35], [1.15, 1.9, 0.35]], own: 'activation'},
  tyre: {title: 'Tyre', build: addTyre, tets: 1500, focus: [[-0.95, 0, -0.95], [0.95, 0.8, 0.95]], own: 'pressure'},
};
/** Settings that belong to one scene each, which names its `own`. */
const OWN = Object.values(SCENES).map(({own}) => own).filter(Boolean);
const isSettingOf = (name, setting) => !OWN.includes(setting) || SCENES[name].own === setting;

/** The meshes of scenes by name; the serpent is the page's own. */
const SHAPES = {
  ring: () => ringMesh(0.3, 0.09, 0.16, 72, 28),
  ball: () => ballMesh(0.33, 20),
  cube: () => roundedBoxMesh([0.31, 0.31, 0.31], 0.1, 18),
  cushion: () => roundedBoxMesh([0.42, 0.26, 0.42], 0.1, 18),
  soft_ball: () => ballMesh(BALL_RADIUS, 40),
  mat: () => matMesh([1, 0.2, 1], 24, 0.25),
  clay: () => roundedBoxMesh(CLAY.half, 0.09, 40),
  arm: () => paintedRodsMesh(ARM.rods(), [-0.3, 0.4, -0.5], [1.3, 2, 0.5], 0.026, 0.012),
  tyre: () => tyreMesh(TYRE.ring, TYRE.outer, TYRE.inner, 160, 56),
  bar: () => barMesh(BAR.half, BAR.width, 120, 96),
};
