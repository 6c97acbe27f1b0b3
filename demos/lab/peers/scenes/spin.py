# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""A free box of 1 x 0.4 x 0.3 m spins without gravity, damping and contact for 5 s, about an axis that is not one of
its own.

The drift of its angular momentum, and its remaining kinetic energy, which swings into strain and back by some percent.
"""
import numpy as np

from plan import cases, usual
from problem import Body, Material, advance
from shapes import box_tets

TITLE = "Free spin at 6 rad/s for 5 s: E 1e5 Pa, 200 kg/m3, 600 tets, no damping"
OMEGA = np.array([1.0, 0.5, 6.0])


def plan(quick):
    return usual(quick) + cases("mujoco", "Euler", [{"substeps": 16, "integrator": "Euler"}], {"substeps": 16})


def run(Simulation, case, clock, _):
    nodes, tets = box_tets((10, 5, 2), (1.0, 0.4, 0.3), (-0.5, -0.2, -0.15))
    body = Body(nodes, tets, Material(youngs_modulus=1e5, density=200.0), contact=False)
    simulation = Simulation(**case.setting, gravity=(0.0, 0.0, 0.0))
    handle = simulation.add_soft(body)
    simulation.start()
    simulation.set_velocities(handle, np.cross(OMEGA, nodes))
    begin = momentum_and_energy(body.masses, nodes, np.cross(OMEGA, nodes))
    advance(simulation, 300, clock)
    end = momentum_and_energy(body.masses, simulation.nodes(handle), simulation.velocities(handle))
    drift = np.linalg.norm(end[0] - begin[0]) / np.linalg.norm(begin[0])
    return {"error of the angular momentum, %": 100 * drift, "kinetic energy left, %": 100 * end[1] / begin[1]}


def momentum_and_energy(masses, x, v):
    """About the centre of mass."""
    x = x - np.average(x, axis=0, weights=masses)
    return np.sum(masses[:, None] * np.cross(x, v), axis=0), 0.5 * np.sum(masses * np.sum(v**2, axis=1))
