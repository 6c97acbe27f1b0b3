# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Rigid balls fall on a soft mat with a rim of rigid boxes."""
import numpy as np

from plan import usual
from problem import Body, Material, Rigid, advance
from shapes import box_tets

TITLE = "Pit: 50 rigid balls of 1 kg on a soft mat of 3,072 tets: E 1e5 Pa, 200 kg/m3, damping 0.02 s, mu 0.5"
RADIUS, COUNT = 0.08, 50


def plan(quick):
    return usual(quick, many=True)


def run(Simulation, case, clock, _):
    nodes, tets = box_tets((16, 2, 16), (1.6, 0.2, 1.6), (-0.8, 0.0, -0.8))
    material = Material(youngs_modulus=1e5, density=200.0, damping=0.02, friction=1.0)
    simulation = Simulation(**case.setting)
    simulation.add_soft(Body(nodes, tets, material, pinned=nodes[:, 1] < 1e-9))
    for x, z, hx, hz in ((0.9, 0, 0.05, 1), (-0.9, 0, 0.05, 1), (0, 0.9, 1, 0.05), (0, -0.9, 1, 0.05)):
        simulation.add_rigid(Rigid("box", (hx, 1.0, hz), position=(x, 1.0, z)))
    turn = np.random.default_rng(1)
    balls = []
    for k in range(COUNT):
        layer, place = divmod(k, 25)
        x, z = 0.28 * (place % 5 - 2), 0.28 * (place // 5 - 2)
        x, z = x + turn.uniform(-0.03, 0.03), z + turn.uniform(-0.03, 0.03)
        balls.append(
            simulation.add_rigid(Rigid("ball", RADIUS, mass=1.0, position=(x, 0.4 + 0.3 * layer, z), friction=0.5)))
    simulation.start()
    advance(simulation, 180, clock)
    places = np.array([simulation.pose(ball)[0] for ball in balls])
    inside = np.abs(places[:, [0, 2]]).max(1) < 0.9
    return {
        "balls that have sunk or left": float(np.sum((places[:, 1] < 0.15) | ~inside)),
        "lowest ball, mm above the mat": 1e3 * (places[:, 1].min() - 0.2 - RADIUS)
    }
