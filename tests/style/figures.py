#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Checks that the tables in demos/lab/figures are well formed and linked from demos/README.md, and that tests which they
name exist; that their plots exist, are shown on that page, and were drawn from the current tables. Draws them once:
needs matplotlib."""
import csv
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tests/pages"))
sys.path.insert(0, str(REPOSITORY / "demos/lab/plots"))
import page  # noqa: E402
from check_names import all_tests  # noqa: E402
from figures import hash_of  # noqa: E402

FOLDER = REPOSITORY / "demos/lab/figures"
LARGEST = 80000  # bytes of a picture
TEST = re.compile(r"(?<![\w.])([A-Z][A-Za-z]*)\.([A-Z][A-Za-z0-9]+)\b(?!\.)")


def table_faults(table, tests):
    with open(table, newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    if not rows:
        yield "has no rows"
    if "" in head or len(set(head)) != len(head):
        yield f"has a column without a name of its own: {head}"
    for number, row in enumerate(rows, 2):
        if len(row) != len(head):
            yield f"row {number} has {len(row)} columns instead of {len(head)}"
        for name in TEST.findall(" ".join(row)):
            if name not in tests:
                yield f"row {number} names no test: {'.'.join(name)}"


def source_in(picture):
    """The source in the picture's text chunk."""
    data = picture.read_bytes()
    position = 8
    while position < len(data):
        size, kind = struct.unpack(">I4s", data[position:position + 8])
        key, _, text = data[position + 8:position + 8 + size].partition(b"\0")
        if kind == b"tEXt" and key == b"Source":
            return text.decode()
        position += size + 12
    return ""


def picture_faults(picture):
    table = picture.with_suffix(".csv")
    if picture.stat().st_size > LARGEST:
        yield f"has more than {LARGEST} bytes"
    if not table.exists():
        yield f"is of no table: there is no {table.name}"
    elif source_in(picture) != f"{table.name} sha256 {hash_of(table)}":
        yield f"is not of {table.name} as it is now: run demos/lab/plots/figures.py"


def drawn():
    """The names of the plots that the program draws."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-B", REPOSITORY / "demos/lab/plots/figures.py", folder], check=True)
        return {picture.name for picture in Path(folder).iterdir()}


def main():
    text = (REPOSITORY / "demos/README.md").read_text()
    shown = {Path(target).name for _, target in page.links(text) if re.match(r"lab/figures/", target)}
    pictures = sorted(FOLDER.glob("*.png"))
    tables = sorted(FOLDER.glob("*.csv"))
    tests = all_tests()
    faults = [f"{table.name}: {fault}" for table in tables for fault in table_faults(table, tests)]
    faults += [f"{picture.name}: {fault}" for picture in pictures for fault in picture_faults(picture)]
    faults += [f"{file.name}: demos/README.md has no link to it"
               for file in tables + pictures if file.name not in shown]
    faults += [f"{name}: is not what demos/lab/plots/figures.py draws, or is missing"
               for name in drawn() ^ {picture.name for picture in pictures}]
    if not tables:
        faults.append("no tables found: look for them elsewhere")
    if faults:
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
