#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Holds what is written by hand to the tables that bindings are made of: the options of a soft body, whose types and
defaults for JavaScript are in tetskin.d.ts, and whose defaults are the library's; the names of status codes."""
import re
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
TYPES = {"double": "number", "int": "number", "std::optional<double>": "number", "bool": "boolean", "Vec3": "Vector",
         "Quaternion": "Quaternion", "std::vector<int>": "Numbers", "std::vector<double>": "Numbers"}


def read(name):
    return (REPOSITORY / name).read_text(encoding="utf-8")


def found(pattern, text):
    return re.search(pattern, text, re.S)[1]


def table():
    """Type, name in Python, and default of each option, by its name."""
    rows = re.findall(r"^  option\(([^,]*), (\w+), (\w+)(?:, ([^)]*))?\)", read("plugin/facade/worlds.h"), re.M)
    return {name: (kind, python, default) for kind, name, python, default in rows}


def options_of_javascript():
    """Type and default of each option, by its name."""
    interface = found(r"export interface BodyOptions \{\n(.*?)\n\}", read("plugin/js/tetskin.d.ts"))
    rows = re.findall(r"/\*\*((?:(?!\*/).)*)\*/\s*(\w+)\?: ([^;]*);", interface, re.S)
    return {name: (kind, found(r"(?:.*;)?\s*(.*?)\.?(?: With .*)?\s*$", text)) for text, name, kind in rows}


def option_faults():
    options, theirs = table(), options_of_javascript()
    for name in options.keys() ^ theirs.keys():
        yield f"tetskin.d.ts, BodyOptions: {'lacks' if name in options else 'has another'} option {name}"
    ours = "".join(read(f"plugin/tetskin/{name}") for name in ("bullet/soft_body.h", "world/world.h"))
    for name, (kind, python, default) in options.items():
        if python != re.sub("[A-Z]", lambda capital: "_" + capital[0].lower(), name):
            yield f"{name}: its name in Python is {python}"
        told, said = theirs.get(name, (None, default))
        if told is not None and told != TYPES.get(kind, told):
            yield f"tetskin.d.ts: {name} is {told}, and {kind} in C++"
        if default and said != default:
            yield f"tetskin.d.ts: the default of {name} is said to be {said}, and is {default}"
        library = re.search(rf"^  (?:double|int|bool)\s+{name}\s*=\s*([^;]*);", ours, re.M)
        if library and (float(library[1]) != float(default) if kind in ("double", "int") else library[1] != default):
            yield f"{name}: its default is {default}, and {library[1]} in the library"


def code_faults():
    codes = re.findall(r"^ {4}(\w+),", found(r"enum class \[\[nodiscard\]\] StatusCode\s*\{(.*?)\};",
                                             read("plugin/tetskin/core/types.h")), re.M)
    names = re.findall(r'\{"(\w+)", "', found(r"kWords\[\] = \{(.*?)\n\};", read("plugin/tetskin/core/src/base/types.cpp")))
    typed = re.findall(r'"(\w+)"', found(r"export type ErrorCode =(.*?);\n", read("plugin/js/tetskin.d.ts")))
    if names != codes:
        yield f"types.cpp: names of status codes are not those of the enumeration: {sorted({*names} ^ {*codes})}"
    if typed[:len(codes) - 1] != codes[1:]:
        yield f"tetskin.d.ts, ErrorCode: begins with other codes than the library's: {sorted({*codes[1:]} - {*typed})}"


def main():
    faults = [*option_faults(), *code_faults()]
    for fault in faults:
        print(fault)
    assert len(table()) > 20, "the table was not read"
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
