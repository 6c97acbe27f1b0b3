#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""stability_map.py STRESS.json MAP.png: draws the stability maps of tetskin_measure --json: stiffness against time step,
one cell a run, coloured by how large the body became, crossed out where it exploded. Bullet's force is in MAP.png, with
both integrators; tetskin's is in MAP_tetskin.png, with a ring where Bullet's explodes with both. One of them may be
missing in STRESS.json."""
import json
import math
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.colors import LogNorm

LARGEST = 1000.0  # times its size; colours end there


def draw(axes, cells):
    steps = sorted({cell["time_step"] for cell in cells})
    stiffnesses = sorted({cell["stiffness"] for cell in cells})
    extents = [[math.nan] * len(steps) for _ in stiffnesses]
    for cell in cells:
        column, row = steps.index(cell["time_step"]), stiffnesses.index(cell["stiffness"])
        extents[row][column] = min(cell["extent_max"], LARGEST) if cell["simulation_finite"] else LARGEST
        if not cell["simulation_bounded"]:
            axes.text(column, row, "×", ha="center", va="center", fontsize=13)
        elif cell["bullet_cannot_tetskin_can"]:
            axes.text(column, row, "○", ha="center", va="center", fontsize=10)
    image = axes.imshow(extents, origin="lower", aspect="auto", cmap="YlOrRd", norm=LogNorm(1.0, LARGEST))
    axes.set_xticks(range(len(steps)), [f"1/{round(1.0 / step)}" for step in steps])
    axes.set_yticks(range(len(stiffnesses)), [f"$10^{round(math.log10(value))}$" for value in stiffnesses])
    axes.set_xticks([k - 0.5 for k in range(1, len(steps))], minor=True)
    axes.set_yticks([k - 0.5 for k in range(1, len(stiffnesses))], minor=True)
    axes.grid(which="minor", color="white")
    axes.tick_params(which="minor", length=0)
    axes.set_xlabel("time step, s")
    return image


def draw_bullets(cells, path):
    figure, both = plt.subplots(1, 2, figsize=(9.5, 3.8), sharey=True, layout="constrained")
    for axes, implicit in zip(both, (False, True)):
        image = draw(axes, [cell for cell in cells if (cell["whose"] == "implicit") == implicit])
        axes.set_title("implicit: one Newton step" if implicit else "explicit, implicit damping")
    both[0].set_ylabel("Young's modulus, Pa")
    bar = figure.colorbar(image, ax=both, extend="max")
    bar.set_label("largest extent, relative to the body's size; × exploded")
    figure.savefig(path, dpi=110)


def draw_ours(cells, path):
    figure, axes = plt.subplots(figsize=(6.2, 4.4), layout="constrained")
    image = draw(axes, cells)
    axes.set_title("tetskin's elasticity and solver")
    axes.set_ylabel("Young's modulus, Pa")
    bar = figure.colorbar(image, ax=axes, extend="max")
    bar.set_label("largest extent, relative to the body's size; × exploded\n○ Bullet's elasticity explodes, explicit and implicit (run to $10^7$ Pa)")
    figure.savefig(path, dpi=110)


def cell_of(scene):
    """A cell of the map, map/WHOSE/E=STIFFNESS/dt=1/RATE."""
    _, whose, stiffness, _, rate = scene["scene"].split("/")
    figures = {figure["name"]: figure["value"] for figure in scene["figures"]}
    return {"whose": whose, "stiffness": float(stiffness.removeprefix("E=")), "time_step": 1 / float(rate),
            "extent_max": figures["largest extent"], "simulation_finite": figures["finite"] == 1,
            "simulation_bounded": figures["bounded"] == 1}


def mark_gains(cells):
    """Says of each cell of tetskin's whether Bullet's force explodes there with both integrators."""
    bullets = {}
    for cell in cells:
        if cell["whose"] != "tetskin":
            bullets.setdefault((cell["stiffness"], cell["time_step"]), []).append(cell["simulation_bounded"])
    for cell in cells:
        there = bullets.get((cell["stiffness"], cell["time_step"]), [])
        cell["bullet_cannot_tetskin_can"] = cell["whose"] == "tetskin" and there and not any(there)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        cells = [cell_of(scene) for scene in json.load(file) if scene["scene"].startswith("map/")]
    if not cells:
        sys.exit(f"{sys.argv[1]}: has no stability map; make it with tetskin_measure --only map/ --elasticity both --json")
    mark_gains(cells)
    bullets = [cell for cell in cells if cell["whose"] != "tetskin"]
    ours = [cell for cell in cells if cell["whose"] == "tetskin"]
    name, extension = os.path.splitext(sys.argv[2])
    if bullets:
        draw_bullets(bullets, sys.argv[2])
    if ours:
        draw_ours(ours, f"{name}_tetskin{extension}")


if __name__ == "__main__":
    main()
