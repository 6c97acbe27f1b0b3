# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Detailed soft bodies in real time: a fine surface follows a coarse cage of tets, which Bullet simulates.

    import tetskin as ts
    mesh = ts.load_mesh("dragon.obj")
    cage = ts.create_cage(mesh, target_tets=1000)
    world = ts.World()
    world.add_plane()
    body = world.add_body(cage, mesh, position=(0, 2, 0))
    for frame in range(240):
        world.step(1/60, substeps=4)
    body.positions  # (vertices, 3) float32, a read-only view
"""
from ._core import (AppliedForces, Body, BonePalette, Cage, Contacts, ElasticBody, ElasticMuscle, Error, GlbWriter, Hit,
                    ImpulseResult, Joint, Muscle, Recorder, Replay, RigidBody, Shape, Skin, Spring, StatusCode,
                    SurfacePoint, TriangleMesh, Weld, World, Wrench, __version__, calibrate, create_cage, fibres_along,
                    fit_elastic_law, load_cage, load_mesh, load_vertex_map, paint_cage, refine_quadratic, spread_map)
from .page import Film

__all__ = ["AppliedForces", "Body", "BonePalette", "Cage", "Contacts", "ElasticBody", "ElasticMuscle", "Error", "Film",
           "GlbWriter", "Hit", "ImpulseResult", "Joint", "Muscle", "Recorder", "Replay", "RigidBody", "Shape", "Skin",
           "Spring", "StatusCode", "SurfacePoint", "TriangleMesh", "Weld", "World", "Wrench", "__version__",
           "calibrate", "create_cage", "fibres_along", "fit_elastic_law", "load_cage", "load_mesh", "load_vertex_map",
           "paint_cage", "refine_quadratic", "spread_map"]
