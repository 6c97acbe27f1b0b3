#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Holds what is written by hand to the tables that bindings are made of: the options of a soft body, whose types and
defaults for JavaScript are in tetskin.d.ts, and whose members and defaults are the library's; the names of status
codes. First it checks that it finds an option that is planted in the library."""
import re
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
TYPES = {"double": "number", "int": "number", "std::optional<double>": "number", "bool": "boolean", "Vec3": "Vector",
         "Quaternion": "Quaternion", "std::vector<int>": "Numbers", "std::vector<double>": "Numbers"}
# The library's structures, and which of their members bindings do not offer, because ...
STRUCTURES = {
    "SoftBodyOptions": ("bullet/soft_body.h", {
        "forceModel": "a World is solved by DeformableSolver, for Corotated",
        "timeStep": "only for Bullet's own forces", "implicit": "only for Bullet's own forces",
        "linkStiffness": "only for MassSpring", "configureWorld": "a World belongs to nobody else",
        "faceTree": "rays are cast at the surface, by SurfaceTree", "pinned": "replaced by indices of nodes"}),
    "BindingOptions": ("core/mesh_skin.h", {"order": "arrays have the order of the mesh; no binding tells another"}),
    "WorldBodyOptions": ("world/world.h", {"material": "see SoftBodyOptions", "binding": "see BindingOptions"}),
    "SurfaceContactOptions": ("contact/surface_contact.h", {
        "margin": "contactMargin of WorldBodyOptions", "sampleSpacing": "of WorldBodyOptions"}),
    "ContactShapeOptions": ("contact/soft_contacts.h", {
        "sampleCount": "chosen for the model", "gridResolution": "chosen for the model"}),
}


def read(name):
    return (REPOSITORY / name).read_text(encoding="utf-8")


def found(pattern, text):
    return re.search(pattern, text, re.S)[1]


def table():
    """The structure, type, name in Python, and default of each option, by its name."""
    rows = re.findall(r"^  option\((\w+), ([^,]*), (\w+), (\w+)(?:, ([^)]*))?\)", read("plugin/facade/worlds.h"), re.M)
    return {name: (structure, kind, python, default) for structure, kind, name, python, default in rows}


def members_of(structure, header):
    """The members of a structure, with their defaults."""
    code = re.sub(r"//[^\n]*", "", header)
    constants = dict(re.findall(r"constexpr \w+ (\w+) = ([^;]*);", code))
    body = found(rf"struct {structure}\b[^;{{]*\{{(.*?)\n\}};", code)
    plain = re.sub(r"<[^<>]*>|\{[^{}]*\}", "", re.sub(r"\([^()]*\)", "", re.sub(r"\s*static [^;]*;", "", body)))
    rows = re.findall(r"(\w+)\s*(?:=\s*([^;,]*))?[;,]", plain + ";")
    return {name: constants.get(default, default) for name, default in rows}


def member_faults(structure, members, options):
    """members  the structure's, with their defaults;  options  of the table"""
    left_out = STRUCTURES[structure][1]
    offered = {name: row for name, row in options.items() if row[0] == structure}
    for name in members.keys() - offered.keys() - left_out.keys():
        yield f"{structure}::{name} is neither in TETSKIN_BODY_OPTIONS nor left out of it for a reason"
    for name in (left_out.keys() | offered.keys()) - members.keys() | left_out.keys() & offered.keys():
        yield f"{structure}::{name} is not what TETSKIN_BODY_OPTIONS or this test takes it for"
    for name, (_, kind, _, default) in offered.items():
        library = members.get(name)
        if library and default:
            same = float(library) == float(default) if kind in ("double", "int") else \
                library.split("::")[-1].lower() == default.strip('"')
            if not same:
                yield f"{name}: its default is {default}, and {library} in the library"


def check_itself():
    planted = members_of("Planted", "struct Planted : Other {\n  int a = 1;  ///< a; b\n  A<int, 2> b{};\n"
                                    "  bool c, d;\n};")
    assert planted == {"a": "1", "b": "", "c": "", "d": ""}, planted
    members = members_of("BindingOptions", read("plugin/tetskin/core/mesh_skin.h"))
    for changed in ({**members, "planted": "1.0"}, {**members, "hardEdgeDegrees": "6.0"}, {}):
        assert any(member_faults("BindingOptions", changed, table())), f"this test does not find {changed}"


def options_of_javascript():
    """Type and default of each option, by its name."""
    interface = found(r"export interface BodyOptions \{\n(.*?)\n\}", read("plugin/js/tetskin.d.ts"))
    rows = re.findall(r"/\*\*((?:(?!\*/).)*)\*/\s*(\w+)\?: ([^;]*);", interface, re.S)
    return {name: (kind, found(r"(?:.*;)?\s*(.*?)\.?(?: With .*)?\s*$", text)) for text, name, kind in rows}


def option_faults():
    options, theirs = table(), options_of_javascript()
    for name in options.keys() ^ theirs.keys():
        yield f"tetskin.d.ts, BodyOptions: {'lacks' if name in options else 'has another'} option {name}"
    for structure, (header, _) in STRUCTURES.items():
        yield from member_faults(structure, members_of(structure, read(f"plugin/tetskin/{header}")), options)
    for name, (_, kind, python, default) in options.items():
        if python != re.sub("[A-Z]", lambda capital: "_" + capital[0].lower(), name):
            yield f"{name}: its name in Python is {python}"
        told, said = theirs.get(name, (None, default))
        if told is not None and told != TYPES.get(kind, told):
            yield f"tetskin.d.ts: {name} is {told}, and {kind} in C++"
        if default and said != default:
            yield f"tetskin.d.ts: the default of {name} is said to be {said}, and is {default}"


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
    check_itself()
    faults = [*option_faults(), *code_faults()]
    for fault in faults:
        print(fault)
    assert len(table()) > 20, "the table was not read"
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
