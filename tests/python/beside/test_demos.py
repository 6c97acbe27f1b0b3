# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The demos of demos/examples/python do what they say, and write the files that they name."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

image = pytest.importorskip("matplotlib.image")
FOLDER = Path(__file__).parents[3] / "demos/examples/python"
DEMOS = {
    "drop": ["drop.html", "height.png"],
    "gripper": ["gripper.html", "forces.png"],
    "cage_from_scan": ["cage_from_scan.html", "stiffness.png", "cage.vtk"],
}
"""The output of each demo."""
MOMENTS = {"drop": 61, "gripper": 181, "cage_from_scan": 45}
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")


def run(demo, folder, *arguments):
    environment = dict(os.environ, MPLBACKEND="agg")
    command = [sys.executable, "-B", str(FOLDER / f"{demo}.py"), "--output", str(folder), *arguments]
    return subprocess.run(command, capture_output=True, text=True, env=environment, cwd=folder.parent, timeout=300)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The folder of a demo's quick run, which is made once."""
    folders = {}

    def folder_of(demo):
        if demo not in folders:
            folder = folders[demo] = tmp_path_factory.mktemp("demos") / demo
            result = run(demo, folder, "--quick")
            assert result.returncode == 0, result.stderr
            assert result.stdout
        return folders[demo]

    return folder_of


@pytest.mark.parametrize("demo", DEMOS)
def test_a_demo_passes_its_own_check_and_writes_its_files(demo, written):
    folder = written(demo)
    assert sorted(file.name for file in folder.iterdir()) == sorted(DEMOS[demo])
    for name in DEMOS[demo]:
        if name.endswith(".png"):
            pixels = image.imread(folder / name)
            assert min(pixels.shape[:2]) >= 200 and pixels[..., :3].std() > 0.02, name
        elif name.endswith(".html"):
            text = (folder / name).read_text()
            assert f'"moments":{MOMENTS.get(demo)},' in text and '"cage":' in text and "class Stage" in text


@pytest.mark.parametrize("demo", DEMOS)
def test_a_demo_that_cannot_write_fails_and_says_where(demo, tmp_path):
    (tmp_path / "out").write_text("")
    result = run(demo, tmp_path / "out", "--quick")
    assert result.returncode == 1 and "out" in result.stderr


def test_each_demo_is_told_of():
    page = (FOLDER / "README.md").read_text()
    scripts = {file.stem for file in FOLDER.glob("*.py")} - {"notebooks"}
    assert scripts == set(re.findall(r"demos/examples/python/(\w+)\.py", page)) - {"notebooks"}
    assert set(DEMOS) <= scripts


def drawn(path, frame, folder):
    """The picture of a page at a frame, without the player."""
    out = folder / f"{frame}.png"
    command = [CHROMIUM, "--headless", "--no-sandbox", f"--user-data-dir={folder / 'profile'}",
               "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--window-size=600,500",
               "--virtual-time-budget=3000", "--enable-logging=stderr", f"--screenshot={out}",
               f"file://{path}#frame={frame}"]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert out.exists() and "CONSOLE" not in result.stderr, result.stderr
    return image.imread(out)[70:330, :, :3]


@pytest.mark.skipif(not CHROMIUM, reason="no chromium")
@pytest.mark.parametrize("demo", DEMOS)
def test_a_browser_draws_the_page_of_a_demo(demo, written, tmp_path):
    path = written(demo) / f"{demo}.html"
    first, last = drawn(path, 0, tmp_path), drawn(path, MOMENTS[demo] - 1, tmp_path)
    for picture in (first, last):
        green = (picture[..., 1] > 1.3 * picture[..., 0]) & (picture[..., 1] > 1.3 * picture[..., 2])
        assert green.mean() > 0.01  # the soft body, whose colour nothing else has
        assert len(np.unique((255 * picture[::4, ::4]).astype(int).reshape(-1, 3), axis=0)) > 100
    assert (np.abs(first - last).max(-1) > 0.1).mean() > 0.02
