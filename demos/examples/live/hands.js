// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The pointers' actions on the canvas: hold a body and drag it, push it, throw a ball at it. Away from bodies they turn
// the view: the controls start with every pointer, and are stopped when the worker answers that a body was hit.

const PUSH = 1.5;             // mass times velocity, of a body's mass and sizes per second
const THROW_SPEED = 7;        // sizes per second

/** So many pixels beside a body, a mouse or a finger still takes hold of it: horns are thin. */
const NEAR = {mouse: [4, 9], touch: [9, 18]};

class Hands {
  /** app: with `stage`, `port` and `tool` */
  constructor(canvas, app) {
    this.canvas = canvas;
    this.app = app;
    this.pointers = new Set();
    this.at = [innerWidth / 2, innerHeight / 2];
    this.held = null;  // {pointer, point}: the pointer that drags, and the point of the body that it holds
    canvas.addEventListener('pointerdown', event => this.down(event), true);
    window.addEventListener('pointermove', event => this.move(event), true);
    for (const what of ['pointerup', 'pointercancel']) window.addEventListener(what, event => this.up(event), true);
  }

  down({pointerId, pointerType, button, clientX, clientY}) {
    this.pointers.add(pointerId);
    this.at = [clientX, clientY];
    if (this.pointers.size > 1) return this.letGo();  // two fingers turn and zoom
    if (button !== 0) return;
    if (this.app.tool === 'hold') this.hold(pointerId, clientX, clientY, NEAR[pointerType] || NEAR.mouse);
    else this.act(this.app.tool);
  }

  /** near: radii around the pixel, on which the body is searched for if it is not there */
  async hold(pointer, x, y, near) {
    const {stage, port} = this.app, view = this.viewOf(stage);
    const answer = await port.ask('pick', {rays: this.raysAround(stage, x, y, near)});
    if (!answer) return;
    if (!this.pointers.has(pointer) || this.pointers.size > 1 || stage !== this.app.stage) {
      port.ask('letGo');
      return;
    }
    this.held = {pointer, point: answer.point};
    stage.controls.enabled = false;
    stage.controls.dampingFactor = 1;
    stage.camera.position.copy(view.position);
    stage.controls.target.copy(view.target);
    stage.camera.lookAt(view.target);
    this.drag();
  }

  raysAround(stage, x, y, radii) {
    const points = [[x, y]];
    for (const radius of radii) {
      for (let angle = 0; angle < 6; angle += Math.PI / 4) {
        points.push([x + radius * Math.cos(angle), y + radius * Math.sin(angle)]);
      }
    }
    return points.map(point => {
      const {from, to} = stage.rayThrough(...point);
      return {from, to};
    });
  }

  viewOf({camera, controls}) { return {position: camera.position.clone(), target: controls.target.clone()}; }

  move({pointerId, clientX, clientY}) {
    this.at = [clientX, clientY];
    if (!this.held || this.held.pointer !== pointerId) return;
    this.moved = true;
  }

  /** Once a picture: tells the worker where the pointer is. */
  update() {
    if (this.held && this.moved) this.drag();
    this.moved = false;
  }

  drag() {
    const [x, y] = this.at, {stage, port} = this.app;
    return port.ask('drag', {target: stage.onPlane(x, y, this.held.point)});
  }

  up({pointerId}) {
    this.pointers.delete(pointerId);
    if (this.held && this.held.pointer === pointerId) this.letGo();
  }

  letGo() {
    if (!this.held) return;
    const {controls} = this.app.stage;
    this.held = null;
    controls.enabled = true;  // before the mouse event of this pointer, which ends the turn of the view
    controls.dampingFactor = 0.2;
    this.app.port.ask('letGo').then(() => this.app.refresh());
  }

  /** Where the pointer is. */
  async act(tool) {
    const [x, y] = this.at, {stage, port} = this.app, ray = stage.rayThrough(x, y);
    if (tool === 'push') {
      await port.ask('push', {from: ray.from, to: ray.to, strength: PUSH});
    } else {
      const speed = THROW_SPEED * stage.radius, position = ray.direction.clone().multiplyScalar(1.2 * stage.radius);
      position.add(stage.camera.position);
      const velocity = ray.direction.clone().multiplyScalar(speed).toArray();
      velocity[1] += 0.6;
      await port.ask('throwBall', {position: position.toArray(), velocity, radius: stage.ballRadius});
    }
    await this.app.refresh();
  }
}
