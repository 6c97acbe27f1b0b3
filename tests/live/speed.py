#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The cost of a frame of the live page: four substeps of the serpent on ramp and dome, and then of all scenes. Run it
by hand, on an idle machine; prints two tables.

speed.py [FRAMES [ROUNDS]]   by default 240 frames, five rounds

By turns, in each round: natively, with the instructions that each x86-64 processor has (SSE2), with and without
`deterministic`, and with all that this one has; in Node; and in the page's worker in Chromium, where the bones and the
hash of each frame are made, too. Medians over frames, then over rounds; ratios are medians of those within a round. For
all scenes in the worker: median, mean, and the limit below which 95 of 100 frames stay. Needs the page (./demos/run
--live), build/js/package, and live_native (see tests/live/run).
"""
import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import chromium
from live import NATIVE, REPOSITORY, Live
from native import stored_scene

MODULE = REPOSITORY / "build/js/package/tetskin.js"


def said(command):
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return dict(line.split(" ", 1) for line in out.splitlines())


def main(frames, rounds):
    scenes = {}
    columns = {"native, SSE2, deterministic": [], "native, SSE2": [], "native": [], "Node": [], "Chromium's worker": []}
    with chromium.Chromium() as browser, tempfile.TemporaryDirectory() as folder:
        live = Live(browser)
        live.open("serpent")
        scene = stored_scene(live, "serpent", Path(folder))
        for _ in range(rounds):
            first = said([NATIVE, scene, str(frames)])
            node = said(["node", Path(__file__).parent / "speed.mjs", MODULE, scene, str(frames)])
            live.call("reset")
            times = live.call("time", frames)
            results = [float(first["milliseconds"]), float(said([NATIVE, scene, str(frames), "--fast"])["milliseconds"]),
                       float(said([NATIVE, scene, str(frames), "--fast", "--any"])["milliseconds"]),
                       float(node["milliseconds"]), statistics.median(times)]
            for column, result in zip(columns.values(), results):
                column.append(result)
            if node["hash"] != first["hash"]:
                print("Node's states are not those of the native run", file=sys.stderr)
        for name in live.page.evaluate("tetskinLive.scenes"):
            tets = live.open(name)["tets"]
            scenes[f"{name}, {tets:,} tets"] = sorted(live.call("time", frames))
    processor = re.search(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.M)
    print(f"serpent on ramp and dome, {first['tets']} tets, four substeps; {frames} frames, {rounds} rounds; "
          f"{processor[1] if processor else 'unknown processor'}, load {os.getloadavg()[0]:.1f}")
    print("| | ms per frame | of native, SSE2, deterministic |\n|---|---|---|")
    base = columns["native, SSE2, deterministic"]
    for name, column in columns.items():
        ratio = statistics.median(one / other for one, other in zip(column, base))
        print(f"| {name} | {statistics.median(column):.2f} | {ratio:.2f} |")
    print("\n| in Chromium's worker | median | mean | 95 of 100 below |\n|---|---|---|---|")
    for name, times in scenes.items():
        median, most = statistics.median(times), times[95 * len(times) // 100]
        print(f"| {name} | {median:.1f} ms | {statistics.mean(times):.1f} | {most:.1f} |")


if __name__ == "__main__":
    if not NATIVE or not MODULE.exists():
        sys.exit(__doc__)
    main(*(int(word) for word in [*sys.argv[1:], *("240", "5")[len(sys.argv) - 1:]]))
