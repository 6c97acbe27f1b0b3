# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Nothing dangles, whatever Python lets go of first; nothing leaks."""

import gc
import sys
import threading
import weakref

import numpy as np
import pytest

import tetskin as ts


def test_views_are_read_only_and_not_copies(dropped):
    _, body = dropped
    for name in ("positions", "normals", "nodes", "velocities"):
        view = getattr(body, name)
        assert not view.flags.writeable and view.dtype == np.float32 and view.shape[1] == 3
        assert np.shares_memory(view, getattr(body, name))
        with pytest.raises(ValueError):
            view[0] = 0


def test_each_view_has_a_shape_of_its_own(dropped, mesh, cage):
    skin = ts.Skin(cage, mesh)
    for owner in (dropped[1], skin):
        view = owner.positions
        view.shape = (-1,)
        assert owner.positions.shape == (mesh.vertex_count, 3)
        assert np.shares_memory(view, owner.positions)


def test_views_follow_the_steps(dropped):
    world, body = dropped
    positions, nodes = body.positions, body.nodes
    before = positions.copy(), nodes.copy()
    world.step()
    assert (positions[:, 1] < before[0][:, 1]).all() and (nodes[:, 1] < before[1][:, 1]).all()


def test_views_outlive_their_owners(mesh, cage):
    world = ts.World()
    body = world.add_body(cage, mesh, normals="recomputed")
    skin = ts.Skin(cage, mesh)
    palette = ts.BonePalette(cage, mesh)
    elastic = ts.ElasticBody(cage)
    own = ts.Cage(cage.nodes, cage.tets)
    views = [
        body.positions,
        body.normals,
        body.nodes,
        body.velocities,
        skin.positions,
        palette.bones,
        elastic.positions,
        own.nodes,
        own.tets,
    ]
    sums = [float(np.abs(view).sum()) for view in views]
    body.remove()
    del world, body, skin, palette, elastic, own
    gc.collect()
    ts.World().add_body(cage, mesh)  # takes memory that may have been freed
    assert sums == [float(np.abs(view).sum()) for view in views]


def test_a_body_keeps_its_world_and_a_world_its_bodies(mesh, cage):
    world = ts.World()
    ball = world.add_sphere(0.3, mass=1, position=(0, 3, 0))
    world.add_body(cage, mesh)
    gc.collect()
    for _ in range(10):
        world.step()
    body = world.bodies[0]
    del world
    gc.collect()
    assert body.nodes[:, 1].max() < cage.nodes[:, 1].max() - 0.1 and ball.position[1] < 3 and not body.removed


def test_what_was_removed_refuses_to_be_used(dropped):
    world, body = dropped
    box = world.add_box((0.1, 0.1, 0.1), mass=1, position=(0, 3, 0))
    hinge = world.add_hinge(box, pivot=(0, 3, 0), axis=(0, 0, 1))
    point = world.point_at_vertex(body, 0)
    spring, weld = world.add_spring(point), world.add_weld(point, box)
    box.remove()
    assert weld.released and not spring.released and box.removed
    body.remove()
    body.remove()
    assert spring.released and world.bodies == []
    for use in (
        lambda: body.positions,
        lambda: body.nodes,
        lambda: body.set_pinned([0]),
        lambda: body.youngs_modulus,
        lambda: point.position,
        lambda: box.position,
        lambda: world.forces_on(body),
        lambda: world.contacts(body),
    ):
        with pytest.raises(ts.Error) as error:
            use()
        assert error.value.code == ts.StatusCode.BODY_DELETED
    for use in (lambda: hinge.coordinate, lambda: spring.force, lambda: weld.angle):
        with pytest.raises(ts.Error) as error:
            use()
        assert error.value.code == ts.StatusCode.RELEASED
    for _ in range(10):
        world.step()


def test_handles_of_one_thing_are_equal(dropped):
    world, body = dropped
    assert world.bodies == [body] and hash(world.bodies[0]) == hash(body)
    assert body != world.add_body(body.cage, body.mesh) and body != 3


def test_reference_counts_stay_flat_over_many_steps():
    world = ts.World()
    tet = ts.Cage([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2, 3]])
    surface = ts.TriangleMesh(tet.nodes, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    body = world.add_body(tet, surface)
    skin = ts.Skin(tet, surface)

    def frame():
        world.step(substeps=1)
        world.contacts(body), world.forces_on(body).total.force
        skin.update(body.nodes)
        return body.positions[0], body.velocities[0], body.pinned[0]

    for _ in range(100):
        frame()
    gc.collect()
    watched = [None, world, body, skin, tet, surface, ts.World, np.float32]
    counts, blocks = [sys.getrefcount(one) for one in watched], sys.getallocatedblocks()
    for _ in range(10_000):
        frame()
    gc.collect()
    after = [sys.getrefcount(one) for one in watched]
    # Counts of objects that the interpreter itself uses change by a few.
    assert all(abs(a - b) < 50 for a, b in zip(counts, after)), (counts, after)
    assert abs(sys.getallocatedblocks() - blocks) < 1000


def test_a_call_that_mentions_its_replay_is_let_go(dropped, tmp_path):
    world, _ = dropped
    with ts.Recorder(world, tmp_path / "run") as recorder:
        recorder.step()
    gone = []
    for _ in range(5):
        replay = ts.Replay(world, tmp_path / "run")

        def change(step, replay=replay, world=world):
            return replay, world

        replay.on_change(change)
        replay.step()
        gone.append(weakref.ref(change))
        del replay, change
    gc.collect()
    assert not any(one() for one in gone)


def test_threads_take_turns(dropped):
    world, body = dropped
    failures = []

    def work(call):
        try:
            for _ in range(30):
                call()
        except Exception as failure:  # noqa: BLE001: whatever it is, the test fails
            failures.append(failure)

    def add_and_remove():
        world.add_sphere(0.1, mass=1, position=(0, 9, 0)).remove()

    calls = [
        world.step,
        lambda: body.positions.sum(),
        add_and_remove,
        lambda: world.contacts(body),
        lambda: world.restore(world.save()) if not failures else None,
    ]
    threads = [threading.Thread(target=work, args=(call,)) for call in calls[:4]]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures and np.isfinite(body.positions).all()


def test_what_long_work_reads_may_be_let_go_of_meanwhile(mesh):
    expected = ts.calibrate(ts.create_cage(mesh, target_tets=50)).stiffness_factor
    held = [ts.TriangleMesh(mesh.positions, mesh.triangles)]

    def let_go(fraction):
        held.clear()
        gc.collect()
        ts.TriangleMesh(mesh.positions + 1, mesh.triangles)  # takes memory that may have been freed

    held[:] = [ts.create_cage(held[0], target_tets=50, progress=let_go)]
    assert np.array_equal(ts.calibrate(held[0], progress=let_go).stiffness_factor, expected)


def test_others_run_during_long_work(mesh):
    ticks, done = [], threading.Event()

    def tick():
        while not done.wait(0.001):
            ticks.append(1)

    thread = threading.Thread(target=tick)
    thread.start()
    ts.calibrate(ts.create_cage(mesh, target_tets=1500))
    done.set()
    thread.join()
    assert len(ticks) > 10
