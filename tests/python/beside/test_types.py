# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Type checking of the package: mypy, strict, on correct programs and on wrong lines."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[3]

RIGHT = """
import array
import numpy as np
import tetskin as ts
from pathlib import Path
from tetskin.typing import Array, Vector


def told(fraction: float) -> bool:
    return fraction < 2


def lengths(positions: Array) -> float:
    return float(np.linalg.norm(np.asarray(positions)))


mesh = ts.TriangleMesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.0, 0, 1)], np.array([[0, 2, 1], [0, 1, 3]]))
single: np.typing.NDArray[np.float32] = mesh.normals
cage = ts.create_cage(mesh, target_tets=10, progress=told)
cage = ts.calibrate(cage, progress=lambda fraction: print(fraction))
cage.save(Path("cage.vtk"))


class Scan:  # as Open3D has it
    vertices = np.zeros((4, 3))
    triangles = np.zeros((4, 3), np.int32)


scan: ts.Cage = ts.create_cage(Scan())
where: Vector = np.zeros(3)
world = ts.World(gravity=[0, -9.81, 0])
body = world.add_body(cage, mesh, position=where, pinned=cage.nodes[:, 0] < 0, normals="transformed")
body.velocities = np.zeros((cage.node_count, 3), np.float32)
body.set_pinned([0, 1])
body.set_pinned_positions(np.array([0]), [body.nodes[0]])
box = world.add_box((1, 1, 1), mass=2.0, position=body.nodes[0])
box.position = body.positions.mean(axis=0)
lower, upper = body.bounds
size: float = float((upper - lower).max())
hit = world.raycast(lower, [0.0, 1, 2])
if hit is not None:
    world.add_spring(world.point_at(hit)).set_target(hit.point)
total: np.typing.NDArray[np.float64] = world.forces_on(body, box).total.force
with ts.Recorder(world, "run", description="a fall") as recorder:
    made: int = recorder.step(1 / 60, substeps=2)
with ts.GlbWriter(Path("run.glb")) as glb:
    glb.add_body(body)
try:
    ts.load_mesh("nothing.obj")
except ts.Error as error:
    if error.code is ts.StatusCode.FILE_NOT_FOUND:
        print(error, ts.__version__)
skin = ts.Skin(cage, mesh, interpolation="quadratic")
lengths(skin.update(cage.nodes.tolist()))
"""

WRONG = """
import tetskin as ts
mesh = ts.TriangleMesh("positions", [(0, 1, 2)])  # wrong
mesh = ts.load_mesh(3)  # wrong
mesh = ts.load_mesh("a.obj", scale=2)  # wrong
cage = ts.create_cage("a.obj")  # wrong
cage = ts.create_cage(mesh, 1000)  # wrong
cage = ts.create_cage(mesh, tets=1000)  # wrong
cage = ts.create_cage(mesh, target_tets="many")  # wrong
cage = ts.create_cage(mesh, progress="yes")  # wrong
cage = ts.create_cage(mesh, progress=lambda: True)  # wrong
cage.nodes = []  # wrong
world = ts.World(gravity=-9.81)  # wrong
body = world.add_body(mesh)  # wrong
body = world.add_body(cage, mesh, normals="smooth")  # wrong
body = world.add_body(cage, mesh, position="above")  # wrong
body = world.add_body(cage, mesh, interpolation=2)  # wrong
body.positions.shape.nothing  # wrong
body.position  # wrong
body.positions = [(0, 0, 0)]  # wrong
world.step("1/60")  # wrong
world.step(1 / 60, 4)  # wrong
world.raycast((0, 0, 0), (0, 1, 0)).point  # wrong
world.forces_on(cage)  # wrong
world.contacts(body).points + "1"  # wrong
ts.Skin(cage, mesh).update("nodes")  # wrong
ts.BonePalette(cage, mesh, layout="diagonal")  # wrong
ts.Error("text").codes  # wrong
ts.nothing  # wrong
"""


@pytest.fixture(scope="module")
def mypy(tmp_path_factory):
    """Checks files; returns what mypy says, and whether it is content. Packages without types are accepted."""
    folder = tmp_path_factory.mktemp("mypy")

    def run(*files):
        command = [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--no-error-summary"]
        command += ["--cache-dir", str(folder / "cache"), "--config-file", ""]
        command += ["--disable-error-code", "import-untyped", "--untyped-calls-exclude", "nbformat"]
        command += ["--untyped-calls-exclude", "IPython"]
        done = subprocess.run([*command, *map(str, files)], cwd=folder, capture_output=True, text=True)
        assert not done.stderr, done.stderr
        return done.stdout, done.returncode == 0

    return run


def test_right_programs_are_right(mypy, tmp_path):
    program = tmp_path / "right.py"
    program.write_text(RIGHT)
    said, content = mypy(program)
    assert content, said


def test_every_name_of_the_package_has_a_whole_type(mypy):
    said, content = mypy("-p", "tetskin")
    assert content, said


def test_each_wrong_line_is_an_error_and_no_other(mypy, tmp_path):
    program = tmp_path / "wrong.py"
    program.write_text(WRONG)
    said, content = mypy(program)
    found = {int(line) for line in re.findall(r"^[^:]*wrong\.py:(\d+): error", said, re.MULTILINE)}
    wrong = {number for number, line in enumerate(WRONG.splitlines(), 1) if line.endswith("# wrong")}
    lines = WRONG.splitlines()
    assert not content
    assert not wrong - found, "no error: " + "; ".join(lines[number - 1] for number in sorted(wrong - found))
    assert not found - wrong, said


@pytest.mark.parametrize("page", ["python/README.md", "docs/python.md"])
def test_programs_of_pages_are_right(mypy, tmp_path, page):
    text = (REPOSITORY / "plugin" / page).read_text()
    programs = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert programs
    program = tmp_path / "page.py"
    program.write_text("\n".join(programs))  # each goes on where the last one ended
    said, content = mypy(program)
    assert content, said


def test_demos_are_right(mypy):
    demos = sorted((REPOSITORY / "demos/examples/python").glob("*.py"))
    if not demos:
        pytest.skip("there are no demos")
    said, content = mypy(*demos)
    assert content, said
