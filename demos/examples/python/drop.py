# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
# %% [markdown]
# # A knot falls
# Bullet simulates a coarse cage of tets; the fine surface follows it, touches the ground and the bar where it is drawn,
# and is played by a page that needs no network.

# %%
import argparse
import sys
import time
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import tetskin as ts

parser = argparse.ArgumentParser(description="A knot falls onto a bar and the ground.")
parser.add_argument("--output", type=Path, default=Path("out/drop"), help="folder for what is written")
parser.add_argument("--quick", action="store_true", help="a coarser surface, and a shorter run")
options = parser.parse_args()
options.output.mkdir(parents=True, exist_ok=True)

# %% [markdown]
# ## The mesh
# A tube along a trefoil knot, as arrays of positions and triangles.


# %%
def knot(along: int, around: int, radius: float = 0.42) -> ts.TriangleMesh:
    """A closed tube with so many vertices along it and around it."""
    u = np.arange(along) * 2 * np.pi / along
    centre = np.stack([np.sin(u) + 2 * np.sin(2 * u), -np.sin(3 * u), np.cos(u) - 2 * np.cos(2 * u)], -1)
    tangent = np.roll(centre, -1, 0) - np.roll(centre, 1, 0)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    side = np.cross(tangent, [0.0, 1.0, 0.0])
    side /= np.linalg.norm(side, axis=1)[:, None]
    up = np.cross(side, tangent)
    v = np.arange(around) * 2 * np.pi / around
    ring = np.cos(v)[None, :, None] * side[:, None] + np.sin(v)[None, :, None] * up[:, None]
    positions = (centre[:, None] + radius * ring).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(along), np.arange(around), indexing="ij")
    a, b = i * around + j, (i + 1) % along * around + j
    c, d = (i + 1) % along * around + (j + 1) % around, i * around + (j + 1) % around
    triangles = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return ts.TriangleMesh(positions, triangles)


mesh = knot(200, 20) if options.quick else knot(800, 40)
begin = time.perf_counter()
cage = ts.create_cage(mesh, target_tets=600 if options.quick else 1500)
print(f"{mesh.vertex_count} vertices, in a cage of {cage.tet_count} tets made in {time.perf_counter() - begin:.1f} s")

# %% [markdown]
# ## The run
# What falls, what it falls on, and a film of it.

# %%
world = ts.World()
world.add_plane()
world.add_rigid_body(ts.Shape.cylinder(0.5, 8), position=(0, 0.5, 0), rotation=(0, np.sqrt(0.5), np.sqrt(0.5), 0))
body = world.add_body(cage, mesh, position=(0, 4, 0), relative_stiffness=100, self_contact=True)
film = ts.Film(world, title="A knot falls")
film.add_frame()
heights, seconds = [], 0.0
for frame in range(60 if options.quick else 240):
    begin = time.perf_counter()
    world.step(1 / 60, substeps=4)
    seconds += time.perf_counter() - begin
    film.add_frame()
    heights.append((body.positions[:, 1].min(), body.positions[:, 1].max()))
each = 1000 * seconds / (len(film) - 1)
print(f"{len(film) - 1} frames in {seconds:.1f} s: {each:.1f} ms each, contact and skin included")

# %%
film.save(options.output / "drop.html")
print(f"{options.output / 'drop.html'}: {(options.output / 'drop.html').stat().st_size / 1e6:.1f} MB")
#: film.show()

# %%
figure, axes = plt.subplots(figsize=(6, 3), layout="constrained")
times = np.arange(1, len(film)) / 60
axes.fill_between(times, *np.transpose(heights), alpha=0.4, label="from the lowest vertex to the highest")
axes.axhline(0, color="black", linewidth=1)
axes.set(xlabel="time (s)", ylabel="height", title="A knot falls onto a bar and the ground")
axes.legend(frameon=False)
figure.savefig(options.output / "height.png", dpi=100)

# %% [markdown]
# ## Check
# No vertex is deeper in the ground than a hundredth of the knot's height; and it has fallen.

# %%
lowest, highest = np.min(heights, axis=0)[0], heights[-1][1]
print(f"lowest vertex of all frames: {lowest:.4f}; highest one at the end: {highest:.2f}")
if not (-0.03 < lowest < 0.5 and highest < 5):
    sys.exit("drop.py: the knot does not lie on the ground")
