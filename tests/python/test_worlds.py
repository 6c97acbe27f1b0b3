# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The features of one world: shapes, joints, bodies, contacts, touch, snapshots, runs, animations."""

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


def test_pressure_and_gas_fill_a_body(mesh, cage):
    world = ts.World(gravity=(0, 0, 0))
    body = world.add_body(cage, mesh, youngs_modulus=2e5, stiffness_damping=0.1)
    before = body.volume
    assert body.pressure == 0 and before > 0
    body.pressure = 1e4
    settle(world, 30)
    assert body.pressure == 1e4 and body.volume > 1.02 * before
    body.pressure = 0
    settle(world, 60)
    body.set_gas(pressure=2e4)
    amount = body.pressure * body.volume
    saved = world.save()
    settle(world, 60)
    assert body.volume > 1.02 * before and body.pressure * body.volume == pytest.approx(amount, rel=1e-4)
    world.restore(saved)
    assert body.pressure == pytest.approx(2e4, rel=1e-5)
    body.set_gas(1e3, outside=101325)
    assert body.pressure == pytest.approx(1e3, rel=1e-3)
    body.set_gas(0)
    assert body.pressure == 0


def volume_of(positions, triangles):
    a, b, c = (np.asarray(positions)[np.asarray(triangles)[:, k]] for k in range(3))
    return abs(np.einsum("ij,ij", a, np.cross(b, c))) / 6


def test_the_surface_under_pressure_is_the_visible_one_another_one_or_that_of_the_tets(mesh, cage):
    body = ts.World(gravity=(0, 0, 0)).add_body(cage, mesh)
    visible = volume_of(mesh.positions, mesh.triangles)
    assert body.volume == pytest.approx(visible, rel=1e-5)
    middle = np.asarray(mesh.positions) * (1, 0, 1)
    middle /= np.linalg.norm(middle, axis=1)[:, None]
    inner = ts.TriangleMesh(0.5 * (middle + mesh.positions), mesh.triangles)  # of half the tube's radius
    body.set_gas(100)
    body.set_pressure_surface(inner)
    assert body.volume == pytest.approx(volume_of(inner.positions, inner.triangles), rel=1e-5)
    assert body.pressure == pytest.approx(100, rel=1e-6)
    body.set_pressure_surface(None)
    boundary = body.volume
    assert abs(boundary / visible - 1) > 1e-3  # the tets reach a little beyond the surface, or not as far
    body.set_pressure_surface(mesh)
    assert body.volume == pytest.approx(visible, rel=1e-5)
    with pytest.raises(ts.Error, match="not closed"):
        body.set_pressure_surface(ts.TriangleMesh(mesh.positions, mesh.triangles[1:]))
    with pytest.raises(TypeError):
        body.set_pressure_surface()
    assert body.volume == pytest.approx(visible, rel=1e-5)


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


def motion(world, body, rigid):
    return [body.nodes.copy(), body.velocities.copy(), rigid.position, rigid.rotation, rigid.velocity]


def test_no_time_passes_in_a_step_of_none(mesh, cage, tmp_path):
    world, body, box = scene(mesh, cage)
    settle(world, 3)
    body.apply_radial_impulse((0, 0, 0), 9, 5)
    point = world.point_at_vertex(body, 0)
    point.apply_force((0, 3, 0), 4)
    before, state = motion(world, body, box), world.save()
    assert world.step(0) == 0 and world.step(0.0, substeps=9) == 0
    assert all(np.array_equal(*pair) for pair in zip(before, motion(world, body, box))) and world.save() == state
    with ts.Recorder(world, tmp_path / "run") as recorder:
        assert [recorder.step(dt) for dt in (1 / 60, 0, 1 / 60)] == [4, 0, 4] and recorder.steps == 2
    replay = ts.Replay(world, tmp_path / "run")
    while replay.step():
        pass
    assert replay.steps == 2 and not replay.differs
    elastic = ts.ElasticBody(cage)
    elastic.velocities = np.ones_like(cage.nodes)
    assert elastic.step(0) == 0 and np.array_equal(elastic.positions, cage.nodes)


def driven():
    """An arm that a motor turns, with hardly more torque than needed."""
    world = ts.World(gravity=(0, 0, 0))
    arm = world.add_box((0.5, 0.05, 0.05), mass=1, position=(0.5, 0, 0))
    hinge = world.add_hinge(arm, pivot=(0, 0, 0), axis=(0, 0, 1))
    finger = world.add_box((0.1, 0.1, 0.1), mass=1, position=(0, 2, 0))
    slider = world.add_slider(finger, axis=(1, 0, 0))
    return world, hinge, slider


def turned(world, hinge, slider, frames=30):
    settle(world, frames)
    return hinge.coordinate, slider.coordinate


def test_the_limits_of_motors_are_in_snapshots(tmp_path):
    world, hinge, slider = driven()
    hinge.set_motor(2.0, 0.5)
    slider.set_motor(2.0, 0.5)
    untouched = world.save()
    with ts.Recorder(world, tmp_path / "run") as recorder:
        for _ in range(5):
            recorder.step()
    settle(world, 5)
    snapshot = world.save()
    expected = turned(world, hinge, slider)
    assert 0.1 < expected[0] < 0.9 and 0.01 < expected[1] < 0.9  # they lag behind
    hinge.set_motor(0.0, 0.0)
    slider.set_motor(0.0, 0.0)
    world.restore(snapshot)
    assert turned(world, hinge, slider) == expected
    other, other_hinge, other_slider = driven()
    other.restore(snapshot)
    assert turned(other, other_hinge, other_slider) == expected
    for taken in (untouched, None):  # before any step, and after those of a file
        other, other_hinge, other_slider = driven()
        if taken:
            other.restore(taken)
            settle(other, 5)
        else:
            replay = ts.Replay(other, tmp_path / "run")
            while replay.step():
                pass
            assert replay.steps == 5 and not replay.differs
        settle(other, 5)
        assert turned(other, other_hinge, other_slider) == pytest.approx(expected, rel=1e-5)


def test_a_motors_limit_is_a_torque_whatever_the_steps():
    ends = []
    for dt, substeps in ((1 / 60, 1), (1 / 60, 8), (1 / 240, 1)):
        world, hinge, slider = driven()
        hinge.set_motor(50.0, 0.5)
        for _ in range(round(0.5 / dt)):
            world.step(dt, substeps=substeps)
        ends.append(hinge.coordinate)
    # Inertia of the arm about its end: (1 + 0.01) / 12 + 0.25.
    assert ends == pytest.approx([0.5 * 0.5 / (1.01 / 12 + 0.25) * 0.5**2] * 3, rel=0.05)


@pytest.mark.parametrize("surface", ["seen", "hidden", "none"])
def test_a_body_that_is_not_finite_is_told_whatever_is_seen_of_it(mesh, cage, surface):
    world = ts.World(gravity=(0, 0, 0))
    world.add_body(cage, mesh, position=(9, 9, 9))
    body = world.add_body(cage, None if surface == "none" else mesh, visible=surface != "hidden")
    world.step()
    snapshot = world.save()
    for _ in range(2):
        body.transform((1e18, 0, 0))  # further than what counts as finite
    with pytest.raises(ts.Error, match="body 1 .*not finite") as error:
        world.step()
    assert error.value.code == ts.StatusCode.NON_FINITE
    world.restore(snapshot)
    world.step()
    assert np.isfinite(body.nodes).all()


@pytest.mark.parametrize("within", ["World.step", "Recorder.step", "Replay.step", "World.restore", "Replay"])
def test_no_step_is_made_within_a_step(mesh, cage, tmp_path, within):
    world, _, box = scene(mesh, cage)
    snapshot = world.save()
    with ts.Recorder(world, tmp_path / "run") as recorder:
        recorder.step()
        box.remove()
        recorder.step()
    other, body, twin = scene(mesh, cage)
    replay = ts.Replay(other, tmp_path / "run")
    calls = {
        "World.step": other.step,
        "Recorder.step": lambda: ts.Recorder(other, tmp_path / "other").step(),
        "Replay.step": replay.step,
        "World.restore": lambda: other.restore(snapshot),
        "Replay": lambda: ts.Replay(other, tmp_path / "run"),
    }
    told = []

    def change(step):
        told.append(step)
        with pytest.raises(ts.Error, match="within a step") as error:
            calls[within]()
        assert error.value.code == ts.StatusCode.INVALID_OPTION
        twin.remove()

    replay.on_change(change)
    assert replay.step() and replay.step() and not replay.step() and told == [1]
    assert not replay.differs
    other.step()


def test_what_a_replay_calls_may_be_replaced_by_itself(mesh, cage, tmp_path):
    world, _, box = scene(mesh, cage)
    with ts.Recorder(world, tmp_path / "run") as recorder:
        recorder.step()
        box.remove()
        recorder.step()
    other, _, twin = scene(mesh, cage)
    replay = ts.Replay(other, tmp_path / "run")

    def change(step):
        replay.on_change(print)
        twin.remove()

    replay.on_change(change)
    del change
    assert replay.step() and replay.step() and not replay.differs


def test_pins_let_go_of_a_body_that_flies_on(mesh, cage):
    """Held at its top and led upwards for two seconds, then let go."""
    world = ts.World()
    body = world.add_body(cage, mesh, density=1000, youngs_modulus=2e5)
    free_mass = body.mass
    top = cage.nodes[:, 1] > 0.1
    at, masses = cage.nodes[top], cage.masses / cage.masses.sum()
    body.set_pinned(top)
    assert body.mass < free_mass
    for frame in range(120):
        body.set_pinned_positions(top, at + [0, 0.5 * (frame + 1) / 60, 0])
        world.step()

    def flight():
        body.set_pinned(top, False)
        assert not body.pinned.any() and body.mass == pytest.approx(free_mass, rel=1e-6)
        start, speed = masses @ body.nodes, masses @ body.velocities
        settle(world, 18)
        assert np.linalg.norm(body.velocities, axis=1).min() > 0.1  # none is at rest
        return start, speed, masses @ body.nodes

    snapshot = world.save()
    first = flight()
    start, speed, end = first
    t, fall, half_substep = 0.3, 0.5 * 9.81 * 0.3**2, 1 / 480  # speeds are those at the middle of a substep
    assert end[1] - start[1] == pytest.approx((speed[1] - 9.81 * half_substep) * t - fall, abs=0.001 * fall)
    world.restore(snapshot)
    assert np.array_equal(body.pinned, top)
    assert all(np.array_equal(*pair) for pair in zip(first, flight()))


def test_a_weld_does_not_outlive_its_rigid_body(mesh, cage):
    def hanging():
        world = ts.World()
        body = world.add_body(cage, mesh, pinned=cage.nodes[:, 1] > 0.25, youngs_modulus=2e4, density=300)
        return world, body

    plain, alone = hanging()
    world, body = hanging()
    point = world.point_at_rest(body, (0, -0.35, 1))
    sphere = world.add_sphere(0.1, mass=0.5, position=point.position - [0, 0.1, 0])
    weld = world.add_weld(point, sphere)
    settle(world, 30)
    snapshot = world.save()
    assert not weld.released
    sphere.remove()
    assert weld.released
    other = world.add_sphere(0.1, mass=0.5, position=(1, -2, 1))
    with pytest.raises(ts.Error) as error:
        world.restore(snapshot)
    assert error.value.code == ts.StatusCode.SNAPSHOT_MISMATCH
    settle(world, 30)
    dt, steps = 1 / 240, 120  # Bullet's fall by steps
    assert other.position[1] == pytest.approx(-2 - 9.81 * dt**2 * steps * (steps + 1) / 2, abs=1e-4)
    settle(world, 400)
    settle(plain, 460)
    sag = cage.nodes[:, 1].min() - alone.nodes[:, 1].min()
    assert np.abs(body.nodes - alone.nodes).max() < 1e-3 * abs(sag) + 1e-5


def test_what_things_are_is_said(mesh, cage, tmp_path):
    world, body, box = scene(mesh, cage)
    point = world.point_at_vertex(body, 0)
    spring, weld = world.add_spring(point), world.add_weld(point, box)
    hinge = world.add_hinge(box, pivot=(0, 0, 0), axis=(0, 0, 1))
    world.step()
    recorder = ts.Recorder(world, tmp_path / "run")
    recorder.step()
    tets = f"{cage.tet_count} tets"
    words = {
        mesh: "TriangleMesh: 800 vertices, 1600 triangles",
        cage: f"Cage: {tets}, {cage.node_count} nodes",
        ts.calibrate(cage): f"Cage: {tets}, {cage.node_count} nodes, calibrated",
        ts.refine_quadratic(cage): "nodes, quadratic",
        world: "World: 1 soft body, 2 rigid bodies",
        body: f"Body: {tets}, 800 vertices",
        ts.World().add_body(cage): f"Body: {tets}, no surface",
        box: "RigidBody: Box at (",
        ts.Shape.sphere(1): "Shape: SPHERE",
        hinge: "Joint: hinge",
        point: "SurfacePoint: at (",
        spring: "Spring: holds",
        weld: "Weld: holds",
        world.raycast((1, 5, 0), (1, -5, 0)): "Hit: triangle ",
        world.contacts(body): "Contacts: ",
        world.forces_on(body): "AppliedForces: total force (",
        world.forces_on(body).total: "Wrench: force (",
        body.apply_radial_impulse((0, 0, 0), 9, 1): "ImpulseResult: 800 vertices, linear (",
        recorder: "Recorder: 1 step",
        ts.Skin(cage, mesh): "Skin: 800 vertices",
        ts.BonePalette(cage, mesh): f"BonePalette: {cage.node_count} bones",
        ts.ElasticBody(cage): f"ElasticBody: {cage.node_count} nodes",
        ts.GlbWriter(tmp_path / "run.glb"): "GlbWriter: 0 frames",
        ts.Film(world): "Film: 0 frames",
    }
    for thing, said in words.items():
        assert repr(thing).startswith("<tetskin.") and said in repr(thing) and str(thing) == repr(thing)
    recorder.close()
    assert repr(ts.Replay(world, tmp_path / "run")) == "<tetskin.Replay: 0 steps played>"
    box.remove()
    body.remove()
    for thing, said in {recorder: "closed", body: "removed", box: "removed", hinge: "removed", weld: "released"}.items():
        assert repr(thing).endswith(f": {said}>")
    assert repr(point) == "<tetskin.SurfacePoint: of a body that has been removed>"


def four(mesh, cage):
    world = ts.World()
    world.add_plane()
    places = [(4 * k, 0.8 + 0.1 * k, 0) for k in range(4)]
    return world, [world.add_body(cage, mesh, position=place, youngs_modulus=3e4) for place in places]


def test_one_body_of_several_goes_back_to_its_start(mesh, cage):
    """Like an environment that ends while others continue."""
    world, bodies = four(mesh, cage)
    plain, others = four(mesh, cage)
    fall = []
    for _ in range(60):
        world.step()
        fall.append(bodies[2].nodes.copy())
    bodies[2].reset()
    assert np.abs(bodies[2].nodes - cage.nodes - [8, 1, 0]).max() < 1e-6 and not bodies[2].velocities.any()
    assert np.abs(bodies[2].positions - mesh.positions - [8, 1, 0]).max() < 1e-5 and not bodies[2].asleep
    for before in fall:
        world.step()
        assert np.abs(bodies[2].nodes - before).max() < 1e-6
    settle(plain, 120)
    for k in (0, 1, 3):
        assert np.array_equal(bodies[k].nodes, others[k].nodes) and np.array_equal(
            bodies[k].positions, others[k].positions
        )
    bodies[2].remove()
    with pytest.raises(ts.Error) as error:
        bodies[2].reset()
    assert error.value.code == ts.StatusCode.BODY_DELETED


def test_restitution_is_read_and_set(mesh, cage):
    world = ts.World()
    body, ball = world.add_body(cage, mesh, restitution=0.75), world.add_sphere(0.1, mass=1)
    assert body.restitution == 0.75 and world.add_body(cage).restitution == 0 and ball.restitution == 0
    for restitution in (0.25, 1.0, 0.0):
        body.restitution = ball.restitution = restitution
        assert body.restitution == restitution and ball.restitution == restitution


def test_a_reset_body_keeps_what_was_set(mesh, cage):
    world = ts.World()
    body = world.add_body(cage, mesh)
    body.set_pinned([0, 1])
    body.youngs_modulus, body.friction = 1234.0, 0.25
    settle(world, 10)
    body.reset()
    assert body.pinned.sum() == 2 and body.youngs_modulus == 1234 and body.friction == 0.25
    settle(world, 10)
    assert np.abs(body.nodes[:2] - cage.nodes[:2]).max() < 1e-6


def test_a_body_is_placed_in_its_motion(mesh, cage):
    """Velocities turn along, and nothing shakes."""
    ends = []
    quarter = (0, np.sqrt(0.5), 0, np.sqrt(0.5))
    for placed in (False, True):
        world = ts.World(gravity=(0, 0, 0))
        body = world.add_body(cage, mesh)
        body.velocities = cage.nodes[:, [1, 0, 2]] * [1, -1, 0] + [0, 0, 1.0]
        settle(world, 20)
        if placed:
            body.transform((5, 0, 0), quarter)
        settle(world, 20)
        ends.append(body.nodes.copy())
    x, y, z = ends[0].T
    assert np.abs(ends[1] - np.stack([z + 5, y, -x], -1)).max() < 1e-4


def test_a_worlds_origin_is_shifted(mesh, cage):
    ends = []
    for shifted in (False, True):
        world, body, box = scene(mesh, cage)
        spring = world.add_spring(world.point_at_vertex(body, 0), stiffness=20)
        settle(world, 20)
        if shifted:
            world.shift_origin((1024, 0, -1024))
            assert np.abs(body.positions[:, 0].mean() + 1024) < 2
        settle(world, 20)
        ends.append([body.nodes - np.float32([-1024, 0, 1024]) * shifted, box.position, spring.stretch])
    assert np.abs(ends[1][0] - ends[0][0]).max() < 2e-3
    # It has hit the body, a kilometre from the origin: rounding of its place changes where it is sent.
    assert ends[1][1] - ends[0][1] == pytest.approx([-1024, 0, 1024], abs=2e-2)
    assert ends[1][2] == pytest.approx(ends[0][2], abs=2e-3)
