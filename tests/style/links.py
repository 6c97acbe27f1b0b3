#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Checks that links and pictures of all pages lead to existing files and headings; also paths of the repository in
`code`."""
import re
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tests/pages"))
import page  # noqa: E402

OURS = re.compile(r"(\./)?(demos|plugin|tests)/[\w./-]+")


def link_fault(source, target):
    """The fault of a link; empty if its target exists, or is outside of the repository."""
    if re.match(r"\w+:", target):
        return ""
    path, _, anchor = target.partition("#")
    file = (source.parent / path).resolve() if path else source
    if not file.exists():
        return f"leads to no file: {target}"
    if anchor and anchor not in page.anchors(file.read_text()):
        return f"leads to no heading: {target}"
    return ""


def path_fault(code):
    words = code.split()
    if not words or not OURS.fullmatch(words[0]) or (REPOSITORY / words[0]).exists():
        return ""
    return f"no such file: {code}"


def main():
    pages = [file for file in sorted(REPOSITORY.rglob("*.md")) if file.relative_to(REPOSITORY).parts[0] not in ("build", "out")]
    faults, links = [], 0
    for source in pages:
        text = source.read_text()
        name = source.relative_to(REPOSITORY)
        for line, target in page.links(text):
            links += 1
            fault = link_fault(source, target)
            if fault:
                faults.append(f"{name}:{line}: {fault}")
        codes = [code for passage in page.passages(text) for code in page.code(passage)]
        faults += [f"{name}: {path_fault(code)}" for code in codes if path_fault(code)]
    if links < 20:
        faults.append(f"only {links} links found: look for them elsewhere")
    if faults:
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
