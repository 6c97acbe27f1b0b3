# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""A clamped beam, stiffer than the one that swings, sags under its weight and comes to rest within 3 s.

Error: of the sag, beside the same tets at rest (tetskin's ElasticBody with a residual of 1e-7; strains are small, and
all materials the same).
"""
from dataclasses import replace

from plan import usual
from problem import FRAME, advance
from scenes.beam import body_of as swinging, corners_of

TITLE = "Clamped beam 4 x 1 x 1 m at rest: E 8e6 Pa, 100 kg/m3, 3,000 tets, damping 0.05 s"


def plan(quick):
    return usual(quick)


def body_of():
    body = swinging("3,000 tets")
    return replace(body, material=replace(body.material, youngs_modulus=8e6, damping=0.05))


def sag_of(simulation, clock=None):
    body = body_of()
    handle = simulation.add_soft(body)
    simulation.start()
    advance(simulation, 179, clock)
    corners = corners_of(body.nodes)
    before = simulation.nodes(handle)[corners, 1].mean()
    advance(simulation, 1, clock)
    after = simulation.nodes(handle)[corners, 1].mean()
    return body.nodes[corners, 1].mean() - after, abs(after - before) / FRAME


def run(Simulation, case, clock, references):
    sag, speed = sag_of(Simulation(**case.setting), clock)
    return {
        "sag, mm": 1e3 * sag,
        "error of the sag, %": 100 * abs(sag / references["sag"] - 1),
        "speed, mm/s": 1e3 * speed
    }


def prepare(quick):
    from adapters.tetskin import Simulation
    sag, _ = sag_of(Simulation(4, "alone", tolerance=1e-7))
    return {"sag": sag}, f"reference: {1e3 * sag:.2f} mm"
