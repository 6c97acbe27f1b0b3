# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""A bar of clay is pulled to three strains in half a second, held, and let go.

Its middle half keeps the strain at which it was held less that at which it yields, if flow is at once. Error: of what
it keeps, beside that. Peers that let strain flow at a rate get one at which it is gone within a step, and that of their
example.
"""
import numpy as np

from materials import volumes
from plan import cases
from problem import FRAME, Body, Material, advance
from shapes import box_tets

YIELD, STRAINS = 0.02, (0.05, 0.2, 0.5)
PULLS, HOLDS, RESTS = 30, 18, 90  # frames
MATERIAL = Material(youngs_modulus=2e5, density=1000.0, damping=0.01, yield_strain=YIELD)
TITLE = "Bar 1 x 0.25 x 0.25 m, 1,536 tets, pulled to 5, 20 and 50 %: E 2e5 Pa, 1,000 kg/m3, yields at 2 %"


def plan(quick):
    of = lambda counts, **more: [{"substeps": n, **more} for n in counts]  # noqa: E731
    few = (4,) if quick else (4, 16)
    fem = {"solver": "fem", "iterations": 100}
    return [
        *cases("tetskin", "world", of((4,) if quick else (1, 2, 4, 8, 16)), {"substeps": 4}),
        *cases("rapier", "constraints", of(few) + ([] if quick else of((64,))), {"substeps": 4}),
        *cases("rapier", "constraints, flow at once", of(few + (() if quick else (64,)), creep=1e4)),
        *cases("rapier", "finite elements", of((4,), **fem), {"substeps": 4}),
        *cases("rapier", "finite elements, flow at once", of(few, creep=1e4, **fem)),
        *cases("mujoco", "discrete", of((16,) if quick else (4, 16)), {"substeps": 16}),
        *cases("pybullet", "neo-Hookean", of((4,)), {"substeps": 4}),
        *cases("newton", "VBD", of((10,), iterations=10), {"substeps": 10}),
    ]


def body_of():
    nodes, tets = box_tets((16, 4, 4), (1, 0.25, 0.25))
    return Body(nodes, tets, MATERIAL, pinned=nodes[:, 0] < 1e-9, led=nodes[:, 0] > 1 - 1e-9, contact=False)


def strain_of(rest, now):
    """That of the middle half along x, by least squares."""
    middle = np.abs(rest[:, 0] - 0.5) < 0.2501
    return np.polyfit(rest[middle, 0], now[middle, 0], 1)[0] - 1


def kept(simulation, strain, clock):
    """The strain that its middle keeps over the exact one, and its volume over that at rest."""
    body = body_of()
    handle = simulation.add_soft(body)
    simulation.start()
    end = body.nodes[body.led]
    for frame in range(1, PULLS + HOLDS + 1):
        simulation.lead(handle, end + [strain * min(frame / PULLS, 1), 0, 0])
        advance(simulation, 1, clock)
    held = strain_of(body.nodes, simulation.nodes(handle))
    simulation.release(handle)
    advance(simulation, RESTS, clock)
    now = simulation.nodes(handle)
    volume = volumes(now, body.tets).sum() / volumes(body.nodes, body.tets).sum()
    return strain_of(body.nodes, now) / (held - YIELD), volume


def run(Simulation, case, clock, references):
    pulled = [kept(Simulation(**case.setting, gravity=(0, 0, 0)), strain, clock) for strain in STRAINS]
    errors = {f"error at {strain:.0%}, %": 100 * abs(share - 1) for strain, (share, _) in zip(STRAINS, pulled)}
    changes = [100 * abs(volume - 1) for _, volume in pulled]
    return {"error of the kept strain, %": max(errors.values()), **errors, "volume's change, %": max(changes)}
