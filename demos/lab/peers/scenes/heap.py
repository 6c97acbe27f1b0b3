# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""26 soft balls fall on the ground and on each other."""
import numpy as np

from plan import usual
from problem import FRAME, Body, Material, advance
from shapes import ball_tets

TITLE = "Heap of 26 balls of 384 tets: radius 0.2 m, E 2e5 Pa, 200 kg/m3, damping 0.02 s, mu 1"


def plan(quick):
    return usual(quick, many=True)


def run(Simulation, case, clock, _):
    simulation = Simulation(**case.setting)
    simulation.add_plane(1.0)
    nodes, tets = ball_tets(0.2)
    ball = Body(nodes, tets, Material(youngs_modulus=2e5, density=200.0, damping=0.02, friction=1.0))
    places = [(0.3 * (i - 1) + 0.02 * k, 0.25 + 0.45 * k, 0.3 * (j - 1) - 0.015 * k)
              for k in range(3) for i, j in np.ndindex(3, 3)][:26]
    places = [(1.5 * x, y, 1.5 * z) for x, y, z in places]
    handles = [simulation.add_soft(ball.moved(place)) for place in places]
    simulation.start()
    advance(simulation, 119, clock)
    before = np.stack([simulation.nodes(handle) for handle in handles])
    advance(simulation, 1, clock)
    after = np.stack([simulation.nodes(handle) for handle in handles])
    centres = after.mean(1)
    pairs = np.linalg.norm(centres[:, None] - centres[None], axis=2)[np.triu_indices(26, 1)]
    return {"nearest centres, share of two radii": pairs.min() / 0.4, "lowest node, mm": 1e3 * after[:, :, 1].min(),
            "speed at the end, mm/s": 1e3 * np.sqrt(np.mean(np.sum((after - before) ** 2, axis=-1))) / FRAME}
