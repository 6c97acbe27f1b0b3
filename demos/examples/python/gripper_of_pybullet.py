#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
# %% [markdown]
# # pybullet's arm lifts a soft ball
#
# The arm (Franka's Panda) and the ground are from pybullet's data. The ball is a soft body of tetskin's. A `Mirror`
# shows the hand and the ground to tetskin's world, and gives the forces of the ball back to the fingers, which hold it
# by friction alone.

# %%
import argparse
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pybullet as p
import pybullet_data
import trimesh
from matplotlib.image import imsave

import tetskin as ts
import tetskin.pybullet

STEP = 1 / 240
GRAVITY = (0, 0, -9.81)
RADIUS, MASS = 0.03, 0.05  # of the ball: m, kg
HAND, FINGERS, BETWEEN_FINGERS = 8, (9, 10), 11  # links of the arm
ARM = range(7)
READY = (0, 0.4, 0, -2.1, 0, 2.5, 0.785)  # angles with the hand above the ball
OPEN = 0.04  # m: each finger's way
PLACE = (0.5, 0.0)


# %%
def make_arm(client: int) -> tuple[int, int]:
    """The ground and the arm, whose hand looks down."""
    p.setAdditionalSearchPath(pybullet_data.getDataPath(), physicsClientId=client)
    p.setGravity(*GRAVITY, physicsClientId=client)
    p.setTimeStep(STEP, physicsClientId=client)
    ground = p.loadURDF("plane.urdf", physicsClientId=client)
    arm = p.loadURDF("franka_panda/panda.urdf", useFixedBase=True, physicsClientId=client)
    for joint, angle in zip(ARM, READY):
        p.resetJointState(arm, joint, angle, physicsClientId=client)
    for finger in FINGERS:
        p.resetJointState(arm, finger, OPEN, physicsClientId=client)
    return ground, arm


def add_ball(world: ts.World, subdivisions: int) -> ts.Body:
    sphere = trimesh.creation.icosphere(subdivisions=subdivisions, radius=RADIUS)
    cage = ts.create_cage(sphere, target_tets=500)
    return world.add_body(cage, sphere, position=(*PLACE, RADIUS + 0.0005), mass=MASS, youngs_modulus=3e4, friction=0.8)


# %%
class Control:
    """The arm's plan: the hand's height changes evenly, and fingers are open, or close with a force."""

    def __init__(self, client: int, arm: int) -> None:
        self.client, self.arm = client, arm
        self.height = 0.2

    def move(self, towards: float, speed: float = 0.15) -> None:
        self.height += float(np.clip(towards - self.height, -speed * STEP, speed * STEP))
        angles = p.calculateInverseKinematics(self.arm, BETWEEN_FINGERS, (*PLACE, self.height), (1, 0, 0, 0),
                                              maxNumIterations=50, physicsClientId=self.client)
        p.setJointMotorControlArray(self.arm, ARM, p.POSITION_CONTROL, angles[:7], forces=[200] * 7,
                                    physicsClientId=self.client)

    def grip(self, force: float | None) -> None:
        """force: newton, of each finger; None: they open."""
        for finger in FINGERS:
            p.setJointMotorControl2(self.arm, finger, p.POSITION_CONTROL, OPEN if force is None else 0,
                                    force=20 if force is None else force, maxVelocity=0.05, physicsClientId=self.client)


def picture(client: int, ball: ts.Body, path: Path) -> None:
    """pybullet's view, with the ball in its current shape."""
    assert ball.mesh
    shape = p.createVisualShape(p.GEOM_MESH, vertices=ball.positions.tolist(),
                                indices=ball.mesh.triangles.ravel().tolist(), rgbaColor=(0.9, 0.3, 0.2, 1),
                                physicsClientId=client)
    shown = p.createMultiBody(0, -1, shape, physicsClientId=client)
    view = p.computeViewMatrix((0.85, -0.35, 0.25), (0.48, 0, 0.12), (0, 0, 1))
    projection = p.computeProjectionMatrixFOV(40, 4 / 3, 0.05, 5)
    width, height, colours, _, _ = p.getCameraImage(640, 480, view, projection, renderer=p.ER_TINY_RENDERER,
                                                    lightDirection=(1, -1, 2), physicsClientId=client)
    p.removeBody(shown, physicsClientId=client)
    imsave(path, np.reshape(colours, (height, width, 4)).astype(np.uint8)[..., :3])


# %%
def run(output: Path | None = None, force: float = 6.0, quick: bool = False) -> dict[str, Any]:
    """Lowers the hand, grips, lifts, holds. Returns its measurements. output: a folder for pictures, or None. quick: a
    coarser ball, held for a shorter time."""
    client = p.connect(p.DIRECT)
    try:
        ground, arm = make_arm(client)
        world = ts.World(gravity=GRAVITY)
        ball = add_ball(world, 4 if quick else 5)
        mirror = tetskin.pybullet.Mirror(client, world, bodies=[ground])
        mirror.add(arm, links=[HAND, *FINGERS])
        control = Control(client, arm)
        measured: dict[str, Any] = {}
        start = time.perf_counter()
        steps = 0
        # seconds, height of the fingertips' middle, force of each finger
        for name, seconds, height, grip in [("above", 1.0, 0.2, None), ("around", 1.5, 0.03, None),
                                            ("gripped", 1.0, 0.03, force), ("lifted", 2.0, 0.25, force),
                                            ("held", 0.5 if quick else 2.0, 0.25, force)]:
            for _ in range(round(seconds / STEP)):
                control.move(height)
                control.grip(grip)
                mirror.step(substeps=4)
                steps += 1
            felt = [mirror.force_on(arm, finger)[0] for finger in FINGERS]
            measured[name] = {"lowest": float(ball.positions[:, 2].min()),
                              "centre": ball.positions.mean(0).astype(float),
                              "width": float(np.ptp(ball.positions[:, 1])),
                              "squeeze": float(0.5 * (abs(felt[0][1]) + abs(felt[1][1]))),
                              "carried": float(-felt[0][2] - felt[1][2]),
                              "on_ground": float(world.forces_on(ball, mirror.rigid_bodies(ground)[0]).total.force[2])}
            if output:
                output.mkdir(parents=True, exist_ok=True)
                picture(client, ball, output / f"{len(measured)}_{name}.png")
        measured["step"] = (time.perf_counter() - start) / steps
        return measured
    finally:
        p.disconnect(client)


# %%
def report(measured: dict[str, Any]) -> None:
    print(f"ball: {MASS * 9.81:.3f} N, {2e3 * RADIUS:.0f} mm wide")
    for name, m in measured.items():
        if name == "step":
            continue
        print(f"{name:8} lowest point {1e3 * m['lowest']:7.2f} mm, {1e3 * m['width']:5.1f} mm wide, fingers squeeze "
              f"with {m['squeeze']:5.2f} N and carry {m['carried']:6.3f} N, the ground {m['on_ground']:6.3f} N")
    print(f"{1e3 * measured['step']:.1f} ms per step of {1e3 * STEP:.1f} ms, the arm's control and pictures included")


def faults(measured: dict[str, Any]) -> Iterator[str]:
    """The faults of a lift."""
    weight = MASS * 9.81
    lifted, held = measured["lifted"], measured["held"]
    if abs(measured["around"]["on_ground"] - weight) > 0.02 * weight:
        yield "the ball does not rest on the ground at first"
    if not held["lowest"] > 0.15:
        yield "the ball has not been lifted"
    if np.abs(held["centre"] - lifted["centre"]).max() > 0.005:
        yield "the ball slips"
    if abs(held["carried"] - weight) > 0.05 * weight or held["on_ground"] != 0:
        yield "the fingers do not carry the ball's weight"
    if not held["width"] < 2 * RADIUS - 0.001:
        yield "the ball is not squeezed"


# %%
def main() -> None:
    parser = argparse.ArgumentParser(description="pybullet's arm lifts a soft ball of tetskin's.")
    parser.add_argument("--output", type=Path, default=Path("out/gripper_of_pybullet"), help="folder for pictures")
    parser.add_argument("--force", type=float, default=6.0, help="of each finger, N")
    parser.add_argument("--quick", action="store_true", help="a coarser ball, held for a shorter time")
    arguments = parser.parse_args()
    measured = run(arguments.output, arguments.force, arguments.quick)
    report(measured)
    wrong = list(faults(measured))
    if wrong:
        sys.exit("gripper_of_pybullet.py: " + "; ".join(wrong))
    print(f"held; pictures are in {arguments.output}")


# %%
if __name__ == "__main__":
    main()
