# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The meshes of the scenes, all by formula: no peer needs a file."""
import itertools

import numpy as np


def box_tets(cells, size, origin=(0, 0, 0)):
    """Nodes and tets of a box with these numbers of cells along x, y and z, six tets each, mirrored from cell to cell.

    The size is that of the whole box. Node (i, j, k) is at row (i (ny + 1) + j) (nz + 1) + k.
    """
    nx, ny, nz = cells
    steps = np.array(list(np.ndindex(nx + 1, ny + 1, nz + 1)))
    nodes = np.asarray(origin, float) + steps * np.asarray(size, float) / np.array(cells)
    row = lambda i, j, k: (i * (ny + 1) + j) * (nz + 1) + k  # noqa: E731
    tets = []
    for cell in np.ndindex(nx, ny, nz):
        for order in itertools.permutations(range(3)):
            corner, path = [0, 0, 0], []
            for axis in (None, *order):
                if axis is not None:
                    corner[axis] = 1
                path.append(row(*(c + (bit ^ (c & 1)) for c, bit in zip(cell, corner))))
            tets.append(path)
    return nodes, oriented(nodes, np.array(tets))


def oriented(nodes, tets):
    """The tets, with those that are oriented negatively reversed."""
    tets = np.array(tets)
    corners = nodes[tets]
    negative = np.linalg.det(corners[:, 1:] - corners[:, :1]) < 0
    tets[negative] = tets[negative][:, [0, 1, 3, 2]]
    return tets


def surface_of(tets):
    """(m, 3) the triangles of the tets' boundary, counter-clockwise from outside."""
    faces = np.concatenate([tets[:, list(f)] for f in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))])
    _, first, count = np.unique(np.sort(faces, 1), axis=0, return_index=True, return_counts=True)
    return faces[np.sort(first[count == 1])]


def ball_tets(radius, cells=4, centre=(0, 0, 0)):
    """A ball of 6 cells^3 tets: a box whose shells are pushed out onto spheres."""
    nodes, tets = box_tets((cells,) * 3, (2.0,) * 3, (-1.0,) * 3)
    largest = np.abs(nodes).max(1)
    length = np.linalg.norm(nodes, axis=1)
    ball = nodes * (largest / np.where(length > 0, length, 1))[:, None]
    return ball * radius + np.asarray(centre, float), oriented(ball, tets)


def tube(line, radius, around):
    """A closed surface around a line of points (n, 3), round at both ends: positions and triangles."""
    count = len(line)
    tangent = np.gradient(line, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    side = np.cross(tangent, np.eye(3)[np.abs(tangent).max(0).argmin()])
    side /= np.linalg.norm(side, axis=1)[:, None]
    up = np.cross(side, tangent)
    angle = 2 * np.pi * np.arange(around) / around
    ring = np.cos(angle)[None, :, None] * side[:, None] + np.sin(angle)[None, :, None] * up[:, None]
    positions = (line[:, None] + radius[:, None, None] * ring).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(count - 1), np.arange(around), indexing="ij")
    a, b, c, d = i * around + j, i * around + (j + 1) % around, (i + 1) * around + (j + 1) % around, (i +
                                                                                                      1) * around + j
    triangles = [np.stack([a, c, b], -1).reshape(-1, 3), np.stack([a, d, c], -1).reshape(-1, 3)]
    first, last = len(positions), len(positions) + 1
    ends = np.arange(around)
    tip = (count - 1) * around
    triangles.append(np.stack([np.full(around, first), ends, (ends + 1) % around], -1))
    triangles.append(np.stack([np.full(around, last), tip + (ends + 1) % around, tip + ends], -1))
    return np.concatenate([positions, line[[0, -1]]]), np.concatenate(triangles)


def snake(vertices_along=300, around=100):
    """A snake in an S with scales, 1 m long: 60,000 triangles by default. It lies along x, its belly near y = 0.05."""
    t = np.linspace(0, 1, vertices_along)
    line = np.stack([t - 0.5, 0.05 + 0.02 * np.sin(3 * np.pi * t), 0.12 * np.sin(2 * np.pi * t)], 1)
    thick = 0.045 * np.sqrt(np.clip(1 - (2 * t - 1) ** 4, 1e-4, None))
    positions, triangles = tube(line, thick, around)
    rows = np.arange(vertices_along * around).reshape(vertices_along, around)
    scales = 1 + 0.03 * np.sin(0.9 * np.arange(vertices_along))[:, None] * np.cos(
        8 * 2 * np.pi * np.arange(around) / around)
    centres = np.repeat(line, around, 0)
    positions[rows.ravel()] = centres + (positions[rows.ravel()] - centres) * scales.reshape(-1, 1)
    return positions, triangles


def volume_of(nodes, tets):
    corners = nodes[tets]
    return np.linalg.det(corners[:, 1:] - corners[:, :1]).sum() / 6
