# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""demos/lab/peers, which compares tetskin with others: it still runs, with tetskin alone, and a failure becomes a cell."""
import csv
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

PEERS = Path(__file__).parents[2] / "demos/lab/peers"


@pytest.fixture
def modules(monkeypatch):
    """The folder's modules can be imported, and are forgotten afterwards: their names are common ones."""
    before = set(sys.modules)
    monkeypatch.syspath_prepend(str(PEERS))
    yield
    for name in set(sys.modules) - before:
        del sys.modules[name]


def compare(*arguments):
    return subprocess.run([sys.executable, "-B", str(PEERS / "compare.py"), *arguments], capture_output=True, text=True)


def table(folder):
    with open(folder / "peers.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_scenes_run_with_tetskin_alone(tmp_path):
    done = compare("--quick", "--only", "spin", "--only", "skin", "--peers", "tetskin", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr
    rows = table(tmp_path)
    assert {row["status"] for row in rows} == {"ok"} and all(float(row["ms_per_frame"]) > 0 for row in rows)
    figures = {row["figure"]: float(row["value"]) for row in rows if row["scene"] == "spin"}
    assert figures["error of the angular momentum, %"] < 0.1 and 90 < figures["kinetic energy left, %"] < 101


def test_wrong_arguments_are_refused_before_anything_runs(tmp_path):
    for wrong in (("--only", "bean"), ("--peers", "tetskin,physx")):
        done = compare(*wrong, "--out", str(tmp_path / "out"))
        assert done.returncode == 2 and "there are:" in done.stderr
    assert not (tmp_path / "out").exists()


def test_what_a_peer_cannot_do_and_a_crash_are_cells(modules, tmp_path, monkeypatch):
    import compare as harness
    from plan import Case
    (tmp_path / "adapters").mkdir()
    for name in ("one.py", "plan.py", "problem.py"):
        (tmp_path / name).write_text((PEERS / name).read_text())
    (tmp_path / "adapters/__init__.py").touch()
    (tmp_path / "adapters/peer.py").write_text("VERSION = '1'\nclass Simulation: pass\n")
    (tmp_path / "scenes").mkdir()
    (tmp_path / "scenes/__init__.py").touch()
    (tmp_path / "scenes/trouble.py").write_text("""
import os, time
from problem import Unsupported
def run(Simulation, case, clock, references):
    if case.mesh == "cannot":
        raise Unsupported("it has no wheels")
    if case.mesh == "explodes":
        return {"error": float("nan")}
    if case.mesh == "crashes":
        os.abort()
    if case.mesh == "too slow":
        while True:
            pass
    with clock:
        time.sleep(0)
    return {"error": 1.0}
""")
    monkeypatch.setattr(harness, "HERE", tmp_path)
    outcomes = {}
    timed = ["too slow"] if Path("/proc/self/stat").exists() else []  # else it would be "hangs", after a minute
    for what in ("cannot", "explodes", "crashes", "ok", *timed):
        outcomes[what] = harness.run_one("trouble", harness.json.dumps(Case("peer", "", {}, what).as_dict()), tmp_path,
                                         2)
    outcomes["not installed"] = harness.run_one("trouble", harness.json.dumps(Case("nobody", "").as_dict()), tmp_path,
                                                2)
    assert {what: outcome["status"] for what, outcome in outcomes.items()} == {what: what for what in outcomes}
    assert outcomes["cannot"]["why"] == "it has no wheels" and "SIGABRT" in outcomes["crashes"]["why"]


def test_materials_agree_at_small_strains_and_do_not_resist_rotation(modules):
    from materials import MATERIALS
    generator = np.random.default_rng(0)
    rotation = np.linalg.qr(generator.normal(size=(3, 3)))[0]
    rotation *= np.sign(np.linalg.det(rotation))
    small = 1e-6 * generator.normal(size=(1, 3, 3))
    strain = 0.5 * (small + np.swapaxes(small, 1, 2))
    hooke = 2 * 3.0 * strain + 2.0 * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(3)
    for stress in set(MATERIALS.values()):
        assert np.abs(stress(np.eye(3) + small, 3.0, 2.0) - hooke).max() < 1e-3 * np.abs(hooke).max()
        assert np.abs(stress(rotation[None], 3.0, 2.0)).max() < 1e-12


def test_the_beam_is_that_of_theory(modules):
    from adapters.tetskin import Simulation
    from scenes import beam
    beam.REFERENCES["coarser reference"] = (8, 2, 2)
    assert "sag" in beam.theory(Simulation)  # raises where it is off by a hundredth


def test_the_program_of_the_page_measures_less_error_in_shorter_steps(obj, tmp_path, monkeypatch, capsys):
    page = (Path(__file__).parents[2] / "plugin/docs/peers.md").read_text()
    program, = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    (tmp_path / "dragon.obj").write_text(obj.read_text())
    monkeypatch.chdir(tmp_path)
    exec(program, {})
    told = re.findall(r"^(\d+) substeps: [\d.]+ ms per frame, error in time ([\d.]+) %", capsys.readouterr().out, re.M)
    assert [int(substeps) for substeps, _ in told] == [1, 2, 4, 8]
    errors = [float(error) for _, error in told]
    assert errors[3] < errors[0] < 5
