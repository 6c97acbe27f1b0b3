# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""What one world has: shapes, joints, bodies, contacts, touch, snapshots, runs, animations."""

import json
import struct

import numpy as np
import pytest

import tetskin as ts


def settle(world, frames=60):
    for _ in range(frames):
        world.step()


HULL = [(x, y, z) for x in (-0.3, 0.3) for y in (-0.3, 0.3) for z in (-0.3, 0.3)]
SHAPES = {
    "box": ts.Shape.box((0.3, 0.3, 0.3)),
    "sphere": ts.Shape.sphere(0.3),
    "capsule": ts.Shape.capsule(0.3, 0.01),
    "cylinder": ts.Shape.cylinder(0.3, 0.6),
    "hull": ts.Shape.convex_hull(HULL),
    "compound": ts.Shape.compound([(ts.Shape.box((0.3, 0.3, 0.15)), (0, 0, z), (0, 0, 0, 1)) for z in (-0.15, 0.15)]),
}


@pytest.mark.parametrize("name", SHAPES)
def test_shapes_land_on_the_ground(name):
    world = ts.World()
    world.add_plane()
    body = world.add_rigid_body(SHAPES[name], mass=2, position=(1, 0.35, 0))
    settle(world, 120)
    assert body.position == pytest.approx([1, 0.3, 0], abs=0.02) and body.mass == 2
    assert np.linalg.norm(body.rotation) == pytest.approx(1, abs=1e-5)


def test_a_body_rests_on_a_mesh(mesh, cage):
    world = ts.World()
    ground = ts.TriangleMesh([[-5, 0, -5], [5, 0, -5], [5, 0, 5], [-5, 0, 5.0]], [[0, 2, 1], [0, 3, 2]])
    world.add_rigid_body(ts.Shape.mesh(ground))
    body = world.add_body(cage, mesh, position=(0, 0.4, 0))
    settle(world, 120)
    assert -0.01 < body.positions[:, 1].min() < 0.02


def test_rigid_bodies_are_moved():
    world = ts.World(gravity=(0, 0, 0))
    body = world.add_sphere(0.1, mass=1)
    body.velocity, body.angular_velocity = (1, 0, 0), (0, 1, 0)
    settle(world)
    assert body.position == pytest.approx([1, 0, 0], abs=0.02)
    body.position, body.rotation = (0, 5, 0), (0, 0, 2, 0)
    assert body.position.tolist() == [0, 5, 0] and np.abs(body.rotation).tolist() == [0, 0, 1, 0]
    body.apply_impulse((0, 2, 0))
    assert body.velocity[1] == pytest.approx(2)
    body.mass = 4
    assert body.mass == 4
    lift = world.add_box((1, 0.1, 1), position=(0, -3, 0), kinematic=True)
    for frame in range(10):
        lift.position = (0, -3 + 0.1 * (frame + 1), 0)
        world.step()
    assert lift.position[1] == pytest.approx(-2) and lift.kinematic
    world.gravity = (0, -1, 0)
    assert world.gravity.tolist() == [0, -1, 0]


def test_joints_hold_and_drive():
    world = ts.World(gravity=(0, 0, 0))
    arm = world.add_box((0.5, 0.05, 0.05), mass=1, position=(0.5, 0, 0))
    hinge = world.add_hinge(arm, pivot=(0, 0, 0), axis=(0, 0, 1))
    hinge.set_motor(1.0, 100.0)
    settle(world)
    assert hinge.coordinate == pytest.approx(1, abs=0.05)
    assert arm.position == pytest.approx([0.5 * np.cos(1), 0.5 * np.sin(1), 0], abs=0.05)
    hinge.set_motor(None, 0)
    hinge.set_limits((0, 0.2))
    finger = world.add_box((0.1, 0.1, 0.1), mass=1, position=(0, 2, 0))
    slider = world.add_slider(finger, axis=(1, 0, 0), limits=(0, 0.5))
    slider.set_motor(1.0, 100.0)
    settle(world, 120)
    assert slider.coordinate == pytest.approx(0.5, abs=0.02) and finger.position == pytest.approx([0.5, 2, 0], abs=0.02)
    world.gravity = (0, -9.81, 0)
    held = world.add_sphere(0.1, mass=1, position=(5, 0, 0))
    world.add_point_joint(held, pivot=(5, 0, 0))
    other = world.add_sphere(0.1, mass=1, position=(5.5, 0, 0))
    fixed = world.add_fixed_joint(other, held)
    settle(world, 10)
    assert np.linalg.norm(other.position - held.position) == pytest.approx(0.5, abs=0.02)
    fixed.remove()
    fixed.remove()
    settle(world)
    assert other.position[1] < -2 and held.position == pytest.approx([5, 0, 0], abs=0.02)


def test_pins_are_masks_and_move(mesh, cage):
    held = cage.nodes[:, 0] < -1
    world = ts.World()
    body = world.add_body(cage, mesh, pinned=held)
    assert np.array_equal(body.pinned, held)
    settle(world, 20)
    assert (
        np.abs(body.nodes[held] - cage.nodes[held]).max() < 1e-6
        and body.nodes[:, 1].min() < cage.nodes[:, 1].min() - 0.05
    )
    body.set_pinned_positions(held, cage.nodes[held] + [0, 0.1, 0])
    world.step()
    assert np.abs(body.nodes[held] - cage.nodes[held] - [0, 0.1, 0]).max() < 1e-5
    body.set_pinned(np.flatnonzero(held), False)
    assert not body.pinned.any()


def test_materials_are_read_and_set(mesh, cage):
    world = ts.World()
    body = world.add_body(
        cage, mesh, mass=3, youngs_modulus=2e4, poisson_ratio=0.2, stiffness_damping=0.01, friction=0.9
    )
    assert body.mass == pytest.approx(3) and body.youngs_modulus == 2e4 and body.poisson_ratio == 0.2
    assert body.friction == pytest.approx(0.9) and body.stiffness_damping == 0.01
    body.youngs_modulus, body.poisson_ratio, body.stiffness_damping, body.friction = 1e5, 0.4, 0.0, 0.1
    assert (body.youngs_modulus, body.poisson_ratio, body.stiffness_damping) == (
        1e5,
        0.4,
        0.0,
    ) and body.relative_stiffness > 0
    body.set_gravity((0, 0, 0))
    settle(world, 10)
    assert np.abs(body.nodes - cage.nodes).max() < 1e-3
    body.velocities = np.broadcast_to([0.0, 0.0, 1.0], cage.nodes.shape)
    settle(world, 30)
    assert body.nodes[:, 2].mean() - cage.nodes[:, 2].mean() == pytest.approx(0.5, abs=0.01)
    body.transform((0, 10, 0))
    assert body.positions[:, 1].min() > 9
    assert body.bounds[0][1] > 9 and not body.asleep


def test_a_body_is_placed_and_turned(mesh, cage):
    body = ts.World().add_body(cage, mesh, position=(1, 2, 3), rotation=(0, 0, np.sqrt(0.5), np.sqrt(0.5)))
    x, y, z = mesh.positions.T
    assert np.abs(body.positions - np.stack([1 - y, 2 + x, 3 + z], -1)).max() < 1e-5


def test_contacts_and_forces_carry_the_weight(dropped):
    world, body = dropped
    ground = world.rigid_bodies[0]
    settle(world, 240)
    contacts = world.contacts(body)
    weight = 9.81 * body.mass
    assert len(contacts) > 0 and set(contacts.bodies) == {ground}
    assert contacts.normals[:, 1].min() == 1 and contacts.points[:, 1].max() < 0.1
    force = world.forces_on(body).total.force
    if not body.asleep:
        assert contacts.impulses[:, 1].sum() * 240 == pytest.approx(weight, rel=0.1)
    assert force[1] == pytest.approx(weight, rel=0.05)
    assert world.forces_on(ground, body).contact.force[1] == pytest.approx(-force[1], rel=1e-3)


def test_soft_bodies_meet(mesh, cage):
    world = ts.World()
    world.add_plane()
    low = world.add_body(cage, mesh, position=(0, 0.4, 0), soft_contact=True)
    high = world.add_body(cage, mesh, position=(0, 1.2, 0), soft_contact=True, self_contact=True)
    settle(world, 90)
    assert high.positions[:, 1].mean() > low.positions[:, 1].mean() + 0.3
    contacts = world.soft_contacts
    assert len(contacts) > 0 and {high, low} == set(contacts.bodies[0])
    assert world.forces_on(high, low).contact.force[1] > 0


def test_rays_points_springs_and_welds(mesh, cage):
    world = ts.World(gravity=(0, 0, 0))
    body = world.add_body(cage, mesh)
    hit = world.raycast((1, 5, 0), (1, -5, 0))
    assert (
        hit.body == body
        and hit.point == pytest.approx([1, 0.35, 0], abs=0.02)
        and hit.distance == pytest.approx(4.65, abs=0.02)
    )
    assert hit.weights.sum() == pytest.approx(1) and hit.normal[1] > 0.9
    assert world.raycast((0, 5, 0), (0, -5, 0)) is None and world.raycast_body(body, (0, 5, 0), (0, -5, 0)) is None
    point = world.point_at(hit)
    assert point.position == pytest.approx(hit.point, abs=1e-4) and point.normal[1] > 0.9 and point.effective_mass > 0
    assert world.point_at_rest(body, (1, 2, 0)).position == pytest.approx([1, 0.35, 0], abs=0.02)
    spring = world.add_spring(point, stiffness=100)
    spring.set_target(point.position + [0, 0.5, 0])
    settle(world, 30)
    assert spring.force[1] != 0 and spring.stretch < 0.3 and body.positions[:, 1].mean() > 0.05
    spring.release()
    point.apply_impulse((0, 0, 0.1))
    point.apply_force((0, 0, 0.1), 2)
    pushed = body.apply_radial_impulse(body.positions[0], 0.2, 0.01)
    assert pushed.vertices > 0 and np.linalg.norm(pushed.linear) > 0
    sword = world.add_box((0.05, 0.3, 0.05), mass=0.1, position=world.point_at_vertex(body, 0).position)
    weld = world.add_weld(world.point_at_vertex(body, 0), sword)
    settle(world, 10)
    assert weld.separation < 0.02 and weld.angle < 0.2


def scene(mesh, cage):
    world = ts.World()
    world.add_plane()
    body = world.add_body(cage, mesh, position=(0, 0.5, 0))
    box = world.add_box((0.2, 0.2, 0.2), mass=1, position=(0, 1.4, 0))
    world.add_point_joint(box, pivot=(1, 1.4, 0))
    return world, body, box


def test_a_snapshot_goes_on_in_another_world_to_the_bit(mesh, cage):
    world, body, box = scene(mesh, cage)
    settle(world, 30)
    snapshot = world.save()
    assert isinstance(snapshot, bytes)
    at = body.positions.copy()
    settle(world, 30)
    end = body.positions.copy(), box.position
    world.restore(snapshot)
    assert np.array_equal(body.positions, at)
    other, twin, twin_box = scene(mesh, cage)
    other.restore(snapshot)
    settle(other, 30)
    assert np.array_equal(twin.positions, end[0]) and np.array_equal(twin_box.position, end[1])


def test_a_run_is_recorded_and_played_again(mesh, cage, tmp_path):
    world, body, box = scene(mesh, cage)
    with ts.Recorder(world, tmp_path / "run.replay", description="a drop") as recorder:
        for frame in range(20):
            if frame == 10:
                box.apply_impulse((0, 3, 0))
            recorder.step()
        assert recorder.steps == 20
    with pytest.raises(ts.Error):
        recorder.step()
    end = body.positions.copy()
    assert ts.Replay.description_of(tmp_path / "run.replay") == "a drop"
    other, twin, _ = scene(mesh, cage)
    replay = ts.Replay(other, tmp_path / "run.replay")
    while replay.step():
        pass
    assert replay.steps == 20 and not replay.differs and not replay.cut_short
    assert np.array_equal(twin.positions, end)


def test_changes_of_a_world_are_made_again(mesh, cage, tmp_path):
    world, _, box = scene(mesh, cage)
    recorder = ts.Recorder(world, tmp_path / "run.replay")
    recorder.step()
    box.remove()
    recorder.step()
    recorder.close()
    other, _, twin = scene(mesh, cage)
    replay = ts.Replay(other, tmp_path / "run.replay")
    replay.on_change(lambda step: twin.remove())
    assert replay.step() and replay.step() and not replay.step() and twin.removed
    failing = ts.Replay(scene(mesh, cage)[0], tmp_path / "run.replay")

    def fail(step):
        raise KeyError(step)

    failing.on_change(fail)
    failing.step()
    with pytest.raises(KeyError):
        failing.step()


def test_a_run_is_written_as_glb(mesh, cage, tmp_path):
    world, body, box = scene(mesh, cage)
    with ts.GlbWriter(tmp_path / "run.glb", 30) as glb:
        glb.add_body(body, "torus")
        glb.add_object(mesh, box, "box")
        glb.add_object(mesh)
        for _ in range(5):
            world.step(1 / 30)
            glb.add_frame()
    data = (tmp_path / "run.glb").read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    document = json.loads(data[20 : 20 + length])
    assert len(document["animations"]) == 1 and {"torus", "box"} <= {node.get("name") for node in document["nodes"]}
    with pytest.raises(ts.Error):
        glb.add_frame()
    assert ts.load_mesh(tmp_path / "run.glb").vertex_count > 0


def test_a_hidden_surface_is_not_updated(dropped):
    world, body = dropped
    body.visible = False
    before = body.positions.copy()
    settle(world, 5)
    assert np.array_equal(body.positions, before) and not body.visible
    body.visible = True
    world.step()
    assert not np.array_equal(body.positions, before)
