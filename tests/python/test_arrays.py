# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Arrays of every layout and type of number, for every function that takes them, give the bits of plain ones."""

import array
from types import SimpleNamespace

import numpy as np
import pytest

import tetskin as ts


class Foreign:
    """An object like those of other packages, which NumPy turns into an array."""

    def __init__(self, numbers):
        self.numbers = numbers

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.numbers, dtype)

    @property
    def T(self):
        return Foreign(self.numbers.T)


def kept_on_disk(numbers, folder):
    file = np.memmap(folder / "numbers", numbers.dtype, "w+", shape=numbers.shape)
    file[:] = numbers
    return np.memmap(folder / "numbers", numbers.dtype, "r", shape=numbers.shape)


def read_only(numbers):
    numbers = numbers.copy()
    numbers.flags.writeable = False
    return numbers


def wide(numbers):
    full = np.full((len(numbers), *(9 for _ in numbers.shape[1:])), 77, numbers.dtype)
    part = full[:, 2 : 2 + numbers.shape[1]] if numbers.ndim == 2 else full
    part[:] = numbers
    return part


def unaligned(numbers):
    memory = np.zeros(numbers.nbytes + 1, np.uint8)
    view = memory[1:].view(numbers.dtype).reshape(numbers.shape)
    view[:] = numbers
    return view


LAYOUTS = {
    "Fortran's order": lambda numbers, _: np.asfortranarray(numbers),
    "by a list of columns": lambda numbers, _: numbers[:, [0, 1, 2]] if numbers.shape[1:] == (3,) else numbers,
    "turned twice": lambda numbers, _: numbers[::-1][::-1].copy()[::-1][::-1],
    "backwards": lambda numbers, _: numbers[::-1].copy()[::-1],
    "each second": lambda numbers, _: np.repeat(numbers, 2, axis=0)[::2],
    "part of a wider one": lambda numbers, _: wide(numbers),
    "read-only": lambda numbers, _: read_only(numbers),
    "not aligned": lambda numbers, _: unaligned(numbers),
    "memory-mapped": kept_on_disk,
    "of another package": lambda numbers, _: Foreign(numbers),
    "of another package, transposed": lambda numbers, _: Foreign(numbers.T.copy()).T,
    "lists": lambda numbers, _: numbers.tolist(),
    "tuples": lambda numbers, _: tuple(map(tuple, numbers)) if numbers.ndim == 2 else tuple(numbers),
    "a memory": lambda numbers, _: memoryview(np.ascontiguousarray(numbers)),
}
REAL = ["f2", "f4", "f8", ">f2", ">f4", ">f8", "<f8", "i1", "u1", "i2", ">i2", "u2", "i4", "u4", ">i4", "i8", "u8", ">u8"]
WHOLE = ["i1", "u1", "i2", ">i2", "u2", "i4", "u4", ">i4", "i8", "u8", ">u8"]
VARIANTS = {
    **LAYOUTS,
    **{f"type {kind}": lambda numbers, _, kind=kind: numbers.astype(kind) for kind in REAL},
}

# A tet of whole numbers: any type holds them.
CORNERS = np.array([[0, 0, 0], [6, 0, 0], [0, 4, 0], [0, 0, 2]], float)
TETS = np.array([[0, 1, 2, 3]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def scene(**options):
    cage = ts.Cage(CORNERS, TETS)
    mesh = ts.TriangleMesh(CORNERS, FACES)
    world = ts.World()
    return world, world.add_body(cage, mesh, **options), cage, mesh


def stepped(world, body):
    world.step(substeps=1)
    return body.positions.copy(), body.nodes.copy(), body.velocities.copy()


def of_new_body(**options):
    world, body, _, _ = scene(**options)
    return (*stepped(world, body), body.pinned)


def with_velocities(numbers):
    world, body, _, _ = scene()
    body.velocities = numbers
    return stepped(world, body)


def with_pins(nodes, positions=None):
    world, body, _, _ = scene(pinned=[0, 1, 2, 3] if positions is not None else None)
    if positions is None:
        body.set_pinned(nodes)
    else:
        body.set_pinned_positions(nodes, positions)
    return (*stepped(world, body), body.pinned)


def of_elastic_body(**arrays):
    body = ts.ElasticBody(ts.Cage(CORNERS, TETS))
    for name, numbers in arrays.items():
        setattr(body, name, numbers)
    body.step(1 / 60)
    return body.positions, body.velocities


def of_hull(points):
    world = ts.World()
    hull = world.add_rigid_body(ts.Shape.convex_hull(points), mass=1)
    world.step(substeps=1)
    return hull.position, np.frombuffer(world.save(), np.uint8)[200:]


def with_pinned_elastic_nodes(nodes):
    body = ts.ElasticBody(ts.Cage(CORNERS, TETS))
    body.set_pinned(nodes)
    body.step(1 / 60, (0, -1, 0))
    return body.positions, body.velocities


UVS = CORNERS[:, :2]
MASSES = np.array([1.0, 2, 3, 4])
# The function, with one array left open, and that array.
REAL_ARRAYS = {
    "positions of a mesh": (lambda a: [ts.TriangleMesh(a, FACES).positions], CORNERS),
    "normals": (lambda a: [ts.TriangleMesh(CORNERS, FACES, normals=a).normals], CORNERS),
    "texcoords": (lambda a: [ts.TriangleMesh(CORNERS, FACES, texcoords=a).texcoords], UVS),
    "nodes of a cage": (lambda a: [ts.Cage(a, TETS).nodes], CORNERS),
    "vertices of another package": (
        lambda a: [ts.create_cage(SimpleNamespace(vertices=a, faces=FACES), target_tets=10).nodes],
        CORNERS,
    ),
    "nodes of a skin": (lambda a: [ts.Skin(*scene()[2:]).update(a)], CORNERS + 1),
    "nodes of bones": (lambda a: [ts.BonePalette(*scene()[2:]).update(a)], CORNERS + 1),
    "velocities": (with_velocities, CORNERS),
    "pins' positions": (lambda a: with_pins([0, 1, 2, 3], a), CORNERS + 1),
    "masses": (lambda a: of_new_body(node_masses=a), MASSES),
    "stiffness": (lambda a: of_new_body(stiffness_scale=a), MASSES[:1]),
    "positions of an elastic body": (lambda a: of_elastic_body(positions=a), CORNERS + [[0, 0, 1]]),
    "velocities of an elastic body": (lambda a: of_elastic_body(velocities=a), CORNERS),
    "points of a hull": (of_hull, CORNERS),
}
WHOLE_ARRAYS = {
    "triangles": (lambda a: [ts.TriangleMesh(CORNERS, a).triangles], FACES),
    "tets": (lambda a: [ts.Cage(CORNERS, a).tets], TETS),
    "faces of another package": (
        lambda a: [ts.create_cage(SimpleNamespace(vertices=CORNERS, faces=a), target_tets=10).nodes],
        FACES,
    ),
    "pinned": (lambda a: of_new_body(pinned=a), np.array([3, 1])),
    "nodes to pin": (with_pins, np.array([3, 1])),
    "pinned nodes": (lambda a: with_pins(a, CORNERS[[3, 1]] + 1), np.array([3, 1])),
    "pinned nodes of an elastic body": (with_pinned_elastic_nodes, np.array([3, 1])),
}
MASKS = ["pinned", "nodes to pin", "pinned nodes of an elastic body"]


def check(call, numbers, variant, folder):
    for got, expected in zip(call(variant(numbers, folder)), call(numbers)):
        assert np.array_equal(got, expected)


@pytest.mark.parametrize("name", REAL_ARRAYS)
def test_numbers_of_any_layout_and_type_have_the_bits_of_plain_ones(name, tmp_path):
    call, numbers = REAL_ARRAYS[name]
    for variant in VARIANTS.values():
        check(call, numbers, variant, tmp_path)


@pytest.mark.parametrize("name", WHOLE_ARRAYS)
def test_indices_of_any_layout_and_type_have_the_bits_of_plain_ones(name, tmp_path):
    call, numbers = WHOLE_ARRAYS[name]
    for variant in LAYOUTS.values():
        check(call, numbers, variant, tmp_path)
    for kind in WHOLE:
        check(call, numbers, lambda indices, _, kind=kind: indices.astype(kind), tmp_path)


@pytest.mark.parametrize("name", MASKS)
def test_masks_of_any_layout_are_those_of_plain_ones(name, tmp_path):
    call, numbers = WHOLE_ARRAYS[name]
    mask = np.isin(np.arange(4), numbers)
    for variant in LAYOUTS.values():
        for got, expected in zip(call(variant(mask, tmp_path)), call(numbers)):
            assert np.array_equal(got, expected)


@pytest.mark.parametrize("name", {**REAL_ARRAYS, **WHOLE_ARRAYS})
def test_what_is_no_number_of_the_kind_is_named(name):
    call, numbers = {**REAL_ARRAYS, **WHOLE_ARRAYS}[name]
    kinds = [complex, "U8", object, "M8[s]", [("x", "f8")]]
    if name in REAL_ARRAYS:
        kinds.append(bool)
    else:
        kinds.append(float)
    for kind in kinds:
        with pytest.raises((TypeError, ValueError), match=r"^\w+: "):
            call(np.zeros(numbers.shape, kind))


def test_later_changes_of_an_array_change_nothing():
    corners, faces, nodes, tets = CORNERS.copy(), FACES.copy(), CORNERS.copy(), TETS.copy()
    mesh, cage = ts.TriangleMesh(corners, faces), ts.Cage(nodes, tets)
    velocities, pins = np.ones((4, 3)), np.array([0])
    world = ts.World(gravity=(0, 0, 0))
    body = world.add_body(cage, mesh, pinned=pins)
    body.velocities = velocities
    for one in (corners, faces, nodes, tets, velocities, pins):
        one[:] = 0
    assert np.array_equal(mesh.positions, CORNERS) and np.array_equal(mesh.triangles, FACES)
    assert np.array_equal(cage.nodes, CORNERS) and np.array_equal(cage.tets, TETS)
    assert np.array_equal(body.velocities[1:], np.ones((3, 3))) and body.pinned.tolist() == [True, False, False, False]


def test_vectors_may_be_anything_that_has_three_numbers():
    for vector in ([1, 2, 3], (1.0, 2, 3), np.array([1, 2, 3], ">f8"), np.array([1, 2, 3], "f2"), array.array("d", [1, 2, 3]),
                   np.array([1, 9, 2, 9, 3])[::2], np.arange(1, 4, dtype="u1")):
        assert ts.World().add_sphere(1, position=vector).position.tolist() == [1, 2, 3]


def test_meshes_of_several_packages_are_taken(mesh):
    """By the names that trimesh, Open3D and meshio have."""
    trimesh = SimpleNamespace(vertices=CORNERS, faces=FACES)
    open3d = SimpleNamespace(vertices=Foreign(CORNERS), triangles=Foreign(FACES.astype("i4")))
    cells = {"triangle": FACES, "tetra": TETS}
    meshio = SimpleNamespace(points=CORNERS.astype(">f8"), cells=[], get_cells_type=cells.__getitem__)
    cages = [ts.create_cage(other, target_tets=10).nodes for other in (trimesh, open3d, meshio)]
    assert np.array_equal(cages[0], cages[1]) and np.array_equal(cages[0], cages[2])
    assert np.array_equal(ts.Cage(meshio.points, meshio.get_cells_type("tetra")).nodes, CORNERS)
    for nothing in (SimpleNamespace(vertices=CORNERS), SimpleNamespace(points=CORNERS), 3):
        with pytest.raises(TypeError, match="Open3D"):
            ts.create_cage(nothing)
    with pytest.raises(ValueError, match=r"^vertices: the shape must be \(n, 3\), not \(4, 2\)"):
        ts.create_cage(SimpleNamespace(vertices=UVS, faces=FACES))
    with pytest.raises(TypeError, match="^faces: "):
        ts.create_cage(SimpleNamespace(vertices=CORNERS, faces=CORNERS))
