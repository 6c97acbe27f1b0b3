# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Rapier: corotational cells, by its constraint solver (the default) or its implicit finite elements.

Its world steps once per frame, and divides that by num_solver_iterations, 4 by default. Cells are damped by a ratio at
a frequency of each cell: damping_ratio_of gives the one with the same Rayleigh damping in the mean, and the constraint
solver gets at most 1. Its own examples (soft_fem3, soft_meshes3) leave substeps and iterations at the defaults. Cells
yield by the norm of their strain's deviator, and flow at a rate: 50 per second is that of the clay in soft_plasticity3.
"""
import statistics
import time
from dataclasses import replace
from importlib.metadata import version

import numpy as np
import rapier3d as rapier

from materials import gradients, volumes
from problem import GRAVITY, Unsupported
from shapes import surface_of

VERSION = version("rapier3d")


def damping_ratio_of(body):
    """The ratio whose Rayleigh coefficient, in the mean over the cells, is the material's damping in seconds.

    Rapier's coefficient of a cell is twice the ratio over the mean of the frequencies of its six strains, each beside
    the masses of its corners.
    """
    if body.material.damping == 0:
        return 0.0
    mu, lam = body.material.lame
    inverse = np.where(body.held, 0, 1 / body.masses)[body.tets][:, :, None]
    g2, v = gradients(body.nodes, body.tets) ** 2, volumes(body.nodes, body.tets)[:, None]
    normal = np.sqrt(v * (2 * mu + lam) * np.sum(inverse * g2, axis=1))
    shear = np.sqrt(v * mu * np.sum(inverse * (g2 + np.roll(g2, 1, axis=2)), axis=1))
    return body.material.damping / 2 * np.concatenate([normal, shear], 1).mean()


class Simulation:
    """substeps: per frame. solver: "constraints" or "fem". iterations: passes of the constraints within a substep, or
    the maximum of the conjugate gradients. radius: of particles and skin, in contact. creep: rate of plastic flow, 1/s."""

    def __init__(self, substeps=4, solver="constraints", iterations=None, radius=0.004, creep=50.0, gravity=GRAVITY):
        self.solver, self.iterations, self.radius, self.creep = solver, iterations, radius, creep
        self.world = rapier.PhysicsWorld(gravity=tuple(gravity))
        self.world.set_num_threads(1)
        options = self.world.integration_parameters
        options.num_solver_iterations = substeps
        if solver == "fem" and iterations:
            settings = options.soft_bodies
            fem = settings.fem
            fem.max_linear_iterations = iterations
            settings.fem = fem
            options.soft_bodies = settings
        self.skins, self.kept = {}, {}

    def add_plane(self, friction=1.0):
        plane = rapier.Collider.halfspace((0.0, 1.0, 0.0)).friction(friction)
        plane = plane.friction_combine_rule(rapier.CoefficientCombineRule.MULTIPLY)
        self.world.add_collider(plane.build())

    def add_soft(self, body):
        ratio = damping_ratio_of(body)
        if self.solver == "constraints":  # which a ratio above that of its examples makes worse, not more damped
            ratio = min(ratio, 1.0)
        material = rapier.SoftBodyMaterial(young_modulus=body.material.youngs_modulus,
                                           poisson_ratio=body.material.poisson_ratio,
                                           elastic_damping_ratio=float(ratio), **self.plasticity_of(body.material))
        kind = rapier.SoftBodySolver.FEM if self.solver == "fem" else rapier.SoftBodySolver.CONSTRAINTS
        builder = rapier.SoftBodyBuilder(body.nodes.astype(np.float32)).masses([float(m) for m in body.masses])
        builder = builder.cells(body.tets.astype(np.uint32)).cell_model(rapier.SoftBodyCellModel.COROTATIONAL)
        builder = builder.material(material).solver(kind)
        if body.fixed.any():
            builder = builder.pinned_particles(np.flatnonzero(body.fixed).astype(np.uint32))
        if self.solver == "constraints" and self.iterations:
            builder = builder.additional_pgs_iterations(self.iterations - 1)
        if body.swells != 1:
            builder = builder.volume_factor(float(body.swells)).volume_preservation(True)
        if body.contact:
            collider = rapier.Collider.ball(self.radius).friction(body.material.friction)
            collider = collider.friction_combine_rule(rapier.CoefficientCombineRule.MULTIPLY)
            builder = builder.particle_radius(self.radius).surface_collider(collider).self_contacts(body.self_contact)
            builder = builder.surface(surface_of(body.tets).astype(np.uint32))
            if body.skin:
                builder = builder.skin(body.skin[0].astype(np.float32),
                                       body.skin[1].astype(np.uint32)).skin_collision(True)
        else:
            builder = builder.no_surface_collider()
        handle = self.world.add_soft_body(builder)
        self.kept[handle] = body
        return handle

    def plasticity_of(self, material):
        """The norm of the strain's deviator in a bar that is pulled to the strain at which it yields."""
        if material.yield_strain is None:
            return {}
        norm = np.sqrt(2 / 3) * (1 + material.poisson_ratio) * material.yield_strain
        return {"plastic_yield": float(norm), "plastic_creep": self.creep}

    def add_rigid(self, rigid):
        if rigid.shape == "box":
            collider = rapier.Collider.cuboid(*(float(half) for half in rigid.size))
        else:
            collider = rapier.Collider.ball(float(rigid.size))
        collider = collider.friction(rigid.friction).friction_combine_rule(rapier.CoefficientCombineRule.MULTIPLY)
        body = rapier.RigidBody.dynamic() if rigid.mass else rapier.RigidBody.fixed()
        if rigid.moved:
            body = rapier.RigidBody.kinematic_position_based()
        x, y, z, w = rigid.rotation
        length = np.linalg.norm((x, y, z))
        turn = np.array((x, y, z)) / length * 2 * np.arctan2(length, w) if length else np.zeros(3)
        body = body.translation(tuple(map(float, rigid.position))).rotation(tuple(map(float, turn)))
        if rigid.mass:
            body, collider = body.linvel(tuple(map(float, rigid.velocity))), collider.mass(float(rigid.mass))
        return self.world.add_body(body.build(), [collider.build()])

    def start(self):
        pass

    def move(self, handle, position):
        self.world.rigid_bodies[handle].set_next_kinematic_translation(tuple(map(float, position)))

    def lead(self, handle, positions):
        for particle, position in zip(np.flatnonzero(self.kept[handle].led), positions):
            self.world.soft_bodies[handle].set_particle_kinematic_target(int(particle), tuple(map(float, position)))

    def release(self, handle):
        for particle in np.flatnonzero(self.kept[handle].led):
            self.world.soft_bodies[handle].set_particle_pinned(int(particle), False)

    def set_velocities(self, handle, rows):
        self.world.soft_bodies[handle].particle_velocities = np.asarray(rows, np.float32)

    def step(self, dt):
        self.world.integration_parameters.dt = dt
        self.world.step()
        if not self.world.quarantine.is_empty():
            raise FloatingPointError("Rapier has set a body aside whose state was not finite")

    def nodes(self, handle):
        return np.array(self.world.soft_bodies[handle].particle_positions, float)

    def velocities(self, handle):
        return np.array(self.world.soft_bodies[handle].particle_velocities, float)

    def surface(self, handle):
        if not self.kept[handle].skin:
            return self.nodes(handle)
        skinned = [mesh for mesh in self.world.soft_bodies[handle].meshes if mesh.is_skinned]
        return np.array(skinned[0].vertices, float)

    def pose(self, handle):
        body = self.world.rigid_bodies[handle]
        turn = body.rotation
        return np.array([*body.translation]), np.array([turn.i, turn.j, turn.k, turn.w])

    def asleep(self, handle):
        return self.world.soft_bodies[handle].is_sleeping


def skin_times(body, moved):
    """Seconds of processor time to insert the body with its skin more than without, and to read the skin's vertices,
    which Rapier computes from the particles when they are asked for: the median of 20."""
    spent = {}
    for skin in (None, body.skin):
        simulation = Simulation(gravity=(0.0, 0.0, 0.0))
        began = time.process_time()
        handle = simulation.add_soft(replace(body, skin=skin))
        spent[skin is None] = time.process_time() - began
    simulation.world.soft_bodies[handle].particle_positions = moved.astype(np.float32)
    times = []
    for _ in range(20):
        began = time.process_time()
        simulation.surface(handle)
        times.append(time.process_time() - began)
    return spent[False] - spent[True], statistics.median(times)
