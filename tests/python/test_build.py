# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The build names what a machine lacks, with the cure. Only configures: nothing is compiled."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[2]
SOURCE = REPOSITORY / "plugin" / "python"

pytestmark = pytest.mark.skipif(
    not shutil.which("cmake") or not shutil.which("bash") or not (SOURCE / "CMakeLists.txt").exists(),
    reason="no CMake, or no checkout",
)


@pytest.fixture
def configure(tmp_path):
    """Configures; returns CMake's output. path: the available programs, if not all."""

    def run(*options, source=SOURCE, programs=None):
        environment = {"PATH": "/usr/bin:/bin", "HOME": str(tmp_path)}
        if programs is not None:
            folder = tmp_path / "bin"
            folder.mkdir()
            for program in programs:
                if shutil.which(program):
                    (folder / program).symlink_to(shutil.which(program))
            environment["PATH"] = str(folder)
        command = [shutil.which("cmake"), "-S", source, "-B", tmp_path / "build", "-G", "Unix Makefiles"]
        command += [f"-DPython_EXECUTABLE={sys.executable}", *options]
        done = subprocess.run(command, env=environment, capture_output=True, text=True)
        assert done.returncode != 0
        return " ".join(done.stderr.split())  # CMake breaks lines

    return run


def test_a_missing_compiler(configure):
    said = configure(programs=["make"])
    assert "There is no C++ compiler" in said and "apt-get install g++" in said


HEADERS = {
    "Eigen3_DIR": "Eigen 3.4 (libeigen3-dev)",
    "TINYGLTF_INCLUDE": "tinygltf (libtinygltf-dev)",
    "JSON_INCLUDE": "JSON for Modern C++ (nlohmann-json3-dev)",
}


@pytest.mark.parametrize("missing", HEADERS)
def test_missing_headers_and_no_others(configure, tmp_path, missing):
    (tmp_path / "Eigen3Config.cmake").touch()
    (tmp_path / "Eigen3ConfigVersion.cmake").write_text("set(PACKAGE_VERSION_COMPATIBLE TRUE)")
    given = [f"-D{name}={tmp_path}" for name in HEADERS if name != missing]
    nowhere = ["-DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF"]
    if missing == "Eigen3_DIR":  # which is also found beside the programs
        nowhere.append("-DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON")
    said = configure(*given, *nowhere)
    for name, package in HEADERS.items():
        assert (f"{package}, or set {name} to" in said) == (name == missing), said
    assert "pip sets a variable by --config-settings=cmake.define.NAME=VALUE" in said


def test_sources_of_bullet_that_cannot_be_fetched(configure, tmp_path):
    checkout = tmp_path / "checkout"  # in which nothing has been fetched
    for part in ("plugin/python", "tests/platforms"):
        shutil.copytree(REPOSITORY / part, checkout / part, ignore=shutil.ignore_patterns("build"))
    shutil.copy(REPOSITORY / "plugin" / "tetskin" / "tetskin.h", checkout / "plugin" / "python")
    programs = ["g++", "make", "bash", "dirname", "basename", "mkdir", "tail", "ld", "ar", "as", "rm", "uname"]
    said = configure(source=checkout / "plugin" / "python", programs=programs)
    assert "The sources of Bullet could not be fetched" in said and "Set BULLET_SOURCE" in said, said


def test_sources_of_another_bullet(configure, tmp_path):
    (tmp_path / "src" / "BulletSoftBody").mkdir(parents=True)
    (tmp_path / "src" / "BulletSoftBody" / "btSoftBody.cpp").touch()
    (tmp_path / "VERSION").write_text("2.89\n")
    said = configure(f"-DBULLET_SOURCE={tmp_path}")
    assert "made with Bullet 3.24" in said and "has 2.89" in said and "Set BULLET_SOURCE" in said


def test_no_sources_of_bullet_where_they_should_be(configure, tmp_path):
    said = configure(f"-DBULLET_SOURCE={tmp_path}")
    assert "There are no sources of Bullet" in said and "Set BULLET_SOURCE" in said
