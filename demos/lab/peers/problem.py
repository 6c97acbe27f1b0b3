# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The interface between scenes and peers. Units are metres, kilograms and seconds; y points up.

Each module in `adapters` has a class `Simulation` with these functions, which scenes call in this order:

    simulation = Simulation(**setting, gravity=(x, y, z))
    simulation.add_plane(friction)                    the ground, y = 0
    simulation.add_soft(Body), add_rigid(Rigid)       each returns a handle
    simulation.start()                                what the peer compiles; afterwards nothing is added
    simulation.set_velocities(handle, rows)           of a soft body's nodes
    simulation.move(handle, position)                 before a step: where it takes a rigid body that is moved
    simulation.lead(handle, positions)                before a step: where it takes the nodes that are led
    simulation.release(handle)                        the nodes that were led are free
    simulation.step(dt)                               one frame, in the substeps of the setting
    simulation.nodes(handle), velocities(handle)      (nodes, 3)
    simulation.surface(handle)                        (vertices, 3): the skin, or the nodes without one
    simulation.pose(handle)                           of a rigid body: position, quaternion x, y, z, w
    simulation.asleep(handle)                         whether the peer has put it to sleep

What a peer does not have raises Unsupported, with the reason in words: it becomes the cell of the table.
"""
import contextlib
from dataclasses import dataclass, field, replace

import numpy as np

GRAVITY = (0.0, -9.81, 0.0)
FRAME = 1 / 60


def advance(simulation, frames, clock=None):
    """Runs this many frames, timed."""
    for _ in range(frames):
        with clock or contextlib.nullcontext():
            simulation.step(FRAME)


class Unsupported(Exception):
    """A peer does not support the scene. The text says why."""


@dataclass(frozen=True)
class Material:
    """youngs_modulus: Pa; density: kg/m3; damping: seconds, proportional to stiffness (Rayleigh). yield_strain: of a bar
    that is pulled, its stress over Young's modulus; None: elastic."""
    youngs_modulus: float = 5e5
    poisson_ratio: float = 0.3
    density: float = 100.0
    damping: float = 0.0
    friction: float = 0.5
    yield_strain: float | None = None

    @property
    def lame(self):
        """Lamé's mu and lambda, in Pa."""
        e, nu = self.youngs_modulus, self.poisson_ratio
        return e / (2 * (1 + nu)), e * nu / ((1 + nu) * (1 - 2 * nu))


@dataclass(frozen=True)
class Body:
    """A soft body, placed: nodes (n, 3), tets (t, 4) that are oriented positively, pinned (n,) booleans, led (n,): nodes
    that the scene moves, until it releases them. swells: times its volume that it is to have.

    skin: positions (v, 3) and triangles (m, 3), counter-clockwise from outside, in the space of the nodes, or None:
    then its surface is that of the tets. contact: with the ground and with others; self_contact: also with itself.
    """
    nodes: np.ndarray
    tets: np.ndarray
    material: Material = field(default_factory=Material)
    pinned: np.ndarray | None = None
    led: np.ndarray | None = None
    swells: float = 1.0
    skin: tuple | None = None
    contact: bool = True
    self_contact: bool = False

    def moved(self, offset):
        """A copy at another place."""
        skin = None if self.skin is None else (self.skin[0] + np.asarray(offset), self.skin[1])
        return replace(self, nodes=self.nodes + np.asarray(offset), skin=skin)

    @property
    def held(self):
        return np.zeros(len(self.nodes), bool) if self.pinned is None else self.pinned

    @property
    def fixed(self):
        """Those that no force moves at the start: held or led."""
        return self.held if self.led is None else self.held | self.led

    @property
    def masses(self):
        """(n,) kg: a quarter of each tet's mass at each of its corners."""
        corners = self.nodes[self.tets]
        volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
        masses = np.zeros(len(self.nodes))
        np.add.at(masses, self.tets, self.material.density * volumes[:, None] / 4)
        return masses


@dataclass(frozen=True)
class Rigid:
    """A rigid box or ball. mass 0: it does not move, unless it is moved, by `move`. rotation: x, y, z, w. friction: with
    soft bodies of friction 1."""
    shape: str  # "box" or "ball"
    size: object  # half extents, or the radius
    mass: float = 0.0
    position: tuple = (0.0, 0.0, 0.0)
    rotation: tuple = (0.0, 0.0, 0.0, 1.0)
    velocity: tuple = (0.0, 0.0, 0.0)
    friction: float = 0.5
    moved: bool = False
