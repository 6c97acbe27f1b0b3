# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Films and pages: they contain what the world contains. How a browser draws them is tested in tests/demos."""

import base64
import html
import json
import re
import signal

import numpy as np
import pytest

import tetskin as ts
from tetskin import page, progress

pytestmark = pytest.mark.skipif(
    not page.has_three(), reason="the package was built without three.js (libjs-three)"
)
TYPES = {"u16": np.uint16, "u32": np.uint32, "f32": np.float32}


def data_of(text):
    """The data of a page, with its arrays."""

    def unpacked(value):
        kinds = [kind for kind in TYPES if isinstance(value.get(kind), str)]
        return np.frombuffer(base64.b64decode(value[kinds[0]]), TYPES[kinds[0]]) if kinds else value

    found = re.search(r'<script id="data" type="application/json">(.*?)</script>', text, re.DOTALL)
    return json.loads(found.group(1), object_hook=unpacked)


def nodes_of(data, body, moment):
    """The nodes of a body at a moment, in world space with y upwards."""
    box = data["bodies"][body]["box"]
    words = data["bodies"][body]["nodes"].reshape(data["moments"], -1, 3)[moment] / 65535
    return words * np.subtract(box["max"], box["min"]) + box["min"] + data["origin"]


def skinned(data, body, nodes):
    """The surface that a page makes of nodes, linearly."""
    model = data["models"][data["bodies"][body]["model"]]
    skin = model["cage"]["embedding"]
    counts = np.diff(skin["runStarts"].astype(int))
    corners = nodes[np.repeat(skin["runNodes"].reshape(-1, 4).astype(int), counts, axis=0)]
    weights = skin["weights"].reshape(-1, 3)
    weights = np.column_stack([weights, 1 - weights.sum(1)])
    positions = np.empty((model["vertices"], 3))
    positions[skin["slotVertices"]] = (weights[:, :, None] * corners).sum(1)
    return positions


def prop_of(data, prop, moment):
    """The corners of a moving object at a moment."""
    place = data["props"][prop]["places"].reshape(-1, 4, 3)[moment]
    return data["props"][prop]["positions"].reshape(-1, 3) @ place[:3] + place[3] + data["origin"]


def shown(world):
    film = ts.Film(world)
    film.add_frame()
    return data_of(film.html())


def test_a_film_has_the_nodes_of_each_frame_and_what_skins_them(dropped):
    world, body = dropped
    film = ts.Film(world, title="</script><b>", frames_per_second=30)
    states = []
    for _ in range(20):
        world.step(1 / 30)
        film.add_frame()
        states.append((np.array(body.nodes), np.array(body.positions)))
    assert len(film) == 20
    text = film.html()
    assert "</script><b>" not in text
    data = data_of(text)
    assert data["moments"] == 20 and data["rate"] == 30 and data["title"] == "</script><b>"
    for moment in (0, 19):
        nodes, positions = states[moment]
        assert np.abs(nodes_of(data, 0, moment) - nodes).max() < 1e-4
        assert np.abs(skinned(data, 0, nodes_of(data, 0, moment)) - positions).max() < 2e-4
    assert np.abs(states[0][0] - states[19][0]).max() > 0.1


def test_a_page_needs_nothing_else(dropped, tmp_path):
    world, body = dropped
    for save in (world.save_page, body.save_page):
        save(tmp_path / "page.html")
        text = (tmp_path / "page.html").read_text()
        assert not re.search(r"<(script|link|img|iframe)[^>]*\s(src|href)=.(?!data:)", text)
        assert "three.js authors" in text and "class Stage" in text
    assert [file.name for file in tmp_path.iterdir()] == ["page.html"]


SHAPES = {
    "box": (ts.Shape.box((0.1, 0.2, 0.3)), (0.1, 0.2, 0.3)),
    "sphere": (ts.Shape.sphere(0.2), (0.2, 0.2, 0.2)),
    "capsule": (ts.Shape.capsule(0.1, 0.4), (0.1, 0.3, 0.1)),
    "cylinder": (ts.Shape.cylinder(0.1, 0.4), (0.1, 0.2, 0.1)),
    "hull": (ts.Shape.convex_hull([[x, y, z] for x in (-1, 1) for y in (-2, 2) for z in (-3, 3)]), (1, 2, 3)),
    "compound": (ts.Shape.compound([(ts.Shape.sphere(1), (x, 0, 0), (0, 0, 0, 1)) for x in (-1, 1)]), (2, 1, 1)),
}


@pytest.mark.parametrize("name", SHAPES)
def test_rigid_bodies_are_where_they_are(name):
    shape, half = SHAPES[name]
    world = ts.World()
    body = world.add_rigid_body(shape, mass=1, position=(1, 2, 3))
    film = ts.Film(world)
    film.add_frame()
    quarter = np.sqrt(0.5)
    body.position, body.rotation = (4, 5, 6), (0, 0, quarter, quarter)
    film.add_frame()
    data = data_of(film.html())
    triangles = data["props"][0]["triangles"].reshape(-1, 3)
    for moment, middle, size in ((0, (1, 2, 3), half), (1, (4, 5, 6), (half[1], half[0], half[2]))):
        corners = prop_of(data, 0, moment)
        assert np.allclose((corners.min(0) + corners.max(0)) / 2, middle, atol=1e-4)
        assert np.allclose((corners.max(0) - corners.min(0)) / 2, size, rtol=2e-3)
        a, b, c = corners[triangles.astype(int)].transpose(1, 0, 2)
        volume = (np.cross(a - middle, b - middle) * (c - middle)).sum() / 6
        assert 0.5 < volume / np.prod(np.multiply(2, half)) < 1.05  # seen from outside, and closed


def test_what_is_fixed_is_an_obstacle_and_what_is_kinematic_moves(mesh):
    world = ts.World()
    world.add_plane(offset=-0.5)
    world.add_box((0.5, 0.5, 0.5), position=(3, 0, 0))
    world.add_rigid_body(ts.Shape.mesh(mesh), position=(0, 1, 0))
    pusher = world.add_box((0.1, 0.1, 0.1), kinematic=True)
    film = ts.Film(world)
    film.add_frame()
    pusher.position = (0, 0, 1)
    world.step()
    film.add_frame()
    data = data_of(film.html())
    assert len(data["props"]) == 1
    assert np.allclose(prop_of(data, 0, 1).mean(0) - prop_of(data, 0, 0).mean(0), (0, 0, 1), atol=1e-5)
    obstacles = data["obstacles"]
    groups = {group["material"]: group for group in obstacles["groups"]}
    floor = groups["floor"]
    corners = obstacles["triangles"].reshape(-1, 3)[floor["first"] : floor["first"] + floor["count"]].ravel()
    heights = obstacles["positions"].reshape(-1, 3)[corners, 1] + data["origin"][1]
    assert np.allclose(heights, -0.5, atol=1e-5)
    assert [group["material"] for group in obstacles["groups"]] == ["fixed", "fixed", "floor"]
    assert obstacles["groups"][1]["count"] == mesh.triangle_count


def test_up_is_against_gravity(mesh, cage):
    world = ts.World(gravity=(0, 0, -10))
    world.add_plane(normal=(0, 0, 1), offset=-2)
    body = world.add_body(cage, mesh, position=(0, 0, 3))
    data = shown(world)
    x, y, z = np.transpose(body.nodes)
    assert np.abs(nodes_of(data, 0, 0) - np.column_stack([x, z, -y])).max() < 1e-4
    assert [group["material"] for group in data["obstacles"]["groups"]] == ["floor"]


def test_bodies_of_one_cage_share_it_and_have_their_own_colours(mesh, cage):
    world = ts.World()
    for x in (0, 3):
        world.add_body(cage, mesh, position=(x, 0, 0))
    world.add_body(cage, mesh, position=(6, 0, 0), interpolation="quadratic")
    world.add_body(cage, position=(9, 0, 0))
    data = shown(world)
    assert len(data["models"]) == 3 and data["bodies"][0]["model"] == data["bodies"][1]["model"]
    assert len({body["material"] for body in data["bodies"]}) == 4
    assert [body["skin"] for body in data["bodies"]] == ["linear", "linear", "quadratic", "linear"]
    assert "cage" not in data["models"][2]


def test_a_body_is_shown_alone_with_what_is_fixed(dropped, mesh, cage, tmp_path):
    world, body = dropped
    world.add_body(cage, mesh, position=(5, 0, 0))
    world.add_sphere(0.1, mass=1)
    body.save_page(tmp_path / "body.html")
    data = data_of((tmp_path / "body.html").read_text())
    assert len(data["bodies"]) == 1 and not data["props"] and "obstacles" in data
    assert np.abs(nodes_of(data, 0, 0) - body.nodes).max() < 1e-4


def test_long_runs_stay_small(dropped):
    world, body = dropped
    sizes = []
    film = ts.Film(world)
    for count in (10, 60):
        while len(film) < count:
            film.add_frame()
        sizes.append(len(film.html()))
    assert sizes[1] - sizes[0] < 50 * (8 * body.node_count + 50)


def test_a_film_of_what_has_gone_is_refused_and_keeps_its_frames(dropped):
    world, body = dropped
    film = ts.Film(world)
    with pytest.raises(ts.Error, match="add_frame"):
        film.html()
    film.add_frame()
    before = film.html()
    body.remove()
    with pytest.raises(ts.Error) as refused:
        film.add_frame()
    assert refused.value.code == ts.StatusCode.BODY_DELETED
    assert len(film) == 1 and film.html() == before


def test_bad_arguments_name_the_cure(dropped, monkeypatch, tmp_path):
    world, _ = dropped
    with pytest.raises(ts.Error, match="nothing to show"):
        ts.Film(ts.World()).add_frame()
    for rate in (0, -1, np.nan, np.inf):
        with pytest.raises(ValueError, match="frames_per_second"):
            ts.Film(world, frames_per_second=rate)
    with pytest.raises(ValueError, match="height"):
        world.show(height=-1)
    with pytest.raises((ModuleNotFoundError, RuntimeError), match=r"save_page\(path\)"):
        world.show()
    with pytest.raises(FileNotFoundError):
        world.save_page(tmp_path / "no" / "folder.html")
    monkeypatch.setattr(page, "_FOLDER", tmp_path)
    with pytest.raises(RuntimeError, match="libjs-three"):
        world.save_page(tmp_path / "page.html")
    assert not list(tmp_path.iterdir())


def test_worlds_of_rigid_bodies_and_of_planes_alone_can_be_seen():
    world = ts.World()
    world.add_plane()
    assert shown(world)["focus"]["max"] != shown(world)["focus"]["min"]
    world.add_plane(normal=(1, 0, 0), offset=-3)
    world.add_sphere(0.5, mass=1, position=(0, 4, 0))
    focus = shown(world)
    assert np.allclose(np.add(focus["focus"]["min"], focus["origin"]), (-0.5, 3.5, -0.5), atol=1e-3)


def test_a_frame_for_notebooks_holds_the_page(dropped):
    world, _ = dropped
    film = ts.Film(world)
    film.add_frame()
    text = page.frame(film.html(), 300)
    source, height = re.search(r'srcdoc="([^"]*)" width="100%" height="(\d+)"', text).groups()
    assert html.unescape(source) == film.html() and height == "300"


def test_progress_prints_a_bar(mesh, capsys):
    cage = ts.create_cage(mesh, target_tets=200, progress=True)
    printed = capsys.readouterr().out
    assert printed.startswith("\rcage [") and printed.endswith("[##############################] 100 %\n")
    ts.calibrate(cage, progress=True)
    assert "\rcalibration [" in capsys.readouterr().out
    ts.create_cage(mesh, target_tets=200, progress=False)
    assert capsys.readouterr().out == ""


def test_an_interrupt_cancels_what_has_a_bar(mesh, monkeypatch):
    monkeypatch.setattr(progress.Bar, "__call__", lambda self, fraction: signal.raise_signal(signal.SIGINT))
    with pytest.raises(KeyboardInterrupt):
        ts.create_cage(mesh, target_tets=200, progress=True)
