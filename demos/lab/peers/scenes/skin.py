# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The cost of a fine surface by itself: attaching the snake's 60,000 triangles to a cage, and moving them once per
frame.

Each adapter's function skin_times uses what the peer offers; the cage's nodes are moved by a bend that all share.
"""
import importlib

import numpy as np

from plan import Case
from problem import Unsupported
from scenes.snake import body_of

TITLE = "Bind and update of 60,000 triangles in some 1,000 tets"


def plan(quick):
    return [Case("tetskin", "linear"), Case("tetskin", "quadratic", {"interpolation": "quadratic"})] + [
        Case(peer, "own") for peer in ("rapier", "mujoco", "pybullet", "newton")]


def bent(nodes):
    return nodes + np.stack([0 * nodes[:, 0], 0.1 * np.sin(4 * nodes[:, 0]), 0 * nodes[:, 0]], 1)


def run(Simulation, case, clock, _):
    adapter = importlib.import_module(Simulation.__module__)
    if not hasattr(adapter, "skin_times"):
        raise Unsupported(adapter.NO_SKIN)
    body = body_of()
    bind, update = adapter.skin_times(body, bent(body.nodes), **case.setting)
    clock.parts, clock.seconds = [update], update
    return {"bind, ms": 1e3 * bind}
