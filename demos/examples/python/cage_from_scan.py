# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
# %% [markdown]
# # A cage from a scan
# Scans are noisy, have holes, come in pieces that reach into each other, and some edges have three triangles. No repair
# is needed: the cage asks what is inside, not whether the surface is closed.

# %%
import argparse
import sys
import time
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import tetskin as ts

parser = argparse.ArgumentParser(description="Makes a mesh like those of scanners, a cage of it, and drops it.")
parser.add_argument("--output", type=Path, default=Path("out/cage_from_scan"), help="folder for what is written")
parser.add_argument("--quick", action="store_true", help="a coarser mesh and cage, and a shorter run")
options = parser.parse_args()
options.output.mkdir(parents=True, exist_ok=True)
random = np.random.default_rng(7)


# %% [markdown]
# ## The scan
# A jug: a bulging body and a handle that reaches into it, both with noise; then holes, a fin on an edge, and specks of
# dust.

# %%
def grid(rows: int, columns: int) -> np.ndarray:
    """Triangles between rings of vertices, open at both ends."""
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns), indexing="ij")
    a, b = i * columns + j, (i + 1) * columns + j
    c, d = (i + 1) * columns + (j + 1) % columns, i * columns + (j + 1) % columns
    return np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])


def scan(fineness: int) -> tuple[np.ndarray, np.ndarray]:
    rows, columns = 3 * fineness, 4 * fineness
    u, v = np.meshgrid(np.linspace(0.02, np.pi - 0.02, rows), np.arange(columns) * 2 * np.pi / columns, indexing="ij")
    bulge = 1 + 0.25 * np.sin(2 * u) + 0.04 * np.cos(6 * v) * np.sin(u)
    body = np.stack([bulge * np.sin(u) * np.cos(v), -1.2 * np.cos(u), -bulge * np.sin(u) * np.sin(v)], -1)
    s, t = np.meshgrid(np.linspace(-1.9, 1.9, 2 * fineness), np.arange(fineness) * 2 * np.pi / fineness, indexing="ij")
    away = 0.7 + 0.16 * np.cos(t)
    handle = np.stack([0.8 + away * np.cos(s), 0.1 + away * np.sin(s), -0.16 * np.sin(t)], -1)
    pieces = [(body.reshape(-1, 3), grid(rows, columns)), (handle.reshape(-1, 3), grid(2 * fineness, fineness))]
    for _ in range(5):  # specks of dust
        corner = random.normal(size=3)
        speck = 1.25 * corner / np.linalg.norm(corner) + 0.02 * random.normal(size=(4, 3))
        pieces.append((speck, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])))
    first = np.cumsum([0] + [len(points) for points, _ in pieces])
    points = np.concatenate([points for points, _ in pieces])
    triangles = np.concatenate([part + start for (_, part), start in zip(pieces, first)])
    points += 0.004 * random.normal(size=points.shape)
    middles = points[triangles].mean(1)
    holes = middles[random.integers(first[1], size=6)]
    far = np.linalg.norm(middles[:, None] - holes, axis=2).min(1) > 0.12
    triangles = triangles[far | (np.arange(len(triangles)) > len(triangles) - 20)]
    fin = np.append(triangles[len(triangles) // 3][:2], len(points))
    return np.vstack([points, points[fin[:2]].mean(0) * 1.1]), np.vstack([triangles, fin])


positions, triangles = scan(16 if options.quick else 60)
mesh = ts.TriangleMesh(positions, triangles)
edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
uses = np.unique(edges, axis=0, return_counts=True)[1]
print(f"{mesh.vertex_count} vertices, {mesh.triangle_count} triangles, {(uses == 1).sum()} edges of holes, "
      f"{(uses > 2).sum()} edges of three triangles")

# %% [markdown]
# ## The cage
# `progress=True` prints a bar, and the interrupt button cancels. The report says how well the cage fits; calibration
# makes it as compliant as the real body.

# %%
begin = time.perf_counter()
cage = ts.create_cage(mesh, target_tets=500 if options.quick else 1500, progress=True)
made = time.perf_counter()
calibrated = ts.calibrate(cage, progress=True)
print(f"cage {made - begin:.1f} s, calibration {time.perf_counter() - made:.1f} s")
print(calibrated.report)
mesh_error = np.abs(ts.Skin(cage, mesh).update(cage.nodes) - mesh.positions)[np.unique(triangles)].max()
print(f"at rest, the skin is the scan to {mesh_error:.1e}")

# %%
figure, axes = plt.subplots(figsize=(6, 3), layout="constrained")
axes.hist(calibrated.stiffness_factor, bins=40)
axes.set(xlabel="stiffness factor", ylabel="tets", title="By how much calibration softens the tets")
figure.savefig(options.output / "stiffness.png", dpi=100)

# %% [markdown]
# ## The run

# %%
world = ts.World()
world.add_plane()
body = world.add_body(calibrated, mesh, position=(0, 2, 0), relative_stiffness=100)
film = ts.Film(world, title="A scan falls")
for frame in range(45 if options.quick else 180):
    film.add_frame()
    world.step(1 / 60, substeps=4)
film.save(options.output / "cage_from_scan.html")
cage.save(options.output / "cage.vtk")
print(f"{options.output / 'cage_from_scan.html'}: "
      f"{(options.output / 'cage_from_scan.html').stat().st_size / 1e6:.1f} MB")
#: film.show()

# %% [markdown]
# ## Check
# The cage carries every vertex, and the scan lies on the ground by its surface.

# %%
lowest = body.positions[:, 1].min()
print(f"lowest vertex: {lowest:.4f}")
if mesh_error > 1e-5:
    sys.exit("cage_from_scan.py: the cage does not carry the scan")
if not (np.isfinite(body.positions).all() and abs(lowest) < 0.05):
    sys.exit("cage_from_scan.py: the scan does not lie on the ground")
