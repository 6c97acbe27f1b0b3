# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""A soft ball rolls down a slope of 10 degrees for 2 s. Its way, over that of a rigid ball: 5/14 g t^2 sin 10
degrees."""
import numpy as np

from plan import usual
from problem import Body, Material, advance
from shapes import ball_tets, volume_of

TITLE = "Soft ball rolls down 10 degrees: radius 0.2 m, E 1e6 Pa, 200 kg/m3, 1,296 tets, damping 0.001 s, mu 1"
SLOPE, SECONDS = np.radians(10), 2


def plan(quick):
    return usual(quick)


def run(Simulation, case, clock, _):
    nodes, tets = ball_tets(0.2, 6, (0.0, 0.202, 0.0))
    ball = Body(nodes, tets, Material(youngs_modulus=1e6, density=200.0, damping=0.001, friction=1.0))
    simulation = Simulation(**case.setting, gravity=(9.81 * np.sin(SLOPE), -9.81 * np.cos(SLOPE), 0.0))
    simulation.add_plane(1.0)
    handle = simulation.add_soft(ball)
    simulation.start()
    advance(simulation, 60 * SECONDS, clock)
    after = simulation.nodes(handle)
    way = np.average(after - nodes, axis=0, weights=ball.masses)[0] / (5 / 14 * 9.81 * SECONDS**2 * np.sin(SLOPE))
    volume = volume_of(after, tets) / volume_of(nodes, tets)
    return {"way, share of a rigid ball's": way, "volume, share": volume, "gap, mm": 1e3 * after[:, 1].min()}
