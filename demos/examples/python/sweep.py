#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
# mypy: disable-error-code="no-untyped-call"
# distributed has types in part.
# %% [markdown]
# # Thousands of runs on more than one machine
#
# `sweep.py` bends a bar for every stiffness and every number of steps per frame, and reports the error and the cost of
# each run. `sweep.py rollouts` pushes a ball to a target: hundreds of tries from one snapshot, and from the best of
# them the next generation. Both do it through Dask's `distributed`, on workers of this machine or, with `--scheduler
# ADDRESS`, of a cluster; and both give the same bits as one process alone, which `--check` compares.
#
# Needs `pip install distributed pandas matplotlib` beside `tetskin`, in the same versions on all machines.

# %%
from __future__ import annotations

import argparse
import contextlib
import gc
import hashlib
import itertools
import logging
import math
import os
import pickle
import socket
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from distributed import Client, Future, KilledWorker, LocalCluster, as_completed, wait
from matplotlib.figure import Figure

import tetskin as ts

FRAME = 1 / 60  # seconds
Model = tuple[ts.TriangleMesh, ts.Cage]
Row = dict[str, Any]  # of a table; each has a "status", which is "ok" or says what went wrong
INTERRUPTED = "not run: interrupted"


# %% [markdown]
# ## The models
#
# They are made once, here. Meshes, cages and snapshots can be pickled, so that every worker gets the same bits,
# whatever machine it is on. A world cannot: instead, send the function that builds it, and `world.save()`.

# %%
def box_mesh(size: Sequence[float], cells: Sequence[int]) -> ts.TriangleMesh:
    """The surface of a box about the origin, with this many cells along each axis. size: rest units."""
    points, triangles, first = [], [], 0
    for axis, far in itertools.product(range(3), (False, True)):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        i, j = np.meshgrid(np.arange(cells[u] + 1), np.arange(cells[v] + 1), indexing="ij")
        point = np.full((i.size, 3), cells[axis] if far else 0)
        point[:, u], point[:, v] = i.ravel(), j.ravel()
        a = first + (i * (cells[v] + 1) + j)[:-1, :-1].ravel()
        b, c, d = a + cells[v] + 1, a + cells[v] + 2, a + 1
        two = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])
        points.append(point)
        triangles.append(two if far else two[:, ::-1])
        first += i.size
    # Faces share the vertices of their edges.
    lattice, index = np.unique(np.concatenate(points), axis=0, return_inverse=True)
    return ts.TriangleMesh((lattice / cells - 0.5) * size, index.reshape(-1)[np.concatenate(triangles)])


def bar_model(tets: int) -> Model:
    mesh = box_mesh((2, 0.4, 0.4), (40, 8, 8))
    return mesh, ts.create_cage(mesh, target_tets=tets)


def ball_model(tets: int, radius: float = 0.3) -> Model:
    cube = box_mesh((2, 2, 2), (12, 12, 12))
    positions = radius * cube.positions / np.linalg.norm(cube.positions, axis=1, keepdims=True)
    mesh = ts.TriangleMesh(positions, cube.triangles)
    return mesh, ts.create_cage(mesh, target_tets=tets)


def new_world() -> ts.World:
    # One thread per world: the runs themselves keep all cores busy, and two threads that wait for each other within a
    # step of 0.2 ms are slower than two runs. deterministic: machines of a cluster may have different processors.
    return ts.World(threads=1, deterministic=True, record_forces=False)


# %% [markdown]
# ## A run of the sweep
#
# A bar, held at one end, bends under its weight and swings. The reference makes many more steps, solved more precisely.
# Positions of the whole surface are compared after every frame; the error is their root mean square, divided by that of
# the motion since rest. The time is that of the processor within the steps, in the worker: it does not depend on what
# else is computed there, or only little, while the time on the clock would.

# %%
def bend(model: Model, stiffness: float, substeps: int, frames: int, **solver: Any) -> tuple[np.ndarray, float]:
    """Positions (frames, vertices, 3) float32 of the bar's surface, world space, and the processor's ms per frame."""
    mesh, cage = model
    body = (world := new_world()).add_body(
        cage,
        mesh,
        pinned=cage.nodes[:, 0] < -0.9,
        youngs_modulus=stiffness,
        density=1000,
        stiffness_damping=0,
        **solver,
    )
    positions = np.empty((frames, mesh.vertex_count, 3), np.float32)
    seconds = 0.0
    for frame in range(frames):
        started = time.thread_time()
        world.step(FRAME, substeps=substeps)
        seconds += time.thread_time() - started
        positions[frame] = body.positions
    return positions, 1e3 * seconds / frames


def bend_finely(plan: Row, model: Model) -> np.ndarray | Exception:
    """The reference of all runs of one stiffness: positions like those of `bend`, or why there are none."""
    try:
        precise = {"solver_tolerance": 1e-6, "max_iterations": 1000}
        return bend(model, plan["stiffness"], plan["substeps"], plan["frames"], **precise)[0]
    except Exception as error:  # each of the stiffness's runs is to be a row
        return error


def bend_and_compare(plan: Row, model: Model, reference: np.ndarray | Exception) -> Row:
    if isinstance(reference, Exception):
        raise reference
    positions, milliseconds = bend(model, plan["stiffness"], plan["substeps"], plan["frames"])
    if not np.isfinite(positions).all():
        return {"status": "positions are not finite"}
    # Not by np.linalg.norm, whose sums depend on the number of the processor's cores.
    error, motion = (np.sqrt(np.square(x).sum()) for x in (positions - reference, reference - model[0].positions))
    return {"error": error / motion, "ms_per_frame": milliseconds, "sha256": hash_of(positions)}


def hash_of(array: np.ndarray) -> str:
    return hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest()


# %% [markdown]
# ## A rollout
#
# A ball lies on the ground, and a paddle beside it pushes it. All rollouts begin with one snapshot, in which the ball
# has come to rest; they differ in the actions, the paddle's velocities.

# %%
KNOTS = 6  # of a rollout's actions
TARGET = np.array([1.0, 0.3])  # x, z: where the ball's centre is to be at the end, at rest


def actions_of(knots: np.ndarray, frames: int) -> np.ndarray:
    """(frames, 2) float64: velocities along x and z, world length / s, linear between `knots` (KNOTS, 2)."""
    at = np.linspace(0, len(knots) - 1, frames)
    return np.stack([np.interp(at, range(len(knots)), knots[:, k]) for k in (0, 1)], -1)


def table_top(model: Model) -> tuple[ts.World, ts.Body, ts.RigidBody]:
    mesh, cage = model
    world = new_world()
    world.add_plane()
    ball = world.add_body(cage, mesh, position=(0, 0.3, 0), friction=0.8, youngs_modulus=2e4, stiffness_damping=0.01)
    return world, ball, world.add_box((0.05, 0.2, 0.25), position=(-0.4, 0.25, 0), kinematic=True)


def at_rest(model: Model, frames: int = 90) -> bytes:
    """The snapshot with which all rollouts begin."""
    world, _, _ = table_top(model)
    for _ in range(frames):
        world.step(FRAME)
    return world.save()


def centre(ball: ts.Body) -> np.ndarray:
    """Mean of the surface, x and z, world space. Exact sums: NumPy's may differ by the processor in their last bit."""
    return np.array([math.fsum(ball.positions[:, k].tolist()) for k in (0, 2)]) / len(ball.positions)


def roll_out(plan: Row, model: Model, snapshot: bytes) -> Row:
    """plan["actions"]: (frames, 2) float64, the paddle's velocity along x and z in each frame, world length / s."""
    world, ball, paddle = table_top(model)
    world.restore(snapshot)
    history = hashlib.sha256()
    for x, z in plan["actions"].tolist():
        before = centre(ball)
        paddle.position = (paddle.position + np.array([FRAME * x, 0, FRAME * z])).tolist()
        world.step(FRAME)
        history.update(ball.positions.tobytes())
    off, speed = centre(ball) - TARGET, (centre(ball) - before) / FRAME
    reward = -math.hypot(*off) - 0.1 * math.hypot(*speed)
    if not math.isfinite(reward):
        return {"status": "positions are not finite"}
    return {"reward": reward, "sha256": history.hexdigest()}


# %% [markdown]
# ## Many of them
#
# A worker runs `attempted`: a run that fails becomes a row that says so, and the others continue. Dask makes a run
# again whose worker is lost; it gives up a run with which more than `distributed.scheduler.allowed-failures` (3) were
# lost.

# %%
def attempted(plan: Row, *inputs: Any, function: Callable[..., Row], version: str) -> Row:
    told = {"status": "ok", "worker": f"{socket.gethostname()}:{os.getpid()}"}
    if ts.__version__ != version:  # a worker that has joined since
        return {**told, "status": f"not run: tetskin {ts.__version__} there, and {version} here"}
    try:
        return {**told, **function(plan, *inputs)}
    except Exception as error:  # any error belongs to this run
        return {**told, "status": f"{type(error).__name__}: {error}".splitlines()[0]}


def begun(client: Client | None, function: Callable[..., Any], *inputs: Any) -> Any:
    """A future of the function's result; without a client, the result.

    Data that many runs need is the result of such a task, and is sent once to each worker that runs some of them. It is
    not scattered, as Dask makes again what was lost with its workers only if a task has made it.
    """
    return client.submit(function, *inputs, pure=False) if client else function(*inputs)


def farm(
    client: Client | None, function: Callable[..., Row], plans: list[Row], *inputs: Any
) -> Iterator[tuple[int, Row]]:
    """Yields the index of a plan and its row, in the order in which they are done; without a client, here.

    inputs  the function's arguments after the plan: for each a list, of as many values or futures as there are plans
    """
    run: dict[str, Any] = {"function": function, "version": ts.__version__}
    if not client:
        yield from ((k, attempted(*arguments, **run)) for k, arguments in enumerate(zip(plans, *inputs)))
        return
    # With a lost worker, Dask counts a failure of all runs that it had been given, not only of the one that it was at.
    # So workers get few at a time; and those that Dask has given up are tried once more, each alone.
    waiting, given_up = enumerate(zip(plans, *inputs)), []
    threads, counted = 0, -math.inf
    index: dict[Future[Row], int] = {}

    def begin(k: int, arguments: tuple[Any, ...]) -> Future[Row]:
        future = client.submit(attempted, *arguments, **run, pure=False)  # or results of another sweep were ours
        index[future] = k
        return future

    def next_ones() -> list[Future[Row]]:
        nonlocal threads, counted
        if time.monotonic() - counted > 1:  # workers come and go
            threads, counted = sum(client.nthreads().values()), time.monotonic()
        free = max(1, 2 * threads - len(index))
        return [begin(k, arguments) for k, arguments in itertools.islice(waiting, free)]

    try:
        running = as_completed(next_ones(), with_results=True, raise_errors=False)
        for future, result in running:
            k = index.pop(future)
            running.update(next_ones())
            if future.status == "finished":
                yield k, result
            elif isinstance(future.exception(), KilledWorker):
                given_up.append(k)
            else:
                yield k, {"status": lost(result)}
        for k in given_up:
            future = begin(k, (plans[k], *(of_all[k] for of_all in inputs)))
            wait(future)
            yield k, future.result() if future.status == "finished" else {"status": lost(future.exception())}
    finally:  # also if the caller was interrupted
        client.cancel(list(index))


def lost(result: Any) -> str:
    """The row of a run that Dask has given up, whose result is an exception or `sys.exc_info` of one."""
    error = result[1] if isinstance(result, tuple) else result
    return f"lost: {type(error).__name__}: {error}".splitlines()[0]


def table_of(plans: list[Row], rows: Iterator[tuple[int, Row]]) -> pd.DataFrame:
    """All plans with their rows, in the plans' order, whatever the order in which they come. Prints the progress."""
    done: list[Row] = [{"status": INTERRUPTED} for _ in plans]
    terminal = sys.stderr.isatty()
    pause = 0.1 if terminal else 10.0  # seconds from one line to the next, which in a terminal replaces it
    started = told = time.monotonic()
    failed = 0
    with contextlib.suppress(KeyboardInterrupt):  # the rows so far are kept
        for count, (k, row) in enumerate(rows, 1):
            done[k] = row
            failed += row["status"] != "ok"
            now, last = time.monotonic(), count == len(plans)
            if last or now - told > pause:
                told = now
                line = f"{count} of {len(plans)} runs, {failed} failed, {count / (now - started):.1f} per second"
                print(line, end="\r" if terminal and not last else "\n", file=sys.stderr, flush=True)
    return pd.DataFrame([{**plan, **row} for plan, row in zip(plans, done)])


# %%
def sweep(client: Client | None, options: argparse.Namespace) -> pd.DataFrame:
    """A row for every stiffness and number of substeps."""
    # As bytes, which the scheduler only passes on.
    model = begun(client, pickle.loads, pickle.dumps(bar_model(options.tets)))
    plan = {"frames": options.frames}
    fine = {**plan, "substeps": options.reference}
    references = {s: begun(client, bend_finely, {**fine, "stiffness": s}, model) for s in options.stiffness}
    plans = [{**plan, "stiffness": s, "substeps": n} for s in options.stiffness for n in options.substeps]
    inputs = [model] * len(plans), [references[plan["stiffness"]] for plan in plans]
    return table_of(plans, farm(client, bend_and_compare, plans, *inputs))


def rollouts(client: Client | None, options: argparse.Namespace) -> pd.DataFrame:
    """A row for every rollout, with its actions. The cross-entropy method: each generation is drawn about the best
    eighth of the last one."""
    random = np.random.default_rng(options.seed)
    model = begun(client, pickle.loads, pickle.dumps(ball_model(options.tets)))
    snapshot = begun(client, at_rest, model)
    mean, spread = np.tile([0.4, 0.0], (KNOTS, 1)), np.full((KNOTS, 2), 0.5)
    generations = []
    for generation in range(options.generations):
        knots = mean + spread * random.standard_normal((options.rollouts, KNOTS, 2))
        actions = [actions_of(one, options.frames) for one in knots]
        plans = [{"generation": generation, "rollout": k, "actions": one} for k, one in enumerate(actions)]
        table = table_of(plans, farm(client, roll_out, plans, [model] * len(plans), [snapshot] * len(plans)))
        rewards = table.reindex(columns=["reward"])["reward"].fillna(-np.inf).to_numpy()
        best = np.argsort(-rewards, kind="stable")[: max(2, options.rollouts // 8)]
        mean, spread = knots[best].mean(0), knots[best].std(0)
        generations.append(table)
        if table["status"].eq(INTERRUPTED).any():
            break
    return pd.concat(generations, ignore_index=True)


# %% [markdown]
# ## Workers
#
# Without `--scheduler`, they are processes on this machine. With it, they are all `dask worker`s that have been started
# for that scheduler: with the same version of tetskin, since another one may have other bits.

# %%
class Refused(Exception):
    """Nothing can be run; the text says what to do."""


def version_of(told: Any) -> str:
    """In one of `Client.get_versions`. Functions are sent as Python's code, which is its minor version's."""
    python = ".".join(str(told["host"]["python"]).split(".")[:2])
    version = told["packages"]["tetskin"]
    return f"Python {python}, " + (f"tetskin {version}" if version else "no tetskin")


def check_versions(client: Client) -> None:
    """Versions of the workers, and of the scheduler, which opens the tasks before it passes them on."""
    versions: Any = client.get_versions(packages=["tetskin"])
    here = version_of(versions["client"])
    there = {"the scheduler": versions["scheduler"], **versions["workers"]}
    others = {name: version_of(told) for name, told in there.items() if version_of(told) != here}
    if others:
        raise Refused(
            f"other versions than this program's ({here}) have other bits, or none:\n"
            + "".join(f"  {name}: {version}\n" for name, version in sorted(others.items()))
            + f"Install tetskin {ts.__version__} there, for the same Python, and start these anew."
        )


@contextlib.contextmanager
def connected(options: argparse.Namespace) -> Iterator[Client]:
    if options.scheduler is None:
        # Processes with one thread each: each run has its own processor clock, and a crash affects one run.
        local = {"n_workers": options.workers, "threads_per_worker": 1, "processes": True, "dashboard_address": ":0"}
        with LocalCluster(**local, silence_logs=logging.ERROR) as cluster, Client(cluster) as client:
            yield client
        return
    gc.collect()  # a client that could not be made, and is collected while another one starts, waits for it forever
    try:
        client = Client(options.scheduler, timeout=options.timeout)
    except (OSError, ValueError) as error:
        raise Refused(
            f"no scheduler at {options.scheduler}: {error}\nStart one by `dask scheduler`, which prints its address, "
            "as tcp://10.0.0.1:8786, and workers by `dask worker ADDRESS --nthreads 1`."
        ) from error
    with client:
        try:
            client.wait_for_workers(1, timeout=options.timeout)
        except TimeoutError as error:
            raise Refused(
                f"the scheduler at {options.scheduler} has no workers. Start some: "
                f"`dask worker {options.scheduler} --nthreads 1`, once per core."
            ) from error
        check_versions(client)
        yield client


# %% [markdown]
# ## The table, the figure, and the command line

# %%
def plot_sweep(table: pd.DataFrame, path: Path) -> None:
    axes = (figure := Figure(figsize=(7, 5))).subplots()
    for stiffness, runs in table.groupby("stiffness"):
        runs = runs.sort_values("ms_per_frame")
        axes.loglog(runs["ms_per_frame"], runs["error"], "o-", label=f"{stiffness:g}")
        for x, y, n in zip(runs["ms_per_frame"], runs["error"], runs["substeps"]):
            axes.annotate(str(n), (x, y), textcoords="offset points", xytext=(4, 4), fontsize=7)
    axes.set(xlabel="processor's ms per frame", ylabel="error / motion", title="Numbers: steps per frame")
    axes.legend(title="Young's modulus")
    axes.grid(alpha=0.3, which="both")
    figure.savefig(path, dpi=120)


def plot_rollouts(table: pd.DataFrame, path: Path) -> None:
    axes = (figure := Figure(figsize=(7, 5))).subplots()
    axes.plot(table["generation"], table["reward"], "o", alpha=0.3)
    axes.plot(table.groupby("generation")["reward"].median(), "k-", label="median")
    axes.set(xlabel="generation", ylabel="reward")
    axes.legend()
    axes.grid(alpha=0.3)
    figure.savefig(path, dpi=120)


def describe(table: pd.DataFrame) -> str:
    failed = table[table["status"].ne("ok")]
    lines = [f"{len(table)} runs, {len(failed)} failed"]
    lines += [f"  {count} x {status}" for status, count in failed["status"].value_counts().items()]
    if "reward" in table and table["reward"].notna().any():
        best = table.loc[table["reward"].idxmax()]
        lines.append(f"best: rollout {best['rollout']} of generation {best['generation']}, reward {best['reward']:.4f}")
    return "\n".join(lines)


def differing(table: pd.DataFrame, other: pd.DataFrame) -> int:
    """Number of runs whose positions, to the bit, or whose status is another one."""
    result = ["status", "sha256"]
    both = (one.reindex(columns=result).fillna("") for one in (table, other))
    return int(next(both).ne(next(both)).any(axis=1).sum())


def numbers(kind: type) -> Callable[[str], list[Any]]:
    def listed(text: str) -> list[Any]:
        return [kind(word) for word in text.split(",")]

    listed.__name__ = f"list of {kind.__name__}s, as 1,2,4,"  # for argparse's error
    return listed


def positive(text: str) -> int:
    if (number := int(text)) < 1:
        raise argparse.ArgumentTypeError(f"must be 1 or more: {text}")
    return number


def options_of(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Many runs through Dask: stiffness x step, error against run time; or a policy's rollouts.",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    add = parser.add_argument
    add("what", nargs="?", choices=["sweep", "rollouts"], default="sweep", help="what is run")
    add("--scheduler", metavar="ADDRESS", help="of a Dask scheduler, as tcp://10.0.0.1:8786, in place of own workers")
    add("--timeout", type=float, default=10, help="seconds to wait for the scheduler, and for its first worker")
    add("--workers", type=positive, default=os.cpu_count(), help="number of own workers")
    add("--stiffness", type=numbers(float), default="1e4,1e5,1e6,1e7", help="of the sweep: Young's moduli")
    add("--substeps", type=numbers(int), default="1,2,4,8,16,32", help="of the sweep: steps per frame of 1/60 s")
    add("--reference", type=positive, default=128, help="steps per frame of the runs that are compared with")
    add("--rollouts", type=positive, default=64, help="per generation")
    add("--generations", type=positive, default=4, help="of rollouts")
    add("--seed", type=int, default=1, help="of the rollouts' actions")
    add("--frames", type=positive, default=90, help="of each run")
    add("--tets", type=positive, default=500, help="of the cage, about")
    add("--output", type=Path, default=Path("out/sweep"), metavar="FOLDER", help="gets a table and a figure")
    add("--quick", action="store_true", help="smaller models and fewer runs: seconds")
    add("--check", action="store_true", help="makes all runs here once more, in this process, and compares the bits")
    # In a notebook, arguments are those of its kernel.
    options = parser.parse_args([] if arguments is None and "ipykernel" in sys.modules else arguments)
    if options.quick:
        options.tets, options.frames, options.reference = min(options.tets, 200), min(options.frames, 20), 32
        options.rollouts, options.generations = min(options.rollouts, 8), min(options.generations, 2)
        options.stiffness, options.substeps = options.stiffness[:3], options.substeps[:3]
    return options


def main(arguments: Sequence[str] | None = None) -> int:
    """Returns 0; 1 if no run has succeeded, or --check has found other bits; 2 if nothing could be run; 130 if
    it was interrupted."""
    options = options_of(arguments)
    work, plot = {"sweep": (sweep, plot_sweep), "rollouts": (rollouts, plot_rollouts)}[options.what]
    try:
        options.output.mkdir(parents=True, exist_ok=True)
        with connected(options) as client:
            table = work(client, options)
    except (Refused, ts.Error, OSError) as error:
        print(f"sweep.py: {error}", file=sys.stderr)
        return 2
    table.drop(columns="actions", errors="ignore").to_csv(options.output / f"{options.what}.csv", index=False)
    print(describe(table))
    if not (succeeded := table["status"].eq("ok")).any():
        return 1
    plot(table[succeeded], options.output / f"{options.what}.png")
    print(f"written: {options.output / options.what}.csv and .png")
    if table["status"].eq(INTERRUPTED).any():
        return 130
    if options.check:
        different = differing(table, work(None, options))
        print(f"{different} of {len(table)} runs differ from those of one process" if different else
              "the same to the bit as in one process")
        return 1 if different else 0
    return 0


# %%
if __name__ == "__main__":
    if status := main():
        sys.exit(status)
