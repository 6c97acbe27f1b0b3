#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Follows the first page with the page's own blocks, as somebody who has just cloned the repository: builds and
installs the library, builds the first program with it, and runs it. Prints each block and its time.

readme.py --folder FOLDER --prefix PREFIX --generator GENERATOR

It uses nothing from a developer's build: no options except the page's, no compiler cache, nothing installed before.
PREFIX is kept for other tests.
"""
import argparse
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tests/pages"))
import page  # noqa: E402
from run_commands import write_ring  # noqa: E402

README = (REPOSITORY / "README.md").read_text()
OF_DEVELOPERS = ("CMAKE_UNITY_BUILD", "CMAKE_CXX_COMPILER_LAUNCHER", "CMAKE_PREFIX_PATH", "CPATH", "CXXFLAGS")


def block(language, words):
    """The only block of the page that contains these words."""
    found = [text for kind, text in page.blocks(README) if kind == language and words in text]
    if len(found) != 1:
        sys.exit(f"README.md: {len(found)} blocks of {language} have '{words}', not one: follow the page here")
    return found[0]


def copy_repository(folder):
    """Copies the files of a clone, and files that are not committed yet."""
    names = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=REPOSITORY,
                           check=True, capture_output=True, text=True).stdout
    for name in filter(None, names.split("\0")):
        if (REPOSITORY / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(REPOSITORY / name, folder / name)


def run(name, script, folder, environment):
    begun = time.monotonic()
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=folder, env=environment,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(f"{name}: {time.monotonic() - begun:.1f} s", flush=True)
    if done.returncode != 0 or "warning:" in done.stdout:
        sys.exit(f"FAILED, exit status {done.returncode}, or with a warning:\n{script}\n{done.stdout}")


def run_program(prefix, folder, environment):
    folder.mkdir()
    (folder / "main.cpp").write_text(block("cpp", "int main("))
    (folder / "CMakeLists.txt").write_text(block("cmake", "find_package(tetskin"))
    write_ring(folder / "dragon.obj")
    run("first program", f"cmake -DCMAKE_PREFIX_PATH={prefix} -DCMAKE_BUILD_TYPE=Release -S . -B build && cmake --build build",
        folder, environment)
    run("with a mesh", "build/app dragon.obj", folder, environment)
    for arguments in ("", "none.obj"):
        run(f"refuses '{arguments}'", f"status=0; build/app {arguments} || status=$?; [ $status -eq 2 ]", folder,
            environment)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--prefix", type=Path, required=True)
    parser.add_argument("--generator", required=True)
    arguments = parser.parse_args()
    folder, prefix = arguments.folder, arguments.prefix

    environment = {name: value for name, value in os.environ.items() if name not in OF_DEVELOPERS}
    environment.update(CCACHE_DISABLE="1", CMAKE_GENERATOR=arguments.generator)
    for old in (folder, prefix):
        shutil.rmtree(old, ignore_errors=True)
    copy_repository(folder / "tetskin")
    run("build and install", block("sh", "cmake -S tetskin").replace("--prefix PREFIX", f"--prefix {prefix}"), folder,
        environment)
    run_program(prefix, folder / "first", environment)


if __name__ == "__main__":
    main()
