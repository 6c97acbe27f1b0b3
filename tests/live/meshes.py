# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Files of meshes to drop on the page: a ball with furrows, and the same damaged in many ways."""
import json
import math
import struct


def ball(rings=24, segments=32):
    """Positions and triangles of a closed ball of radius 0.5, with furrows; counter-clockwise from outside."""
    positions = [(0.0, 0.5, 0.0)]
    for ring in range(1, rings):
        angle = math.pi * ring / rings
        radius = 0.5 + 0.03 * math.cos(4 * angle)
        for segment in range(segments):
            turn = 2 * math.pi * segment / segments
            positions.append((radius * math.sin(angle) * math.cos(turn), radius * math.cos(angle),
                              -radius * math.sin(angle) * math.sin(turn)))
    positions.append((0.0, -0.5, 0.0))
    last, triangles = len(positions) - 1, []
    for segment in range(segments):
        following = (segment + 1) % segments
        triangles.append((0, 1 + segment, 1 + following))
        for ring in range(rings - 2):
            a, b = 1 + ring * segments + segment, 1 + ring * segments + following
            triangles += [(a, a + segments, b + segments), (a, b + segments, b)]
        low = 1 + (rings - 2) * segments
        triangles.append((low + segment, last, low + following))
    return positions, triangles


def obj(positions, triangles):
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in positions]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles]
    return ("\n".join(lines) + "\n").encode()


def ply(positions, triangles, vertices=None, faces=None):
    """A binary PLY; with wrong counts in its header, if given."""
    header = ("ply\nformat binary_little_endian 1.0\n"
              f"element vertex {len(positions) if vertices is None else vertices}\n"
              "property float x\nproperty float y\nproperty float z\n"
              f"element face {len(triangles) if faces is None else faces}\n"
              "property list uchar int vertex_indices\nend_header\n")
    return (header.encode() + b"".join(struct.pack("<3f", *one) for one in positions) +
            b"".join(struct.pack("<B3i", 3, *one) for one in triangles))


def glb(positions, triangles, count=None):
    """A GLB with one mesh; with a wrong count of positions, if given."""
    indices = b"".join(struct.pack("<3I", *one) for one in triangles)
    points = b"".join(struct.pack("<3f", *one) for one in positions)
    low, high = ([pick(one[k] for one in positions) for k in range(3)] for pick in (min, max))
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
        "buffers": [{"byteLength": len(indices) + len(points)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(indices)},
                        {"buffer": 0, "byteOffset": len(indices), "byteLength": len(points)}],
        "accessors": [{"bufferView": 0, "componentType": 5125, "count": 3 * len(triangles), "type": "SCALAR"},
                      {"bufferView": 1, "componentType": 5126, "count": len(positions) if count is None else count,
                       "type": "VEC3", "min": low, "max": high}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    chunks += struct.pack("<II", len(indices + points), 0x004E4942) + indices + points
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def good():
    """Name and bytes of files, each of which becomes a body."""
    shape = ball()
    return [("ball.obj", obj(*shape)), ("ball.ply", ply(*shape)), ("BALL.GLB", glb(*shape))]


def damaged():
    """Name and bytes of files that the page must refuse."""
    positions, triangles = ball(8, 8)
    noise = bytes((97 * i * i + 31 * i) % 251 for i in range(5000))
    files = []
    for name, data in (("ball.obj", obj(positions, triangles)), ("ball.ply", ply(positions, triangles)),
                       ("ball.glb", glb(positions, triangles))):
        form = name[-3:]
        files += [(f"empty.{form}", b""), (f"noise.{form}", noise)]
        if form != "obj":  # a part of an OBJ may be a whole one
            files += [(f"half.{form}", data[:len(data) // 2]), (f"head.{form}", data[:40])]
    outside = [(*triangles[0][:2], 999999), *triangles[1:]]
    blank = [(0.0, 0.0, 0.0)] * len(positions)
    unbounded = [(math.nan, math.inf, 0.0), *positions[1:]]
    files += [("outside.obj", obj(positions, outside)), ("outside.ply", ply(positions, outside)),
              ("outside.glb", glb(positions, outside)), ("points.obj", obj(positions, [])),
              ("many_vertices.ply", ply(positions, triangles, vertices=4000000000)),
              ("many_faces.ply", ply(positions, triangles, faces=2**62)),
              ("many_vertices.glb", glb(positions, triangles, count=4000000000)),
              ("one_point.ply", ply(blank, triangles)), ("unbounded.ply", ply(unbounded, triangles)),
              ("picture.png", b"\x89PNG\r\n\x1a\n" + noise), ("no_extension", obj(positions, triangles))]
    return files
