# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""A cube falls 0.1 m and rests, with stiffness from 1e3 to 1e9 Pa: which peers stay stable.

How far its longest diagonal is from that at rest at the end, and how fast it still is.
"""
import numpy as np

from plan import Case, usual
from problem import FRAME, Body, Material, advance
from shapes import box_tets

TITLE = "Cube of 0.3 m and 384 tets that falls 0.1 m, 1e3 to 1e9 Pa: 200 kg/m3, damping 0.02 s, mu 0.5"


def plan(quick):
    examples = [case for case in usual(True) if case.example]
    powers = (3, 6, 9) if quick else range(3, 10)
    return [Case(case.peer, case.curve, case.setting, f"1e{power} Pa", True) for case in examples for power in powers]


def run(Simulation, case, clock, _):
    simulation = Simulation(**case.setting)
    simulation.add_plane(1.0)
    nodes, tets = box_tets((4, 4, 4), (0.3, 0.3, 0.3), (-0.15, 0.1, -0.15))
    body = Body(nodes, tets, Material(youngs_modulus=float(case.mesh.split()[0]), density=200.0, damping=0.02))
    handle = simulation.add_soft(body)
    simulation.start()
    advance(simulation, 119, clock)
    before = simulation.nodes(handle)
    advance(simulation, 1, clock)
    after = simulation.nodes(handle)
    diagonal = np.linalg.norm(after[-1] - after[0]) / np.linalg.norm(nodes[-1] - nodes[0])
    return {"diagonal, share": diagonal, "height of the middle, mm": 1e3 * after[:, 1].mean(),
            "speed at the end, mm/s": 1e3 * np.sqrt(np.mean(np.sum((after - before) ** 2, axis=1))) / FRAME}
