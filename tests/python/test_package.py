# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The contents of the package: one symbol, few libraries, the licences, the types."""

import importlib.metadata
import os
import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import pytest

import tetskin as ts

MODULE = Path(ts._core.__file__)
LIBRARIES = ("libc.so", "libm.so", "libstdc++.so", "libgcc_s.so", "ld-linux")


def output(*command):
    if not shutil.which(command[0]):
        pytest.skip(f"no {command[0]} (binutils)")
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def test_the_module_exports_one_symbol():
    lines = output("nm", "-D", "--defined-only", str(MODULE)).splitlines()
    assert [line.split()[-1] for line in lines] == ["PyInit__core"]


def test_the_module_needs_the_systems_libraries_alone():
    needed = [
        line.split("[")[1].rstrip("]") for line in output("readelf", "-d", str(MODULE)).splitlines() if "NEEDED" in line
    ]
    assert needed and all(name.startswith(LIBRARIES) for name in needed), needed


def test_auditwheel_names_the_wheel_and_adds_nothing():
    wheel = os.environ.get("TETSKIN_WHEEL")  # of tests/python/run --staged, repaired
    if not wheel:
        pytest.skip("TETSKIN_WHEEL names no wheel")
    said = output("auditwheel", "show", wheel)
    tag = re.search(r'consistent with[^"]*"(manylinux_[0-9_]+_\w+)"', " ".join(said.split()))
    assert tag and tag.group(1) in Path(wheel).name, said
    with zipfile.ZipFile(wheel) as parts:
        folders = {name.split("/")[0] for name in parts.namelist()}
    assert folders == {"tetskin", f"tetskin-{ts.__version__}.dist-info"}


def test_licences_of_all_that_is_inside_are_in_the_package():
    files = {file.name: file.read_text() for file in importlib.metadata.files("tetskin") if "licences" in str(file)}
    for name, words in {
        "tetskin.txt": "2026 the tetskin authors",
        "bullet.txt": "bulletphysics.org",
        "eigen.txt": "Mozilla Public License Version 2.0",
        "tinygltf.txt": "Syoyo Fujita",
        "json.txt": "Niels Lohmann",
        "nanobind.txt": "Wenzel Jakob",
        "three.txt": "three.js authors",
    }.items():
        assert words in files[name]


def test_every_file_of_the_package_is_its_own():
    """Foreign files, which would need a licence here, would be noticed by their kind."""
    names = [str(file) for file in importlib.metadata.files("tetskin") if file.parts[0] == "tetskin"]
    assert names
    own = re.compile(r"tetskin/(_core[.\w-]*[.](so|pyd|pyi)|py[.]typed|\w+[.]py|__pycache__/.*)")
    pages = re.compile(r"tetskin/view/(view[.](html|css)|(data|player|shading|skin|stage)[.]js|three_notice[.]txt)")
    three = {"tetskin/view/three.min.js", "tetskin/view/OrbitControls.js"}  # whose licence is three.txt
    assert [name for name in names if not own.fullmatch(name) and not pages.fullmatch(name) and name not in three] == []
    for name in names:
        if name.endswith(".py"):
            text = (MODULE.parents[1] / name).read_text(encoding="utf-8")
            assert "SPDX-FileCopyrightText: 2026 the tetskin authors" in text, name


def test_types_are_told():
    folder = MODULE.parent
    assert (folder / "py.typed").exists()
    stub = (folder / "_core.pyi").read_text()
    assert "class World" in stub and "substeps: int = 4" in stub and "A read-only view" in stub


def test_the_version_is_that_of_the_library():
    assert ts.__version__ == importlib.metadata.version("tetskin")


def test_all_names_have_words():
    for name in ts.__all__:
        thing = getattr(ts, name)
        assert isinstance(thing, str) or thing.__doc__, name
