# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""A rigid box slides on a soft slab that is held from below. The way it makes, over Coulomb's v^2 / (2 mu g)."""
import numpy as np

from plan import usual
from problem import FRAME, Body, Material, Rigid, advance
from shapes import box_tets

TITLE = "Rigid box of 2 kg slides at 2 m/s on a soft slab, mu 0.3: E 5e5 Pa, 200 kg/m3, 1,440 tets, damping 0.02 s"
MU, SPEED = 0.3, 2.0


def plan(quick):
    return usual(quick)


def run(Simulation, case, clock, _):
    nodes, tets = box_tets((20, 2, 6), (2.0, 0.2, 0.6), (-0.4, 0.0, -0.3))
    material = Material(youngs_modulus=5e5, density=200.0, damping=0.02, friction=1.0)
    slab = Body(nodes, tets, material, pinned=nodes[:, 1] < 1e-9)
    simulation = Simulation(**case.setting)
    simulation.add_soft(slab)
    box = simulation.add_rigid(
        Rigid("box", (0.1, 0.05, 0.1), mass=2.0, position=(0.0, 0.255, 0.0), velocity=(SPEED, 0, 0), friction=MU))
    simulation.start()
    advance(simulation, 120, clock)
    before = simulation.pose(box)[0]
    advance(simulation, 1, clock)
    position, rotation = simulation.pose(box)
    share = position[0] / (SPEED**2 / (2 * MU * 9.81))
    tilt = np.degrees(2 * np.arcsin(min(1.0, np.linalg.norm(rotation[:3]))))
    return {
        "error of the way, %": 100 * abs(share - 1),
        "way, share of Coulomb's": share,
        "height above the slab, mm": 1e3 * (position[1] - 0.25),
        "turned by, degrees": tilt,
        "speed at the end, mm/s": 1e3 * np.linalg.norm(position - before) / FRAME
    }
