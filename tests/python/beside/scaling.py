#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""How demos/examples/python/sweep.py scales with workers, for plugin/docs/many_runs.md; by hand, on a machine at rest.

    scaling.py [ROUNDS]     medians of as many rounds, 5, in which 1 and 2 workers take turns
"""

import pickle
import statistics
import sys
import time
from pathlib import Path

import cloudpickle
from distributed import Client, LocalCluster

sys.path.insert(0, str(Path(__file__).parents[3] / "demos/examples/python"))
import sweep

RUNS, SUBSTEPS, EMPTY = 48, 8, 200


def nothing(plan):
    return {}


def seconds_of(client, function, plans, *inputs):
    started = time.perf_counter()
    rows = list(sweep.farm(client, function, plans, *inputs))
    seconds = time.perf_counter() - started
    assert len(rows) == len(plans) and all(row["status"] == "ok" for _, row in rows)
    return seconds


def measured(client, model):
    """Runs per second; ms per task that does nothing; of these, the processor's for client and scheduler, which are
    one process here."""
    model = sweep.begun(client, pickle.loads, pickle.dumps(model))
    plans = [{"stiffness": 1e5, "substeps": SUBSTEPS, "frames": 90}] * RUNS
    reference = sweep.begun(client, sweep.bend_finely, plans[0], model)
    seconds_of(client, sweep.bend_and_compare, plans[:8], [model] * 8, [reference] * 8)  # everything is there by now
    seconds = seconds_of(client, sweep.bend_and_compare, plans, [model] * RUNS, [reference] * RUNS)
    processor = time.process_time()
    empty = seconds_of(client, nothing, [{"k": k} for k in range(EMPTY)])
    return RUNS / seconds, 1e3 * empty / EMPTY, 1e3 * (time.process_time() - processor) / EMPTY


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    model = sweep.bar_model(500)
    plan = {"stiffness": 1e5, "substeps": SUBSTEPS, "frames": 90}
    cloudpickle.register_pickle_by_value(sweep)  # as when it is the script that runs
    task = cloudpickle.dumps((sweep.attempted, sweep.bend_and_compare, plan))
    cloudpickle.unregister_pickle_by_value(sweep)
    positions, _ = sweep.bend(model, 1e5, SUBSTEPS, 90)
    started = time.thread_time()
    sweep.bend_and_compare(plan, model, positions)
    print(f"model {len(pickle.dumps(model))} bytes, reference {positions.nbytes} bytes, task {len(task)} bytes, "
          f"run {1e3 * (time.thread_time() - started):.0f} ms of the processor")
    figures = {1: [], 2: []}
    for _ in range(rounds):
        for workers, told in figures.items():
            local = {"n_workers": workers, "threads_per_worker": 1, "dashboard_address": ":0"}
            with LocalCluster(**local) as cluster, Client(cluster) as client:
                told.append(measured(client, model))
    for workers, told in figures.items():
        rates, empty, processor = zip(*told)
        print(
            f"{workers} workers: {statistics.median(rates):.1f} runs per second "
            f"({min(rates):.1f} to {max(rates):.1f}), "
            f"{statistics.median(empty):.2f} ms per empty task ({min(empty):.2f} to {max(empty):.2f}), "
            f"{statistics.median(processor):.2f} of the processor in client and scheduler"
        )
    ratios = [two[0] / one[0] for one, two in zip(*figures.values())]
    print(f"2 workers to 1: {statistics.median(ratios):.2f} ({min(ratios):.2f} to {max(ratios):.2f})")


if __name__ == "__main__":
    main()
