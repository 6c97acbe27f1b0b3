# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""pybullet's deformable world, with its neo-Hookean force.

The force's constants are not Lamé's: 4/3 mu and lambda + 5/6 mu have the same Young's modulus and Poisson's ratio. A
body divides its mass evenly among its nodes, and no call changes that; damping is Rayleigh's, without rotation. Soft
bodies collide with each other only if self-collision is on. Their example is deformable_torus.py: margin 0.006,
friction 0.5, repulsion 800, steps of 1/240 s.
"""
import contextlib
import os
import statistics
import tempfile
import time
from pathlib import Path

import numpy as np

from problem import GRAVITY, Unsupported


@contextlib.contextmanager
def quiet():
    """pybullet prints from C."""
    kept, null = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept), os.close(null)


with quiet():
    import pybullet as bullet
from importlib.metadata import version  # noqa: E402

VERSION = version("pybullet")


def write_vtk(path, nodes, tets):
    lines = ["# vtk DataFile Version 2.0", "tets", "ASCII", "DATASET UNSTRUCTURED_GRID", f"POINTS {len(nodes)} double"]
    lines += [" ".join(f"{x:.9g}" for x in node) for node in nodes]
    lines += [f"CELLS {len(tets)} {5 * len(tets)}"] + ["4 " + " ".join(map(str, tet)) for tet in tets]
    lines += [f"CELL_TYPES {len(tets)}"] + ["10"] * len(tets)
    path.write_text("\n".join(lines) + "\n")


class Simulation:
    """substeps: per frame. margin: of collisions, metres. lame: give the force Lamé's constants unchanged."""

    def __init__(self, substeps=4, margin=0.006, lame=False, gravity=GRAVITY):
        self.substeps, self.margin, self.lame = substeps, margin, lame
        self.folder = tempfile.TemporaryDirectory()
        self.soft, self.friction = {}, 0.5
        with quiet():
            bullet.connect(bullet.DIRECT)
            bullet.resetSimulation(bullet.RESET_USE_DEFORMABLE_WORLD)
            bullet.setGravity(*gravity)
            bullet.setPhysicsEngineParameter(sparseSdfVoxelSize=0.25)

    def add_plane(self, friction=1.0):
        """A box, as in their plane.urdf: above a GEOM_PLANE soft bodies float by 0.1 m."""
        shape = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=(15, 5, 15))
        self._add(shape, 0, (0, -5, 0), (0, 0, 0, 1), friction)

    def _add(self, shape, mass, position, rotation, friction):
        body = bullet.createMultiBody(mass,
                                      shape,
                                      basePosition=position,
                                      baseOrientation=rotation,
                                      useMaximalCoordinates=True)
        bullet.changeDynamics(body, -1, lateralFriction=friction)
        return body

    def add_soft(self, body):
        if len(np.unique(body.tets)) != len(body.nodes):
            raise Unsupported("pybullet's nodes are those of a file, and all need a tet")
        if body.swells != 1:
            raise Unsupported("its soft bodies have no other volume at rest")
        if body.material.yield_strain is not None:
            raise Unsupported("its soft bodies have no plasticity")
        path = Path(self.folder.name) / f"{len(self.soft)}.vtk"
        write_vtk(path, body.nodes, body.tets)
        mu, lam = body.material.lame
        if not self.lame:
            mu, lam = 4 / 3 * mu, lam + 5 / 6 * mu
        with quiet():
            handle = bullet.loadSoftBody(str(path), mass=float(body.masses.sum()), useNeoHookean=1, NeoHookeanMu=mu,
                                         NeoHookeanLambda=lam, NeoHookeanDamping=body.material.damping,
                                         collisionMargin=self.margin, frictionCoeff=body.material.friction,
                                         useSelfCollision=int(body.contact), repulsionStiffness=800)
            for node in np.flatnonzero(body.held):
                bullet.createSoftBodyAnchor(handle, int(node))
        self.soft[handle] = body
        return handle

    def add_rigid(self, rigid):
        if rigid.shape == "box":
            shape = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=rigid.size)
        else:
            shape = bullet.createCollisionShape(bullet.GEOM_SPHERE, radius=rigid.size)
        handle = self._add(shape, rigid.mass, rigid.position, rigid.rotation, rigid.friction)
        if rigid.mass:
            bullet.resetBaseVelocity(handle, rigid.velocity)
        return handle

    def start(self):
        self.before = {handle: self.nodes(handle) for handle in self.soft}

    def set_velocities(self, handle, rows):
        raise Unsupported("pybullet has no call that sets the velocities of nodes")

    def step(self, dt):
        bullet.setTimeStep(dt / self.substeps)
        with quiet():
            for _ in range(self.substeps):
                bullet.stepSimulation()

    def nodes(self, handle):
        count, rows = bullet.getMeshData(handle, -1, flags=bullet.MESH_DATA_SIMULATION_MESH)
        return np.array(rows)

    def velocities(self, handle):
        raise Unsupported("pybullet has no call that reads the velocities of nodes")

    def surface(self, handle):
        if self.soft[handle].skin:
            raise Unsupported("contact is at the nodes of the tets: a second mesh is drawn alone")
        return self.nodes(handle)

    def pose(self, handle):
        return [np.array(part) for part in bullet.getBasePositionAndOrientation(handle)]

    def asleep(self, handle):
        return False


def skin_times(body, moved):
    """Seconds of processor time to load the body with a mesh to draw more than without. Its update is a part of the
    step, and cannot be timed by itself: the difference between steps with and without the mesh, the median of 10."""
    spent, steps = {}, {}
    for drawn in (False, True):
        simulation = Simulation(gravity=(0.0, 0.0, 0.0))
        path = Path(simulation.folder.name)
        write_vtk(path / "cage.vtk", body.nodes, body.tets)
        lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in body.skin[0]]
        (path / "skin.obj").write_text("\n".join(lines + [f"f {a} {b} {c}" for a, b, c in body.skin[1] + 1]) + "\n")
        files = {
            "fileName": str(path / "skin.obj"),
            "simFileName": str(path / "cage.vtk")
        } if drawn else {
            "fileName": str(path / "cage.vtk")
        }
        began = time.process_time()
        with quiet():
            bullet.loadSoftBody(**files, mass=1.0, useNeoHookean=1, NeoHookeanMu=1e3, NeoHookeanLambda=1e3)
        spent[drawn], times = time.process_time() - began, []
        for _ in range(10):
            began = time.process_time()
            simulation.step(1 / 240)
            times.append(time.process_time() - began)
        steps[drawn] = statistics.median(times) / simulation.substeps
        bullet.disconnect()
    return spent[True] - spent[False], steps[True] - steps[False]
