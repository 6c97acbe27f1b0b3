#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Checks that the drawings in plugin/docs are true: libraries.svg has a box for each library and an arrow for each
dependency that CMake's lists name, and no others; step.svg has the calls and stages that the comment of step.cpp lists,
in its order, and names files that exist. No text leaves its box, as far as its number of letters tells."""
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
DOCS = REPOSITORY / "plugin/docs"
LIBRARIES = REPOSITORY / "plugin/tetskin"
STEP = LIBRARIES / "solver/src/step/step.cpp"
SVG = "{http://www.w3.org/2000/svg}"
KINDS = ("PUBLIC", "PRIVATE", "INTERFACE")
# Targets of other projects, by the ids of their boxes.
OTHERS = {"Eigen3::Eigen": "Eigen", "tetskin::bullet_physics": "Bullet", "assimp::assimp": "assimp",
          "TinyGLTF::TinyGLTF": "tinygltf", "Threads::Threads": "Threads"}


def box_of(target):
    """The id of a target's box; the target itself if it has none."""
    ours = re.fullmatch(r"tetskin(?:_|::)(\w+)", target)
    return OTHERS.get(target) or (ours[1] if ours else target)


def dependencies():
    """The libraries, and (library, what it needs, how), as CMake's lists say."""
    libraries, needs = set(), set()
    for file in sorted(LIBRARIES.glob("*/CMakeLists.txt")):
        text = re.sub(r"#.*", "", file.read_text(encoding="utf-8"))
        libraries.update(re.findall(r"\b(?:tetskin_add_library\(|add_library\(tetskin_)(\w+)", text))
        for library, words in re.findall(r"\btarget_link_libraries\(\s*tetskin_(\w+)\s([^)]*)\)", text):
            kind = ""
            for word in words.split():
                if word in KINDS:
                    kind = word.lower()
                else:
                    needs.add((library, box_of(word), kind))
    return libraries, needs


def library_faults(root):
    boxes = {group.get("id"): group.get("class") for group in root.iter(SVG + "g") if group.get("id")}
    arrows = [(path.get("data-from"), path.get("data-to"), path.get("data-link"))
              for path in root.iter(SVG + "path") if path.get("data-from")]
    libraries, needs = dependencies()
    if len(libraries) < 5 or len(needs) < 5:
        yield f"only {len(libraries)} libraries with {len(needs)} dependencies found: look for them elsewhere"
    drawn = {name for name, kind in boxes.items() if kind in ("library", "group")}
    yield from (f"has no box of the library {name}" for name in sorted(libraries - drawn))
    yield from (f"has a box of {name}, which is no library" for name in sorted(drawn - libraries))
    others = {need for _, need, _ in needs} - libraries
    external = {name for name, kind in boxes.items() if kind == "external"}
    yield from (f"has no box of {name}, which a library needs" for name in sorted(others - external))
    yield from (f"has a box of {name}, which no library needs" for name in sorted(external - others))
    yield from (f"has no arrow: {a} needs {b}, {how}" for a, b, how in sorted(needs - set(arrows)))
    yield from (f"has an arrow that no list of CMake's knows: {arrow}" for arrow in sorted(set(arrows) - needs))
    yield from (f"has an arrow twice: {arrow}" for arrow in sorted(set(arrows)) if arrows.count(arrow) > 1)


def stages_in_source():
    """Bullet's calls and the stages, in the order of the table in the comment of step.cpp."""
    comment = STEP.read_text(encoding="utf-8").partition("#include")[0]
    calls = re.findall(r"^//   ([a-z]\w+)  +", comment, re.MULTILINE)
    stages = re.findall(r"^//   (?:[a-z]\w+)?  +([a-z]\w+)  +", comment, re.MULTILINE)
    return calls, stages


def step_faults(root):
    calls, stages = stages_in_source()
    if len(calls) < 3 or len(stages) < 3:
        yield f"calls {calls} and stages {stages} found in step.cpp: look for them elsewhere"
    for what, expected in (("call", calls), ("stage", stages)):
        drawn = [group.get(f"data-{what}") for group in root.iter(SVG + "g") if group.get(f"data-{what}")]
        if drawn != expected:
            yield f"has the {what}s {drawn}; the comment of step.cpp has {expected}"
    paths = [path for group in root.iter(SVG + "g") for path in (group.get("data-path") or "").split()]
    if not paths:
        yield "names no files"
    yield from (f"names a file that does not exist: {path}" for path in paths if not (REPOSITORY / path).exists())
    for group in root.iter(SVG + "g"):  # what is written in a box is part of its data
        for text in group.iter(SVG + "text"):
            if text.get("class") == "path":
                named = [name.strip() for name in text.text.split(",")]
                known = group.get("data-path", "").split()
                yield from (f"has the text {name}, but {known}" for name in named
                            if not any(f"/{path}/".find(f"/{name}/") >= 0 for path in known))


def width_faults(root):
    """A letter of Helvetica is half as wide as it is high, on average; bold and DejaVu's letters are a fifth wider."""
    height = {"name": 16.0, "what": 12.0, "path": 11.0}
    for group in root.iter(SVG + "g"):
        rect = group.find(SVG + "rect")
        if rect is None or group.get("class") == "what":
            continue
        left, width = float(rect.get("x")), float(rect.get("width"))
        for text in group.iter(SVG + "text"):
            needed = 0.5 * height[text.get("class")] * len(text.text)
            at, anchor = float(text.get("x")), text.get("text-anchor") or root.get("text-anchor") or "start"
            start = at - needed * {"start": 0, "middle": 0.5, "end": 1}[anchor]
            if start < left or start + needed > left + width:
                yield f"has a text that leaves its box: {text.text}"


def main():
    faults = []
    for name, own in (("libraries.svg", library_faults), ("step.svg", step_faults)):
        root = ElementTree.parse(DOCS / name).getroot()
        faults += [f"{name} {fault}" for check in (own, width_faults) for fault in check(root)]
    if faults:
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
