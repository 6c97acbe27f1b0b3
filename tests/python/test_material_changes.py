# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Plastic flow, growth and muscles, of bodies in a world and by themselves. The laws are tested in C++."""

import numpy as np
import pytest
import tetskin as ts


def cage_of_box():
    cells = np.array([(x, y, z) for x in range(8) for y in range(2) for z in range(2)])
    corners = {}
    tets = []
    even = [(0, 3, 5, 6), (1, 0, 3, 5), (2, 0, 3, 6), (4, 0, 5, 6), (7, 3, 5, 6)]
    for cell in cells:
        mirror = cell.sum() % 2
        for tet in even:
            made = []
            for corner in tet:
                c = corner ^ mirror
                at = tuple(cell + [c & 1, c >> 1 & 1, c >> 2])
                made.append(corners.setdefault(at, len(corners)))
            tets.append(made)
    nodes = np.array(list(corners), float) * 0.125
    tets = np.array(tets)
    volume = np.einsum("ij,ij->i", np.cross(nodes[tets[:, 1]] - nodes[tets[:, 0]], nodes[tets[:, 2]] - nodes[tets[:, 0]]),
                       nodes[tets[:, 3]] - nodes[tets[:, 0]])
    tets[volume < 0] = tets[volume < 0][:, [0, 2, 1, 3]]
    return ts.Cage(nodes, tets)


@pytest.fixture
def elastic():
    return ts.ElasticBody(cage_of_box(), youngs_modulus=1e6, density=1000, stiffness_damping=0.02)


@pytest.fixture
def world_and_body():
    world = ts.World(gravity=(0, 0, 0))
    body = world.add_body(cage_of_box(), youngs_modulus=1e6, density=1000, stiffness_damping=0.02)
    return world, body


def length(nodes):
    return np.ptp(np.asarray(nodes)[:, 0])


def test_growth_by_a_factor_by_tet_and_by_axis(elastic, world_and_body):
    world, body = world_and_body
    tets = len(body.plastic_strains)
    stretch = np.tile(np.diag([1.3, 1.0, 1.0]), (tets, 1, 1))
    for growth, expected in [(1.2, 1.2), (np.full(tets, 1.1), 1.1), (stretch, 1.3), (1, 1.0)]:
        elastic.set_growth(growth)
        body.set_growth(growth)
        for _ in range(240):
            elastic.step(1 / 60)
            world.step(1 / 60)
        assert length(elastic.positions) == pytest.approx(expected, abs=1e-3)
        assert length(body.nodes) == pytest.approx(expected, abs=1e-3)


def test_a_muscle_contracts_as_its_activation_says(elastic, world_and_body):
    world, body = world_and_body
    tets = len(body.plastic_strains)
    for one, step in [(elastic, elastic.step), (body, world.step)]:
        muscle = one.add_muscle(tets=np.ones(tets, bool), fibres=(1, 0, 0), stress=3e5)
        assert muscle.activation == 0
        muscle.activation = 0.5
        assert muscle.activation == 0.5
        for _ in range(240):
            step(1 / 60)
        w = 2 * 0.15 / (1 + np.sqrt(1 + 8 * 0.3 * 0.15))
        nodes = one.positions if one is elastic else one.nodes
        assert length(nodes) == pytest.approx(1 / (1 + w), abs=2e-3)
        own = one.add_muscle(tets=[3, 5], fibres=np.eye(3)[:2], stress=1e5)
        own.activation = 1
        with pytest.raises(ts.Error, match="0 to 1"):
            own.activation = 2


def test_fibres_make_a_bar_stiffer_and_muscles_know_their_length(elastic):
    tets = np.arange(160)
    elastic.add_fibres(tets, (1, 0, 0), stiffness=9e6)
    muscle = elastic.add_muscle(tets, (1, 0, 0), stress=1e6, length_factors=[(0.8, 0), (1, 1)])
    muscle.activation = 1
    elastic.set_damping_scale(np.full(160, 2.0))
    for _ in range(240):
        elastic.step(1 / 60)
    assert length(elastic.positions) == pytest.approx(1 - 0.2 / 3, abs=6e-3)  # 1e7 (1 - s) = 1e6 (s - 0.8) / 0.2


def test_a_law_stiffens_and_a_fit_finds_it(elastic, world_and_body):
    stretched = np.array(elastic.positions) * (2, 0.5 ** 0.5, 0.5 ** 0.5)
    elastic.positions = stretched
    linear = elastic.energy
    elastic.set_elastic_law("yeoh", c2=0.5, c3=0.5)
    elastic.positions = stretched
    k = 2.0  # 4 + 2 / 2 - 3
    # The volume stays: mu / 2 (K + c2 K^2 + c3 K^3) in 0.0625 m^3.
    assert elastic.energy == pytest.approx(0.0625 * 1e6 / 2.6 / 2 * (k + 0.5 * k**2 + 0.5 * k**3), rel=1e-5)
    elastic.set_elastic_law("corotated", tets=np.ones(160, bool))
    elastic.set_elastic_law("neo-hookean", tets=[])
    elastic.positions = stretched
    assert elastic.energy == pytest.approx(linear, rel=1e-6)
    world, body = world_and_body
    body.set_elastic_law("neo-hookean", tets=[0, 1])
    world.step(1 / 60)
    stretches = np.array([1.2, 1.5, 2, 2.5])
    yeoh = (stretches - stretches**-2) * (1 + 0.2 * (stretches**2 + 2 / stretches - 3)) * 1e5
    fit = ts.fit_elastic_law("yeoh", np.column_stack([stretches, yeoh]))
    assert fit["youngs_modulus"] == pytest.approx(3e5) and fit["c2"] == pytest.approx(0.1) and fit["error"] < 1e-6
    assert ts.fit_elastic_law("neo-hookean", np.column_stack([stretches, yeoh]), loading="uniaxial")["error"] > 0.05


def test_fibres_follow_a_curve(elastic):
    cage = cage_of_box()
    fibres = ts.fibres_along(cage, np.ones(160, bool), [(0, 0.1, 0.1), (1, 0.1, 0.1)])
    assert fibres.shape == (160, 3) and np.allclose(fibres, (1, 0, 0))
    elastic.add_muscle(tets=[4, 9], fibres=ts.fibres_along(cage, [4, 9], [(0, 0, 0), (0, 1, 0)]), stress=1e4)
    with pytest.raises(ts.Error, match="two points"):
        ts.fibres_along(cage, [0], [(0, 0, 0)])


def test_what_yields_keeps_its_strain(elastic):
    elastic.set_plasticity(yield_stress=2e4, hardening=0.0, flow_rate=None, largest=0.5)
    ends = [np.flatnonzero(np.isclose(elastic.positions[:, 0], x)) for x in (0, 1)]
    for end in ends:
        elastic.set_pinned(end)
    velocities = np.zeros((elastic.node_count, 3))
    velocities[ends[1], 0] = 0.2
    elastic.velocities = velocities
    for _ in range(60):
        elastic.step(1 / 60)
    elastic.set_pinned(ends[1], False)
    for _ in range(240):
        elastic.step(1 / 60)
    assert 1.12 < length(elastic.positions) < 1.19
    strains = elastic.plastic_strains
    assert strains.shape == (160,) and strains.dtype == np.float64 and strains.max() > 0.1
    elastic.reset_plastic_flow()
    for _ in range(240):
        elastic.step(1 / 60)
    assert length(elastic.positions) == pytest.approx(1, abs=5e-3)
    elastic.set_plasticity(None)


def test_yield_stresses_by_tet(world_and_body):
    _, body = world_and_body
    body.set_plasticity(np.full(160, 1e4), hardening=1e5, flow_rate=3, largest=0.2)
    with pytest.raises(ts.Error, match="12 values for 160 tets"):
        body.set_plasticity(np.full(12, 1e4))


@pytest.mark.parametrize("call, part", [
    (lambda b: b.set_plasticity(0), "yield stress"),
    (lambda b: b.set_plasticity(1, hardening=-1), "hardening"),
    (lambda b: b.set_plasticity(1, flow_rate=0), "rate of flow"),
    (lambda b: b.set_plasticity(1, largest=-1), "largest"),
    (lambda b: b.set_growth(0), "0.05 to 20"),
    (lambda b: b.set_growth(np.ones(7)), "7 values for 160 tets"),
    (lambda b: b.set_growth(np.ones((160, 2))), "matrices"),
    (lambda b: b.set_growth(np.tile([[1, 1, 0], [0, 1, 0], [0, 0, 1]], (160, 1, 1)).astype(float)), "symmetric"),
    (lambda b: b.add_muscle(tets=[], fibres=(1, 0, 0)), "at least one tet"),
    (lambda b: b.add_muscle([0], (1, 0, 0), length_factors=[(1, 1), (1, 0)]), "lengthFactors"),
    (lambda b: b.set_elastic_law("yeoh", c2=-1), "at least 0.05"),
    (lambda b: b.set_elastic_law("neo-hookean", c2=1), "only Yeoh"),
    (lambda b: b.set_elastic_law("yeoh", tets=[1, 1]), "twice"),
    (lambda b: b.add_fibres([0], (1, 0, 0), stiffness=0), "stiffness of fibres"),
    (lambda b: b.add_fibres([0], (0, 0, 0), stiffness=1), "longer than 0"),
    (lambda b: b.set_damping_scale(np.full(160, -1.0)), "0 or more"),
    (lambda b: b.set_damping_scale(np.ones(3)), "3"),
    (lambda b: b.add_muscle(tets=[0, 0], fibres=(1, 0, 0)), "twice"),
    (lambda b: b.add_muscle(tets=[0], fibres=(0, 0, 0)), "fibre 0"),
    (lambda b: b.add_muscle(tets=[0], fibres=np.ones((2, 3))), "2 values for 1 tets"),
    (lambda b: b.add_muscle(tets=[0], fibres=(1, 0, 0), stress=0), "stress"),
])  # yapf: disable
def test_bad_values_are_refused(elastic, world_and_body, call, part):
    for body in (elastic, world_and_body[1]):
        with pytest.raises((ts.Error, ValueError), match=part):
            call(body)


def test_a_snapshot_holds_them(world_and_body):
    world, body = world_and_body
    muscle = body.add_muscle(tets=np.arange(80), fibres=(1, 0, 0), stress=2e5)
    body.set_plasticity(3e3)
    muscle.activation = 0.6
    for _ in range(10):
        world.step(1 / 60)
    saved = world.save()
    body.set_growth(1.05)
    ends = []
    for _ in range(2):
        for _ in range(10):
            world.step(1 / 60)
        ends.append(body.nodes.copy())
        world.restore(saved)
        assert muscle.activation == 0.6
        body.set_growth(1.05)
        muscle.activation = 0.6
    assert (ends[0] == ends[1]).all()
