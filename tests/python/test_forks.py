# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Processes that are forked beside a pool of threads continue with the parent's bits, or say what to do."""

import os
import signal
import sys
import threading
import time

import numpy as np
import pytest

import tetskin as ts

pytestmark = [
    pytest.mark.skipif(not hasattr(os, "fork") or sys.platform == "darwin", reason="processes are not forked here"),
    pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning"),
]
SECONDS = 20  # after which a process that would wait forever is ended


def in_child(work):
    """Its result in a forked process, as text; and the seconds that it took."""
    read, write = os.pipe()
    start = time.monotonic()
    child = os.fork()
    if child == 0:
        signal.alarm(SECONDS)
        try:
            said = work()
        except BaseException as error:  # noqa: BLE001: told to the parent
            said = repr(error)
        os.write(write, str(said).encode())
        os._exit(0)
    os.close(write)
    with os.fdopen(read, "rb") as pipe:
        said = pipe.read().decode()
    assert os.waitpid(child, 0)[1] == 0, said
    return said, time.monotonic() - start


def threaded(mesh, cage):
    world = ts.World(threads=4)
    world.add_plane()
    body = world.add_body(cage, mesh, position=(0, 0.3, 0))
    world.step()
    return world, body


def bits(world, body, frames=5):
    for _ in range(frames):
        world.step()
    return hash(body.positions.tobytes() + body.nodes.tobytes())


def test_a_forked_world_steps_with_the_parents_bits(mesh, cage):
    world, body = threaded(mesh, cage)
    said, seconds = in_child(lambda: bits(world, body))
    assert said == str(bits(world, body)) and seconds < 5


def test_a_forked_world_is_let_go(mesh, cage):
    holder = [threaded(mesh, cage)]

    def let_go():
        holder.clear()
        other = threaded(mesh, cage)  # with its own threads
        return bits(*other)

    said, seconds = in_child(let_go)
    assert said == str(bits(*holder[0])) and seconds < 5


def test_a_skin_of_a_forked_process_is_updated(mesh, cage):
    skin = ts.Skin(cage, mesh)
    assert in_child(lambda: np.array_equal(skin.update(cage.nodes), skin.positions))[0] == "True"


def test_a_world_that_was_stepping_when_it_was_forked_says_so(mesh, cage, tmp_path):
    world, body = threaded(mesh, cage)
    recorder = ts.Recorder(world, tmp_path / "run")
    ends = threading.Event()

    def step():
        while not ends.is_set():
            world.step(0.1, substeps=500)

    thread = threading.Thread(target=step)
    thread.start()
    time.sleep(0.1)  # within a step, which takes longer

    def use():
        with pytest.raises(ts.Error, match="spawn"):
            world.step()
        with pytest.raises(ts.Error, match="spawn"):
            body.asleep
        nonlocal recorder
        del recorder
        return "said"

    said, seconds = in_child(use)
    ends.set()
    thread.join()
    assert said == "said" and seconds < 5
    world.step()
