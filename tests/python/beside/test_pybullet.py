# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Beside pybullet: skins on its soft bodies, its rigid bodies among tetskin's, and both in one process."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

p = pytest.importorskip("pybullet", reason="pybullet has no wheels for this Python")

import loose_coupling  # noqa: E402
import tetskin as ts  # noqa: E402
import tetskin.pybullet  # noqa: E402

pybullet_data = pytest.importorskip("pybullet_data")
REPOSITORY = Path(__file__).parents[3]
MATERIAL = {"mass": 3, "useNeoHookean": 1, "NeoHookeanMu": 400, "NeoHookeanLambda": 600, "NeoHookeanDamping": 0.02,
            "collisionMargin": 0.006, "useSelfCollision": 0, "frictionCoeff": 0.5}


@pytest.fixture
def client():
    one = p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath(), physicsClientId=one)
    yield one
    if p.getConnectionInfo(one)["isConnected"]:
        p.disconnect(one)


@pytest.fixture
def soft_client(client):
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD, physicsClientId=client)
    p.setGravity(0, -10, 0, physicsClientId=client)
    ground = p.createCollisionShape(p.GEOM_PLANE, planeNormal=(0, 1, 0), physicsClientId=client)
    p.createMultiBody(0, ground, physicsClientId=client)
    return client


@pytest.fixture(scope="module")
def ball():
    return ts.create_cage(sphere := round_mesh(0.1), target_tets=100), sphere


def round_mesh(radius):
    """A cube's surface, blown up."""
    mesh = loose_coupling.slab((1, 1, 1), 6)
    points = np.asarray(mesh.positions)
    return ts.TriangleMesh(radius * points / np.linalg.norm(points, axis=1, keepdims=True), mesh.triangles)


def brute_force(cage, mesh, nodes):
    """Each vertex in the tet whose smallest weight is largest: (vertices, 3)."""
    rest, tets = np.asarray(cage.nodes), np.asarray(cage.tets)
    edges = np.linalg.inv(np.stack([rest[tets[:, k]] - rest[tets[:, 3]] for k in range(3)], -1))
    weights = np.einsum("tij,tvj->tvi", edges, mesh.positions[None] - rest[tets[:, 3]][:, None])
    weights = np.concatenate([weights, 1 - weights.sum(-1, keepdims=True)], -1)
    tet = weights.min(-1).argmax(0)
    return np.einsum("vk,vkj->vj", weights[tet, np.arange(len(tet))], nodes[tets[tet]])


# Skins of pybullet's own soft bodies.


def test_a_skin_is_where_brute_force_puts_it(soft_client, cage, mesh):
    body, skin = tetskin.pybullet.load_soft_body(cage, mesh, client=soft_client, normals="recomputed",
                                                 basePosition=(0, 0.7, 0), **MATERIAL)
    assert np.abs(skin.nodes - cage.nodes - (0, 0.7, 0)).max() < 1e-6
    for _ in range(120):
        p.stepSimulation(physicsClientId=soft_client)
    positions = skin.update()
    assert abs(np.ptp(positions[:, 1]) / np.ptp(mesh.positions[:, 1]) - 1) > 0.03  # it has landed, and is deformed
    assert np.abs(positions - brute_force(cage, mesh, skin.nodes)).max() < 1e-6
    assert positions.dtype == np.float32 and positions.shape == (800, 3) and not positions.flags.writeable
    assert np.shares_memory(positions, skin.positions)
    assert np.allclose(np.linalg.norm(skin.normals, axis=1), 1, atol=1e-5)


def test_a_skin_is_updated_by_update_alone(soft_client, cage, mesh):
    _, skin = tetskin.pybullet.load_soft_body(cage, mesh, client=soft_client, basePosition=(0, 0.7, 0), **MATERIAL)
    before = skin.positions.copy()
    p.stepSimulation(physicsClientId=soft_client)
    assert np.array_equal(before, skin.positions)
    skin.update()
    assert not np.array_equal(before, skin.positions)


def failed(code, call, *arguments, **options):
    """The text of the Error that a call raises, of this code."""
    with pytest.raises(ts.Error) as caught:
        call(*arguments, **options)
    assert caught.value.code == getattr(ts.StatusCode, code)
    return str(caught.value)


def test_a_skin_tells_what_is_wrong(soft_client, cage, mesh):
    body, skin = tetskin.pybullet.load_soft_body(cage, mesh, client=soft_client, basePosition=(0, 0.7, 0), **MATERIAL)
    other = ts.create_cage(mesh, target_tets=400)
    assert f"{len(cage.nodes)} nodes" in failed("SIZE_MISMATCH", tetskin.pybullet.Skin, body, other, mesh, soft_client)
    assert "no soft body" in failed("INVALID_OPTION", tetskin.pybullet.Skin, 0, cage, mesh, soft_client)
    second = p.connect(p.DIRECT)
    try:
        assert f"client {second}" in failed("BODY_DELETED", tetskin.pybullet.Skin, body, cage, mesh, second)
    finally:
        p.disconnect(second)
    assert "connect" in failed("NOT_ADDED", tetskin.pybullet.Skin, body, cage, mesh, second)
    assert "connect" in failed("NOT_ADDED", tetskin.pybullet.load_soft_body, cage, mesh, client=second)
    before = skin.positions.copy()
    p.removeBody(body, physicsClientId=soft_client)
    assert "removed" in failed("BODY_DELETED", skin.update)
    assert np.array_equal(before, skin.positions)
    p.disconnect(soft_client)
    assert "connect" in failed("NOT_ADDED", skin.update)


def test_what_could_not_be_skinned_is_not_left_in_the_world(soft_client, cage, mesh):
    count = p.getNumBodies(physicsClientId=soft_client)
    with pytest.raises(ValueError, match="normals"):
        tetskin.pybullet.load_soft_body(cage, mesh, client=soft_client, normals="unknown", **MATERIAL)
    with pytest.raises(TypeError, match="fileName"):
        tetskin.pybullet.load_soft_body(cage, mesh, client=soft_client, fileName="x.vtk")
    with pytest.raises(TypeError):
        tetskin.pybullet.load_soft_body(cage, mesh, client=soft_client, unknown=1)
    assert p.getNumBodies(physicsClientId=soft_client) == count


# Shapes and poses of mirrored bodies.


def surface_distances(client, body, link, ball):
    """Presses a soft ball on a link from some sides, and compares where tetskin finds the link's surface with where
    pybullet's rays do: the differences, world length."""
    cage, mesh = ball
    low, high = np.array(p.getAABB(body, link, physicsClientId=client))
    middle, reach = 0.5 * (low + high), np.linalg.norm(high - low)
    world = ts.World(gravity=(0, 0, 0))
    mirror = tetskin.pybullet.Mirror(client, world, bodies=[])
    mirror.add(body, links=[link])
    differences = []
    for towards in ((0.9, 0.3, 0.2), (-0.2, 0.9, 0.4), (0.1, -0.3, -0.9), (-0.8, -0.4, 0.4)):
        towards = np.array(towards)
        hit = p.rayTest(middle + reach * towards, middle - reach * towards, physicsClientId=client)[0]
        if hit[:2] != (body, link):
            continue  # another link is before it
        point, normal = np.array(hit[3]), np.array(hit[4])
        soft = world.add_body(cage, mesh, position=point + 0.096 * normal)
        world.step(1e-3, substeps=1)
        contacts = world.contacts(soft)
        nearest = contacts.distances.argmin()
        at, away = contacts.points[nearest].astype(float), contacts.normals[nearest].astype(float)
        # Rays that are much shorter than their targets sometimes miss them.
        again = p.rayTest(at + 0.4 * away, at - 0.4 * away, physicsClientId=client)[0]
        if again[:2] == (body, link):
            differences.append((at - again[3]) @ away - contacts.distances[nearest])
        soft.remove()
    return np.array(differences)


TURNED = ((1.0, 2.0, 3.0), p.getQuaternionFromEuler((0.3, 0.5, 0.7)))
SHAPES = {
    "sphere": {"shapeType": p.GEOM_SPHERE, "radius": 0.4},
    "box": {"shapeType": p.GEOM_BOX, "halfExtents": (0.2, 0.3, 0.4)},
    "capsule": {"shapeType": p.GEOM_CAPSULE, "radius": 0.2, "height": 0.5},
    "cylinder": {"shapeType": p.GEOM_CYLINDER, "radius": 0.3, "height": 0.5},
    "hull": {"shapeType": p.GEOM_MESH, "vertices": [(0, 0, 0), (0.8, 0, 0), (0, 0.7, 0), (0, 0, 0.9)]},
    "hulls of a file": {"shapeType": p.GEOM_MESH, "fileName": "duck_vhacd.obj", "meshScale": (0.5, 0.5, 0.5)},
}


@pytest.mark.parametrize("name", SHAPES)
def test_shapes_are_where_pybullet_has_them(client, ball, name):
    shape = p.createCollisionShape(collisionFramePosition=(0.1, 0.2, 0.3), physicsClientId=client,
                                   collisionFrameOrientation=p.getQuaternionFromEuler((-0.5, 0.2, 0.9)), **SHAPES[name])
    body = p.createMultiBody(1, shape, -1, *TURNED, (0.3, -0.2, 0.1), p.getQuaternionFromEuler((1, 0.5, 0.2)),
                             physicsClientId=client)
    differences = surface_distances(client, body, -1, ball)
    # Contact keeps a margin of 0.5 mm, and pybullet rounds its hulls by 1 mm.
    assert len(differences) >= 2 and np.abs(differences).max() < 0.0011


@pytest.mark.parametrize("file, scale, links", [("duck_vhacd.urdf", 5, [-1]), ("r2d2.urdf", 1, [-1, 1, 2, 13]),
                                                ("franka_panda/panda.urdf", 5, [-1, 1, 2, 5, 8, 9])])
def test_links_are_where_pybullet_has_them(client, ball, file, scale, links):
    body = p.loadURDF(file, *TURNED, useFixedBase=True, globalScaling=scale, physicsClientId=client)
    for joint in range(p.getNumJoints(body, physicsClientId=client)):
        p.resetJointState(body, joint, 0.1 + 0.02 * joint, physicsClientId=client)
    for link in links:
        differences = surface_distances(client, body, link, ball)
        assert len(differences) >= 1 and np.abs(differences).max() < 0.0011, link


def test_several_shapes_of_a_link_and_a_plane(client, ball):
    shapes = p.createCollisionShapeArray(shapeTypes=[p.GEOM_BOX, p.GEOM_SPHERE], radii=[0, 0.2], lengths=[0, 0],
                                         halfExtents=[(0.1, 0.2, 0.3), (0, 0, 0)], physicsClientId=client,
                                         collisionFramePositions=[(0.1, 0, 0), (0, 0.3, 0)])
    body = p.createMultiBody(1, shapes, -1, *TURNED, (0.5, 0, 0), (0.5, 0.5, 0.5, 0.5), physicsClientId=client)
    assert np.abs(surface_distances(client, body, -1, ball)).max() < 0.0011
    plane = p.createCollisionShape(p.GEOM_PLANE, planeNormal=(0, 0, 1), physicsClientId=client)
    p.createMultiBody(0, plane, basePosition=(0, 0, -0.5), physicsClientId=client)
    world = ts.World(gravity=(0, 0, -9.81))
    mirror = tetskin.pybullet.Mirror(client, world)
    assert len(mirror.rigid_bodies(body)) == 2
    soft = world.add_body(*ball, position=(3, 3, -0.3))
    for _ in range(240):
        mirror.step()
    assert -0.5 < soft.positions[:, 2].min() < -0.498


def test_triangles_of_a_file_that_are_not_hulls(client, ball, tmp_path):
    """A bowl: the ball lies in it, and would be pushed out of its hull."""
    grid = np.linspace(-1, 1, 9)
    x, y = np.meshgrid(grid, grid, indexing="ij")
    lines = [f"v {a} {b} {0.5 * (a * a + b * b)}" for a, b in zip(x.ravel(), y.ravel())]
    for i in range(8):
        for j in range(8):
            a, b, c, d = (1 + i * 9 + j, 1 + (i + 1) * 9 + j, 2 + (i + 1) * 9 + j, 2 + i * 9 + j)
            lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"]
    (tmp_path / "bowl.obj").write_text("\n".join(lines) + "\n")
    (tmp_path / "bowl.urdf").write_text(
        '<robot name="bowl"><link name="bowl"><inertial><mass value="0"/>'
        '<inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial>'
        '<collision concave="yes"><origin xyz="0 0 -0.1"/><geometry><mesh filename="bowl.obj" scale="1 1 2"/>'
        '</geometry></collision></link></robot>')
    p.setGravity(0, 0, -9.81, physicsClientId=client)
    body = p.loadURDF(str(tmp_path / "bowl.urdf"), (1, 2, 3), physicsClientId=client)
    world = ts.World(gravity=(0, 0, -9.81))
    mirror = tetskin.pybullet.Mirror(client, world)
    soft = world.add_body(*ball, position=(1, 2, 3.02))
    for _ in range(240):
        mirror.step()
    assert len(mirror.rigid_bodies(body)) == 1
    assert abs(soft.positions[:, 2].min() - 2.9) < 0.01


def test_triangles_that_pybullet_does_not_tell(client):
    shape = p.createCollisionShape(p.GEOM_MESH, fileName="duck.obj", flags=p.GEOM_FORCE_CONCAVE_TRIMESH,
                                   physicsClientId=client)
    body = p.createMultiBody(0, shape, physicsClientId=client)
    world = ts.World()
    assert "Shape.mesh" in failed("INVALID_OPTION", tetskin.pybullet.Mirror, client, world)
    assert tetskin.pybullet.Mirror(client, world, bodies=[]).bodies == ()
    assert world.rigid_bodies == [] and body == 0


def test_poses_follow_pybullet_in_each_step(client):
    p.setGravity(0, 0, -9.81, physicsClientId=client)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=(0.1, 0.2, 0.3), physicsClientId=client)
    body = p.createMultiBody(1, shape, -1, *TURNED, physicsClientId=client)
    p.resetBaseVelocity(body, (1, 2, 3), (3, 2, 1), physicsClientId=client)
    world = ts.World(gravity=(0, 0, 0))
    mirror = tetskin.pybullet.Mirror(client, world)
    for _ in range(20):
        mirror.step()
        position, rotation = p.getBasePositionAndOrientation(body, physicsClientId=client)
        rigid, = mirror.rigid_bodies(body)
        assert np.abs(rigid.position - position).max() < 1e-5
        assert abs(abs(rigid.rotation @ rotation) - 1) < 1e-5
        # Both have gone the same way in the step, at the same velocity.
        assert np.abs(rigid.velocity - p.getBaseVelocity(body, physicsClientId=client)[0]).max() < 0.01


def test_links_follow_pybullet_in_each_step(client):
    """Unless asked to compute them, pybullet returns poses of links from before its last step."""
    p.setGravity(0, 0, -9.81, physicsClientId=client)
    arm = p.loadURDF("franka_panda/panda.urdf", useFixedBase=True, physicsClientId=client)
    p.resetJointState(arm, 1, 1, physicsClientId=client)
    for joint in range(7):
        p.setJointMotorControl2(arm, joint, p.VELOCITY_CONTROL, force=0, physicsClientId=client)
    mirror = tetskin.pybullet.Mirror(client, ts.World(), bodies=[])
    mirror.add(arm, links=[6])
    rigid, = mirror.rigid_bodies(arm, 6)
    before = rigid.position
    for _ in range(60):
        mirror.step()
    # The frame of its file, in which the points of the hull are.
    state = p.getLinkState(arm, 6, computeForwardKinematics=1, physicsClientId=client)
    assert np.abs(rigid.position - before).max() > 0.1
    assert np.abs(rigid.position - state[4]).max() < 1e-4
    assert abs(abs(rigid.rotation @ state[5]) - 1) < 1e-5


# Forces.


@pytest.fixture(scope="module")
def slab():
    mesh = loose_coupling.slab((0.2, 0.2, 0.1))
    return ts.create_cage(mesh, target_tets=300), mesh


def test_the_force_on_a_box_at_rest_is_its_weight(slab):
    mesh, mass = slab[1], 3.0
    cage = ts.create_cage(mesh, target_tets=500)  # of the guide; a coarser one is near where boxes of 3 kg tremble
    measured = loose_coupling.rest(cage, mesh, mass, 1 / 240, "loose", seconds=3.0)
    together = loose_coupling.rest(cage, mesh, mass, 1 / 240, "strong", seconds=3.0)
    assert abs(measured["force"] - 1) < 0.002
    assert measured["ripple"] < 0.01
    assert measured["depth"] < 0.0002
    assert abs(measured["height"] - together["height"]) < 0.0005


def test_impulses_that_pybullet_is_given_are_those_that_the_soft_body_has(slab):
    measured = loose_coupling.hit(*slab, 3.0, 1 / 240, "loose")
    assert abs(measured["lost"]) < 0.005
    assert measured["speed"] > -0.9  # it has hit


def test_a_lever_is_held_by_moments(client, slab):
    """An arm, which turns about a joint, lies with a sphere at its end on the slab: half of its weight does."""
    p.setGravity(0, 0, -9.81, physicsClientId=client)
    mass, length = 6.0, 1.0
    sphere = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1, collisionFramePosition=(length, 0, 0),
                                    physicsClientId=client)
    arm = p.createMultiBody(0, -1, -1, basePosition=(-length, 0, 0.3), linkMasses=[mass],
                            linkCollisionShapeIndices=[sphere], linkVisualShapeIndices=[-1], linkPositions=[(0, 0, 0)],
                            linkOrientations=[(0, 0, 0, 1)], linkInertialFramePositions=[(length / 2, 0, 0)],
                            linkInertialFrameOrientations=[p.getQuaternionFromEuler((0.4, 0.2, 0.1))],
                            linkParentIndices=[0], linkJointTypes=[p.JOINT_REVOLUTE], linkJointAxis=[(0, 1, 0)],
                            physicsClientId=client)
    p.setJointMotorControl2(arm, 0, p.VELOCITY_CONTROL, force=0, physicsClientId=client)
    world = ts.World(gravity=(0, 0, -9.81))
    world.add_plane(normal=(0, 0, 1))
    world.add_body(*slab, mass=1.0, youngs_modulus=2e4, position=(0, 0, 0.1))
    mirror = tetskin.pybullet.Mirror(client, world)
    forces = []
    for step in range(960):
        mirror.step()
        if step >= 720:
            forces.append(mirror.force_on(arm, 0)[0])
    angle = p.getJointState(arm, 0, physicsClientId=client)[0]
    assert 0 < angle < 0.1
    # Only the moment about the joint is given: friction is along the arm, nearly through the joint.
    assert abs(np.mean(forces, 0)[2] / (0.5 * mass * 9.81) - 1) < 0.02
    assert np.array_equal(mirror.force_on(arm, -1)[0], np.zeros(3))


# Bodies that come and go.


def make_box(client, at=(0, 0, 1), mass=1, **options):
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=(0.1, 0.1, 0.1), physicsClientId=client)
    return p.createMultiBody(mass, shape, basePosition=at, physicsClientId=client, **options)


def test_bodies_come_and_go(client):
    first = make_box(client)
    world = ts.World()
    mirror = tetskin.pybullet.Mirror(client, world)
    second = make_box(client, (2, 0, 1))
    mirror.step()
    assert mirror.bodies == (first,) and len(world.rigid_bodies) == 1  # new bodies join only by add
    mirror.add(second)
    assert mirror.bodies == (first, second) and len(world.rigid_bodies) == 2
    assert "already" in failed("INVALID_OPTION", mirror.add, second)
    p.removeBody(first, physicsClientId=client)
    mirror.step()
    assert mirror.bodies == (second,) and len(world.rigid_bodies) == 1
    mirror.remove(second)
    mirror.remove(second)
    assert mirror.bodies == () and world.rigid_bodies == [] and mirror.rigid_bodies(second) == []
    mirror.step()


def test_a_teleported_body_takes_nothing_along(client, ball):
    speeds = []
    for teleported in (False, True):
        body = make_box(client, (0, 0, 0), mass=0)
        world = ts.World(gravity=(0, 0, 0))
        soft = world.add_body(*ball, position=(0.22, 0, 0))
        mirror = tetskin.pybullet.Mirror(client, world, bodies=[body])
        p.resetBasePositionAndOrientation(body, (0.04, 0, 0), (0, 0, 0, 1), physicsClientId=client)
        if teleported:
            mirror.teleport(body)
        mirror.step()
        assert np.abs(mirror.rigid_bodies(body)[0].position - (0.04, 0, 0)).max() < 1e-6
        speeds.append((mirror.rigid_bodies(body)[0].velocity[0], soft.velocities[:, 0].max()))
    (pushing, pushed), (still, let_be) = speeds
    assert pushing > 5 and still == 0 and let_be < 0.5 * pushed
    assert "not mirrored" in failed("NOT_ADDED", mirror.teleport, make_box(client))


def test_a_mirror_tells_what_is_wrong(client, cage, mesh):
    world = ts.World()
    box = make_box(client)
    mirror = tetskin.pybullet.Mirror(client, world)
    assert "no body 77" in failed("BODY_DELETED", mirror.add, 77)
    assert "no link 3" in failed("INDEX_OUT_OF_RANGE", mirror.add, make_box(client), links=[3])
    maximal = make_box(client, useMaximalCoordinates=True)
    assert "useMaximalCoordinates" in failed("INVALID_OPTION", mirror.add, maximal)
    assert "useMaximalCoordinates" in failed("INVALID_OPTION", tetskin.pybullet.Mirror, client, world)
    assert mirror.bodies == (box,) and len(world.rigid_bodies) == 1  # nothing is left of the failed call
    p.setRealTimeSimulation(1, physicsClientId=client)
    assert "setRealTimeSimulation" in failed("INVALID_OPTION", mirror.step)
    p.setRealTimeSimulation(0, physicsClientId=client)
    with pytest.raises(ValueError, match="substeps"):
        mirror.step(substeps=0)
    mirror.step()
    p.disconnect(client)
    assert "connect" in failed("NOT_ADDED", mirror.step)
    assert "connect" in failed("NOT_ADDED", tetskin.pybullet.Mirror, client, world)


def test_soft_bodies_of_pybullet_are_not_mirrored(soft_client, cage, mesh):
    body, _ = tetskin.pybullet.load_soft_body(cage, mesh, client=soft_client, **MATERIAL)
    mirror = tetskin.pybullet.Mirror(soft_client, ts.World())
    assert mirror.bodies == (0,)  # the ground
    assert "soft" in failed("INVALID_OPTION", mirror.add, body)


def test_without_pybullet_the_cure_is_named(monkeypatch, cage, mesh):
    monkeypatch.setitem(sys.modules, "pybullet", None)
    with pytest.raises(ImportError, match="pip install pybullet"):
        tetskin.pybullet.Mirror(0, ts.World())


# Two Bullets in one process.


BOTH = """
import hashlib, os, sys
sys.path.insert(0, {tests!r})
if {shared!r}: sys.setdlopenflags(os.RTLD_NOW | os.RTLD_GLOBAL)
if {first!r} == "pybullet":
    import pybullet as p
    import tetskin as ts
else:
    import tetskin as ts
    import pybullet as p
import numpy as np
import tetskin.pybullet
from conftest import torus
mesh = ts.TriangleMesh(*torus())
cage = ts.create_cage(mesh, target_tets=200)
world = ts.World()
world.add_plane()
body = world.add_body(cage, mesh, position=(0, 0.5, 0))
client = p.connect(p.DIRECT)
p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
p.setGravity(0, -10, 0)
p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE, planeNormal=(0, 1, 0)))
_, skin = tetskin.pybullet.load_soft_body(cage, mesh, basePosition=(0, 0.7, 0), **{material!r})
for _ in range(60):
    p.stepSimulation()
    world.step(1 / 240, substeps=1)
skin.update()
assert np.isfinite(skin.positions).all()
print("hashes", *[hashlib.sha256(np.array(x).tobytes()).hexdigest() for x in (body.positions, skin.positions)])
"""


def test_both_orders_of_import_give_the_same_bits(tmp_path):
    hashes = set()
    for first in ("pybullet", "tetskin"):
        for shared in (False, True):
            program = BOTH.format(tests=str(Path(__file__).parents[1]), shared=shared, first=first, material=MATERIAL)
            done = subprocess.run([sys.executable, "-B", "-c", program], capture_output=True, text=True, cwd=tmp_path)
            assert done.returncode == 0, done.stderr
            hashes.add(re.search(r"hashes (\w+) (\w+)", done.stdout).groups())
    assert len(hashes) == 1


# The page and the demos.


def test_the_programs_of_the_page_run_as_written(tmp_path, monkeypatch):
    text = (REPOSITORY / "plugin/docs/pybullet.md").read_text()
    programs = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    mesh = loose_coupling.slab((0.2, 0.2, 0.1))
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(mesh.positions, float).tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in mesh.triangles.tolist()]
    (tmp_path / "cushion.obj").write_text("\n".join(lines) + "\n")
    monkeypatch.chdir(tmp_path)
    names = {}
    clients = []
    connect = p.connect
    monkeypatch.setattr(p, "connect", lambda *arguments: clients.append(connect(*arguments)) or clients[-1])
    try:
        for program in programs:
            exec(program, names)
    finally:
        for one in clients:
            p.disconnect(one)
    # The page's claims about its first program.
    assert abs(names["on_box"][2] - 29.4) < 0.1 and abs(names["on_ground"][2] + 39.2) < 0.1
    assert names["skin"].positions.shape == (len(mesh.positions), 3)


def run_demo(name, folder, *arguments):
    pytest.importorskip("trimesh")
    pytest.importorskip("matplotlib")
    command = [sys.executable, "-B", str(REPOSITORY / "demos/examples/python" / name), "--quick", "--output", "out", *arguments]
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, timeout=500)


def test_a_gripper_lifts_a_ball(tmp_path):
    done = run_demo("gripper_of_pybullet.py", tmp_path)
    assert done.returncode == 0, done.stderr
    assert "held" in done.stdout and len(list((tmp_path / "out").glob("*.png"))) == 5


def test_a_gripper_that_is_too_weak_lifts_no_ball(tmp_path):
    done = run_demo("gripper_of_pybullet.py", tmp_path, "--force", "0.2")
    assert done.returncode == 1 and "has not been lifted" in done.stderr


def test_a_torus_of_pybullet_has_a_fine_surface(tmp_path):
    done = run_demo("torus_of_pybullet.py", tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out/torus.obj").is_file()
