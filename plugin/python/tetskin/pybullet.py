# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Works with pybullet: a fine surface on its soft bodies, and its robots among tetskin's.

    body, skin = tetskin.pybullet.load_soft_body(cage, mesh, mass=3, useNeoHookean=1)
    mirror = tetskin.pybullet.Mirror(client, world)

Needs the package pybullet, which the first call imports. All lengths are those of pybullet's world; the `World` that
mirrors it uses the same.
"""
from __future__ import annotations

import importlib
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np

from . import _core

__all__ = ["Mirror", "Skin", "load_soft_body"]

Normals = Literal["none", "transformed", "recomputed"]
Interpolation = Literal["linear", "quadratic"]
SOFT_BODY = 3  # of getDynamicsInfo; pybullet has no name for it
ALONG_Y = (-np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5))  # turns z, the axis of pybullet's shapes, into tetskin's y
NO_TURN = (0.0, 0.0, 0.0, 1.0)


def _pybullet() -> Any:
    try:
        return importlib.import_module("pybullet")
    except ImportError as error:
        raise ImportError("tetskin.pybullet needs the package pybullet: pip install pybullet") from error


def _error(code: str, message: str) -> _core.Error:
    error = _core.Error(message)
    error.code = getattr(_core.StatusCode, code)
    return error


def _connected(client: int) -> Any:
    """The module pybullet; checks that the client is connected."""
    p = _pybullet()
    if not p.getConnectionInfo(client)["isConnected"]:
        raise _error("NOT_ADDED", f"client {client} of pybullet is not connected: call pybullet.connect first, and "
                                  "pass what it returns")
    return p


def _ids(p: Any, client: int) -> set[int]:
    """Ids of all bodies of a client. pybullet crashes when asked for the mesh of any other id."""
    return {p.getBodyUniqueId(i, physicsClientId=client) for i in range(p.getNumBodies(physicsClientId=client))}


def _check_body(p: Any, body: int, client: int) -> None:
    if body not in _ids(p, client):
        raise _error("BODY_DELETED", f"client {client} of pybullet has no body {body}: it has been removed, or is "
                                     "another client's")


class Skin:
    """A fine surface on one of pybullet's soft bodies, loaded from a cage's file (`Cage.save`).

    body_id, client: as in pybullet. cage, mesh, normals, interpolation: as in `tetskin.Skin`. Raises an Error if the
    body is not soft, or has another number of nodes than the cage; its nodes must be the cage's, in the same order.
    """

    def __init__(self, body_id: int, cage: _core.Cage, mesh: Any, client: int = 0, *, normals: Normals = "none",
                 interpolation: Interpolation = "linear") -> None:
        self.body_id: int = int(body_id)
        self.client: int = int(client)
        self._skin = _core.Skin(cage, mesh, normals=normals, interpolation=interpolation)
        self.update()

    def update(self) -> np.ndarray:
        """Computes the surface for the current nodes: call it after stepSimulation. Returns positions. On an Error, the
        surface stays as it was."""
        return self._skin.update(self.nodes)

    @property
    def nodes(self) -> np.ndarray:
        """(nodes, 3) float64, world space: pybullet's current nodes, in the cage's order. A new array."""
        p = _connected(self.client)
        _check_body(p, self.body_id, self.client)
        if p.getDynamicsInfo(self.body_id, -1, physicsClientId=self.client)[10] != SOFT_BODY:
            raise _error("INVALID_OPTION", f"body {self.body_id} is no soft body of pybullet's")
        # Without the flag, pybullet returns the vertices that it draws, which are different.
        count, nodes = p.getMeshData(self.body_id, -1, flags=p.MESH_DATA_SIMULATION_MESH, physicsClientId=self.client)
        if count != self._skin.node_count:
            raise _error("SIZE_MISMATCH", f"body {self.body_id} has {count} nodes, and the cage "
                                          f"{self._skin.node_count}: load it from the file that this cage has saved")
        return np.array(nodes)

    @property
    def positions(self) -> np.ndarray:
        """(vertices, 3) float32, world space. A read-only view, which each update overwrites."""
        return self._skin.positions

    @property
    def normals(self) -> np.ndarray:
        """(vertices, 3) float32, unit length, or (0, 3). A read-only view, which each update overwrites."""
        return self._skin.normals


def load_soft_body(cage: _core.Cage, mesh: Any, *, client: int = 0, normals: Normals = "none",
                   interpolation: Interpolation = "linear", **options: Any) -> tuple[int, Skin]:
    """Makes a pybullet soft body from a cage, and a skin on it. Returns its id and the skin.

    options: those of loadSoftBody except the file's name, such as basePosition, mass, useNeoHookean, NeoHookeanMu,
    collisionMargin. Its world must have been reset with RESET_USE_DEFORMABLE_WORLD.
    """
    p = _connected(client)
    for name in ("fileName", "simFileName", "physicsClientId"):
        if name in options:
            raise TypeError(f"{name}: the cage is the file, and client the client")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cage.vtk"
        cage.save(path)
        body = p.loadSoftBody(str(path), physicsClientId=client, **options)
    try:
        return body, Skin(body, cage, mesh, client, normals=normals, interpolation=interpolation)
    except Exception:
        p.removeBody(body, physicsClientId=client)
        raise


def _product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The product of quaternions (n, 4), x, y, z, w: first b, then a."""
    u, v, s, t = a[:, :3], b[:, :3], a[:, 3:], b[:, 3:]
    return np.hstack([s * v + t * u + np.cross(u, v), s * t - (u * v).sum(1, keepdims=True)])


def _rotated(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Vectors (n, 3), each by its quaternion (n, 4)."""
    cross = 2 * np.cross(q[:, :3], v)
    turned: np.ndarray = v + q[:, 3:] * cross + np.cross(q[:, :3], cross)
    return turned


def _obj_parts(path: Path) -> list[np.ndarray]:
    """The points (n, 3) of each object in an OBJ file: pybullet makes a hull from each."""
    points: list[list[float]] = []
    parts: list[set[int]] = [set()]
    for line in path.read_text(errors="replace").splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            points.append([float(word) for word in words[1:4]])
        elif words[0] in ("o", "g"):
            parts.append(set())
        elif words[0] == "f":
            indices = [int(word.partition("/")[0]) for word in words[1:]]
            parts[-1].update(i - 1 if i > 0 else len(points) + i for i in indices)
    return [np.array([points[i] for i in sorted(part)]) for part in parts if part]


class _Part:
    """A collision shape of a link, its place in the frame of the link's centre of mass, and its rigid body."""

    def __init__(self, link: int, shape: _core.Shape, position: Sequence[float] = (0.0, 0.0, 0.0),
                 rotation: Sequence[float] = NO_TURN) -> None:
        self.link, self.shape, self.position, self.rotation = link, shape, position, rotation
        self.rigid: Any = None


def _mesh_parts(p: Any, client: int, body: int, link: int, index: int, entries: Sequence[Any]) -> list[_Part]:
    """A mesh. pybullet stores it as hulls, or as triangles if it was loaded as such."""
    _, _, _, scale, name, position, rotation = entries[index]
    path = Path(name.decode())
    alone = len(entries) == 1
    is_obj = path.suffix.lower() == ".obj"
    points: Sequence[Any] = ()
    if alone or not is_obj:  # among other shapes, the hulls of one OBJ cannot be told apart
        selected = {} if alone else {"collisionShapeIndex": index}
        points = p.getMeshData(body, link, physicsClientId=client, **selected)[1]
        if not points:
            if not path.is_file():
                raise _error("INVALID_OPTION", f"pybullet does not tell the triangles of a mesh of body {body}, link "
                                               f"{link}: leave it out (bodies=, links=), and add it to the world by "
                                               "Shape.mesh")
            mesh = _core.load_mesh(path)
            scaled = _core.TriangleMesh(mesh.positions * np.array(scale), mesh.triangles)
            return [_Part(link, _core.Shape.mesh(scaled), position, rotation)]
    if not is_obj:
        return [_Part(link, _core.Shape.convex_hull(np.array(points)))]
    if not path.is_file():
        raise FileNotFoundError(f"{path}, of which pybullet has made body {body}, link {link}, is not there any more")
    return [_Part(link, _core.Shape.convex_hull(part * np.array(scale)), position, rotation)
            for part in _obj_parts(path)]


def _parts(p: Any, client: int, body: int, link: int) -> list[_Part]:
    """A link's collision shapes."""
    try:
        entries = p.getCollisionShapeData(body, link, physicsClientId=client)
    except p.error as error:
        raise _error("INVALID_OPTION", f"pybullet does not tell the shapes of body {body}, link {link}: a body with "
                                       "useMaximalCoordinates cannot be mirrored") from error
    parts = []
    for index, (_, _, kind, size, _, position, rotation) in enumerate(entries):
        along_y = _product(np.array([rotation]), np.array([ALONG_Y]))[0]
        if kind == p.GEOM_SPHERE:
            parts.append(_Part(link, _core.Shape.sphere(size[0]), position, rotation))
        elif kind == p.GEOM_BOX:
            parts.append(_Part(link, _core.Shape.box([0.5 * length for length in size]), position, rotation))
        elif kind == p.GEOM_CAPSULE:
            parts.append(_Part(link, _core.Shape.capsule(size[1], size[0]), position, along_y))
        elif kind == p.GEOM_CYLINDER:
            parts.append(_Part(link, _core.Shape.cylinder(size[1], size[0]), position, along_y))
        elif kind == p.GEOM_PLANE:
            parts.append(_Part(link, _core.Shape.plane(size), position, rotation))
        elif kind == p.GEOM_MESH:
            parts.extend(_mesh_parts(p, client, body, link, index, entries))
        else:
            raise _error("INVALID_OPTION", f"body {body}, link {link}: shapes of the kind {kind} of pybullet cannot be "
                                           "mirrored; leave it out (bodies=, links=)")
    return parts


class Mirror:
    """Rigid bodies of pybullet among the soft bodies of a tetskin `World`, in steps that take turns.

    Each collision shape of pybullet's bodies becomes a kinematic body of `world`, at the same place. `step` applies the
    forces of the world's soft bodies to pybullet's links, and steps both. The two are loosely coupled: a link yields to
    a force only in the next step, and bodies too light for that are thrown off; the guide's page gives the limits.
    Rigid bodies of `world` itself collide with pybullet's bodies, but do not push them.

    client: as in pybullet. bodies: their ids; None: all current rigid bodies. `add` adds others. Units are the same on
    both sides; set gravity on both.
    """

    def __init__(self, client: int, world: _core.World, bodies: Iterable[int] | None = None) -> None:
        self.client: int = int(client)
        self.world: _core.World = world
        self._bodies: dict[int, list[_Part]] = {}
        self._forces: dict[tuple[int, int], tuple[np.ndarray, np.ndarray]] = {}
        p = _connected(self.client)
        if bodies is None:
            bodies = [body for body in sorted(_ids(p, self.client))
                      if p.getDynamicsInfo(body, -1, physicsClientId=self.client)[10] != SOFT_BODY]
        try:
            for body in bodies:
                self.add(body)
        except Exception:
            for body in self.bodies:
                self.remove(body)
            raise

    @property
    def bodies(self) -> tuple[int, ...]:
        """Ids of pybullet's bodies that are mirrored, in the order in which they were added."""
        return tuple(self._bodies)

    def add(self, body: int, links: Iterable[int] | None = None) -> None:
        """Mirrors another body in its current state. links: only these, with -1 for its base; None: all. Their friction
        is pybullet's current lateralFriction. Raises an Error if it is already mirrored, does not exist, or has a shape
        that pybullet does not report."""
        p = _connected(self.client)
        _check_body(p, body, self.client)
        if body in self._bodies:
            raise _error("INVALID_OPTION", f"body {body} is mirrored already")
        if p.getDynamicsInfo(body, -1, physicsClientId=self.client)[10] == SOFT_BODY:
            raise _error("INVALID_OPTION", f"body {body} is a soft body of pybullet's: only rigid ones can be mirrored")
        count = p.getNumJoints(body, physicsClientId=self.client)
        chosen = list(range(-1, count)) if links is None else sorted(set(links))
        for link in chosen:
            if not -1 <= link < count:
                raise _error("INDEX_OUT_OF_RANGE", f"body {body} has no link {link}: -1 (its base) to {count - 1}")
        self._place(p, body, [part for link in chosen for part in _parts(p, self.client, body, link)])

    def _place(self, p: Any, body: int, parts: list[_Part]) -> None:
        self._bodies[body] = parts
        self._arrange()
        _, positions, rotations = self._poses(p, [body])
        for part, position, rotation in zip(parts, positions, rotations):
            friction = p.getDynamicsInfo(body, part.link, physicsClientId=self.client)[1]
            part.rigid = self.world.add_rigid_body(part.shape, kinematic=True, position=position, rotation=rotation,
                                                   friction=friction)

    def remove(self, body: int) -> None:
        """Takes a body out of the world, even one that pybullet has removed. Removing it again changes nothing."""
        for part in self._bodies.pop(body, []):
            part.rigid.remove()
        self._forces = {link: force for link, force in self._forces.items() if link[0] != body}
        self._arrange()

    def teleport(self, body: int) -> None:
        """Call it after resetBasePositionAndOrientation or resetJointState: puts a body's mirrors at its new place.
        Otherwise they move there within the next step, and push along what is in their way. Replaces its
        `rigid_bodies`."""
        p = _connected(self.client)
        _check_body(p, body, self.client)
        if body not in self._bodies:
            raise _error("NOT_ADDED", f"body {body} is not mirrored: call add")
        parts = self._bodies[body]
        for part in parts:
            part.rigid.remove()
        self._place(p, body, parts)

    def rigid_bodies(self, body: int, link: int = -1) -> list[_core.RigidBody]:
        """The world's mirrors of a link, one for each of its shapes, for instance to weld something to it."""
        return [part.rigid for part in self._bodies.get(body, []) if part.link == link]

    def force_on(self, body: int, link: int = -1) -> tuple[np.ndarray, np.ndarray]:
        """Force and torque about the centre of mass of a link, (3,) float64 each, world space: the mean over the last
        step, which pybullet's next step applies."""
        force, torque = self._forces.get((body, link), (np.zeros(3), np.zeros(3)))
        return force.copy(), torque.copy()

    def step(self, substeps: int = 4) -> None:
        """Steps both by pybullet's time step: pybullet, by stepSimulation, then the world, in `substeps` steps.

        Pybullet's step applies the forces of the world's last step; then the mirrors move to pybullet's new poses while
        the world steps. So both are at the same time afterwards, and the mirrors have moved with exactly the velocities
        of pybullet's bodies. (Extrapolated poses would give forces a step earlier, but jerk, and even heavy bodies
        would not come to rest.) Bodies that pybullet has removed leave the mirror.
        """
        p = _connected(self.client)
        parameters = p.getPhysicsEngineParameters(physicsClientId=self.client)
        if parameters["useRealTimeSimulation"]:
            raise _error("INVALID_OPTION", "pybullet steps by itself: call setRealTimeSimulation(0)")
        for body in set(self._bodies) - _ids(p, self.client):
            self.remove(body)
        self._give(p)
        p.stepSimulation(physicsClientId=self.client)
        centres, positions, rotations = self._poses(p, self._bodies)
        parts = [(body, part) for body, parts in self._bodies.items() for part in parts]
        self._follow(parts, positions, rotations, positions - centres, parameters["fixedTimeStep"], substeps)

    def _follow(self, parts: list[tuple[int, _Part]], positions: np.ndarray, rotations: np.ndarray, arms: np.ndarray,
                seconds: float, substeps: int) -> None:
        """Steps the world while the parts move there on straight paths, and averages the forces on them.

        The world moves bodies that are set once per frame along curves, which extrapolate their motion: forces on
        pybullet would then follow the extrapolation, and oscillate.
        """
        if substeps < 1:
            self.world.step(seconds, substeps=substeps)  # which reports the error
        from_positions = np.array([part.rigid.position for _, part in parts]).reshape(-1, 3)
        from_rotations = np.array([part.rigid.rotation for _, part in parts]).reshape(-1, 4)
        turned = np.sum(from_rotations * rotations, axis=1, keepdims=True)
        to_rotations = np.where(turned < 0, -rotations, rotations)
        self._forces = {}
        for k in range(1, substeps + 1):
            share = k / substeps
            between = from_rotations + share * (to_rotations - from_rotations)
            between /= np.linalg.norm(between, axis=1, keepdims=True)
            places = from_positions + share * (positions - from_positions)
            for (_, part), place, rotation in zip(parts, places, between):
                part.rigid.position = place
                part.rigid.rotation = rotation
            self.world.step(seconds / substeps, substeps=1)
            for (body, part), arm in zip(parts, arms):
                self._add_force(body, part, arm, 1 / substeps)

    def _arrange(self) -> None:
        """Arrays that stay the same in all steps, by body: links with shapes, and the link's row of each part."""
        self._links: dict[int, list[int]] = {}
        self._rows: dict[int, tuple[list[int], np.ndarray, np.ndarray]] = {}
        for body, parts in self._bodies.items():
            links = sorted({part.link for part in parts})
            self._links[body] = links
            self._rows[body] = ([links.index(part.link) for part in parts],
                                np.array([part.position for part in parts]).reshape(-1, 3),
                                np.array([part.rotation for part in parts]).reshape(-1, 4))

    def _poses(self, p: Any, bodies: Iterable[int]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """For all parts of these bodies: centres of mass of the links, positions, and rotations."""
        states: list[tuple[Any, ...]] = []
        local_positions, local_rotations = [np.zeros((0, 3))], [np.zeros((0, 4))]
        for body in bodies:
            rows, positions, rotations = self._rows[body]
            of_links = self._link_states(p, body)
            states += [of_links[row] for row in rows]
            local_positions.append(positions)
            local_rotations.append(rotations)
        centre = np.array([state[0] for state in states]).reshape(-1, 3)
        frame = np.array([state[1] for state in states]).reshape(-1, 4)
        return (centre, centre + _rotated(frame, np.concatenate(local_positions)),
                _product(frame, np.concatenate(local_rotations)))

    def _link_states(self, p: Any, body: int) -> list[tuple[Any, Any]]:
        """Position and rotation of the centre of mass of each link that has shapes."""
        links = self._links[body]
        states: list[tuple[Any, Any]] = []
        if links and links[0] == -1:
            states.append(p.getBasePositionAndOrientation(body, physicsClientId=self.client))
            links = links[1:]
        if links:
            # pybullet returns the poses of links from before its last step, unless it is asked to compute them.
            of_links = p.getLinkStates(body, links, computeForwardKinematics=1, physicsClientId=self.client)
            states += [state[:2] for state in of_links]
        return states

    def _add_force(self, body: int, part: _Part, arm: np.ndarray, share: float) -> None:
        """Adds a share of the force of the world's last step on a part to its link. arm: from the link's centre to the
        part."""
        wrench = self.world.forces_on(part.rigid).total
        if not any(wrench.force) and not any(wrench.torque):
            return
        force, torque = self._forces.get((body, part.link), (np.zeros(3), np.zeros(3)))
        self._forces[body, part.link] = (force + share * wrench.force,
                                         torque + share * (wrench.torque + np.cross(arm, wrench.force)))

    def _give(self, p: Any) -> None:
        """Applies the forces to the links, for pybullet's next step."""
        for (body, link), (force, torque) in self._forces.items():
            if link == -1:
                centre = p.getBasePositionAndOrientation(body, physicsClientId=self.client)[0]
            else:
                centre = p.getLinkState(body, link, physicsClientId=self.client)[0]
            p.applyExternalForce(body, link, force, centre, p.WORLD_FRAME, physicsClientId=self.client)
            p.applyExternalTorque(body, link, torque, p.WORLD_FRAME, physicsClientId=self.client)
