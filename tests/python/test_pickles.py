# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Objects sent to another process arrive with the same bits: meshes, cages, and worlds, by the function that builds
them."""

import copy
import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest

import tetskin as ts

from conftest import torus

PROTOCOLS = range(pickle.HIGHEST_PROTOCOL + 1)


def grouped(tmp_path):
    """A mesh of two groups, with texture coordinates and normals, as only a file has all of them."""
    lines = ["v 0 0 0", "v 1 0 0", "v 1 1 0", "v 0 1 0.1", "vn 0 0 1", "vt 0 0", "vt 0.1 0.7", "vt 1 1"]
    lines += ["g first", "usemtl red", "f 1/1/1 2/2/1 3/3/1", "g second", "usemtl blue", "f 1/1/1 3/3/1 4/2/1"]
    (tmp_path / "two.obj").write_text("\n".join(lines) + "\n")
    return ts.load_mesh(tmp_path / "two.obj")


def attributed():
    """Numbers of all bits, such as no text would keep."""
    positions, triangles = torus()
    random = np.random.default_rng(1)
    normals = random.standard_normal(positions.shape)
    return ts.TriangleMesh(
        positions * (1 + 1e-9 * random.standard_normal(positions.shape)),
        triangles,
        normals=normals / np.linalg.norm(normals, axis=1, keepdims=True),
        texcoords=random.random((len(positions), 2)),
    )


MODELS = {
    "a mesh": lambda mesh, cage, path: mesh,
    "a mesh with normals and texture coordinates": lambda mesh, cage, path: attributed(),
    "a mesh of groups": lambda mesh, cage, path: grouped(path),
    "a cage": lambda mesh, cage, path: cage,
    "a calibrated cage": lambda mesh, cage, path: ts.calibrate(cage),
    "a quadratic cage": lambda mesh, cage, path: ts.refine_quadratic(cage),
    "a cage of tets alone": lambda mesh, cage, path: ts.Cage(cage.nodes, cage.tets),
}


@pytest.mark.parametrize("name", MODELS)
def test_models_are_pickled_to_the_bit(name, mesh, cage, tmp_path):
    model = MODELS[name](mesh, cage, tmp_path)
    state = model.__getstate__()  # all data of a model, as bytes
    for protocol in PROTOCOLS:
        assert pickle.loads(pickle.dumps(model, protocol)).__getstate__() == state
    assert copy.deepcopy(model).__getstate__() == state


def test_the_state_has_what_a_model_has(mesh, cage, tmp_path):
    """So that the test above compares something."""
    full, empty = attributed(), mesh.__getstate__()
    assert full.texcoords.tobytes() in full.__getstate__() and full.normals.tobytes() in full.__getstate__()
    assert len(full.__getstate__()) == len(empty) + 20 * mesh.vertex_count
    assert all(name in grouped(tmp_path).__getstate__() for name in (b"first", b"red", b"second", b"blue"))
    calibrated = ts.calibrate(cage)
    assert len(calibrated.stiffness_factor) == cage.tet_count
    assert calibrated.stiffness_factor.tobytes() in calibrated.__getstate__()
    assert len(ts.refine_quadratic(cage).__getstate__()) > len(cage.__getstate__()) + 4 * cage.tet_count


def build(mesh, cage):
    """The data sent instead of a world."""
    world = ts.World()
    world.add_plane()
    soft = world.add_body(cage, mesh, position=(0, 0.5, 0), normals="transformed", soft_contact=True)
    high = world.add_body(cage, mesh, position=(0, 1.4, 0), pinned=cage.nodes[:, 0] < -1, soft_contact=True)
    box = world.add_box((0.2, 0.2, 0.2), mass=1, position=(0, 2.2, 0))
    world.add_point_joint(box, pivot=(1, 2.2, 0))
    world.add_spring(world.point_at_vertex(soft, 0), stiffness=20)
    return world, [soft, high], box


def go_on(world, bodies, box, frames=20):
    for _ in range(frames):
        world.step()
    return [array.tobytes() for body in bodies for array in (body.positions, body.normals, body.nodes)], box.position


def continued(builder, arguments, snapshot):
    """In another process: the world, from its snapshot on."""
    world, bodies, box = builder(*arguments)
    world.restore(snapshot)
    return go_on(world, bodies, box)


@pytest.fixture(scope="module")
def other_process():
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        yield pool


def test_a_world_goes_on_in_a_spawned_process_to_the_bit(mesh, cage, other_process):
    world, bodies, box = build(mesh, ts.calibrate(cage))
    go_on(world, bodies, box)
    snapshot = world.save()
    there = other_process.submit(continued, build, (mesh, bodies[0].cage), snapshot)
    here = go_on(world, bodies, box)
    assert there.result()[0] == here[0] and np.array_equal(there.result()[1], here[1])


def test_a_world_that_is_built_otherwise_there_is_refused_there(mesh, cage, other_process):
    snapshot = build(mesh, cage)[0].save()
    with pytest.raises(ts.Error) as error:
        other_process.submit(continued, build, (mesh, ts.create_cage(mesh, target_tets=60)), snapshot).result()
    assert error.value.code == ts.StatusCode.SNAPSHOT_MISMATCH


def test_a_world_says_what_to_pickle_in_its_place():
    for duplicate in (pickle.dumps, copy.copy, copy.deepcopy):
        with pytest.raises(TypeError, match=r"what builds it.*world\.save\(\)"):
            duplicate(ts.World())
