# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The first program, compared with the same program in C++."""

import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

import tetskin as ts
from tetskin.page import has_three


@pytest.mark.parametrize("page", ["python/README.md", "docs/python.md"])
def test_the_programs_of_the_pages_run_as_written(page, obj, tmp_path, monkeypatch):
    text = (Path(__file__).parents[2] / "plugin" / page).read_text()
    programs = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    (tmp_path / "dragon.obj").write_text(obj.read_text())
    monkeypatch.chdir(tmp_path)
    names = {}
    for program in programs:  # each goes on where the last one ended
        if has_three() or "ts.Film" not in program:
            exec(program, names)
    positions = names["body"].positions
    assert positions.shape == (800, 3) and positions.dtype == np.float32 and not positions.flags.writeable
    assert -0.01 < positions[:, 1].min() < 0.02  # it has landed, at its surface
    assert names["cage"].tet_count > 800


def test_a_skin_needs_no_world(mesh, cage):
    skin = ts.Skin(cage, mesh)
    assert np.abs(skin.update(cage.nodes) - mesh.positions).max() < 1e-6
    moved = skin.update(cage.nodes + [0, 3, 0])
    assert np.abs(moved - mesh.positions - [0, 3, 0]).max() < 1e-6
    assert np.shares_memory(moved, skin.positions)


def test_positions_are_those_of_cpp_to_the_bit(obj, tmp_path):
    program = os.environ.get("TETSKIN_REFERENCE")
    if not program:
        pytest.skip("TETSKIN_REFERENCE does not name the C++ program")
    out = tmp_path / "positions"
    subprocess.run([program, str(obj), "500", "120", str(out)], check=True, stdout=subprocess.DEVNULL)
    expected = np.fromfile(out, np.float32).reshape(-1, 3)
    mesh = ts.load_mesh(obj)
    cage = ts.create_cage(mesh, target_tets=500)
    world = ts.World()
    world.add_plane()
    body = world.add_body(cage, mesh, position=(0, 2, 0))
    for _ in range(120):
        world.step(1 / 60, substeps=4)
    assert np.array_equal(body.positions.view(np.uint32), expected.view(np.uint32))


@pytest.mark.parametrize("threads", [1, 2])
def test_threads_do_not_change_the_result(mesh, cage, threads):
    ends = []
    for count in (1, threads):
        world = ts.World(threads=count)
        world.add_plane()
        body = world.add_body(cage, mesh, position=(0, 0.5, 0))
        for _ in range(30):
            world.step()
        ends.append(np.array(body.positions))
    assert np.array_equal(*ends)


@pytest.mark.parametrize("substeps", [1, 3, 4, 7])
def test_every_step_makes_its_substeps(dropped, substeps):
    world, _ = dropped
    assert [world.step(substeps=substeps) for _ in range(20)] == [substeps] * 20
