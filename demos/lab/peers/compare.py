#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Runs scenes with all peers, error against time, and writes FOLDER/peers.csv. `run` calls it in an environment that
has them.

compare.py [--quick] [--only SCENE]... [--peers LIST] [--out FOLDER] [--check]

Each run is a separate process: a crash, a hang or an explosion becomes a cell of the table. Cases take turns, in
rounds, so that other load of the machine affects all equally; times are processor time, with median, minimum and
maximum. Exit status: 0 done, 2 bad arguments.
"""
import argparse
import csv
import datetime
import importlib
import json
import os
import platform
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.dont_write_bytecode = True
HERE = Path(__file__).resolve().parent
SCENES = [path.stem for path in sorted((HERE / "scenes").glob("*.py")) if path.stem != "__init__"]
PEERS = [path.stem for path in sorted((HERE / "adapters").glob("*.py")) if path.stem != "__init__"]
QUICK = ["beam", "snake", "sag", "slide", "heap", "skin"]  # scenes of --quick, unless --only names others
ROUNDS, ENOUGH = 3, 1.0  # most runs of a case, and seconds in total after which there is no further one
LIMIT, QUICK_LIMIT = 60, 8  # seconds of processor time for one run; a scene may have its own QUICK_LIMIT
COLUMNS = [
    "scene", "peer", "version", "curve", "mesh", "setting", "example", "figure", "value", "ms_per_frame", "ms_least",
    "ms_most", "runs", "status", "why", "load", "date", "machine"
]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0], allow_abbrev=False)
    parser.add_argument("--quick", action="store_true", help=f"fewer settings, once, of {', '.join(QUICK)}")
    parser.add_argument("--only", action="append", metavar="SCENE", help=f"may be repeated: {', '.join(SCENES)}")
    parser.add_argument("--peers", metavar="LIST", help=f"with commas: {','.join(PEERS)}")
    parser.add_argument("--out", metavar="FOLDER", default="out/peers")
    parser.add_argument("--check", action="store_true", help="check the arguments, and run nothing")
    options = parser.parse_args()
    options.scenes = options.only or (QUICK if options.quick else SCENES)
    options.peers = options.peers.split(",") if options.peers else PEERS
    for given, known, kind in ((options.scenes, SCENES, "scene"), (options.peers, PEERS, "peer")):
        for name in given:
            if name not in known:
                parser.error(f"no {kind} is called {name}; there are: {', '.join(known)}")
    return options


def machine():
    """The processor, in words."""
    try:
        names = [line.partition(":")[2].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")]
        return f"{names[0]}, {len(names)} logical processors" if names else platform.machine()
    except OSError:
        return platform.processor() or platform.machine()


def load():
    try:
        return f"{open('/proc/loadavg').read().split()[0]}"
    except OSError:
        return "unknown"


def run_one(scene, task, folder, limit):
    """How one process ended: an outcome as one.py prints it. limit: seconds of processor time."""
    command = [sys.executable, str(HERE / "one.py"), scene, task, str(folder)]
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        process, began = subprocess.Popen(command, cwd=folder, stdout=out, stderr=err), time.monotonic()
        while process.poll() is None:
            time.sleep(0.05)
            stopped = overdue(process.pid, began, limit)
            if stopped:
                process.kill()
                process.wait()
                return stopped
        lines, words = (file.seek(0) or file.read().strip().split("\n") for file in (out, err))
    told = [line for line in lines if line.startswith('{"status"')]
    if process.returncode == 0 and told:
        return json.loads(told[-1])
    if process.returncode < 0:
        words = [f"{signal.Signals(-process.returncode).name} {words[-1]}"]
    return {"status": "crashes", "why": words[-1][:200]}


def overdue(process, began, limit):
    """The message on a process that has taken too long, or None.

    The limit is not set in the process: under RLIMIT_CPU, Linux counts its processor time in ticks of some
    milliseconds.
    """
    try:
        ticks = open(f"/proc/{process}/stat").read().rpartition(")")[2].split()[11:13]
        spent = sum(map(int, ticks)) / os.sysconf("SC_CLK_TCK")
    except OSError:
        spent = 0.0
    if spent > limit:
        return {"status": "too slow", "why": f"more than {limit:.0f} s of processor time"}
    if time.monotonic() - began > 60 + 8 * limit:
        return {"status": "hangs", "why": f"no end within {60 + 8 * limit:.0f} s"}
    return None


def prepare(name, scene, folder, quick):
    if not hasattr(scene, "prepare"):
        return
    done = subprocess.run(
        [sys.executable,
         str(HERE / "one.py"), name, f"--prepare{'=quick' if quick else ''}",
         str(folder)],
        cwd=HERE,
        text=True,
        stdout=subprocess.PIPE)
    if done.returncode:
        sys.exit(f"{name}: its reference was not computed")
    print("\n".join("  " + line for line in done.stdout.strip().split("\n")))


def measured(name, cases, folder, limit, rounds):
    """Outcomes of each case, of all rounds: those that are slow, or not ok, have one."""
    outcomes = [[] for _ in cases]
    for turn in range(rounds):
        for k, case in enumerate(cases):
            done = outcomes[k]
            if done and (done[0]["status"] != "ok" or sum(one["cost"] for one in done) > ENOUGH):
                continue
            done.append(run_one(name, json.dumps(case.as_dict()), folder, limit))
            if turn == 0:
                print(f"  {line_of(case, done[0])}", flush=True)
    return outcomes


def line_of(case, outcome):
    told = f"{outcome['status']}: {outcome['why']}"
    if outcome["status"] == "ok":
        figures = [f"{name} {value:.4g}" for name, value in outcome["figures"].items() if value is not None]
        told = "  ".join([f"{outcome['ms']:8.2f} ms", *figures])
    what = ", ".join(words for words in (case.curve, case.mesh, case.words) if words)
    return f"{case.peer:9s} {what}{' *' if case.example else ''}: {told}"


def rows_of(name, cases, outcomes, where):
    """Rows of the table: one for each figure of each case. where: columns that all have."""
    for case, done in zip(cases, outcomes):
        first, good = done[0], [one for one in done if one["status"] == "ok"]
        times = [one["ms"] for one in good]
        row = {
            "scene": name,
            "peer": case.peer,
            "version": first.get("version", ""),
            "curve": case.curve,
            "mesh": case.mesh,
            "setting": case.words,
            "example": int(case.example),
            "runs": len(done),
            "status": first["status"],
            "why": first["why"],
            **where
        }
        if not good:
            yield row
            continue
        row |= {"ms_per_frame": f"{statistics.median(times):.5g}", "ms_least": f"{min(times):.5g}",
                "ms_most": f"{max(times):.5g}"}
        for figure in good[0]["figures"]:
            values = [one["figures"][figure] for one in good if one["figures"][figure] is not None]
            if values:
                yield row | {"figure": figure, "value": f"{statistics.median(values):.5g}"}


def main():
    options = arguments()
    if options.check:
        return
    folder = Path(options.out).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    began, rows = time.time(), []
    where = {"date": str(datetime.date.today()), "machine": f"{machine()}, Python {platform.python_version()}"}
    for name in options.scenes:
        scene = importlib.import_module(f"scenes.{name}")
        print(f"{name}: {scene.TITLE} (load {load()})", flush=True)
        prepare(name, scene, folder, options.quick)
        cases = [case for case in scene.plan(options.quick) if case.peer in options.peers]
        start, before = time.time(), load()
        limit = getattr(scene, "QUICK_LIMIT", QUICK_LIMIT) if options.quick else LIMIT
        outcomes = measured(name, cases, folder, limit, 1 if options.quick else ROUNDS)
        rows += rows_of(name, cases, outcomes, {"load": f"{before} to {load()}", **where})
        write(folder / "peers.csv", rows)  # after each scene, so that an interrupted run keeps its rows
        print(f"  {time.time() - start:.0f} s")
    try:
        import draw
    except ImportError as fault:
        print(f"no plots: {fault}")
    else:
        draw.draw(folder / "peers.csv", folder)
    print(f"{len(rows)} rows in {folder / 'peers.csv'}, after {(time.time() - began) / 60:.1f} minutes")


def write(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


if __name__ == "__main__":
    main()
