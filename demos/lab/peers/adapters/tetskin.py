# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""tetskin: in a world with contact, or as an elastic body alone."""
import statistics
import time

import numpy as np
import tetskin as ts

from problem import GRAVITY, Unsupported
from shapes import surface_of

VERSION = ts.__version__


class Simulation:
    """substeps: per frame. kind: "world", or "alone": an ElasticBody. quadratic: tets of second order. own_masses: the
    mesh's own, where the world raises those of the lightest nodes. tolerance: residual of a step; None: the default."""

    def __init__(self, substeps=4, kind="world", quadratic=False, own_masses=False, tolerance=None, gravity=GRAVITY):
        self.substeps, self.alone, self.quadratic, self.own_masses = substeps, kind == "alone", quadratic, own_masses
        self.tolerance = {} if tolerance is None else {"solver_tolerance": tolerance}
        self.gravity = tuple(gravity)
        self.world = None if self.alone else ts.World(gravity=gravity, record_forces=False)
        self.body, self.forms, self.led = None, {}, {}

    def add_plane(self, friction=1.0):
        if self.alone:
            raise Unsupported("an ElasticBody has no contact")
        self.world.add_plane(friction=friction)

    def add_soft(self, body):
        cage, mesh, place = self.shared(body)
        material = body.material
        options = {"youngs_modulus": material.youngs_modulus, "poisson_ratio": material.poisson_ratio,
                   "stiffness_damping": material.damping, "density": material.density}
        pinned = self.pinned_of(body, cage, place)
        if self.alone:
            if self.body is not None:
                raise Unsupported("an ElasticBody is alone")
            if body.led is not None:
                raise Unsupported("an ElasticBody has no nodes that are led to places")
            tolerance = {"tolerance": self.tolerance["solver_tolerance"]} if self.tolerance else {}
            self.body = ts.ElasticBody(cage, **options, **tolerance)
            self.body.positions = self.body.positions + place
            self.body.set_pinned(pinned)
            return self.body
        if self.own_masses:
            options["node_masses"] = body.masses
        added = self.world.add_body(cage, mesh, position=place, pinned=pinned, friction=material.friction,
                                    soft_contact=mesh is not None, self_contact=body.self_contact, **options,
                                    **self.tolerance)
        self.led[added] = body.led
        if material.yield_strain is not None:
            added.set_plasticity(yield_stress=material.yield_strain * material.youngs_modulus)
        if body.swells != 1:
            added.set_growth(body.swells ** (1 / 3))
        return added

    def shared(self, body):
        """The body's cage, and its surface if it has contact, with its first node at the origin; and where that is.

        Bodies of one form share them, and what the world computes of them once.
        """
        place = body.nodes[0].copy()
        skin = body.skin or (body.nodes, surface_of(body.tets))
        key = [np.round(rows, 9).tobytes() for rows in (body.nodes - place, skin[0] - place)]
        key = (*key, body.tets.tobytes(), body.contact)
        if key not in self.forms:
            cage = ts.Cage(body.nodes - place, body.tets)
            cage = ts.refine_quadratic(cage) if self.quadratic else cage
            self.forms[key] = cage, ts.TriangleMesh(skin[0] - place, skin[1]) if body.contact else None
        return *self.forms[key], place

    def pinned_of(self, body, cage, place):
        """The pinned nodes of the cage: those of the body and, of second order, those in the middle between two."""
        if not self.quadratic:
            return body.fixed
        edges = body.tets[:, [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]].reshape(-1, 2)
        edges = edges[body.held[edges].all(1)]
        held = np.concatenate([body.nodes[body.held], body.nodes[edges].mean(1)])
        rounded = lambda point: tuple(np.round(point, 6) + 0.0)  # noqa: E731
        places = {rounded(point) for point in held}
        return np.array([rounded(point) in places for point in cage.nodes + place])

    def add_rigid(self, rigid):
        if self.alone:
            raise Unsupported("an ElasticBody has no contact")
        shape = ts.Shape.box(rigid.size) if rigid.shape == "box" else ts.Shape.sphere(rigid.size)
        body = self.world.add_rigid_body(shape, mass=rigid.mass, position=rigid.position, rotation=rigid.rotation,
                                         friction=rigid.friction, kinematic=rigid.moved)
        if rigid.mass:
            body.velocity = rigid.velocity
        return body

    def start(self):
        pass

    def move(self, handle, position):
        handle.position = position

    def lead(self, handle, positions):
        handle.set_pinned_positions(self.led[handle], positions)

    def release(self, handle):
        handle.set_pinned(self.led[handle], False)

    def set_velocities(self, handle, rows):
        handle.velocities = rows

    def step(self, dt):
        if not self.alone:
            self.world.step(dt, substeps=self.substeps)
            return
        for _ in range(self.substeps):
            self.body.step(dt / self.substeps, self.gravity)

    def nodes(self, handle):
        return np.array(handle.positions if self.alone else handle.nodes, float)

    def velocities(self, handle):
        return np.array(handle.velocities, float)

    def surface(self, handle):
        return np.array(handle.positions, float)

    def pose(self, handle):
        return handle.position, handle.rotation

    def asleep(self, handle):
        return handle.asleep


def skin_times(body, moved, interpolation="linear"):
    """Seconds of processor time to attach the body's skin, and to move it once: the median of 50."""
    cage, mesh = ts.Cage(body.nodes, body.tets), ts.TriangleMesh(*body.skin)
    began = time.process_time()
    skin = ts.Skin(cage, mesh, interpolation=interpolation)
    bind, times = time.process_time() - began, []
    for _ in range(50):
        began = time.process_time()
        skin.update(moved)
        times.append(time.process_time() - began)
    return bind, statistics.median(times)
