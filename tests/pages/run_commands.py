#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Runs the commands of a page as written: every command in its sh blocks, in a folder with the input files that pages
mention.

run_commands.py --build BUILD --folder FOLDER PAGE [PAGE ...]        pages of the repository
run_commands.py --build BUILD --folder FOLDER --help-of PROGRAM [PROGRAM ...]     the examples in their --help

A command that fails is a fault; commands.txt lists those that are not run, with the reason.
"""
import argparse
import math
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import page
from handling import Handling
from programs import examples

REPOSITORY = Path(__file__).resolve().parents[2]
SECONDS = 300  # for one command


def write_ring(path, around=40, across=20):
    """Writes a mesh like a user's: a ring of 2 * around * across triangles, 4 units wide."""
    with open(path, "w") as obj:
        for i in range(around):
            for k in range(across):
                a, b = 2 * math.pi * i / around, 2 * math.pi * k / across
                radius = 1.5 + 0.5 * math.cos(b)
                obj.write(f"v {radius * math.cos(a):.6f} {0.5 * math.sin(b):.6f} {radius * math.sin(a):.6f}\n")
        for i in range(around):
            for k in range(across):
                corner = lambda di, dk: (i + di) % around * across + (k + dk) % across + 1
                obj.write(f"f {corner(0, 0)} {corner(0, 1)} {corner(1, 1)}\n")
                obj.write(f"f {corner(0, 0)} {corner(1, 1)} {corner(1, 0)}\n")


def write_twisted(source, path):
    """Writes the tet mesh of a .vtk file with its nodes moved, as by a simulator."""
    lines = Path(source).read_text().splitlines()
    first = next(k for k, line in enumerate(lines) if line.startswith("POINTS")) + 1
    for k in range(first, first + int(lines[first - 1].split()[1])):
        x, y, z = map(float, lines[k].split())
        lines[k] = f"{x} {y + 0.1 * x * x} {z}"
    Path(path).write_text("\n".join(lines) + "\n")


def make_inputs(folder, environment):
    """Makes every file that a page may need as input."""
    write_ring(folder / "yours.obj")
    shutil.copy(folder / "yours.obj", folder / "dragon.obj")
    lines = (folder / "yours.obj").read_text().splitlines()
    (folder / "painted.obj").write_text(  # red where x is above 0
        "\n".join(f"{line} {int(line[2] != '-')} 0 0.5" if line[0] == "v" else line for line in lines))
    subprocess.run(["tetskin_cage", "--mesh", "dragon.obj", "--tets", "200", "--quiet", "-o", "rest.vtk"], cwd=folder,
                   env=environment, check=True)
    shutil.copy(folder / "rest.vtk", folder / "yours_cage.vtk")
    subprocess.run(["tetskin_cage", "--mesh", "dragon.obj", "--tets", "200", "--no-duplicate-elements", "--quiet", "-o",
                    "yours.vtk"], cwd=folder, env=environment, check=True)
    write_twisted(folder / "rest.vtk", folder / "now.vtk")


def make_folder(folder, build):
    """Makes a folder like a checkout after the build, without the sources; commands write their files here."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "build").symlink_to(build)
    for name in ("demos", "plugin", "tests"):
        (folder / name).symlink_to(REPOSITORY / name)


def run(command, handling, folder, environment):
    """Runs a command, and returns whether it succeeded or need not run."""
    why = handling.left_out(command)
    if why:
        print(f"not run: {command}\n         {why}")
        return True
    line = f"{command} {handling.extra(command)}".strip()
    print(f"{line}", flush=True)
    begun = time.monotonic()
    try:
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", line], cwd=folder, env=environment, timeout=SECONDS,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        status, output = done.returncode, done.stdout
    except subprocess.TimeoutExpired:
        status, output = f"none after {SECONDS} s", ""
    print(f"         {time.monotonic() - begun:.1f} s", flush=True)
    if status != 0:
        print(f"FAILED, exit status {status}; output:\n{output}")
    return status == 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--help-of", nargs="+")
    parser.add_argument("pages", nargs="*")
    arguments = parser.parse_args()

    environment = dict(os.environ, PATH=f"{arguments.build / 'demos'}:{os.environ['PATH']}")
    make_folder(arguments.folder, arguments.build)
    make_inputs(arguments.folder, environment)
    if arguments.pages:
        commands = [command for name in arguments.pages for command in page.commands((REPOSITORY / name).read_text())]
    else:
        commands = [line for program in arguments.help_of for line in examples(arguments.build, program)]
    handling = Handling()
    failed = [command for command in commands if not run(command, handling, arguments.folder, environment)]
    if failed:
        sys.exit("\n".join(["failed:"] + failed))


if __name__ == "__main__":
    main()
