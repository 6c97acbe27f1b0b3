#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Checks the size, the frames and the time of the moving picture, demos/pictures/drop.webp, by its chunks."""
import sys
from pathlib import Path

FILE = Path(__file__).resolve().parents[2] / "demos/pictures/drop.webp"
MOST_BYTES = 1_500_000
FEWEST_FRAMES = 240  # of the drop, each of them
SHORTEST, LONGEST = 7.0, 10.0  # seconds


def number(data):
    return int.from_bytes(data, "little")


def chunks(data):
    """(name, contents) of each chunk. A chunk begins with its name and its size, and is padded to even size."""
    if data[:4] != b"RIFF" or data[8:12] != b"WEBP" or number(data[4:8]) + 8 != len(data):
        sys.exit(f"{FILE.name}: is not a whole WebP file")
    at = 12
    while at < len(data):
        size = number(data[at + 4:at + 8])
        yield data[at:at + 4].decode(), data[at + 8:at + 8 + size]
        at += 8 + size + size % 2


def faults(data):
    found = list(chunks(data))
    loops = [number(contents[4:6]) for name, contents in found if name == "ANIM"]  # after the colour of the background
    seconds = sum(number(contents[12:15]) for name, contents in found if name == "ANMF") / 1000
    frames = sum(name == "ANMF" for name, _ in found)
    if len(data) > MOST_BYTES:
        yield f"has {len(data)} bytes, more than {MOST_BYTES}"
    if loops != [0]:
        yield f"does not loop for ever: {loops}"
    if frames < FEWEST_FRAMES:
        yield f"has {frames} frames, fewer than {FEWEST_FRAMES}"
    if not SHORTEST <= seconds <= LONGEST:
        yield f"lasts {seconds:g} s, not {SHORTEST:g} to {LONGEST:g}"


def main():
    found = [f"{FILE.name}: {fault}" for fault in faults(FILE.read_bytes())]
    if found:
        sys.exit("\n".join(found))


if __name__ == "__main__":
    main()
