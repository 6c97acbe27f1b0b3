#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The page's scenes, as live_native plays them. As a program: writes demos/examples/live/native_hashes.json, the hashes that the
page shows beside its own. After the solver has changed, build the page and live_native (TETSKIN_LIVE_NATIVE is its
path), run this, and build the page again."""
import json
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import chromium
from live import NATIVE, REPOSITORY, Live

DESCRIBE = (Path(__file__).parent / "describe.js").read_text(encoding="utf-8")
HASHES = REPOSITORY / "demos/examples/live/native_hashes.json"
# Scenes without rigid bodies that turn, and without a script: Bullet turns by the C library's sines, scripts by the
# browser's. Ten seconds of them, every half second.
COMPARED, FRAMES, EVERY = ("serpent", "heap", "stack"), 600, 30


def stored_scene(live, scene, folder):
    """The file of a scene, with its meshes beside it, the same as in the page's worker."""
    described = live.page.evaluate(f"{DESCRIBE}; describeScene({json.dumps(scene)}, simulation.settings)",
                                   session=live.worker())
    lines = []
    for name, mesh in described["meshes"].items():
        path, positions, triangles = folder / name, mesh["positions"], mesh["triangles"]
        path.write_bytes(struct.pack("<2i", len(positions) // 3, len(triangles) // 3) +
                         struct.pack(f"<{len(positions)}d", *positions) + struct.pack(f"<{len(triangles)}i", *triangles))
        lines.append(f"mesh {name} {path}")
    text = folder / "scene.txt"
    text.write_text("\n".join(lines + described["lines"]) + "\n", encoding="utf-8")
    return text


def native_hashes(live, scene, frames):
    """Hashes of the state after each 30 frames of the page's scene."""
    with tempfile.TemporaryDirectory() as folder:
        said = subprocess.run([NATIVE, stored_scene(live, scene, Path(folder)), str(frames)], capture_output=True, text=True,
                              check=True).stdout
    return re.findall(r"hash \d+ (.*)", said)


def main():
    if not NATIVE:
        sys.exit(__doc__)
    hashes = {}
    with chromium.Chromium() as browser:
        live = Live(browser)
        for scene in COMPARED:
            live.open(scene)
            hashes[scene] = native_hashes(live, scene, FRAMES)
    HASHES.write_text(json.dumps(hashes, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
