#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Checks that pages stay short enough to be read, and that each page of plugin/docs is linked from the table of
contents, has one program, and shows its output right after it."""
import re
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tests/pages"))
import page  # noqa: E402

# Pages of other languages have no program in C++; tests/python and tests/js run theirs. That of the live page has none:
# tests/live run the page.
OTHERS = ("python.md", "pybullet.md", "many_runs.md", "peers.md", "javascript.md", "live.md")
FIRST, CONTENTS, TOPICS = "README.md", "plugin/README.md", "plugin/docs"
MOST_LINES = {FIRST: 170, CONTENTS: 80, TOPICS: 150}


def length_faults(name, text, most):
    count = len(text.splitlines())
    if count > most:
        yield f"{name} has {count} lines, and may have {most}: move what is about another task to that task's page"


def program_faults(text):
    blocks = page.blocks(text)
    programs = [k for k, (language, block) in enumerate(blocks) if language == "cpp" and "int main(" in block]
    if len(programs) != 1:
        yield f"has {len(programs)} programs instead of one"
    for k in programs:
        if not re.search(r"int main\(int argc, char\*\* argv\)", blocks[k][1]):
            yield "has a program that takes no mesh"
        if k + 1 == len(blocks) or blocks[k + 1][0] != "text" or not blocks[k + 1][1].strip():
            yield "does not show what its program prints, in a block of text right after it"


def main():
    faults = []
    contents = (REPOSITORY / CONTENTS).read_text(encoding="utf-8")
    linked = {target.partition("#")[0] for _, target in page.links(contents)}
    topics = sorted((REPOSITORY / TOPICS).glob("*.md"))
    for name in (FIRST, CONTENTS):
        faults += length_faults(name, (REPOSITORY / name).read_text(encoding="utf-8"), MOST_LINES[name])
    for topic in topics:
        name, text = f"{TOPICS}/{topic.name}", topic.read_text(encoding="utf-8")
        faults += length_faults(name, text, MOST_LINES[TOPICS])
        if topic.name not in OTHERS:
            faults += [f"{name} {fault}" for fault in program_faults(text)]
        if f"docs/{topic.name}" not in linked:
            faults.append(f"{name} is not linked from {CONTENTS}")
    if not topics:
        faults.append("no pages found: look for them elsewhere")
    if faults:
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
