#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The cost of a call from Python, compared with C++, in microseconds: run it by hand, on an idle machine.

overhead.py MESH REFERENCE   MESH: a file; REFERENCE: the program tetskin_reference, which tests/python/run builds
"""

import subprocess
import sys
import tempfile
import timeit

import numpy as np

import tetskin as ts


def microseconds(call, count=4001):
    return float(np.median([timeit.timeit(call, number=1) for _ in range(count)])) * 1e6


def loop(call, count=20000):
    return min(timeit.repeat(call, number=count, repeat=7)) / count * 1e6


def main(path, reference):
    with tempfile.NamedTemporaryFile() as out:
        said = subprocess.run(
            [reference, path, "200", "1", out.name], check=True, capture_output=True, text=True
        ).stdout
    cpp = {name: float(number) for name, number in (line.split() for line in said.splitlines())}
    mesh = ts.load_mesh(path)
    cage = ts.create_cage(mesh, target_tets=200)
    world, empty = ts.World(), ts.World()
    body = world.add_body(cage, mesh)
    skin, nodes = ts.Skin(cage, mesh), cage.nodes.copy()
    print(f"attribute {loop(lambda: body.node_count) - loop(lambda: None):.3f}")
    print(f"view      {loop(lambda: body.positions) - loop(lambda: None):.3f}")
    for name, call in (("step", lambda: empty.step()), ("update", lambda: skin.update(nodes))):
        took = microseconds(call)
        print(f"{name:9} {took:.2f}, in C++ {cpp[name]:.2f}: {took - cpp[name]:.2f} more")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
