# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""One run of one case in a separate process: compare.py calls it.

one.py SCENE JSON FOLDER        runs a case, and prints its outcome as the last line, in JSON
one.py SCENE --prepare FOLDER   computes what the scene's errors are measured against, into FOLDER/SCENE.npz
"""
import importlib
import json
import os
import sys
import time
import traceback
from pathlib import Path

THREADS = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS")}
os.environ.update(THREADS)  # before anything that reads them is imported
sys.dont_write_bytecode = True

import numpy as np  # noqa: E402

from plan import Case  # noqa: E402
from problem import Unsupported  # noqa: E402


class Clock:
    """Processor time of the whole process, all its threads, while it is entered."""

    def __init__(self):
        self.seconds, self.parts = 0.0, []

    def __enter__(self):
        self.began = time.process_time()

    def __exit__(self, *_):
        self.parts.append(time.process_time() - self.began)
        self.seconds += self.parts[-1]


ABSURD, ABSURD_ERROR = 1e5, 1e3  # no figure of a simulation that holds is larger: millimetres and the like, percent


class Exploded(Exception):
    """The simulation has left all bounds."""


def finite(figures):
    """The figures, with those of a lost simulation refused."""
    for name, value in figures.items():
        if value is not None and not abs(value) < (ABSURD_ERROR if "error" in name else ABSURD):  # nan is not
            raise Exploded("a position is not finite, or far away")
    return {name: None if value is None else float(value) for name, value in figures.items()}


def outcome_of(scene, case, folder):
    """The data that compare.py writes: status, reason in words, figures, ms per frame."""
    clock = Clock()
    try:
        adapter = importlib.import_module(f"adapters.{case.peer}")
    except ImportError as fault:
        return {"status": "not installed", "why": str(fault)}
    path = folder / f"{scene.__name__.rpartition('.')[2]}.npz"
    references = dict(np.load(path)) if path.exists() else {}
    began = time.process_time()
    try:
        figures = finite(scene.run(adapter.Simulation, case, clock, references))
    except Unsupported as reason:
        return {"status": "cannot", "why": str(reason), "version": adapter.VERSION}
    except Exploded as reason:
        return {"status": "explodes", "why": str(reason), "version": adapter.VERSION}
    except Exception as fault:  # a peer's exception is also a result
        traceback.print_exc()
        return {"status": "fails", "why": f"{type(fault).__name__}: {fault}".split("\n")[0], "version": adapter.VERSION}
    frames = max(len(clock.parts), 1)
    return {
        "status": "ok",
        "why": "",
        "figures": figures,
        "ms": 1e3 * clock.seconds / frames,
        "version": adapter.VERSION,
        "cost": time.process_time() - began
    }


def main(name, task, folder):
    scene = importlib.import_module(f"scenes.{name}")
    folder = Path(folder)
    if task.startswith("--prepare"):
        references, words = scene.prepare(quick=task.endswith("=quick"))
        np.savez(folder / f"{name}.npz", **references)
        print(words)
        return
    print(json.dumps(outcome_of(scene, Case(**json.loads(task)), folder)))


if __name__ == "__main__":
    main(*sys.argv[1:])
