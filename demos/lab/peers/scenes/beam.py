# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""A beam, clamped at one end, swings under its weight for 1.5 s without damping.

Error: RMS over time of the tip's distance from the reference's, as a share of its largest way, each peer beside its own
material (materials.py). In time: against the same mesh in small steps. In all: against tets of second order in a finer
mesh, tetskin's, checked against beam theory, and moved by what the material differs in 192 tets of second order.
"""
from contextlib import nullcontext
from dataclasses import replace

import numpy as np

from materials import MATERIALS, bullet_neo_hookean, corotated, linear_elements, quadratic_elements, simulate, volumes
from plan import cases
from problem import FRAME, GRAVITY, Body, Material
from shapes import box_tets

TITLE = "Clamped beam 4 x 1 x 1 m that swings: E 5e5 Pa, nu 0.3, 100 kg/m3, no damping"
LENGTH, FRAMES = 4.0, 90
QUICK_LIMIT = 25  # for Newton
MATERIAL = Material(youngs_modulus=5e5, poisson_ratio=0.3, density=100.0)
CELLS = {"3,000 tets": (20, 5, 5), "32,000 tets": (44, 11, 11)}
QUADRATIC = {
    "4 x 1 x 1 cells": (4, 1, 1),
    "6 x 2 x 2 cells": (6, 2, 2),
    "8 x 2 x 2 cells": (8, 2, 2),
    "12 x 3 x 3 cells": (12, 3, 3)
}
REFERENCES = {"reference": (24, 6, 6), "coarser reference": (16, 4, 4)}


def plan(quick):
    substeps = (1, 4, 16) if quick else (1, 2, 4, 8, 16, 32)
    same = "3,000 tets"
    of = lambda counts, **more: [{"substeps": n, **more} for n in counts]  # noqa: E731
    fem = {"solver": "fem", "iterations": 100}
    planned = [
        *cases("tetskin", "world", of(substeps), {"substeps": 4}, same),
        *cases("tetskin", "world, the mesh's own masses", of(substeps, own_masses=True, tolerance=1e-4), None, same),
        *cases("tetskin", "ElasticBody", of(() if quick else substeps, kind="alone", tolerance=1e-4), None, same),
        *cases("mujoco", "discrete", of((4,) if quick else (1, 4, 16)), {"substeps": 16}, same),
        *cases("mujoco", "Euler", of((16,) if quick else (10, 12, 16, 32), integrator="Euler"), {"substeps": 16}, same),
        *cases("rapier", "constraints", of((4,) if quick else (4, 8, 16, 32, 64)), {"substeps": 4}, same),
        *cases("rapier", "finite elements", of((4,) if quick else (1, 4, 16, 64), **fem), {"substeps": 4}, same),
        *cases("pybullet", "neo-Hookean", of((16,) if quick else (4, 8, 12, 16, 32)), {"substeps": 4}, same),
        *cases("pybullet", "neo-Hookean by Lamé's constants", of(() if quick else (16,), lame=True), None, same),
    ]
    pairs = ((10, 10),) if quick else ((4, 10), (4, 40), (10, 10))
    settings = [{"substeps": n, "iterations": m} for n, m in pairs]
    planned += cases("newton", "VBD", settings, {"substeps": 10, "iterations": 10}, same)
    if not quick:
        planned += cases("tetskin", "world, the mesh's own masses", of((4,), own_masses=True), None, "32,000 tets")
        planned += cases("newton", "XPBD", of((10,), iterations=10, solver="xpbd"), None, same)
        planned += cases("newton", "semi-implicit", of((16,), solver="semi-implicit"), None, same)
    for mesh, cells in list(QUADRATIC.items())[: 3 if quick else 4]:
        few, counts = (2,) if quick else substeps[:4], () if quick else (4, 16)
        planned += cases("tetskin", "quadratic tets", of(few, kind="alone", quadratic=True), None, mesh)
        planned += cases("mujoco", "quadratic cells", of(counts, solver="Newton", cells=cells), {"substeps": 16}, mesh)
        euler = of((16,) if quick else (8, 16), integrator="Euler", cells=cells)
        planned += cases("mujoco", "quadratic cells, Euler", euler, None, mesh)
    return planned


def body_of(mesh):
    nodes, tets = box_tets((CELLS | QUADRATIC | REFERENCES)[mesh], (LENGTH, 1, 1))
    return Body(nodes, tets, MATERIAL, pinned=nodes[:, 0] < 1e-9, contact=False)


def corners_of(nodes):
    """The nodes at the corners of the free end, which all meshes have."""
    end = (nodes[:, 0] > LENGTH - 1e-6) & (np.abs(nodes[:, 1] - 0.5) > 0.499) & (np.abs(nodes[:, 2] - 0.5) > 0.499)
    return np.flatnonzero(end)


def swing(simulation, body, frames=FRAMES, clock=None):
    """(frames, 3): the displacement of the middle of the free end's corners after each frame."""
    handle = simulation.add_soft(body)
    simulation.start()
    rest = simulation.nodes(handle)
    corners = corners_of(rest)
    way = np.zeros((frames, 3))
    for frame in range(frames):
        with clock or nullcontext():
            simulation.step(FRAME)
        way[frame] = (simulation.nodes(handle)[corners] - rest[corners]).mean(0)
    return way


def run(Simulation, case, clock, references):
    way = swing(Simulation(**case.setting), body_of(case.mesh), clock=clock)
    stress = (MATERIALS[case.peer] if case.curve != "semi-implicit" else bullet_neo_hookean).__name__
    in_time = error(way, references[f"{stress} {case.mesh}"]) if case.mesh == "3,000 tets" else None
    return {"error in time": in_time, "error in all": error(way, references[stress])}


def error(way, reference):
    """Percent of the reference's largest way."""
    largest = np.linalg.norm(reference, axis=1).max()
    return 100 * np.sqrt(np.mean(np.sum((way - reference) ** 2, axis=1))) / largest


def prepare(quick):
    """The references by material, (frames, 3) each, and remarks on them."""
    from adapters.tetskin import Simulation
    quadratic = lambda name: swing(Simulation(8, "alone", quadratic=True, tolerance=1e-5), body_of(name))  # noqa: E731
    ours = swing(Simulation(128, "alone", tolerance=1e-7), body_of("3,000 tets"))
    best, words = quadratic("coarser reference"), [theory(Simulation)]
    if not quick:
        coarser, best = best, quadratic("reference")
        words.append(f"reference: from 1,536 to 5,184 quadratic tets it changes by {error(coarser, best):.2f} %")
        words.append(
            f"tetskin's steps and NumPy's lead to the same: {error(explicit(corotated, '3,000 tets'), ours):.3f} %")
    ways = {"corotated 3,000 tets": ours, "corotated": best}
    base = explicit(corotated, "8 x 2 x 2 cells")
    for stress in set(MATERIALS.values()) - {corotated}:
        ways[f"{stress.__name__} 3,000 tets"] = explicit(stress, "3,000 tets")
        moved = explicit(stress, "8 x 2 x 2 cells") - base
        ways[stress.__name__] = best + moved
        words.append(f"{stress.__name__} differs from corotated by {error(best + moved, best):.2f} %")
    return ways, "\n".join(words)


def explicit(stress, mesh, substeps=16):
    """The swing by small explicit steps in NumPy, of any material."""
    body, masses = body_of(mesh), None
    nodes, elements = body.nodes, linear_elements(body.nodes, body.tets)
    if mesh in QUADRATIC:  # the masses of the eight tets that one of second order consists of
        nodes, elements = quadratic_elements(body.nodes, body.tets)
        masses, share = np.zeros(len(nodes)), volumes(body.nodes, body.tets) * MATERIAL.density / 8
        np.add.at(masses, elements[0], share[:, None] * np.array(4 * [1 / 4] + 6 * [7 / 6]))
    rest, way = corners_of(nodes), []
    simulate(nodes, elements, body.masses if masses is None else masses, nodes[:, 0] < 1e-9, MATERIAL, stress, GRAVITY,
             FRAME / substeps, substeps * FRAMES, lambda x: way.append((x[rest] - nodes[rest]).mean(0)))
    return np.array(way)[substeps - 1 :: substeps]


def theory(Simulation):
    """Compares small loads on the coarser reference with Timoshenko's beam, Cowper's shear coefficient; raises if off.

    Without Poisson's effect, which the clamp suppresses, and the theory of beams does not.
    """
    material, share = replace(MATERIAL, poisson_ratio=0.0), 0.01
    body = replace(body_of("coarser reference"), material=material)
    still = replace(body, material=replace(material, damping=0.3))
    light = (0, -9.81 * share, 0)
    options = {"kind": "alone", "quadratic": True, "tolerance": 1e-6, "gravity": light}
    sag = -swing(Simulation(2, **options), still, frames=400)[-1, 1]
    e, nu, load = material.youngs_modulus, material.poisson_ratio, material.density * 9.81 * share
    shear = e / (2 * (1 + nu)) * 10 * (1 + nu) / (12 + 11 * nu)
    beam = load * LENGTH**4 / (8 * e / 12) + load * LENGTH**2 / (2 * shear)
    way = -swing(Simulation(8, **options), body, frames=170)[:, 1]
    free = period_of_timoshenko(shear)
    period = period_of(way, free)
    told = f"small loads beside Timoshenko's beam: sag {sag / beam - 1:+.2%}, period {period / free - 1:+.2%}"
    if abs(sag / beam - 1) > 0.01 or abs(period / free - 1) > 0.01:
        raise RuntimeError(f"the reference is wrong: {told}")
    return told


def period_of(way, near):
    """Seconds: the longer one of the two oscillations that fit the way best, looked for around a period."""
    times = FRAME * np.arange(1, len(way) + 1)

    def left(first, second):
        waves = np.stack([np.ones_like(times), np.cos(first * times), np.cos(second * times)], 1)
        return np.sum((way - waves @ np.linalg.lstsq(waves, way, rcond=None)[0]) ** 2)

    pairs = [(first, ratio * first) for first in 2 * np.pi / near * np.linspace(0.96, 1.04, 81)
             for ratio in np.linspace(5, 6.5, 31)]
    return 2 * np.pi / min(pairs, key=lambda pair: left(*pair))[0]


def period_of_timoshenko(shear):
    """Seconds: the first period by Rayleigh's quotient of the sag under the beam's own weight, bending and shear."""
    x = np.linspace(0, LENGTH, 2001)
    e, rho, inertia = MATERIAL.youngs_modulus, MATERIAL.density, 1 / 12
    shape = x**2 * (6 * LENGTH**2 - 4 * LENGTH * x + x**2) / (24 * e * inertia) + (LENGTH * x - x**2 / 2) / shear
    turn = np.gradient(x**2 * (6 * LENGTH**2 - 4 * LENGTH * x + x**2) / (24 * e * inertia), x)
    sums = lambda values: np.sum(0.5 * (values[1:] + values[:-1])) * (x[1] - x[0])  # noqa: E731
    return 2 * np.pi * np.sqrt(rho * (sums(shape**2) + inertia * sums(turn**2)) / sums(shape))
