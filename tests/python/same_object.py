#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Checks of plugin/python/cmake/same_object.py that objects of another build are taken where they are the same, and
only there. Needs CMake, Ninja and a compiler. The other build's object gets special bytes, by which it is
recognised."""
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

LAUNCHER = Path(__file__).resolve().parents[2] / "plugin/python/cmake/same_object.py"
PROJECT = """cmake_minimum_required(VERSION 3.21)
project(other LANGUAGES CXX)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
add_library(one STATIC one.cpp)
target_compile_options(one PRIVATE -O2 -fPIC)
"""
MARK = b"of the other build"


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "CMakeLists.txt").write_text(PROJECT)
        (folder / "one.h").write_text("inline int two() { return 2; }\n")
        source = folder / "one.cpp"
        source.write_text('#include "one.h"\nint one() { return two() - 1; }\n')
        other = folder / "other"
        for step in (["-S", folder, "-B", other, "-G", "Ninja"], ["--build", other]):
            subprocess.run(["cmake", *step], check=True, capture_output=True)
        made = other / "CMakeFiles/one.dir/one.cpp.o"
        when = made.stat().st_mtime_ns  # which Ninja has recorded
        with made.open("ab") as file:
            file.write(MARK)
        os.utime(made, ns=(when, when))

        def is_taken(*options, text=None):
            """Whether the launcher takes the other build's object for what these options make of the source."""
            here = folder / "here/CMakeFiles/one.dir"
            shutil.rmtree(here, ignore_errors=True)
            here.mkdir(parents=True)
            own = source
            if text:
                own = folder / "own.cpp"
                own.write_text(text)
            subprocess.run([sys.executable, "-B", LAUNCHER, other, *options, "-I", folder, "-MD", "-MF", here / "d", "-o",
                            here / "one.cpp.o", "-c", own], cwd=folder, check=True)
            return (here / "one.cpp.o").read_bytes().endswith(MARK)

        names = [word for word in ("c++", "g++") if shutil.which(word)]
        same = {os.path.realpath(shutil.which(word)) for word in names}
        for compiler in names if len(same) == 1 else names[:1]:
            assert is_taken(compiler, "-O2", "-fPIC"), f"not taken with {compiler}"
            assert is_taken(compiler, "-O2", "-fPIC", text=source.read_text()), "the same text in another file"
            assert not is_taken(compiler, "-O1", "-fPIC"), "taken with another option"
            assert not is_taken(compiler, "-O2", "-fPIC", "-g"), "taken with places of another folder"
            assert not is_taken(compiler, "-O2", "-fPIC", text="int one() { return 3; }\n"), "taken for another text"
        subprocess.run(["cmake", "-S", folder, "-B", other, "-DUNUSED=1"], check=True, capture_output=True)
        assert is_taken("c++", "-O2", "-fPIC"), "not taken from a build that was configured again alike"
        rules = (other / "build.ninja").read_text()
        (other / "build.ninja").write_text(rules.replace("-O2", "-O2 -fno-plt"))
        assert not is_taken("c++", "-O2", "-fPIC"), "taken although it was made by another command"
        (other / "build.ninja").write_text(rules)
        os.utime(folder / "one.h", (2 ** 31 - 1, 2 ** 31 - 1))
        assert not is_taken("c++", "-O2", "-fPIC"), "taken although a header is newer"


if __name__ == "__main__":
    main()
