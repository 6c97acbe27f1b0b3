# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Meshes and cages: from files and arrays, to files and pickles; long work with progress; classes that need no
world."""

import functools
import json
import os
import pickle
import signal
import struct
import threading
import time
from types import SimpleNamespace

import numpy as np
import pytest

import tetskin as ts

from conftest import torus


def test_arrays_of_any_layout_are_taken(mesh):
    positions, triangles = torus()
    wide = np.zeros((len(positions), 5), np.float32)
    wide[:, 1:4] = positions
    for array in (positions, np.asfortranarray(positions), positions[::-1][::-1], wide[:, 1:4], positions.tolist()):
        other = ts.TriangleMesh(array, triangles)
        assert np.abs(other.positions - mesh.positions).max() < 1e-6
    for kind in (np.int32, np.int64, np.uint16, np.uint32):
        assert np.array_equal(ts.TriangleMesh(positions, triangles.astype(kind)).triangles, mesh.triangles)


def test_meshes_of_others_are_taken(mesh):
    positions, triangles = torus()
    other = SimpleNamespace(vertices=positions, faces=triangles)
    cage = ts.create_cage(other, target_tets=50)
    assert np.array_equal(ts.Skin(cage, other).positions, ts.Skin(cage, mesh).positions)


def stl(positions, triangles):
    facets = b"".join(struct.pack("<12fH", 0, 0, 0, *positions[t].ravel(), 0) for t in triangles)
    return bytes(80) + struct.pack("<I", len(triangles)) + facets


def ply(positions, triangles):
    head = (
        f"ply\nformat ascii 1.0\nelement vertex {len(positions)}\nproperty double x\nproperty double y\n"
        "property double z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    return (
        head
        + "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in positions.tolist())
        + "".join(f"3 {a} {b} {c}\n" for a, b, c in triangles.tolist())
    ).encode()


def glb(positions, triangles):
    data = positions.astype("<f4").tobytes() + triangles.astype("<u4").tobytes()
    split = 12 * len(positions)
    text = json.dumps(
        {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "buffers": [{"byteLength": len(data)}],
            "bufferViews": [
                {"buffer": 0, "byteLength": split},
                {"buffer": 0, "byteOffset": split, "byteLength": len(data) - split},
            ],
            "accessors": [
                {
                    "bufferView": 0,
                    "componentType": 5126,
                    "count": len(positions),
                    "type": "VEC3",
                    "min": positions.min(0).tolist(),
                    "max": positions.max(0).tolist(),
                },
                {"bufferView": 1, "componentType": 5125, "count": 3 * len(triangles), "type": "SCALAR"},
            ],
        }
    ).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


@pytest.mark.parametrize("kind", ["stl", "ply", "glb"])
def test_files_are_read_without_assimp(kind, tmp_path):
    positions, triangles = torus()
    path = tmp_path / f"torus.{kind}"
    path.write_bytes({"stl": stl, "ply": ply, "glb": glb}[kind](positions, triangles))
    mesh = ts.load_mesh(path)
    assert mesh.triangle_count == len(triangles)
    assert np.abs(mesh.positions[mesh.triangles] - positions[triangles]).max() < 1e-6
    assert np.array_equal(ts.load_mesh(str(path)).positions, mesh.positions)


def test_other_formats_name_trimesh(tmp_path):
    (tmp_path / "mesh.fbx").write_text("fbx")
    with pytest.raises(ts.Error, match="trimesh") as error:
        ts.load_mesh(tmp_path / "mesh.fbx")
    assert error.value.code == ts.StatusCode.UNSUPPORTED_FORMAT


def test_maps_are_painted(mesh, cage, tmp_path):
    right = mesh.positions[:, 0] > 0
    factors = np.where(right, 4.0, 1.0)
    painted = ts.create_cage(mesh, target_tets=200, stiffness=factors, density=factors, damping=factors - 1)
    assert np.array_equal(painted.nodes, cage.nodes)
    middle = cage.nodes[cage.tets].mean(1)[:, 0]
    assert np.allclose(painted.painted_stiffness[middle > 0.4], 4) and np.allclose(
        painted.painted_stiffness[middle < -0.4], 1
    )
    assert painted.painted_damping.min() == 0 and painted.painted_damping.max() == 3
    assert painted.masses.sum() == pytest.approx(2.5 * cage.masses.sum(), rel=0.02)
    assert equal(ts.paint_cage(cage, mesh, stiffness=factors, density=factors.tolist(), damping=factors - 1), painted)
    assert equal(ts.create_cage(mesh, target_tets=200, stiffness=np.ones(mesh.vertex_count)), cage)
    assert equal(pickle.loads(pickle.dumps(painted)), painted)
    painted.save(tmp_path / "painted.vtk")
    assert equal(ts.load_cage(tmp_path / "painted.vtk"), painted)
    tets, nodes = ts.spread_map(cage, mesh, right)
    assert tets.shape == (cage.tet_count,) and nodes.shape == (cage.node_count,)
    assert (nodes[cage.nodes[:, 0] > 0.4] > 0.9).all() and (nodes[cage.nodes[:, 0] < -0.4] < 0.1).all()
    assert np.allclose(ts.spread_map(cage, mesh, factors, geometric=True)[0], painted.painted_stiffness)


@pytest.mark.parametrize("spoil", [0.0, -1.0, np.nan, None])
def test_bad_maps_are_refused(mesh, cage, spoil):
    factors = np.ones(mesh.vertex_count)
    factors = factors[1:] if spoil is None else np.where(np.arange(len(factors)) == 3, spoil, factors)
    for paint in (
        lambda: ts.create_cage(mesh, target_tets=200, density=factors),
        lambda: ts.paint_cage(cage, mesh, density=factors),
    ):
        with pytest.raises(ts.Error, match="the density map"):
            paint()


def test_maps_are_read(tmp_path):
    positions, triangles = torus()
    values = 1 + 0.25 * np.arange(len(positions))
    lines = ply(positions, triangles).decode().replace("double z\n", "double z\nproperty float stiff\n").splitlines()
    first = lines.index("end_header") + 1
    lines[first : first + len(values)] = [f"{l} {v!r}" for l, v in zip(lines[first:], values.tolist())]
    path = tmp_path / "painted.ply"
    path.write_text("\n".join(lines) + "\n")
    assert np.array_equal(ts.load_vertex_map(path, "stiff"), values)
    with pytest.raises(ts.Error, match="painted.ply.*'soft'.*'stiff'"):
        ts.load_vertex_map(path, "soft")


ARRAYS = [
    "nodes",
    "tets",
    "vertex_tets",
    "volume_fraction",
    "stiffness_factor",
    "painted_stiffness",
    "painted_density",
    "painted_damping",
    "masses",
    "component",
    "source_tet",
    "quadratic_tet",
]


def equal(a, b):
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in ARRAYS)


def test_cages_and_meshes_travel(mesh, cage, tmp_path):
    calibrated = ts.calibrate(cage, poisson_ratio=0.25)
    assert (
        0 < calibrated.stiffness_factor.min() <= calibrated.stiffness_factor.max() <= 1
        and len(cage.stiffness_factor) == 0
    )
    copy = pickle.loads(pickle.dumps(calibrated))
    assert equal(copy, calibrated) and copy.report == calibrated.report
    calibrated.save(tmp_path / "cage.vtk")
    assert equal(ts.load_cage(tmp_path / "cage.vtk"), calibrated)
    other = pickle.loads(pickle.dumps(mesh))
    assert np.array_equal(other.positions, mesh.positions) and np.array_equal(other.triangles, mesh.triangles)
    assert np.array_equal(ts.Skin(copy, other).positions, ts.Skin(calibrated, mesh).positions)


def test_cages_are_made_with_options(mesh):
    coarse = ts.create_cage(mesh, target_tets=60, duplicate_elements=False, fit=False)
    assert coarse.tet_count < 120 and "tets" in coarse.report
    assert coarse.scaled(2).masses.sum() == pytest.approx(8 * coarse.masses.sum())
    quadratic = ts.refine_quadratic(coarse)
    assert quadratic.tet_count == 8 * coarse.tet_count and quadratic.quadratic_tet.max() == coarse.tet_count - 1


@pytest.mark.parametrize(
    "work",
    [
        lambda mesh, cage, tell: ts.create_cage(mesh, progress=tell),
        lambda mesh, cage, tell: ts.calibrate(cage, progress=tell),
    ],
)
def test_long_work_tells_its_progress_and_can_be_cancelled(mesh, cage, work):
    told = []
    work(mesh, cage, told.append)
    assert told == sorted(told) and told[0] == 0 and told[-1] == 1 and len(told) > 3
    # Slow work tells more: its last call is known by the fraction, not by its number.
    for goes_on in (lambda calls: False, lambda calls: len(calls) < 2, lambda calls: calls[-1] < 1):
        calls = []
        with pytest.raises(ts.Error) as error:
            work(mesh, cage, lambda fraction: calls.append(fraction) or goes_on(calls))
        assert error.value.code == ts.StatusCode.CANCELLED
        assert all(goes_on(calls[: k + 1]) for k in range(len(calls) - 1)) and not goes_on(calls)

    def fail(fraction):
        raise KeyError(fraction)

    with pytest.raises(KeyError):
        work(mesh, cage, fail)


@pytest.mark.parametrize("progress", [None, True])
def test_ctrl_c_is_heard_in_the_middle_of_long_work(mesh, progress, capsys):
    """Of half a minute, if nobody interrupts it."""
    timer = threading.Timer(0.1, os.kill, [os.getpid(), signal.SIGINT])
    start = time.monotonic()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        ts.create_cage(mesh, target_tets=3_000_000, progress=progress)
    assert time.monotonic() - start < 8


def test_bones_draw_the_surface_of_the_skin(mesh, cage):
    nodes = cage.nodes @ np.array([[1, 0.2, 0], [0, 1, 0], [0, 0.1, 1]]) + [3, 0, 0]
    expected = ts.Skin(cage, mesh).update(nodes)
    palette = ts.BonePalette(cage, mesh)
    bones = palette.update(nodes)[palette.vertex_bones]
    assert palette.bone_count == cage.node_count and bones.shape == (mesh.vertex_count, 4, 3, 4)
    rest = np.concatenate([mesh.positions, np.ones((mesh.vertex_count, 1))], 1)
    drawn = np.einsum("vb,vbij,vj->vi", palette.vertex_weights, bones, rest)
    assert np.abs(drawn - expected).max() < 1e-5
    assert ts.BonePalette(cage, mesh, interpolation="quadratic", layout="columns").bones.shape == (
        cage.node_count,
        4,
        4,
    )
    assert ts.BonePalette(cage, mesh, gradients=True).bones.shape == (cage.node_count, 3, 4)


def test_skins_have_normals(mesh, cage):
    for normals in ("transformed", "recomputed"):
        skin = ts.Skin(cage, mesh, interpolation="quadratic", normals=normals)
        skin.update(cage.nodes)
        assert np.abs(np.linalg.norm(skin.normals, axis=1) - 1).max() < 1e-4
    assert ts.Skin(cage, mesh).normals.shape == (0, 3)
    assert (skin.bounds[0] <= mesh.positions.min(0) + 1e-5).all() and "outside" in skin.report


def test_recomputed_normals_stay_split_at_hard_edges(mesh, cage):
    corners = mesh.triangles.ravel()
    a, b, c = mesh.positions[mesh.triangles].swapaxes(0, 1)
    flat = np.cross(b - a, c - a)
    flat = np.repeat(flat / np.linalg.norm(flat, axis=1, keepdims=True), 3, axis=0)
    facets = ts.TriangleMesh(mesh.positions[corners], np.arange(len(corners)).reshape(-1, 3), normals=flat)
    world, tets = ts.World(), ts.Cage(cage.nodes, cage.tets)
    for add in (functools.partial(ts.Skin, tets), functools.partial(world.add_body, tets)):
        seamless = add(mesh, normals="recomputed").normals[corners]
        split, joined = (add(facets, normals="recomputed", hard_edge_degrees=d).normals for d in (5, 180))
        assert np.abs(split - seamless).max() > 0.05 and np.abs(joined - seamless).max() < 1e-4
        assert np.array_equal(add(facets, normals="recomputed").normals, split)


def test_an_elastic_body_is_filled_with_gas(cage):
    body = ts.ElasticBody(cage, youngs_modulus=1e5, density=100, stiffness_damping=0.1)
    before = body.volume
    body.set_gas(2e4, outside=1e5)
    assert body.pressure == pytest.approx(2e4)
    for _ in range(60):
        body.step(1 / 60)
    assert body.volume > 1.01 * before
    assert (body.pressure + 1e5) * body.volume == pytest.approx(1.2e5 * before, rel=1e-6)
    body.pressure = 500
    assert body.pressure == 500


def test_an_elastic_body_swings_without_a_world(cage):
    body = ts.ElasticBody(cage, youngs_modulus=1e4, density=100)
    held = cage.nodes[:, 0] < -1
    body.set_pinned(held)
    for _ in range(20):
        assert body.step(1 / 60, (0, -9.81, 0)) > 0
    assert np.array_equal(body.positions[held], cage.nodes[held])
    assert body.positions[:, 1].min() < cage.nodes[:, 1].min() - 0.01 and body.energy > 0
    assert body.forces().shape == cage.nodes.shape
    body.velocities = np.zeros_like(cage.nodes)
    body.positions = cage.nodes + [0, 5, 0]
    assert np.array_equal(body.positions, cage.nodes + [0, 5, 0])
