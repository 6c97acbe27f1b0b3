# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""A snake of 60,000 triangles, in a cage of some 1,000 tets, falls 0.2 m onto the ground and rests there.

All peers simulate the cage's own tets. Those that take a second, finer surface are in contact at it; for the others
tetskin's Skin adds the skin afterwards: this surface is drawn for every peer, and its gap is measured. Error: RMS
distance of the drawn surface, over the frames from 1.5 to 2 s, from that of tetskin's world in 64 substeps, in percent
of the snake's size: it is a comparison with us, and not with the truth, which for the gap is 0.
"""
import numpy as np
import tetskin as ts

from plan import cases
from problem import FRAME, Body, Material, Unsupported
from shapes import snake

TITLE = "Snake of 60,000 triangles in 1,000 tets that lands: E 2e5 Pa, 200 kg/m3, damping 0.02 s, friction 0.5"
MATERIAL = Material(youngs_modulus=2e5, density=200.0, damping=0.02)
QUICK_LIMIT = 30
FALL, END, REST = 0.2, 120, 210  # metres; frames until the error is measured, and until the end


def plan(quick):
    of = lambda counts, **more: [{"substeps": n, **more} for n in counts]  # noqa: E731
    planned = [
        *cases("tetskin", "world", of((2, 4, 16) if quick else (1, 2, 4, 8, 16, 32)), {"substeps": 4}),
        *cases("rapier", "constraints", of((4,) if quick else (2, 4, 8)), {"substeps": 4}),
        *cases("mujoco", "discrete", of((16,) if quick else (4, 16)), {"substeps": 16}),
        *cases("newton", "VBD", of((10,) if quick else (5, 10), iterations=10), {"substeps": 10}),
    ]
    if not quick:
        planned += cases("pybullet", "neo-Hookean", of((4,)), {"substeps": 4})  # more than a minute
        planned += cases("rapier", "finite elements", of((4,), solver="fem", iterations=100), {"substeps": 4})
        planned += cases("mujoco", "Euler", of((16, 64), integrator="Euler"), {"substeps": 16})
    return planned


def body_of():
    positions, triangles = snake()
    cage = ts.create_cage(ts.TriangleMesh(positions, triangles), target_tets=1000)
    lift = np.array([0, FALL - positions[:, 1].min(), 0])
    return Body(np.array(cage.nodes), np.array(cage.tets), MATERIAL, skin=(positions, triangles)).moved(lift)


class Drawn:
    """The drawn surface: the peer's own skin, or ours on its nodes."""

    def __init__(self, simulation, body, handle):
        self.simulation, self.handle, self.skin = simulation, handle, None
        try:
            simulation.surface(handle)
        except Unsupported:
            self.skin = ts.Skin(ts.Cage(body.nodes, body.tets), ts.TriangleMesh(*body.skin))

    def __call__(self):
        if self.skin is None:
            return self.simulation.surface(self.handle)
        return np.array(self.skin.update(self.simulation.nodes(self.handle)), float)


def land(simulation, clock=None, frames=REST):
    """Surfaces (END - 90, vertices, 3) float32 before END, and the values at rest."""
    body = body_of()
    simulation.add_plane(1.0)
    handle = simulation.add_soft(body)
    simulation.start()
    drawn, surfaces, slept = Drawn(simulation, body, handle), [], None
    for frame in range(1, frames + 1):
        if clock:
            with clock:
                simulation.step(FRAME)
        else:
            simulation.step(FRAME)
        if END - 30 < frame <= END:
            surfaces.append(drawn().astype(np.float32))
        if slept is None and simulation.asleep(handle):
            slept = frame * FRAME
    before = drawn()
    simulation.step(FRAME)
    speed = np.sqrt(np.mean(np.sum((drawn() - before) ** 2, axis=1))) / FRAME
    return np.array(surfaces), {
        "gap, mm": 1e3 * before[:, 1].min(),
        "speed at the end, mm/s": 1e3 * speed,
        "asleep after, s": slept
    }


def run(Simulation, case, clock, references):
    surfaces, told = land(Simulation(**case.setting), clock)
    error = np.sqrt(np.mean(np.sum((surfaces - references["surfaces"]) ** 2, axis=2)))
    parts = 1e3 * np.array(clock.parts)
    clock.parts, clock.seconds = clock.parts[:END], sum(clock.parts[:END])  # ms per frame: of falling and landing
    return {"error": 100 * error, "ms at rest": parts[-60:].mean(), **told}


def prepare(quick):
    from adapters.tetskin import Simulation
    surfaces, told = land(Simulation(64), frames=END)
    return {"surfaces": surfaces}, f"reference: gap {told['gap, mm']:.2f} mm after {END * FRAME:.0f} s"
