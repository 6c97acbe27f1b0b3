#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The effect of a change on the bits: runs the demos of two builds, and says which scenes end differently.

    tests/golden/compare.py BEFORE AFTER [--quick] [--only TEXT...]

BEFORE and AFTER are build folders with demos, of two commits on one machine: no hashes are stored, because processors
with other vector instructions, and other compilers, round differently. One line per scene that differs, that only one
of them has, or that failed; exit status 1 if there is any. Without --quick a minute and a half, and every case of
stress by tetskin's force; the same folder twice shows that runs repeat themselves.
"""
import argparse
import concurrent.futures
import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile

SERPENT = ["--triangles", "8000"]
RUNS = {  # name: program and arguments; (of all runs, of --quick)
    "drop": (["tetskin_drop"], ["tetskin_drop", *SERPENT, "--tets", "500", "--frames", "90"]),
    "drop hand": (["tetskin_drop", "--model", "hand", "--tets", "1000", "--triangles", "20000"], None),
    "drop by the cage": (["tetskin_drop", "--contact", "cage", "--tets", "1000"],
                         ["tetskin_drop", *SERPENT, "--tets", "300", "--frames", "60", "--contact", "cage"]),
    "drop of Bullet's force": (["tetskin_drop", "--elasticity", "bullet", "--contact", "cage", "--tets", "1000"],
                               ["tetskin_drop", *SERPENT, "--tets", "300", "--frames", "30", "--elasticity", "bullet",
                                "--contact", "cage"]),
    "drop reduced": (["tetskin_drop", "--body", "reduced", "--contact", "cage", "--tets", "500", "--fine-tets", "3000",
                      "--triangles", "20000"], None),
    "pile": (["tetskin_pile"], ["tetskin_pile", "--bodies", "3", "--tets", "200", "--triangles", "4000", "--frames",
                                "90"]),
    "balls on a mat": (["tetskin_pile", "--scene", "pit", "--bodies", "10", "--frames", "120"],
                       ["tetskin_pile", "--scene", "pit", "--bodies", "4", "--tets", "300", "--frames", "60"]),
    "cubes in a bin": (["tetskin_pile", "--scene", "bin", "--bodies", "25", "--frames", "180"],
                       ["tetskin_pile", "--scene", "bin", "--bodies", "17", "--tets", "40", "--frames", "90"]),
    "drag": (["tetskin_drag"], ["tetskin_drag", *SERPENT, "--tets", "300", "--frames", "90"]),
}
CAGES = {
    "serpent": (["--tets", "3000"], ["--triangles", "20000", "--tets", "1000"]),
    "serpent, 30,000": (["--tets", "30000"], None),
    "serpent, calibrated": (["--triangles", "20000", "--tets", "300", "--calibrate"], None),
    "hand": (["--model", "hand", "--tets", "1000"], ["--model", "hand", "--triangles", "8000", "--tets", "500"]),
    "hand, whole": (["--model", "hand", "--tets", "1000", "--no-duplicate-elements"], None),
    "slotted beam": (["--model", "slotted_beam", "--tets", "300"], ["--model", "slotted_beam", "--tets", "300"]),
    "bar, calibrated": (["--model", "bar", "--tets", "100", "--calibrate"], None),
}


EARLIER = {"--elasticity": "--force", "--no-duplicate-elements": "--whole"}  # in builds of earlier versions


def run(build, arguments):
    program = pathlib.Path(build).resolve() / "demos" / arguments[0]
    result = subprocess.run([program, *arguments[1:]], capture_output=True, text=True)
    if result.returncode != 2 or not EARLIER.keys() & set(arguments):
        return result
    earlier = [EARLIER.get(argument, argument) for argument in arguments]
    return subprocess.run([program, *earlier[1:]], capture_output=True, text=True)


def said(result):
    """The line that --hash prints, or the error."""
    hashes = [line for line in result.stdout.splitlines() if line.startswith("nodes of ")]
    return hashes[0] if hashes else f"exit status {result.returncode}: {result.stderr.strip()[-200:]}"


def hash_of_run(build, arguments):
    with tempfile.TemporaryDirectory() as folder:
        view = ["--no-view"] if arguments[0] == "tetskin_drop" else []
        return said(run(build, [*arguments, "--hash", "--quiet", "--every", "1000", *view, "--out", f"{folder}/frames"]))


def hash_of_cage(build, arguments):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "cage.vtk"
        result = run(build, ["tetskin_cage", "--quiet", *arguments, "-o", str(file)])
        if not file.exists():
            return f"exit status {result.returncode}: {result.stderr.strip()[-200:]}"
        return hashlib.sha256(file.read_bytes()).hexdigest()[:16]


def hashes_of_stress(build, quick):
    """The hashes of the cases, by name."""
    now = (pathlib.Path(build) / "demos" / "tetskin_measure").exists()  # earlier, a separate program
    program = ["tetskin_measure", "--group", "stress"] if now else ["tetskin_stress"]
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "stress.json"
        result = run(build, [*program, "--elasticity", "tetskin", "--quiet", "--json", str(file),
                             *(["--quick"] if quick else [])])
        cases = json.loads(file.read_text()) if file.exists() else []
    found = {"stress " + case.get("scene", case.get("name")): case["hash"] for case in cases}
    return found or {"stress": f"exit status {result.returncode}: {result.stderr.strip()[-200:]}"}


def tasks(quick):
    """Each name with a function of a build, which returns a hash or a table of hashes."""
    which = 1 if quick else 0
    for name, lists in RUNS.items():
        if lists[which]:
            yield name, lambda build, a=lists[which]: hash_of_run(build, a)
    for name, lists in CAGES.items():
        if lists[which]:
            yield "cage of " + name, lambda build, a=lists[which]: hash_of_cage(build, a)
    yield "stress", lambda build: hashes_of_stress(build, quick)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("--quick", action="store_true", help="small models and short runs, in half a minute")
    parser.add_argument("--only", nargs="+", default=[""], help="only what has one of these in its name")
    options = parser.parse_args()
    for build in (options.before, options.after):
        if not (pathlib.Path(build) / "demos" / "tetskin_drop").exists():
            parser.error(f"{build}: has no demos/tetskin_drop; build the demos there")
    chosen = [(name, task) for name, task in tasks(options.quick) if any(text in name for text in options.only)]
    if not chosen:
        parser.error(f"--only {' '.join(options.only)}: no scene has that in its name")
    compared = faults = 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        pairs = [(name, [pool.submit(task, build) for build in (options.before, options.after)])
                 for name, task in chosen]
        for name, pair in pairs:
            before, after = (future.result() for future in pair)
            if not isinstance(before, dict):
                before, after = {name: before}, {name: after}
            for case in {**before, **after}:
                was, now = before.get(case, "not there"), after.get(case, "not there")
                compared += 1
                if was != now or was.startswith(("exit status", "no hash")):
                    faults += 1
                    print(f"{case}: {was}, {now}", flush=True)
    print(f"{compared} scenes compared, {compared - faults} with the same bits")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
