# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Bad input: an exception each, and nothing changes."""

import pickle

import numpy as np
import pytest

import tetskin as ts

NAN = float("nan")
TETS = [[0, 1, 2, 3]]
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)


def error(code):
    return ts.Error, getattr(ts.StatusCode, code)


# Calls, with a world w, its body b, a rigid body r, a spring s, a skin k, an elastic body e, the cage c and the mesh m;
# and the exception: a type, or an Error with a code.
CALLS = {
    # shapes
    "positions of two columns": (lambda t: ts.TriangleMesh(np.zeros((4, 2)), [[0, 1, 2]]), ValueError),
    "positions of one dimension": (lambda t: ts.TriangleMesh(np.zeros(9), [[0, 1, 2]]), ValueError),
    "triangles of four columns": (lambda t: ts.TriangleMesh(CORNERS, TETS), ValueError),
    "tets of three columns": (lambda t: ts.Cage(CORNERS, [[0, 1, 2]]), ValueError),
    "nodes of three dimensions": (lambda t: t.k.update(np.zeros((2, 2, 3))), ValueError),
    "a mask that is too short": (lambda t: t.b.set_pinned(np.ones(3, bool)), ValueError),
    "too few nodes": (lambda t: t.k.update(t.c.nodes[:-1]), error("SIZE_MISMATCH")),
    "too few nodes for bones": (lambda t: ts.BonePalette(t.c, t.m).update(t.c.nodes[1:]), error("SIZE_MISMATCH")),
    "too few velocities": (lambda t: setattr(t.b, "velocities", t.c.nodes[1:]), error("SIZE_MISMATCH")),
    "normals of other vertices": (
        lambda t: ts.TriangleMesh(CORNERS, [[0, 1, 2]], normals=CORNERS[:2]),
        error("SIZE_MISMATCH"),
    ),
    "a hard edge of a negative angle": (
        lambda t: t.w.add_body(t.c, t.m, normals="recomputed", hard_edge_degrees=-1),
        error("INVALID_OPTION"),
    ),
    "a negative distance of contact": (lambda t: t.w.add_body(t.c, t.m, contact_margin=-1), error("INVALID_OPTION")),
    "a spacing of samples below 0": (lambda t: t.w.add_body(t.c, t.m, sample_spacing=-1), error("INVALID_OPTION")),
    "a spacing of too many samples": (lambda t: t.w.add_body(t.c, t.m, sample_spacing=1e-9), error("INVALID_OPTION")),
    "masses of other nodes": (lambda t: t.w.add_body(t.c, t.m, node_masses=[1.0]), error("SIZE_MISMATCH")),
    "a position of two numbers": (lambda t: t.w.add_body(t.c, t.m, position=(0, 0)), TypeError),
    # types
    "positions of booleans": (lambda t: ts.TriangleMesh(CORNERS.astype(bool), [[0, 1, 2]]), TypeError),
    "positions of complex numbers": (lambda t: t.k.update(t.c.nodes.astype(complex)), TypeError),
    "positions of text": (lambda t: t.k.update(np.array([["a", "b", "c"]])), TypeError),
    "triangles of floats": (lambda t: ts.TriangleMesh(CORNERS, [[0.0, 1.0, 2.0]]), TypeError),
    "objects": (lambda t: t.k.update(np.array([[None] * 3])), TypeError),
    "rows of different lengths": (lambda t: t.k.update([[1.0, 2.0, 3.0], [4.0]]), ValueError),
    "no array": (lambda t: t.k.update(None), (TypeError, ValueError)),
    "no mesh": (lambda t: ts.create_cage(3), TypeError),
    "a world for a cage": (lambda t: ts.Skin(t.w, t.m), TypeError),
    "an option without its name": (lambda t: ts.create_cage(t.m, 100), TypeError),
    "a number for a flag's name": (lambda t: ts.Skin(t.c, t.m, interpolation="cubic"), ValueError),
    # numbers
    "a mesh that is not finite": (lambda t: ts.TriangleMesh(CORNERS * NAN, [[0, 1, 2]]), error("NON_FINITE")),
    "nodes that are not finite": (lambda t: t.k.update(t.c.nodes * NAN), error("NON_FINITE")),
    "velocities that are not finite": (lambda t: setattr(t.b, "velocities", t.c.nodes * NAN), error("NON_FINITE")),
    "a place that is not finite": (lambda t: t.w.add_body(t.c, t.m, position=(0, NAN, 0)), error("NON_FINITE")),
    "an impulse that is not finite": (
        lambda t: t.w.point_at_vertex(t.b, 0).apply_impulse((NAN, 0, 0)),
        error("NON_FINITE"),
    ),
    "a target that is not finite": (lambda t: t.s.set_target((0, float("inf"), 0)), error("NON_FINITE")),
    "a gravity that is not finite": (lambda t: setattr(t.w, "gravity", (0, NAN, 0)), error("NON_FINITE")),
    "no rotation": (lambda t: t.w.add_box((1, 1, 1), rotation=(0, 0, 0, 0)), error("INVALID_OPTION")),
    "a step back": (lambda t: t.w.step(-1 / 60), ValueError),
    "a step of NaN": (lambda t: t.w.step(NAN), ValueError),
    "no substeps": (lambda t: t.w.step(substeps=0), ValueError),
    "a negative radius": (lambda t: t.w.add_sphere(-1), ValueError),
    "a negative mass": (lambda t: t.w.add_sphere(1, mass=-1), ValueError),
    "a mass that is not finite": (lambda t: setattr(t.r, "mass", NAN), ValueError),
    "a plane that moves": (lambda t: t.w.add_rigid_body(ts.Shape.plane(), mass=1), ValueError),
    "a Poisson's ratio of a half": (lambda t: t.w.add_body(t.c, t.m, poisson_ratio=0.5), error("INVALID_OPTION")),
    "a body's friction above 1": (lambda t: setattr(t.b, "friction", 2), error("INVALID_OPTION")),
    "a new body's friction above 1": (lambda t: t.w.add_body(t.c, t.m, friction=2), error("INVALID_OPTION")),
    "a body's restitution below 0": (lambda t: setattr(t.b, "restitution", -0.1), error("INVALID_OPTION")),
    "a body's restitution above 1": (lambda t: setattr(t.b, "restitution", 1.1), error("INVALID_OPTION")),
    "a body's restitution of NaN": (lambda t: setattr(t.b, "restitution", NAN), error("INVALID_OPTION")),
    "a new body's restitution below 0": (lambda t: t.w.add_body(t.c, t.m, restitution=-0.1), error("INVALID_OPTION")),
    "a new body's restitution above 1": (lambda t: t.w.add_body(t.c, t.m, restitution=1.1), error("INVALID_OPTION")),
    "a new body's restitution of NaN": (lambda t: t.w.add_body(t.c, t.m, restitution=NAN), error("INVALID_OPTION")),
    "a rigid body's restitution below 0": (lambda t: setattr(t.r, "restitution", -0.1), error("INVALID_OPTION")),
    "a rigid body's restitution above 1": (lambda t: setattr(t.r, "restitution", 1.1), error("INVALID_OPTION")),
    "a rigid body's restitution of NaN": (lambda t: setattr(t.r, "restitution", NAN), error("INVALID_OPTION")),
    "a rigid body's friction": (lambda t: setattr(t.r, "friction", -1), ValueError),
    "a new rigid body's friction": (lambda t: t.w.add_sphere(1, friction=-1), ValueError),
    "a pressure of NaN": (lambda t: setattr(t.b, "pressure", NAN), error("NON_FINITE")),
    "an absurd pressure": (lambda t: setattr(t.b, "pressure", 1e30), error("INVALID_OPTION")),
    "a gas below a vacuum": (lambda t: t.b.set_gas(-1.0), error("INVALID_OPTION")),
    "a negative stiffness": (lambda t: setattr(t.b, "youngs_modulus", -1.0), error("INVALID_OPTION")),
    "no tets": (lambda t: ts.create_cage(t.m, target_tets=0), error("INVALID_OPTION")),
    "a negative number of tets": (lambda t: ts.create_cage(t.m, target_tets=-1), TypeError),
    "too many threads": (lambda t: ts.World(threads=10**6), ValueError),
    "sleep before rest": (lambda t: ts.World(sleep_after=-1), error("INVALID_OPTION")),
    "no part of a step": (lambda t: ts.World(impact_parts=0), error("INVALID_OPTION")),
    # indices
    "a triangle of another vertex": (lambda t: ts.TriangleMesh(CORNERS, [[0, 1, 4]]), error("INDEX_OUT_OF_RANGE")),
    "a tet of another node": (lambda t: ts.Cage(CORNERS, [[0, 1, 2, -1]]), error("INDEX_OUT_OF_RANGE")),
    "an index beyond 32 bits": (lambda t: ts.TriangleMesh(CORNERS, [[0, 1, 2**40]]), error("INDEX_OUT_OF_RANGE")),
    "an index beyond 64 bits": (lambda t: ts.TriangleMesh(CORNERS, [[0, 1, 2**70]]), TypeError),
    "a number of tets beyond 64 bits": (lambda t: ts.create_cage(t.m, target_tets=2**70), TypeError),
    "a node that does not exist": (lambda t: t.b.set_pinned([10**6]), IndexError),
    "a vertex that does not exist": (lambda t: t.w.point_at_vertex(t.b, 10**6), error("INDEX_OUT_OF_RANGE")),
    # meshes and files
    "an empty mesh": (lambda t: ts.create_cage(ts.TriangleMesh(CORNERS, np.zeros((0, 3), int))), error("EMPTY")),
    "a flat cage": (lambda t: ts.Cage(CORNERS * [1, 1, 0], TETS), error("DEGENERATE")),
    "a file that is not there": (lambda t: ts.load_mesh("/no/such.obj"), error("FILE_NOT_FOUND")),
    "a format that is not read": (lambda t: ts.load_mesh(__file__), error("UNSUPPORTED_FORMAT")),
    "a mesh of another cage": (
        lambda t: ts.Skin(t.c, ts.TriangleMesh(t.m.positions + 0.1, t.m.triangles)),
        error("CAGE_MISMATCH"),
    ),
    "a folder that is not there": (lambda t: t.c.save("/no/such/cage.vtk"), error("FILE_NOT_WRITABLE")),
    # worlds
    "a body without a surface": (lambda t: t.w.add_body(t.c).positions, error("UNBOUND")),
    "bytes that are no snapshot": (lambda t: t.w.restore(b"snapshot"), error("MALFORMED")),
    "a snapshot of a deterministic world": (
        lambda t: ts.World().restore(ts.World(deterministic=True).save()),
        error("SNAPSHOT_MISMATCH"),
    ),
    "a snapshot for a deterministic world": (
        lambda t: ts.World(deterministic=True).restore(ts.World().save()),
        error("SNAPSHOT_MISMATCH"),
    ),
    "a snapshot of another world": (lambda t: ts.World().restore(t.w.save()), error("SNAPSHOT_MISMATCH")),
    "a joint with itself": (lambda t: t.w.add_fixed_joint(t.r, t.r), error("INVALID_OPTION")),
    "a joint with another world's": (
        lambda t: t.w.add_fixed_joint(t.r, ts.World().add_sphere(1)),
        error("NOT_IN_WORLD"),
    ),
    "a motor of no hinge": (lambda t: t.w.add_fixed_joint(t.r).set_motor(1.0, 1.0), error("INVALID_OPTION")),
    "a free node that is moved": (lambda t: t.b.set_pinned_positions([0], [[0.0, 0, 0]]), error("INVALID_OPTION")),
    "forces that are not recorded": (lambda t: ts.World(record_forces=False).forces_on(t.r), error("NOT_ADDED")),
    "a pickle of something else": (
        lambda t: ts.Cage.__new__(ts.Cage).__setstate__(t.m.__getstate__()),
        error("MALFORMED"),
    ),
    "an attribute that is not there": (lambda t: setattr(t.b, "positions", t.c.nodes), AttributeError),
}


class Things:
    """The arguments of the calls."""

    def __init__(self, cage, mesh):
        self.c, self.m = cage, mesh
        self.w = ts.World()
        self.b = self.w.add_body(cage, mesh)
        self.r = self.w.add_sphere(0.1, mass=1, position=(0, 5, 0))
        self.s = self.w.add_spring(self.w.point_at_vertex(self.b, 0))
        self.k = ts.Skin(cage, mesh)
        self.e = ts.ElasticBody(cage)


@pytest.mark.parametrize("name", CALLS)
def test_is_refused(name, cage, mesh):
    things = Things(cage, mesh)
    call, expected = CALLS[name]
    before = things.w.save() if "world" not in name else b""
    rigids = len(things.w.rigid_bodies)
    if isinstance(expected, tuple) and expected[0] is ts.Error:
        with pytest.raises(ts.Error) as raised:
            call(things)
        assert raised.value.code == expected[1] and str(raised.value)
    else:
        with pytest.raises(expected):
            call(things)
    added = things.w.bodies != [things.b] or "joint" in name or "motor" in name or "surface" in name
    if before and not added and len(things.w.rigid_bodies) == rigids:
        assert things.w.save() == before
    things.w.step()


def test_damaged_pickles_are_refused(cage):
    state = cage.__getstate__()
    for broken in (state[:-4], state + b"1", state[:100] + b"!" + state[101:], b"", (), (cage.nodes, cage.tets)):
        with pytest.raises(ts.Error) as raised:
            ts.Cage.__new__(ts.Cage).__setstate__(broken)
        assert raised.value.code == ts.StatusCode.MALFORMED and "this version of tetskin" in str(raised.value)


def test_a_snapshot_with_any_byte_changed_is_refused_or_another_one(dropped):
    world, _ = dropped
    world.step()
    snapshot = world.save()
    for at in range(0, len(snapshot), max(1, len(snapshot) // 50)):
        damaged = bytearray(snapshot)
        damaged[at] ^= 0x55
        with pytest.raises(ts.Error):
            world.restore(bytes(damaged))
    world.restore(snapshot)


@pytest.mark.filterwarnings("ignore:nanobind")
def test_what_has_not_been_made_cannot_be_used():
    for kind in (ts.Skin, ts.World, ts.Cage, ts.Body):
        thing = kind.__new__(kind)
        with pytest.raises(TypeError):
            thing.positions if kind in (ts.Skin, ts.Body) else thing.save() if kind is ts.World else thing.nodes


def test_errors_can_be_pickled_by_their_message():
    with pytest.raises(ts.Error) as raised:
        ts.load_mesh("/no/such.obj")
    assert str(pickle.loads(pickle.dumps(raised.value))) == str(raised.value)


# A call, and its message: the wrong word, and a similar word or the existing ones.
NAMES = {
    "a word near to another": (
        lambda t: t.w.add_body(t.c, t.m, stiffnes_scale=3),
        "World.add_body() got an unexpected keyword argument 'stiffnes_scale'; did you mean 'stiffness_scale'?",
    ),
    "a word near to none": (
        lambda t: ts.create_cage(t.m, xyz=3),
        "create_cage() got an unexpected keyword argument 'xyz'; there are: mesh, target_tets, duplicate_elements, "
        "fit, stiffness, density, damping, progress",
    ),
    "of a class": (lambda t: ts.Skin(t.c, t.m, normal=1), "Skin() got an unexpected keyword argument 'normal'; did"),
    "of a static method": (lambda t: ts.Shape.box(radius=1), "Shape.box() got an unexpected keyword argument 'radius'"),
    "of what has no arguments": (lambda t: t.w.save(to=1), "World.save() got an unexpected keyword argument 'to'"),
    "of a method of one argument": (lambda t: t.c.scaled(factor=2), "Cage.scaled() got an unexpected keyword"),
    "of a bound method": (lambda t: (lambda call: call(x=1))(t.b.remove), "Body.remove() got an unexpected keyword"),
    "what is missing": (lambda t: t.w.add_body(), "World.add_body() missing a required argument: 'cage'"),
    "what is missing and has a name": (lambda t: t.w.add_hinge(t.r, axis=(0, 0, 1)), "missing a required argument: 'p"),
    "what is given twice": (lambda t: t.w.step(1 / 60, dt=1 / 60), "World.step() multiple values for argument 'dt'"),
    "a word left out": (
        lambda t: ts.create_cage(t.m, 100),
        "create_cage() too many positional arguments; by their names alone: target_tets, ",
    ),
}


@pytest.mark.parametrize("name", NAMES)
def test_a_wrong_name_is_named(name, cage, mesh):
    call, said = NAMES[name]
    with pytest.raises(TypeError) as raised:
        call(Things(cage, mesh))
    assert said in str(raised.value)


def test_each_function_names_a_wrong_name():
    """Those of all classes and of the module itself, by no more than what nanobind says of them."""
    functions = [(name, getattr(ts._core, name)) for name in dir(ts._core)]
    for _, kind in list(functions):
        if isinstance(kind, type) and kind.__module__ == "tetskin._core":
            functions += [(f"{kind.__name__}.{name}", thing) for name, thing in vars(kind).items()]
    functions = [(name, thing) for name, thing in functions if hasattr(thing, "__nb_signature__")]
    assert len(functions) > 80
    for name, function in functions:
        if name.endswith(("__exit__", "__eq__")):  # which take anything
            continue
        with pytest.raises(TypeError, match="got an unexpected keyword argument 'nonsense'"):
            function(nonsense=1)


def test_arguments_of_a_wrong_type_are_told_by_their_types(cage, mesh):
    with pytest.raises(TypeError, match=r"(?s)incompatible function arguments.*kwargs = \{ position: str \}"):
        ts.World().add_body(cage, mesh, position="above")


@pytest.mark.parametrize("path", ["no\udc80.obj", "no\ud800.obj", b"no\xff.obj", "no\N{SNOWMAN}.obj"])
def test_a_path_of_any_letters_is_not_found(path, cage, mesh, tmp_path):
    for call, code in {
        lambda: ts.load_mesh(path): "FILE_NOT_FOUND",
        lambda: ts.load_cage(path if isinstance(path, bytes) else path.replace("obj", "vtk")): None,
        lambda: cage.save(path): None,
        lambda: ts.Replay(ts.World(), path): "FILE_NOT_FOUND",
        lambda: ts.Replay.description_of(path): "FILE_NOT_FOUND",
    }.items():
        with pytest.raises(ts.Error) as raised:
            call()
        str(raised.value).encode()
        assert code is None or raised.value.code == getattr(ts.StatusCode, code)


@pytest.mark.skipif(not hasattr(__import__("os"), "fork"), reason="names are text here")
def test_files_whose_names_are_no_text_are_read_and_written(cage, obj, tmp_path):
    place = tmp_path / "caf\udce9.obj"
    place.write_bytes(obj.read_bytes().replace(b"f ", b"g caf\xe9\nf ", 1))
    mesh = ts.load_mesh(place)
    assert pickle.loads(pickle.dumps(mesh)).__getstate__() == mesh.__getstate__()
    cage.save(str(place).replace("obj", "vtk"))
    assert ts.load_cage(str(place).replace("obj", "vtk")).tet_count == cage.tet_count
