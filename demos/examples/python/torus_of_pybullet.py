#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
# %% [markdown]
# # pybullet's torus with a fine surface
#
# The mesh is from pybullet's data, with each triangle divided into 16. pybullet loads the cage that tetskin has made
# from it as a soft body, and simulates it alone; tetskin's skin follows.

# %%
import argparse
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pybullet as p
import pybullet_data
import trimesh

import tetskin as ts
import tetskin.pybullet

STEP = 1 / 240
MATERIAL: dict[str, Any] = dict(mass=3, useNeoHookean=1, NeoHookeanMu=400, NeoHookeanLambda=600, NeoHookeanDamping=0.02,
                                collisionMargin=0.006, useSelfCollision=0, frictionCoeff=0.5)


# %%
def fine_torus(iterations: int) -> Any:
    path = Path(pybullet_data.getDataPath()) / "torus" / "torus_textured.obj"
    coarse: Any = trimesh.load(path, force="mesh", process=False)
    coarse = trimesh.Trimesh(coarse.vertices, coarse.faces, process=False)
    coarse.merge_vertices(merge_tex=True, merge_norm=True)
    return coarse.subdivide_loop(iterations=iterations)


def difference_of(skin: tetskin.pybullet.Skin, cage: ts.Cage, mesh: Any) -> float:
    """The largest difference between the skin and each vertex's tet, found by trying all tets: of a sample."""
    sample = np.random.default_rng(1).choice(len(mesh.vertices), 500, replace=False)
    rest, tets = np.asarray(cage.nodes), np.asarray(cage.tets)
    edges = np.linalg.inv(np.stack([rest[tets[:, k]] - rest[tets[:, 3]] for k in range(3)], -1))
    offsets = mesh.vertices[sample][None] - rest[tets[:, 3]][:, None]
    weights = np.einsum("tij,tvj->tvi", edges, offsets)
    weights = np.concatenate([weights, 1 - weights.sum(-1, keepdims=True)], -1)
    tet = weights.min(-1).argmax(0)
    expected = np.einsum("vk,vkj->vj", weights[tet, np.arange(len(sample))], skin.nodes[tets[tet]])
    return float(np.abs(expected - skin.positions[sample]).max())


# %%
def run(output: Path | None = None, seconds: float = 3.0, quick: bool = False) -> dict[str, Any]:
    """Drops the torus. Returns its measurements. output: a folder for the surface at the end, or None. quick: a coarser
    surface, and a shorter run."""
    mesh = fine_torus(1 if quick else 2)
    seconds = min(seconds, 1.5) if quick else seconds
    cage = ts.create_cage(mesh, target_tets=500)
    client = p.connect(p.DIRECT)
    try:
        p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD, physicsClientId=client)
        p.setAdditionalSearchPath(pybullet_data.getDataPath(), physicsClientId=client)
        p.setGravity(0, 0, -10, physicsClientId=client)
        p.setTimeStep(STEP, physicsClientId=client)
        p.loadURDF("plane.urdf", physicsClientId=client)
        _, skin = tetskin.pybullet.load_soft_body(cage, mesh, client=client, normals="recomputed",
                                                  basePosition=(0, 0, 1.5),
                                                  baseOrientation=p.getQuaternionFromEuler((1.2, 0, 0)), **MATERIAL)
        lowest: list[float] = []
        stepping = skinning = 0.0
        for _ in range(round(seconds / STEP)):
            start = time.perf_counter()
            p.stepSimulation(physicsClientId=client)
            middle = time.perf_counter()
            skin.update()
            stepping, skinning = stepping + middle - start, skinning + time.perf_counter() - middle
            lowest.append(float(skin.positions[:, 2].min()))
        if output:
            output.mkdir(parents=True, exist_ok=True)
            trimesh.Trimesh(skin.positions, mesh.faces, process=False).export(output / "torus.obj")
        return {"vertices": len(mesh.vertices), "nodes": len(cage.nodes), "lowest": lowest,
                "difference": difference_of(skin, cage, mesh), "step": stepping / len(lowest),
                "update": skinning / len(lowest), "height": float(np.ptp(skin.positions[:, 2])),
                "positions": skin.positions.copy(), "triangles": np.asarray(mesh.faces)}
    finally:
        p.disconnect(client)


# %%
def report(measured: dict[str, Any]) -> None:
    print(f"{measured['vertices']} vertices on {measured['nodes']} nodes of pybullet's")
    print(f"lowest point: {measured['lowest'][0]:.3f} m at first, {measured['lowest'][-1]:.4f} m at last; "
          f"{measured['height']:.3f} m high")
    print(f"largest difference from the tets of its vertices: {measured['difference']:.1e} m")
    print(f"{1e3 * measured['step']:.2f} ms per step of pybullet's, {1e3 * measured['update']:.2f} ms per update")


def draw(measured: dict[str, Any], path: Path) -> None:
    """The surface at the end, and its lowest point over time."""
    figure = plt.figure(figsize=(8, 3.2), layout="constrained")
    surface: Any = figure.add_subplot(1, 2, 1, projection="3d")
    x, y, z = measured["positions"].T
    surface.plot_trisurf(x, y, z, triangles=measured["triangles"], color="#1a7045", linewidth=0)
    surface.set(box_aspect=(np.ptp(x), np.ptp(y), np.ptp(z)), title=f"{len(x)} vertices")
    surface.set_axis_off()
    heights = figure.add_subplot(1, 2, 2)
    heights.plot(STEP * np.arange(1, len(measured["lowest"]) + 1), measured["lowest"])
    heights.set(xlabel="time (s)", ylabel="lowest point (m)")
    figure.savefig(path, dpi=100)


def faults(measured: dict[str, Any]) -> Iterator[str]:
    """The faults of a drop."""
    if measured["vertices"] < 2000:
        yield "the surface is not fine"
    if not -0.02 < measured["lowest"][-1] < 0.05 or not measured["lowest"][0] > 0.5:
        yield "the torus has not fallen on the ground"
    if not np.all(np.abs(np.diff(measured["lowest"][-24:])) < 0.02):
        yield "the torus does not come to rest"
    if measured["difference"] > 1e-5:
        yield "the skin does not follow pybullet's nodes"


# %%
def main() -> None:
    parser = argparse.ArgumentParser(description="A soft body of pybullet's own, with a fine surface.")
    parser.add_argument("--output", type=Path, default=Path("out/torus_of_pybullet"), help="folder for the surface")
    parser.add_argument("--seconds", type=float, default=3.0)
    parser.add_argument("--quick", action="store_true", help="a coarser surface, and a shorter run")
    arguments = parser.parse_args()
    measured = run(arguments.output, arguments.seconds, arguments.quick)
    report(measured)
    draw(measured, arguments.output / "torus.png")
    wrong = list(faults(measured))
    if wrong:
        sys.exit("torus_of_pybullet.py: " + "; ".join(wrong))
    print(f"landed; its surface is {arguments.output / 'torus.obj'}")


# %%
if __name__ == "__main__":
    main()
