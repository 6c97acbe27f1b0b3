# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""A soft ball without gravity is to have twice its volume: by growth (tetskin), or by a pressure that reaches for that
volume against its elasticity (Rapier).

Error: of its volume after two seconds.
"""
from materials import volumes
from plan import cases
from problem import Body, Material, advance
from shapes import ball_tets

FACTOR = 2.0
TITLE = "Ball of 1 m and 1,296 tets that is to have twice its volume: E 1e5 Pa, 100 kg/m3, damping 0.02 s"


def plan(quick):
    of = lambda counts, **more: [{"substeps": n, **more} for n in counts]  # noqa: E731
    few = (4,) if quick else (4, 16)
    return [
        *cases("tetskin", "world", of(few), {"substeps": 4}),
        *cases("rapier", "constraints", of(few), {"substeps": 4}),
        *cases("rapier", "finite elements", of(few, solver="fem", iterations=100), {"substeps": 4}),
        *cases("mujoco", "discrete", of((16,)), {"substeps": 16}),
        *cases("pybullet", "neo-Hookean", of((4,)), {"substeps": 4}),
        *cases("newton", "VBD", of((10,), iterations=10), {"substeps": 10}),
    ]


def run(Simulation, case, clock, references):
    nodes, tets = ball_tets(0.5, 6)
    simulation = Simulation(**case.setting, gravity=(0, 0, 0))
    handle = simulation.add_soft(Body(nodes, tets, Material(youngs_modulus=1e5, damping=0.02), swells=FACTOR))
    simulation.start()
    advance(simulation, 120, clock)
    reached = volumes(simulation.nodes(handle), tets).sum() / volumes(nodes, tets).sum()
    return {"volume over its first": reached, "error of the volume, %": 100 * abs(reached / FACTOR - 1)}
