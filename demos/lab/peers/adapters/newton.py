# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Newton, on the processor: soft bodies by SolverVBD; also by SolverXPBD and SolverSemiImplicit.

Its damping is of the rate of Green's strain, 4 k_damp for 2 mu times our seconds; that of the volume is not there.
Their example is softbody_hanging: VBD, 10 substeps of 10 iterations, no self-contact, no tiles.
"""
import statistics
import time

import numpy as np
import warp

warp.config.quiet = True
warp.config.log_level = getattr(warp, "LOG_ERROR", 0)
import newton  # noqa: E402

from problem import GRAVITY, Unsupported  # noqa: E402

VERSION = newton.__version__



class Simulation:
    """substeps: per frame; iterations: within each. stiffness, damping, radius: of contact, N/m, N s/m and metres."""

    def __init__(self,
                 substeps=10,
                 iterations=10,
                 solver="vbd",
                 stiffness=1e4,
                 damping=10.0,
                 radius=0.004,
                 gravity=GRAVITY):
        self.substeps, self.iterations, self.kind = substeps, iterations, solver
        self.stiffness, self.damping, self.radius = stiffness, damping, radius
        self.builder = newton.ModelBuilder(up_axis=newton.Axis.Y, gravity=tuple(map(float, gravity)))
        self.soft, self.friction, self.contact, self.self_contact = [], 0.5, False, False

    def add_plane(self, friction=1.0):
        self.builder.add_ground_plane(cfg=newton.ModelBuilder.ShapeConfig(mu=friction))
        self.contact = True

    def add_soft(self, body):
        first, material = len(self.builder.particle_q), body.material
        if body.swells != 1:
            raise Unsupported("its soft bodies have no other volume at rest")
        if material.yield_strain is not None:
            raise Unsupported("its meshes of tets have no plasticity, only its particles (MPM)")
        mu, lam = material.lame
        if self.kind == "semi-implicit":  # whose energy has the logarithm that Bullet's has
            mu, lam = 4 / 3 * mu, lam + 5 / 6 * mu
        self.builder.add_soft_mesh(pos=warp.vec3(0, 0, 0), rot=warp.quat_identity(), scale=1.0, vel=warp.vec3(0, 0, 0),
                                   vertices=[warp.vec3(*p) for p in body.nodes], indices=body.tets.ravel().tolist(),
                                   density=material.density, k_mu=mu, k_lambda=lam, k_damp=mu * material.damping / 2,
                                   particle_radius=self.radius)
        for node in np.flatnonzero(body.held):
            self.builder.particle_mass[first + node] = 0.0
            self.builder.particle_flags[first + node] &= ~newton.ParticleFlags.ACTIVE
        self.friction = material.friction
        self.self_contact |= body.self_contact or bool(self.soft)
        self.soft.append((first, body))
        return len(self.soft) - 1

    def add_rigid(self, rigid):
        shape = newton.ModelBuilder.ShapeConfig(mu=rigid.friction, density=0.0)
        place = warp.transform(warp.vec3(*rigid.position), warp.quat(*rigid.rotation))
        if rigid.mass:
            half = np.broadcast_to(rigid.size, 3)
            inertia = rigid.mass / 3 * np.diag(
                [half[1]**2 + half[2]**2, half[0]**2 + half[2]**2, half[0]**2 + half[1]**2])
            if rigid.shape == "ball":
                inertia = 0.4 * rigid.mass * rigid.size**2 * np.eye(3)
            body = self.builder.add_body(xform=place, mass=rigid.mass, inertia=warp.mat33(*inertia.ravel()))
            self.builder.body_qd[body] = (*rigid.velocity, 0.0, 0.0, 0.0)
            place = warp.transform_identity()
        else:
            body = -1
        if rigid.shape == "box":
            hx, hy, hz = map(float, rigid.size)
            self.builder.add_shape_box(body, xform=place, hx=hx, hy=hy, hz=hz, cfg=shape)
        else:
            self.builder.add_shape_sphere(body, xform=place, radius=float(rigid.size), cfg=shape)
        self.contact = True
        return body

    def start(self):
        self.builder.color()
        self.model = self.builder.finalize(device="cpu")
        self.model.soft_contact_ke, self.model.soft_contact_kd = self.stiffness, self.damping
        self.model.soft_contact_mu = self.friction
        if self.kind == "vbd":
            contact = {"particle_enable_self_contact": True, "particle_self_contact_radius": self.radius,
                       "particle_self_contact_margin": 1.5 * self.radius} if self.self_contact else {}
            self.solver = newton.solvers.SolverVBD(model=self.model, iterations=self.iterations,
                                                   particle_enable_tile_solve=False, **contact)
        elif self.kind == "xpbd":
            self.solver = newton.solvers.SolverXPBD(model=self.model, iterations=self.iterations)
        else:
            self.solver = newton.solvers.SolverSemiImplicit(model=self.model)
        self.now, self.next = self.model.state(), self.model.state()
        self.control = self.model.control()
        self.pipeline = newton.CollisionPipeline(self.model) if self.contact else None
        self.contacts = self.pipeline.contacts() if self.pipeline else None
        self.solver.step(self.now, self.next, self.control, self.contacts, 1e-9)  # compiles kernels that are not in its cache
        self.now = self.model.state()

    def set_velocities(self, handle, rows):
        first, body = self.soft[handle]
        all_rows = self.now.particle_qd.numpy()
        all_rows[first : first + len(body.nodes)] = rows
        self.now.particle_qd.assign(all_rows)

    def step(self, dt):
        for _ in range(self.substeps):
            self.now.clear_forces()
            if self.pipeline:
                self.pipeline.collide(self.now, self.contacts)
            self.solver.step(self.now, self.next, self.control, self.contacts, dt / self.substeps)
            self.now, self.next = self.next, self.now

    def rows(self, handle, array):
        first, body = self.soft[handle]
        return np.array(array.numpy()[first : first + len(body.nodes)], float)

    def nodes(self, handle):
        return self.rows(handle, self.now.particle_q)

    def velocities(self, handle):
        return self.rows(handle, self.now.particle_qd)

    def surface(self, handle):
        if self.soft[handle][1].skin:
            raise Unsupported("contact is at the nodes of the tets: a finer surface is drawn alone")
        return self.nodes(handle)

    def pose(self, handle):
        pose = self.now.body_q.numpy()[handle]
        return np.array(pose[:3], float), np.array(pose[3:], float)

    def asleep(self, handle):
        return False


def skin_times(body, moved):
    """Seconds of processor time to build the model with the skin more than without, and to move it once: median of 20."""
    spent = {}
    for skinned in (True, False, True):  # the first one compiles kernels that are not in its cache
        simulation = Simulation(gravity=(0.0, 0.0, 0.0))
        simulation.add_soft(body)
        began = time.process_time()
        if skinned:
            simulation.builder.add_deformable_visual_mesh(body.skin[0].astype(np.float32), body.skin[1].ravel(),
                                                          kind="tetrahedron", tet_range=(0, len(body.tets)))
        model = simulation.builder.finalize(device="cpu")
        spent[skinned] = time.process_time() - began
    visuals, state, times = newton.geometry.DeformableVisuals(model), model.state(), []
    state.particle_q.assign(moved.astype(np.float32))
    visuals.update(state)
    for _ in range(20):
        began = time.process_time()
        visuals.update(state)
        times.append(time.process_time() - began)
    return spent[True] - spent[False], statistics.median(times)
