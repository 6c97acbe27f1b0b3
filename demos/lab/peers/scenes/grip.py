# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Two fingers lift a soft cube, and shake it for four seconds: how far it slips. They are moved once per frame."""
import numpy as np

from plan import Case, usual
from problem import FRAME, Body, Material, Rigid, advance
from shapes import box_tets

TITLE = "Two fingers shake a soft cube of 0.1 m and 1 kg: E 1e5 Pa, 750 tets, damping 0.02 s, mu 0.6, 2 cm, 30 rad/s"
AXES = {"along the fingers": (1, 0, 0), "up and down": (0, 1, 0), "aside": (0, 0, 1)}
PEERS = ("tetskin", "rapier", "mujoco")
QUICK_LIMIT = 60
AWAY, SQUEEZE, LIFT, SHAKE, RATE, FOR = 0.062, 0.0105, 0.2, 0.02, 30.0, 4.0


def plan(quick):
    # Finite elements of Rapier take more than a minute.
    settings = [case for case in usual(quick) if case.peer in PEERS and case.curve != "finite elements"]
    axes = ["up and down"] if quick else AXES
    return [Case(case.peer, case.curve, case.setting, axis, case.example) for case in settings for axis in axes]


def ramp(x):
    x = np.clip(x, 0, 1)
    return x * x * (3 - 2 * x)


def run(Simulation, case, clock, _):
    nodes, tets = box_tets((5, 5, 5), (0.1, 0.1, 0.1), (-0.05, 0.001, -0.05))
    cube = Body(nodes, tets, Material(youngs_modulus=1e5, density=1000.0, damping=0.02, friction=1.0))
    simulation = Simulation(**case.setting)
    simulation.add_plane(0.5)
    soft = simulation.add_soft(cube)
    fingers = [
        simulation.add_rigid(
            Rigid("box", (0.01, 0.06, 0.06), position=(side * AWAY, 0.062, 0.0), friction=0.6, moved=True))
        for side in (-1, 1)
    ]
    simulation.start()
    axis = np.array(AXES[case.mesh])

    def grip_at(time):
        """How far the fingers have moved, without what squeezes."""
        shaken = time - 2.5
        envelope = ramp(shaken / 0.4) * ramp((FOR + 0.4 - shaken) / 0.4)
        return np.array((0, LIFT * ramp(time - 1), 0)) + axis * SHAKE * envelope * np.sin(RATE * shaken)

    def play(first, last):
        for frame in range(first, last):
            time = (frame + 1) * FRAME
            for side, finger in zip((-1, 1), fingers):
                out = side * (AWAY - SQUEEZE * ramp(time))
                simulation.move(finger, np.array((out, 0.062, 0.0)) + grip_at(time))
            advance(simulation, 1, clock)
        return simulation.nodes(soft).mean(0) - grip_at(last * FRAME)

    before = play(0, 150)
    after = play(150, 150 + round((FOR + 1) / FRAME))
    return {"slipped, mm": 1e3 * np.linalg.norm(after - before)}
