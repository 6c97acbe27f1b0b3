# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""A beam, clamped at one end, swings under its weight for 1.5 s without damping.

Error: RMS over time of the tip's distance from the reference's, as a share of its largest way. In time: against the
same mesh in steps of 1/7,680 s. In all: against tets of second order in a finer mesh and small steps, which are checked
against beam theory. Both references are tetskin's, of a material that is linear but for rotations (corotated): what
other materials differ by at these strains, up to a sixth, is part of the errors in all of those that have others.
"""
from contextlib import nullcontext
from dataclasses import replace

import numpy as np

from plan import cases
from problem import FRAME, Body, Material
from shapes import box_tets

TITLE = "Clamped beam 4 x 1 x 1 m that swings: E 5e5 Pa, nu 0.3, 100 kg/m3, no damping"
LIMIT = 150  # seconds of processor time for one run
LENGTH, FRAMES = 4.0, 90
MATERIAL = Material(youngs_modulus=5e5, poisson_ratio=0.3, density=100.0)
CELLS = {"3,000 tets": (20, 5, 5), "192 tets": (8, 2, 2), "32,000 tets": (44, 11, 11)}
QUADRATIC = {"24 quadratic tets": (4, 1, 1), "192 quadratic tets": (8, 2, 2), "648 quadratic tets": (12, 3, 3)}
REFERENCES = {"reference": (24, 6, 6), "coarser reference": (16, 4, 4)}


def plan(quick):
    substeps = (1, 4, 16) if quick else (1, 2, 4, 8, 16, 32)
    world = cases("tetskin", "world", [{"substeps": n} for n in substeps], example={"substeps": 4})
    alone = cases("tetskin", "ElasticBody", [{"substeps": n, "kind": "alone", "tolerance": 1e-4} for n in substeps])
    masses = cases("tetskin", "world, the mesh's own masses",
                   [{"substeps": n, "own_masses": True, "tolerance": 1e-4} for n in substeps])
    planned = [replace(case, mesh="3,000 tets") for case in world + alone + masses]
    for mesh in list(QUADRATIC)[: 2 if quick else 3]:
        finer = cases("tetskin", "quadratic tets", [{"substeps": n, "kind": "alone", "quadratic": True} for n in substeps])
        planned += [replace(case, mesh=mesh) for case in finer]
    return planned


def body_of(mesh):
    nodes, tets = box_tets((CELLS | QUADRATIC | REFERENCES)[mesh], (LENGTH, 1, 1))
    return Body(nodes, tets, MATERIAL, pinned=nodes[:, 0] < 1e-9, contact=False)


def corners_of(nodes):
    """The nodes at the corners of the free end, which all meshes have."""
    end = (nodes[:, 0] > LENGTH - 1e-6) & (np.abs(nodes[:, 1] - 0.5) > 0.499) & (np.abs(nodes[:, 2] - 0.5) > 0.499)
    return np.flatnonzero(end)


def swing(simulation, body, frames=FRAMES, clock=None):
    """(frames, 3): where the middle of the free end's corners has gone after each frame."""
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
    converged = references.get(f"{case.mesh}, converged")
    return {"error in time": None if converged is None else error(way, converged),
            "error in all": error(way, references["reference"])}


def error(way, reference):
    """Percent of the reference's largest way."""
    largest = np.linalg.norm(reference, axis=1).max()
    return 100 * np.sqrt(np.mean(np.sum((way - reference) ** 2, axis=1))) / largest


def prepare(quick):
    """The references: name to (frames, 3), and what is to be said of them."""
    from adapters.tetskin import Simulation
    ways = {"3,000 tets, converged": swing(Simulation(128, "alone", tolerance=1e-7), body_of("3,000 tets"))}
    quadratic = lambda name: swing(Simulation(8, "alone", quadratic=True, tolerance=1e-5), body_of(name))  # noqa: E731
    ways["reference"] = quadratic("coarser reference")
    words = theory(Simulation)
    if not quick:
        coarser, ways["reference"] = ways["reference"], quadratic("reference")
        words += f"\nreference: from 1,536 to 5,184 quadratic tets it changes by {error(coarser, ways['reference']):.2f} %"
    return ways, words


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
    low = 60 + way[60:].argmin()  # after one period the beam is back where it began
    a, b, c = way[low - 1 : low + 2]
    period = (low + 1 + 0.5 * (a - c) / (a - 2 * b + c)) * FRAME
    free = period_of_timoshenko(shear)
    told = f"small loads beside Timoshenko's beam: sag {sag / beam - 1:+.2%}, period {period / free - 1:+.2%}"
    if abs(sag / beam - 1) > 0.01 or abs(period / free - 1) > 0.01:
        raise RuntimeError(f"the reference is wrong: {told}")
    return told


def period_of_timoshenko(shear):
    """Seconds: the first period by Rayleigh's quotient of the sag under the beam's own weight, bending and shear."""
    x = np.linspace(0, LENGTH, 2001)
    e, rho, inertia = MATERIAL.youngs_modulus, MATERIAL.density, 1 / 12
    shape = x**2 * (6 * LENGTH**2 - 4 * LENGTH * x + x**2) / (24 * e * inertia) + (LENGTH * x - x**2 / 2) / shear
    turn = np.gradient(x**2 * (6 * LENGTH**2 - 4 * LENGTH * x + x**2) / (24 * e * inertia), x)
    sums = lambda values: np.trapezoid(values, x)  # noqa: E731
    return 2 * np.pi * np.sqrt(rho * (sums(shape**2) + inertia * sums(turn**2)) / sums(shape))
