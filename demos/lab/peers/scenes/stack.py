# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Three soft boxes are stacked, and rest for 5 s."""
import numpy as np

from plan import usual
from problem import FRAME, Body, Material, advance
from shapes import box_tets

TITLE = "Stack of three boxes of 0.3 m: E 2e5 Pa, 200 kg/m3, 480 tets each, damping 0.02 s, mu 1"


def plan(quick):
    return usual(quick, many=True)


def run(Simulation, case, clock, _):
    simulation = Simulation(**case.setting)
    simulation.add_plane(1.0)
    nodes, tets = box_tets((4, 5, 4), (0.3, 0.3, 0.3), (-0.15, 0.0, -0.15))
    box = Body(nodes, tets, Material(youngs_modulus=2e5, density=200.0, damping=0.02, friction=1.0))
    boxes = [box.moved((0, 0.005 + 0.305 * k, 0)) for k in range(3)]
    handles = [simulation.add_soft(body) for body in boxes]
    simulation.start()
    slept = None
    for frame in range(1, 301):
        advance(simulation, 1, clock)
        if slept is None and all(simulation.asleep(handle) for handle in handles):
            slept = frame * FRAME
    before = np.stack([simulation.nodes(handle) for handle in handles])
    advance(simulation, 1)
    after = np.stack([simulation.nodes(handle) for handle in handles])
    lean = np.linalg.norm((after.mean(1) - np.stack([body.nodes for body in boxes]).mean(1))[:, [0, 2]], axis=1).max()
    return {
        "ms at rest": 1e3 * np.mean(clock.parts[-60:]),
        "asleep after, s": slept,
        "leans by, mm": 1e3 * lean,
        "top, m": after[2, :, 1].max(),
        "speed at the end, mm/s": 1e3 * np.sqrt(np.mean(np.sum((after - before)**2, axis=-1))) / FRAME
    }
