#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""coverage.py BUILD [COUNT]: which lines of the library the unit tests have run, by file, from the counts that they have
left in BUILD, which was configured with TETSKIN_COVERAGE. Writes BUILD/coverage.json, and prints a table of the COUNT
files with most lines that have not run (20), and of each library. Uses gcovr."""
import collections
import json
import shutil
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]


def main():
    if len(sys.argv) not in (2, 3):
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    build, count = Path(sys.argv[1]).resolve(), int(sys.argv[2]) if len(sys.argv) == 3 else 20
    if not any(build.rglob("*.gcda")):
        print(f"{build}: no counts: configure with -DTETSKIN_COVERAGE=ON, build and run the tests", file=sys.stderr)
        sys.exit(2)
    if not shutil.which("gcovr"):
        print("gcovr is missing: install it", file=sys.stderr)
        sys.exit(2)
    out = build / "coverage.json"
    subprocess.run(["gcovr", "--root", str(REPOSITORY), "--filter", f"{REPOSITORY}/plugin/tetskin/",
                    "--object-directory", str(build), "--gcov-ignore-parse-errors", "--json-summary", str(out),
                    str(build)], check=True)
    files = json.loads(out.read_text(encoding="utf-8"))["files"]
    files = [(one["filename"].removeprefix("plugin/tetskin/"), one["line_total"], one["line_covered"]) for one in files]
    if not files:
        print(f"{out} names no file of the library", file=sys.stderr)
        sys.exit(1)
    print("| library | lines | run |\n|---|---|---|")
    lines, ran = collections.Counter(), collections.Counter()
    for name, total, covered in files:
        for library in (name.split("/")[0], "all"):
            lines[library] += total
            ran[library] += covered
    for library in sorted(lines, key=lambda one: (one == "all", one)):
        print(f"| {library} | {lines[library]:,} | {100 * ran[library] / lines[library]:.1f} % |")
    print("\n| file | lines | not run |\n|---|---|---|")
    for name, total, covered in sorted(files, key=lambda one: one[2] - one[1])[:count]:
        print(f"| `{name}` | {total} | {total - covered} |")


if __name__ == "__main__":
    main()
