# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""demos/examples/python/sweep.py: runs on several workers, whatever becomes of these, end as those in one process."""

import contextlib
import csv
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import tetskin as ts

pytest.importorskip("distributed")
pytest.importorskip("pandas")
pytest.importorskip("matplotlib")
from distributed import Client, LocalCluster

from conftest import torus

SCRIPT = Path(__file__).parents[3] / "demos/examples/python/sweep.py"
HANG = 300  # seconds after which a program counts as hanging, on any machine

sys.path.insert(0, str(SCRIPT.parent))  # also that of processes that are spawned, which find both modules by it
import sweep


@pytest.fixture(scope="module")
def cluster():
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0") as cluster:
        yield cluster


@pytest.fixture
def client(cluster):
    with Client(cluster) as client:
        yield client


def options(*arguments):
    return sweep.options_of(["--quick", "--tets", "60", "--frames", "6", *arguments])


def result_of(table):
    """The data that does not depend on which worker has made a run, and when."""
    return table.drop(columns=["worker", "ms_per_frame", "actions"], errors="ignore")


def program(*arguments, folder):
    command = [sys.executable, str(SCRIPT), "--quick", "--tets", "60", "--frames", "6", "--output", str(folder)]
    return subprocess.run([*command, *arguments], capture_output=True, text=True, timeout=HANG)


def rows_of(path):
    with open(path) as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("what", ["sweep", "rollouts"])
def test_runs_on_workers_are_those_of_one_process_to_the_bit(what, client):
    work = getattr(sweep, what)
    there, here = work(client, options(what, "--frames", "20")), work(None, options(what, "--frames", "20"))
    assert result_of(there).equals(result_of(here)) and there["status"].eq("ok").all()
    assert there["sha256"].nunique() > 3  # some rollouts do not reach the ball
    assert set(there["worker"]).isdisjoint(here["worker"])


def test_other_bits_are_found():
    table = sweep.sweep(None, options("--stiffness", "1e5"))
    other = table.copy()
    assert sweep.differing(table, other) == 0
    other.loc[1, "sha256"] = table.loc[0, "sha256"]
    other.loc[2, "status"] = "lost"
    assert sweep.differing(table, other) == 2


class KillsItsWorker:
    """A run of the sweep whose worker is killed in the middle, as by the system when memory is short."""

    def __init__(self, marker, substeps):
        self.marker, self.substeps, self.run = marker, substeps, sweep.bend_and_compare

    def __call__(self, plan, model, reference):
        if plan["substeps"] == self.substeps and plan["stiffness"] == 1e5 and self.is_to_die():
            sweep.bend(model, plan["stiffness"], plan["substeps"], plan["frames"] // 2)
            os.kill(os.getpid(), signal.SIGKILL)
        return self.run(plan, model, reference)

    def is_to_die(self):
        """Always, or, with a marker, for the first that comes."""
        if not self.marker:
            return True
        try:
            os.close(os.open(self.marker, os.O_CREAT | os.O_EXCL))
        except FileExistsError:
            return False
        return True


def test_a_killed_worker_costs_its_run_again_and_no_result(client, tmp_path, monkeypatch):
    undisturbed = sweep.sweep(client, options())
    marker = tmp_path / "killed"
    monkeypatch.setattr(sweep, "bend_and_compare", KillsItsWorker(marker, 2))
    disturbed = sweep.sweep(client, options())
    assert marker.exists() and result_of(disturbed).equals(result_of(undisturbed))


def test_a_run_that_kills_all_its_workers_is_a_row_and_the_others_go_on(cluster, client, monkeypatch):
    monkeypatch.setattr(cluster.scheduler, "allowed_failures", 0)  # each current run is given up, at first
    monkeypatch.setattr(sweep, "bend_and_compare", KillsItsWorker(None, 2))
    table = sweep.sweep(client, options())
    failed = table[table["status"].ne("ok")]
    assert len(table) == 9 and failed[["stiffness", "substeps"]].values.tolist() == [[1e5, 2]]
    assert failed["status"].item().startswith("lost: KilledWorker")


def test_a_run_that_fails_is_a_row_and_the_others_go_on(client):
    table = sweep.sweep(client, options("--stiffness", "1e5,-1", "--substeps", "0,2"))
    status = {(row["stiffness"], row["substeps"]): row["status"] for _, row in table.iterrows()}
    assert status[1e5, 2] == "ok" and status[1e5, 0].startswith("ValueError: substeps")
    assert status[-1, 0].startswith("Error: the stiffness") and status[-1, 2] == status[-1, 0]


def test_a_worker_of_another_version_runs_nothing(client, monkeypatch):
    monkeypatch.setattr(ts, "__version__", "0.0")
    table = sweep.sweep(client, options("--stiffness", "1e5"))
    assert table["status"].str.startswith("not run: tetskin").all()


def test_an_interrupted_sweep_keeps_the_rows_that_it_has(tmp_path, monkeypatch):
    run = sweep.bend_and_compare

    def interrupted(plan, model, reference):
        if plan["substeps"] == 4:
            raise KeyboardInterrupt
        return run(plan, model, reference)

    monkeypatch.setattr(sweep, "bend_and_compare", interrupted)
    monkeypatch.setattr(sweep, "connected", lambda options: contextlib.nullcontext())
    assert sweep.main(["--quick", "--tets", "60", "--frames", "6", "--check", "--output", str(tmp_path)]) == 130
    status = [row["status"] for row in rows_of(tmp_path / "sweep.csv")]
    assert status == ["ok"] * 2 + [sweep.INTERRUPTED] * 7


def test_the_script_runs_on_the_workers_of_an_address(cluster, tmp_path):
    run = program("--scheduler", cluster.scheduler_address, "--check", "--stiffness", "1e5,-1", folder=tmp_path / "new")
    assert run.returncode == 0, run.stderr
    assert "the same to the bit as in one process" in run.stdout and "3 x Error: the stiffness" in run.stdout
    assert "6 of 6 runs, 3 failed" in run.stderr
    rows = rows_of(tmp_path / "new/sweep.csv")
    runs = [(row["stiffness"], row["substeps"]) for row in rows]
    assert runs == [(s, n) for s in ("100000.0", "-1.0") for n in "124"]
    assert all(0 < float(row["error"]) < 0.1 and float(row["ms_per_frame"]) > 0 for row in rows[:3])
    assert (tmp_path / "new/sweep.png").read_bytes().startswith(b"\x89PNG")


def test_the_script_makes_rollouts_on_workers_of_its_own(tmp_path):
    run = program("rollouts", "--workers", "1", "--generations", "1", "--check", folder=tmp_path)
    assert run.returncode == 0, run.stderr
    assert "the same to the bit as in one process" in run.stdout and "best: rollout" in run.stdout
    assert len(rows_of(tmp_path / "rollouts.csv")) == 8 and (tmp_path / "rollouts.png").exists()


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense:abc", "foo://x:1"])
def test_an_address_without_scheduler_is_refused_with_the_cure(address, tmp_path, capsys):
    assert sweep.main(["--scheduler", address, "--timeout", "1", "--output", str(tmp_path)]) == 2
    told = capsys.readouterr().err
    assert f"no scheduler at {address}" in told and "dask scheduler" in told


@pytest.mark.parametrize("arguments", [["--stiffness", "x"], ["--workers", "0"], ["--tets", "-1"], ["fly"]])
def test_arguments_that_mean_nothing_are_refused(arguments, capsys):
    with pytest.raises(SystemExit) as ended:
        sweep.main(arguments)
    assert ended.value.code == 2 and "usage:" in capsys.readouterr().err


def test_the_program_of_the_page_runs_as_written_and_prints_what_it_shows(tmp_path):
    """As a separate file, which its workers import, with the torus of the other pages."""
    page = (Path(__file__).parents[3] / "plugin/docs/many_runs.md").read_text()
    (code,), (shown,) = (re.findall(rf"```{language}\n(.*?)```", page, re.DOTALL) for language in ("python", "text"))
    (tmp_path / "program.py").write_text(code)
    positions, triangles = torus()
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in positions.tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles.tolist()]
    (tmp_path / "dragon.obj").write_text("\n".join(lines) + "\n")
    command = [sys.executable, "program.py"]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=HANG)
    assert run.returncode == 0, run.stderr
    assert run.stdout == shown


def test_workers_without_tetskin_or_with_another_are_refused(tmp_path):
    """In the place of another version is one that metadata alone claim, and in front of the real one."""
    (tmp_path / "tetskin-0.0.dist-info").mkdir()
    (tmp_path / "tetskin-0.0.dist-info/METADATA").write_text("Metadata-Version: 2.1\nName: tetskin\nVersion: 0.0\n")
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    with LocalCluster(n_workers=0, dashboard_address=":0") as cluster:
        run = program("--scheduler", cluster.scheduler_address, "--timeout", "1", folder=tmp_path / "new")
        assert run.returncode == 2 and "has no workers" in run.stderr and "dask worker" in run.stderr
        command = [sys.executable, "-m", "distributed.cli.dask_worker", cluster.scheduler_address, "--no-nanny"]
        worker = subprocess.Popen([*command, "--nthreads", "1", "--no-dashboard"], env=environment)
        try:
            run = program("--scheduler", cluster.scheduler_address, "--timeout", str(HANG), folder=tmp_path / "new")
        finally:
            worker.kill()
            worker.wait()
    assert run.returncode == 2 and "tetskin 0.0" in run.stderr and f"Install tetskin {ts.__version__}" in run.stderr
