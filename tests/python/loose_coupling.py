#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The cost of loose coupling: the figures of plugin/docs/pybullet.md.

Needs pybullet beside tetskin. The same scenes twice: a rigid body of pybullet's that meets a soft one of tetskin's
through `tetskin.pybullet.Mirror`, and both in one `tetskin.World`. Prints tables; takes some minutes.
"""
from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pybullet as p

import tetskin as ts
import tetskin.pybullet

GRAVITY = 9.81
SUBSTEPS = 4


class Ahead(tetskin.pybullet.Mirror):
    """As Mirror, with bodies where their velocities will have brought them in the next step (their rotation aside)."""

    def _link_states(self, pybullet: Any, body: int) -> Any:
        dt = pybullet.getPhysicsEngineParameters(physicsClientId=self.client)["fixedTimeStep"]
        (at, rotation), = super()._link_states(pybullet, body)
        velocity, _ = pybullet.getBaseVelocity(body, physicsClientId=self.client)
        return [(np.array(at) + dt * np.array(velocity), rotation)]


def slab(half: tuple[float, float, float], count: int = 8) -> ts.TriangleMesh:
    """A box with its faces divided, so that it is drawn, and touches, where it is dented."""
    grid = np.linspace(-1, 1, count + 1)
    u, v = np.meshgrid(grid, grid, indexing="ij")
    points, triangles = [], []
    i, j = np.meshgrid(np.arange(count), np.arange(count), indexing="ij")
    a = i * (count + 1) + j
    squares = np.stack([a, a + count + 1, a + count + 2, a + 1], -1).reshape(-1, 4)
    for axis in range(3):
        for side in (-1, 1):
            face = np.zeros(((count + 1) ** 2, 3))
            face[:, axis], face[:, (axis + 1) % 3], face[:, (axis + 2) % 3] = side, u.ravel(), v.ravel()
            ring = squares if side > 0 else squares[:, ::-1]
            triangles += [(ring[:, k] + len(points) * len(face)).T for k in ([0, 1, 2], [0, 2, 3])]
            points.append(face)
    positions = np.round(np.concatenate(points), 9)
    unique, inverse = np.unique(positions, axis=0, return_inverse=True)
    return ts.TriangleMesh(unique * half, inverse.reshape(-1)[np.concatenate([t.T for t in triangles])])


class Scene:
    """A box, or a ball, of some mass and a soft slab of mass 1 kg, 0.4 m x 0.4 m x 0.2 m, on the ground z = 0."""

    def __init__(self, cage: ts.Cage, mesh: ts.TriangleMesh, mass: float, dt: float, coupling: str, *,
                 drop: float = 0.001, free: bool = False, stiffness: float = 2e4, damping: float = 0.02) -> None:
        gravity = 0.0 if free else -GRAVITY
        self.dt, self.coupling, self.mass = dt, coupling, mass
        self.world = ts.World(gravity=(0, 0, gravity))
        if not free:
            self.world.add_plane(normal=(0, 0, 1))
        self.soft = self.world.add_body(cage, mesh, mass=1.0, youngs_modulus=stiffness, stiffness_damping=damping,
                                        position=(0, 0, 0.1))
        start = (0, 0, 0.25 + drop)
        if coupling == "strong":
            self.rigid = self.world.add_box((0.05, 0.05, 0.05), mass=mass, position=start)
            if free:
                self.rigid.velocity = (0, 0, -1)
            return
        self.client = p.connect(p.DIRECT)
        p.setGravity(0, 0, gravity, physicsClientId=self.client)
        p.setTimeStep(dt, physicsClientId=self.client)
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.05] * 3, physicsClientId=self.client)
        self.box = p.createMultiBody(mass, shape, basePosition=start, physicsClientId=self.client)
        p.changeDynamics(self.box, -1, linearDamping=0, angularDamping=0, physicsClientId=self.client)
        if free:
            p.resetBaseVelocity(self.box, (0, 0, -1), physicsClientId=self.client)
        kind = Ahead if coupling == "ahead" else tetskin.pybullet.Mirror
        self.mirror = kind(self.client, self.world)
        self.rigid = self.mirror.rigid_bodies(self.box)[0]

    def close(self) -> None:
        if self.coupling != "strong":
            p.disconnect(self.client)

    def step(self) -> None:
        if self.coupling == "strong":
            self.world.step(self.dt, substeps=SUBSTEPS)
        else:
            self.mirror.step(SUBSTEPS)

    def force(self) -> float:
        """Up, on the box."""
        return float(self.world.forces_on(self.rigid).total.force[2])

    def height(self) -> float:
        if self.coupling == "strong":
            return float(self.rigid.position[2])
        return float(p.getBasePositionAndOrientation(self.box, physicsClientId=self.client)[0][2])

    def speed(self) -> float:
        if self.coupling == "strong":
            return float(self.rigid.velocity[2])
        return float(p.getBaseVelocity(self.box, physicsClientId=self.client)[0][2])

    def soft_momentum(self) -> float:
        """For nodes with their masses, along z: each node of the slab has the mass of its share of the tets around
        it."""
        return float(self.masses @ self.soft.velocities[:, 2])

    @property
    def masses(self) -> np.ndarray:
        cage = self.soft.cage
        nodes, tets = np.asarray(cage.nodes), np.asarray(cage.tets)
        corners = nodes[tets]
        volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6
        masses = np.zeros(len(nodes))
        np.add.at(masses, tets, volumes[:, None] / 4)
        return masses / masses.sum()


def rest(cage: ts.Cage, mesh: ts.TriangleMesh, mass: float, dt: float, coupling: str, seconds: float = 3.0,
         **material: float) -> dict[str, float]:
    """The last second of a box that has been put on the slab."""
    scene = Scene(cage, mesh, mass, dt, coupling, **material)
    steps = round(seconds / dt)
    forces, speeds = [], []
    try:
        for k in range(steps):
            scene.step()
            if k >= steps - round(1 / dt):
                forces.append(scene.force())
                speeds.append(scene.speed())
        contacts = scene.world.contacts(scene.soft)
        on_box = [d for d, body in zip(contacts.distances, contacts.bodies) if body == scene.rigid]
        return {"force": np.mean(forces) / (mass * GRAVITY), "ripple": np.ptp(forces) / (mass * GRAVITY),
                "speed": np.abs(speeds).max(), "height": scene.height(),
                "depth": -min(on_box) if on_box else np.nan}
    except ts.Error:
        return dict.fromkeys(("force", "ripple", "speed", "height", "depth"), np.inf)
    finally:
        scene.close()


def hit(cage: ts.Cage, mesh: ts.TriangleMesh, mass: float, dt: float, coupling: str) -> dict[str, float]:
    """A box that flies against the slab, without gravity: 1 m/s, and off again."""
    scene = Scene(cage, mesh, mass, dt, coupling, drop=0.01, free=True)
    try:
        for _ in range(round(1 / dt)):
            scene.step()
        return {"lost": 1 - (scene.soft_momentum() + mass * scene.speed()) / -mass, "speed": scene.speed()}
    finally:
        scene.close()


def main() -> None:
    mesh = slab((0.2, 0.2, 0.1))
    cage = ts.create_cage(mesh, target_tets=500)
    print(f"slab of 1 kg: {len(cage.nodes)} nodes, {len(cage.tets)} tets")
    print("\nat rest: mean and ripple (peak to peak) of the force / weight, deepest point below the margin, height")
    for mass in (10.0, 3.0, 1.0):
        for coupling in ("strong", "loose", "ahead"):
            r = rest(cage, mesh, mass, 1 / 240, coupling)
            print(f"{mass:6.2f} kg {coupling:6}: {r['force']:8.4f} {r['ripple']:9.5f} {1e3 * r['depth']:8.3f} mm "
                  f"{1e3 * r['height']:8.2f} mm")
    print("\nlargest speed of the last second, mm/s, by mass in kg: below 1 is at rest")
    print(" " * 14 + " ".join(f"{mass:9}" for mass in MASSES))
    for coupling in ("strong", "loose", "ahead"):
        for dt in (1 / 60, 1 / 120, 1 / 240, 1 / 480, 1 / 960):
            row = [rest(cage, mesh, mass, dt, coupling)["speed"] for mass in MASSES]
            print(f"{coupling:6} 1/{round(1 / dt):3} s " + " ".join(f"{1e3 * v:9.3g}" for v in row))
    print("\nthe same in steps of 1/240 s, by Young's modulus and stiffness damping")
    for stiffness in (2e3, 2e4, 2e5):
        for damping in (0.02, 0.005):
            for coupling in ("strong", "loose"):
                row = [rest(cage, mesh, mass, 1 / 240, coupling, stiffness=stiffness, damping=damping)["speed"]
                       for mass in MASSES]
                print(f"{coupling:6} {stiffness:6.0f} Pa {damping:5} s " + " ".join(f"{1e3 * v:9.3g}" for v in row))
    print("\nmomentum lost, share of the box's, and speed after, m/s (it was -1), by mass as above")
    for coupling in ("strong", "loose", "ahead"):
        for dt in (1 / 60, 1 / 240):
            row = [hit(cage, mesh, mass, dt, coupling) for mass in MASSES]
            print(f"{coupling:6} 1/{round(1 / dt):3} s " + " ".join(f"{r['lost']:9.5f}" for r in row))
            print(" " * 14 + " ".join(f"{r['speed']:9.3f}" for r in row))


MASSES = (10.0, 3.0, 1.0, 0.5, 0.3, 0.1)

if __name__ == "__main__":
    sys.exit(main())
