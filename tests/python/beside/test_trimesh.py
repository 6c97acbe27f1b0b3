# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Meshes of trimesh: accepted directly, with their texture coordinates; and its files, read back."""

import numpy as np
import pytest
import trimesh

import tetskin as ts


@pytest.fixture
def ball():
    return trimesh.creation.icosphere(subdivisions=3)


def test_a_mesh_of_trimesh_is_taken_wherever_a_mesh_is(ball):
    cage = ts.create_cage(ball, target_tets=200)
    world = ts.World()
    world.add_plane()
    body = world.add_body(cage, ball, position=(0, 2, 0))
    for _ in range(30):
        world.step()
    assert body.positions.shape == ball.vertices.shape and body.positions[:, 1].mean() < 2
    assert np.abs(ts.Skin(cage, ball).update(cage.nodes) - ball.vertices).max() < 1e-6
    assert np.array_equal(body.mesh.triangles, ball.faces)


def test_a_surface_goes_back_to_trimesh(ball):
    cage = ts.create_cage(ball, target_tets=200)
    skin = ts.Skin(cage, ball)
    moved = trimesh.Trimesh(skin.update(2 * cage.nodes), ball.faces, process=False)
    assert moved.is_watertight
    assert moved.volume == pytest.approx(8 * ball.volume, rel=1e-3)


def test_texture_coordinates_come_along(ball):
    uv = np.random.default_rng(1).random((len(ball.vertices), 2))
    ball.visual = trimesh.visual.TextureVisuals(uv=uv)
    world = ts.World()
    body = world.add_body(ts.create_cage(ball, target_tets=100), ball)
    assert np.allclose(body.mesh.texcoords, uv, atol=1e-7)
    assert not body.mesh.texcoords.flags.writeable


def test_colours_and_no_texture_coordinates_are_none(ball):
    ball.visual.vertex_colors = [255, 0, 0, 255]
    world = ts.World()
    assert world.add_body(ts.create_cage(ball, target_tets=100), ball).mesh.texcoords.shape == (0, 2)


def test_of_a_scene_the_error_names_the_cure(ball):
    scene = trimesh.Scene([ball, ball.copy().apply_translation((3, 0, 0))])
    with pytest.raises(TypeError, match=r"scene.to_mesh\(\)"):
        ts.create_cage(scene)
    joined = scene.to_mesh()
    assert len(joined.vertices) == 2 * len(ball.vertices)
    assert ts.create_cage(joined, target_tets=400).component.max() == 1


@pytest.mark.parametrize("name", ["mesh.obj", "mesh.ply", "ascii.ply", "mesh.off", "mesh.glb", "mesh.gltf"])
def test_files_of_trimesh_are_read_back_equal(ball, tmp_path, name):
    options = {"encoding": "ascii"} if name.startswith("ascii") else {}
    if name == "mesh.obj":
        options = {"digits": 17}
    path = tmp_path / name
    if name.endswith(".gltf"):
        for part, content in trimesh.Scene(ball).export(file_type="gltf").items():
            (tmp_path / part).write_bytes(content)
        path = tmp_path / "model.gltf"
    else:
        ball.export(path, **options)
    mesh = ts.load_mesh(path)
    assert np.array_equal(mesh.triangles, ball.faces)
    assert np.allclose(mesh.positions, ball.vertices, rtol=0, atol=0 if name == "mesh.obj" else 1e-6)


@pytest.mark.parametrize("ascii", [False, True])
def test_an_stl_of_trimesh_has_the_same_triangles(ball, tmp_path, ascii):
    path = tmp_path / "mesh.stl"
    ball.export(path, file_type="stl_ascii" if ascii else "stl")
    mesh = ts.load_mesh(path)
    assert np.allclose(mesh.positions[mesh.triangles], ball.triangles, rtol=0, atol=1e-6)


def test_of_another_format_the_error_names_trimesh(tmp_path):
    path = tmp_path / "mesh.3mf"
    path.write_bytes(b"PK\x03\x04")
    with pytest.raises(ts.Error, match=r"trimesh.load_mesh\(path\)") as raised:
        ts.load_mesh(path)
    assert raised.value.code == ts.StatusCode.UNSUPPORTED_FORMAT
