#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Finds names in pages that do not exist: programs, options and tests in `code`; also blocks that would not be tested,
and commands that commands.txt lists but no page has.

check_names.py --build BUILD --programs PROGRAM [PROGRAM ...] --pages PAGE [PAGE ...]

An option beside a program's name, in the same code, or else in the same paragraph, item or row, must belong to that
program; an option by itself may belong to any program.
"""
import argparse
import re
import sys
from pathlib import Path

import page
from handling import Handling, plain
from programs import examples, options

REPOSITORY = Path(__file__).resolve().parents[2]
NO_COMMAND_LINE = ["tetskin_hello", "tetskin_attach", "tetskin_clay", "tetskin_muscle"]
LANGUAGES = ("sh", "cpp", "cmake", "json", "text", "python", "js", "")  # by tests/python, tests/js
COMMAND = re.compile(r"\s*(\./|build/|tetskin_|cmake |ctest )")
DROPS = "./demos/run"  # builds tetskin_drop, and runs it with its own arguments
HISTORY = "plugin/CHANGES.md"  # also names programs and options that have been removed


def programs_in(text, programs):
    return [program for program in programs if re.search(rf"\b{program}\b", text)]


def option_faults(passage, known, handling):
    """The faults of one passage. known: options by program"""
    everybodys = set().union(*known.values())
    together = " ".join(page.code(passage))
    nearby = programs_in(together, known) if DROPS not in together else []
    for code in page.code(passage):
        own = programs_in(code.replace(DROPS, "tetskin_drop"), known)
        first = plain(code).split()[0] if code.split() else ""
        if not own and not first.startswith("-"):
            continue  # belongs to another command
        allowed = set().union(*(known[program] for program in own or nearby)) if own or nearby else everybodys
        for option in re.findall(r"(?<![\w-])--[a-z][\w-]*", code):
            if option not in allowed and not handling.is_known_option(option):
                yield f"no option {option} of {', '.join(own or nearby) or 'any program'}: `{code}`"


def program_faults(passage, programs):
    for code in page.code(passage):
        for name in re.findall(r"(?:^|build/demos/)(tetskin_[a-z_]+)(?= |$)", code):
            if name not in programs + NO_COMMAND_LINE:
                yield f"no program {name}: `{code}`"


def test_faults(text, tests):
    """Tests are named as `Suite.Name`, and the next of the same suite as `.Name`. tests: all that exist"""
    suite = ""
    for code in page.code(" ".join(page.passages(text))):
        name = re.fullmatch(r"([A-Z][A-Za-z]*)?\.([A-Z][A-Za-z0-9]+)", code)
        if not name:
            continue
        suite = name.group(1) or suite
        if (suite, name.group(2)) not in tests:
            yield f"no test {suite}.{name.group(2)}"


def all_tests():
    sources = "".join(source.read_text() for source in (REPOSITORY / "tests").rglob("*.cpp"))
    return set(re.findall(r"^TEST(?:_[FP])?\(\s*(\w+),\s*(\w+)", sources, re.MULTILINE))


def block_faults(text):
    blocks = page.blocks(text)
    if text.count("```") != 2 * len(blocks):
        yield "a block that is indented, or has no end, is not tested"
    for language, block in blocks:
        if language not in LANGUAGES:
            yield f"blocks of {language} are not tested: {', '.join(LANGUAGES)} are known"
        elif not language and any(COMMAND.match(line) for line in block.splitlines()):
            yield f"commands in a block that is not one of sh: {block.splitlines()[0]}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--programs", nargs="+", required=True)
    parser.add_argument("--pages", nargs="+", required=True)
    arguments = parser.parse_args()

    handling = Handling()
    known = {program: options(arguments.build, program) for program in arguments.programs}
    commands = [line for program in arguments.programs for line in examples(arguments.build, program)]
    tests = all_tests()
    faults = []
    for name in arguments.pages:
        text = (REPOSITORY / name).read_text()
        commands += page.commands(text)
        faults += [f"{name}: {fault}" for fault in [*block_faults(text), *test_faults(text, tests)]]
        for passage in page.passages(text) if name != HISTORY else ():
            faults += [f"{name}: {fault}" for fault in option_faults(passage, known, handling)]
            faults += [f"{name}: {fault}" for fault in program_faults(passage, arguments.programs)]
    for command in commands:
        if not handling.left_out(command):
            handling.extra(command)
    faults += [f"commands.txt: on no page: {'  '.join(row)}" for row in handling.unused()]
    if faults:
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
