# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Makes gdb print the library's data in one line: (gdb) source plugin/debug/tetskin_gdb.py

    Ok                                            a Status, or what is wrong: OutsideCage: vertex 3 ...
    TetMesh of 8 nodes, 5 tets                    and Cage, TriangleMesh
    Result: Cage of 8 nodes, 5 tets, 12 vertices  or the status that says why there is none

Everything in them is still shown by `print /r`. For GCC's C++ library."""
import gdb


def length(vector):
    start = vector["_M_impl"]
    return int(start["_M_finish"] - start["_M_start"])


def status(value):
    code = str(value["code"]).rsplit("::", 1)[-1]
    return code if code == "Ok" else f"{code}: {value['message'].format_string().strip(chr(34))}"


def tet_mesh(value):
    return f"TetMesh of {length(value['nodes'])} nodes, {length(value['tets'])} tets"


def cage(value):
    mesh = value["mesh"]
    text = f"Cage of {length(mesh['nodes'])} nodes, {length(mesh['tets'])} tets"
    vertices = length(value["vertexTets"])
    return f"{text}, {vertices} vertices" if vertices else text


def triangle_mesh(value):
    return f"TriangleMesh of {length(value['positions'])} vertices, {length(value['triangles'])} triangles"


def result(value):
    payload = value["value_"]["_M_payload"]
    if not payload["_M_engaged"]:
        return f"Result: {status(value['status_'])}"
    return f"Result: {payload['_M_payload']['_M_value'].format_string()}"


TEXTS = {"Status": status, "TetMesh": tet_mesh, "Cage": cage, "TriangleMesh": triangle_mesh}


class Printer:
    def __init__(self, text, value):
        self.text, self.value = text, value

    def to_string(self):
        return self.text(self.value)


def printer(value):
    name = value.type.unqualified().strip_typedefs().name or ""
    if name.startswith("tetskin::Result<"):
        return Printer(result, value)
    text = TEXTS.get(name[len("tetskin::"):]) if name.startswith("tetskin::") else None
    return Printer(text, value) if text else None


gdb.pretty_printers.append(printer)
