# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
# %% [markdown]
# # Two fingers lift a soft ball
# The fingers are rigid, on sliders with motors: the left one holds its place, the right one closes with a limited
# force. A third slider lifts both. The ball, 8 cm and 200 g, is held by friction alone. Metres, kilograms, newtons.

# %%
import argparse
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import tetskin as ts

parser = argparse.ArgumentParser(description="Two fingers close on a soft ball, and lift it.")
parser.add_argument("--output", type=Path, default=Path("out/gripper"), help="folder for what is written")
parser.add_argument("--quick", action="store_true", help="a coarser ball")
options = parser.parse_args()
options.output.mkdir(parents=True, exist_ok=True)
RADIUS, MASS, GRAVITY = 0.04, 0.2, 9.81


# %%
def ball(radius: float, rings: int) -> ts.TriangleMesh:
    """A ball, by a cube of which each face is a grid."""
    steps = np.tan(np.linspace(-np.pi / 4, np.pi / 4, rings + 1))
    x, y = np.meshgrid(steps, steps, indexing="ij")
    i, j = np.meshgrid(np.arange(rings), np.arange(rings), indexing="ij")
    a, b = (i * (rings + 1) + j).ravel(), ((i + 1) * (rings + 1) + j).ravel()
    face = np.concatenate([np.stack([a, b, b + 1], -1), np.stack([a, b + 1, a + 1], -1)])
    positions: list[np.ndarray] = []
    triangles: list[np.ndarray] = []
    for axis in range(3):
        for sign in (1, -1):
            side = np.stack([x * sign, y, np.full_like(x, sign)], -1).reshape(-1, 3)
            triangles.append(face + len(positions) * len(side))
            positions.append(np.roll(side, axis, axis=1))
    points = np.concatenate(positions)
    return ts.TriangleMesh(radius * points / np.linalg.norm(points, axis=1)[:, None], np.concatenate(triangles))


mesh = ball(RADIUS, 12 if options.quick else 40)
cage = ts.create_cage(mesh, target_tets=150 if options.quick else 400)
world = ts.World(gravity=(0, -GRAVITY, 0))
world.add_plane()
body = world.add_body(cage, mesh, position=(0, RADIUS, 0), mass=MASS, youngs_modulus=3e4, friction=1)
print(f"a ball of {mesh.vertex_count} vertices in {cage.tet_count} tets")

# %% [markdown]
# ## The gripper
# Coordinates of sliders are measured from where they were made: 0 is open.

# %%
carriage = world.add_box((0.075, 0.01, 0.02), mass=1, position=(0, 0.17, 0))
lift = world.add_slider(carriage, axis=(0, 1, 0))
fingers, slides = [], []
for side in (-1, 1):
    finger = world.add_box((0.006, 0.06, 0.02), mass=0.2, position=(side * (RADIUS + 0.012), 0.07, 0), friction=1)
    fingers.append(finger)
    slides.append(world.add_slider(finger, carriage, axis=(-side, 0, 0)))
CLOSED = 0.012  # where the left finger stays: 6 mm into the ball, were it hard
GRIP = 4.0  # newtons, the most that the right finger's motor has
STEPS = {"close": 0.3, "lift": 1.0, "hold": 2.0, "end": 3.0}

film = ts.Film(world, title="Two fingers lift a soft ball")
film.add_frame()
rows = []
for frame in range(1, int(60 * STEPS["end"]) + 1):
    now = frame / 60
    closing = now > STEPS["close"]
    slides[0].set_motor(np.clip(20 * (CLOSED - slides[0].coordinate), -0.05, 0.05) if closing else 0, 100)
    slides[1].set_motor(0.05 if closing else 0, GRIP)
    lift.set_motor(0.08 if STEPS["lift"] < now < STEPS["hold"] else 0, 200)
    world.step(1 / 60, substeps=8)
    film.add_frame()
    forces = [world.forces_on(finger, body) for finger in fingers]
    rows.append([now, body.positions[:, 1].min()] + [f.total.force[0] for f in forces]
                + [f.total.force[1] for f in forces])
now, height, left, right, left_up, right_up = np.transpose(rows)

# %%
film.save(options.output / "gripper.html")
print(f"{options.output / 'gripper.html'}: {(options.output / 'gripper.html').stat().st_size / 1e6:.1f} MB")
#: film.show()

# %% [markdown]
# ## The forces
# Of the ball on each finger: across, the grip; and down, what friction carries. In the air, both fingers together carry
# the ball's weight.

# %%
figure, (grip, carried) = plt.subplots(2, 1, figsize=(6, 4.5), sharex=True, layout="constrained")
grip.plot(now, -left, label="left finger")
grip.plot(now, right, "--", label="right finger")
grip.set(ylabel="grip (N)", title="Forces of the ball on the fingers")
carried.plot(now, -left_up, label="left finger")
carried.plot(now, -right_up, "--", label="right finger")
carried.plot(now, -left_up - right_up, color="black", label="both")
carried.axhline(MASS * GRAVITY, color="black", linewidth=1, linestyle=":", label="weight of the ball")
carried.set(xlabel="time (s)", ylabel="carried (N)")
for axes in (grip, carried):
    axes.legend(frameon=False, fontsize=8)
figure.savefig(options.output / "forces.png", dpi=100)

# %% [markdown]
# ## Check
# In the last half second, at rest in the air: the fingers carry the weight, and grip with the motor's largest force.

# %%
held = now > STEPS["end"] - 0.5
weight, carry = MASS * GRAVITY, -(left_up + right_up)[held].mean()
grips = -left[held].mean(), right[held].mean()
print(f"lifted by {1000 * height[-1]:.0f} mm; grips {grips[0]:.2f} N and {grips[1]:.2f} N")
print(f"the fingers carry {carry:.3f} N of a weight of {weight:.3f} N")
if height[-1] < 0.05:
    sys.exit("gripper.py: the ball was not lifted")
if abs(carry - weight) > 0.02 * weight or max(abs(grip - GRIP) for grip in grips) > 0.02 * GRIP:
    sys.exit("gripper.py: the forces are not in balance")
