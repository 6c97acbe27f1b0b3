#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Runs the program of a page as a reader would, with a mesh: `PROGRAM yours.obj`, in a separate folder. It must exit
with 0, and print the block of text after it on the page: the same words, and numbers within 2 % or 0.002, as processors
and compilers round differently.

page_program.py --source REPOSITORY --page PAGE --program PROGRAM --folder FOLDER
PAGE is the page's path with _ for everything but letters and digits, as the file of the program is called.
"""
import argparse
import math
import re
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "pages"))
import page  # noqa: E402
from run_commands import write_ring  # noqa: E402

NUMBER = re.compile(r"[-+]?\d+(?:,\d{3})*(?:\.\d+)?(?:e[-+]?\d+)?")


def shown_output(text):
    """The block of text that follows the page's program; nothing if another block does."""
    found = page.blocks(text)
    at = next(k for k, (language, block) in enumerate(found) if language == "cpp" and "int main(" in block)
    return found[at + 1][1] if at + 1 < len(found) and found[at + 1][0] == "text" else None


def split(line):
    """Its words without the numbers, and the numbers."""
    return " ".join(NUMBER.sub("#", line).split()), [float(n.replace(",", "")) for n in NUMBER.findall(line)]


def same(printed, shown):
    words, numbers = split(printed)
    shown_words, shown_numbers = split(shown)
    return words == shown_words and all(
        math.isclose(a, b, rel_tol=0.02, abs_tol=0.002) for a, b in zip(numbers, shown_numbers))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--source", type=Path, required=True)
    parser.add_argument("--page", required=True)
    parser.add_argument("--program", required=True)
    parser.add_argument("--folder", type=Path, required=True)
    arguments = parser.parse_args()

    named = [file for file in arguments.source.rglob("*.md")
             if re.sub("[^A-Za-z0-9]", "_", str(file.relative_to(arguments.source))) == arguments.page]
    if len(named) != 1:
        sys.exit(f"{len(named)} pages are called {arguments.page}")
    shutil.rmtree(arguments.folder, ignore_errors=True)
    arguments.folder.mkdir(parents=True)
    write_ring(arguments.folder / "yours.obj")
    done = subprocess.run([arguments.program, "yours.obj"], cwd=arguments.folder, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
    print(done.stdout)
    if done.returncode != 0:
        sys.exit(f"{named[0]}: its program ends with status {done.returncode}")
    shown = shown_output(named[0].read_text())
    if shown is None:
        return
    printed_lines, shown_lines = done.stdout.splitlines(), shown.splitlines()
    if len(printed_lines) != len(shown_lines) or not all(map(same, printed_lines, shown_lines)):
        sys.exit(f"{named[0]}: its program prints the above, and the page shows:\n{shown}")


if __name__ == "__main__":
    main()
