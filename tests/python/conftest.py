# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Code shared by the tests of the Python package. They need the installed package, NumPy and pytest alone."""

import signal

import numpy as np
import pytest

import tetskin as ts

# A shell makes background processes, and all that they start, ignore Ctrl-C; tests need it.
signal.signal(signal.SIGINT, signal.default_int_handler)


def torus(rings=40, sides=20):
    """Positions and triangles of a closed torus, counter-clockwise from outside."""
    u, v = np.meshgrid(np.arange(rings) * 2 * np.pi / rings, np.arange(sides) * 2 * np.pi / sides, indexing="ij")
    ring = 1 + 0.35 * np.cos(v)
    positions = np.stack([ring * np.cos(u), 0.35 * np.sin(v), -ring * np.sin(u)], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(rings), np.arange(sides), indexing="ij")
    a, b = i * sides + j, (i + 1) % rings * sides + j
    c, d = (i + 1) % rings * sides + (j + 1) % sides, i * sides + (j + 1) % sides
    triangles = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return positions, triangles


@pytest.fixture(scope="session")
def mesh():
    return ts.TriangleMesh(*torus())


@pytest.fixture(scope="session")
def cage(mesh):
    return ts.create_cage(mesh, target_tets=200)


@pytest.fixture(scope="session")
def obj(tmp_path_factory):
    """The path of a mesh's file."""
    positions, triangles = torus()
    path = tmp_path_factory.mktemp("meshes") / "torus.obj"
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in positions.tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles.tolist()]
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.fixture
def dropped(mesh, cage):
    """A world with a ground, and a body that falls on it."""
    world = ts.World()
    world.add_plane()
    body = world.add_body(cage, mesh, position=(0, 0.5, 0), normals="transformed")
    return world, body
