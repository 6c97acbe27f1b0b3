# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The page's scenes, as live_native plays them."""
import json
import re
import struct
import subprocess
import tempfile
from pathlib import Path

from live import NATIVE

DESCRIBE = (Path(__file__).parent / "describe.js").read_text(encoding="utf-8")


def stored_scene(live, scene, folder):
    """The file of a scene, with its meshes beside it, as the page's worker has them."""
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


def native_hash(live, scene, frames):
    with tempfile.TemporaryDirectory() as folder:
        said = subprocess.run([NATIVE, stored_scene(live, scene, Path(folder)), str(frames)], capture_output=True, text=True,
                              check=True).stdout
    return re.search("hash (.*)", said)[1]


def nodes_of(live):
    """Positions of all nodes, body by body, as bytes."""
    return live.page.evaluate("simulation.parts.map(({body}) => [...new Uint8Array(body.nodes.slice().buffer)])",
                              session=live.worker())


def hash_of(bodies):
    """FNV-1a, as live_native's"""
    value = 1469598103934665603
    for nodes in bodies:
        for byte in nodes:
            value = (value ^ byte) * 1099511628211 & 0xffffffffffffffff
    return f"{value:016x}"
