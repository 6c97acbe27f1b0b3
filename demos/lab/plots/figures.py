#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Draws the figures of demos/README.md: demos/lab/figures/NAME.csv becomes NAME.png beside it, or in the folder given.

figures.py [FOLDER]

Each picture has a hash of the table that it was drawn from, by which a test (style.figures) finds pictures that are out
of date. Needs python3-matplotlib (which brings Pillow).
"""
import csv
import hashlib
import io
import math
import sys
from pathlib import Path

from PIL import Image
from PIL.PngImagePlugin import PngInfo

sys.dont_write_bytecode = True  # leaves nothing in the repository
from look import BLUE, DPI, GREEN, GREY, ORANGE, PINK, SKY, plt  # noqa: E402
from solvers import draw_table  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "peers"))
import draw as peers  # noqa: E402

TABLES = Path(__file__).resolve().parents[1] / "figures"
GRID = {"color": "#dddddd", "linewidth": 0.6}
OURS = {"color": BLUE, "marker": "o"}
BULLET = {"color": GREY, "marker": "x"}


def rows_of(name):
    with open(TABLES / f"{name}.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def tets_axis(axes, ticks):
    axes.set_xscale("log")
    axes.set_xticks(ticks, [f"{tick:,.0f}" for tick in ticks])
    axes.minorticks_off()
    axes.set_xlabel("tets")


def plain_ticks(axis, ticks):
    axis.set_ticks(ticks, [f"{tick:,g}" for tick in ticks])
    axis.set_ticks([], minor=True)


def legend_below(figure, axes, columns):
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=columns, frameon=False,
                  fontsize=9)


def cage_kinds(rows):
    looks = {"bare": (GREY, "x"), "calibrated only": (SKY, "^"), "duplicate elements only": (GREEN, "D"),
             "volume fractions only": (PINK, "v"), "all three": (BLUE, "o")}
    models = list(dict.fromkeys(row["model"] for row in rows))
    figure, panels = plt.subplots(1, len(models), figsize=(9, 3.8), sharey=True, layout="constrained")
    for axes, model in zip(panels, models):
        own = [row for row in rows if row["model"] == model]
        tets = [float(row["tets"]) for row in own]
        for kind, (colour, marker) in looks.items():
            axes.plot(tets, [float(row[kind]) for row in own], color=colour, marker=marker, markersize=5, label=kind,
                      linewidth=2 if kind == "all three" else 1.2)
        axes.set_yscale("log")
        plain_ticks(axes.yaxis, [0.001, 0.002, 0.005, 0.01, 0.02, 0.05])
        axes.set_ylim(0.001, 0.05)
        tets_axis(axes, tets)
        axes.set_title(model, fontsize=11, loc="left")
        axes.grid(True, **GRID)
    panels[0].set_ylabel("error in a sag, RMS, box diagonals")
    legend_below(figure, panels[0], len(looks))
    return figure


def reduction(rows):
    figure, panels = plt.subplots(1, 2, figsize=(9, 4.0), layout="constrained")
    lines = [("calibrated cage", "", "calibrated cage (number: tets)", BLUE, "o", "tets"),
             ("reduced body", "316", "reduced body in 316 tets (number: modes)", GREY, "*", "modes"),
             ("reduced body", "3028", "reduced body in 3,028 tets (number: modes)", "#000000", "*", "modes")]
    for axes, scene in zip(panels, ("sag", "drop")):
        for kind, tets, label, colour, marker, named in lines:
            own = [row for row in rows if row["kind"] == kind and tets in ("", row["tets"])]
            times = [float(row[f"{scene} (ms per frame)"]) for row in own]
            errors = [float(row[f"{scene} (RMS error)"]) for row in own]
            axes.plot(times, errors, color=colour, marker=marker, markersize=6, linewidth=1.4, label=label)
            for row, time, error in zip(own, times, errors):
                offset = (-4, -14) if named == "tets" else (0, 16 if row["modes"] == "20" else 7)
                axes.annotate(f"{int(row[named]):,}", (time, error), fontsize=8, color=colour, xytext=offset,
                              textcoords="offset points", ha="right" if named == "tets" else "center")
        reference = next(row for row in rows if row["kind"] == "reference")
        time = float(reference[f"{scene} (ms per frame)"])
        axes.axvline(time, color="black", linewidth=1)
        axes.annotate(f"reference: {int(reference['tets']):,} tets", (time, 0.97), xycoords=("data", "axes fraction"),
                      rotation=90, ha="right", va="top", fontsize=8)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.margins(0.1, 0.14)
        plain_ticks(axes.xaxis, [0.2, 0.5, 1, 2, 5, 10, 20])
        plain_ticks(axes.yaxis, [0.001, 0.002, 0.005] if scene == "sag" else [0.02, 0.03, 0.05, 0.1])
        axes.set_xlabel("milliseconds per frame (simulation and skin)")
        axes.set_title(scene, fontsize=11, loc="left")
        axes.grid(True, **GRID)
    panels[0].set_ylabel("error, RMS, box diagonals")
    legend_below(figure, panels[0], len(lines))
    return figure


def pairs(axes, labels, before, after, before_look, after_look):
    """Draws a line for each row from one value to another, or a point if one of them is missing."""
    for k, (first, second) in enumerate(zip(before, after)):
        if first and second:
            axes.plot([first, second], [k, k], color="#bbbbbb", linewidth=2, zorder=1)
    for values, look in ((before, before_look), (after, after_look)):
        points = [(value, k) for k, value in enumerate(values) if value]
        axes.plot(*zip(*points), linestyle="", markersize=7, zorder=2, **look)
    axes.set_yticks(range(len(labels)), labels)
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.grid(True, axis="x", **GRID)


def number(text):
    return float(text) if text else None


def attach_update_build(rows):
    figure, axes = plt.subplots(figsize=(8, 4.4), layout="constrained")
    pairs(axes, [row["work"] for row in rows], [number(row["Bullet (ms)"]) for row in rows],
          [number(row["tetskin (ms)"]) for row in rows], {"label": "Bullet", **BULLET}, {"label": "tetskin", **OURS})
    plain_ticks(axes.xaxis, [0.001, 0.01, 0.1, 1, 10, 100, 1000])
    axes.set_xlabel("milliseconds of processor time, one thread")
    legend_below(figure, axes, 2)
    return figure


def crowd(rows):
    figure, axes = plt.subplots(figsize=(8, 3.9), layout="constrained")
    first = [float(row["with it (ms)"].split(" to ")[0]) for row in rows]
    pairs(axes, [f"{row['left out']} ({row['bodies']} bodies)".replace("awake bodies", "bodies awake") for row in rows],
          first, [number(row["without it (ms)"]) for row in rows], {"label": "with it", "color": ORANGE, "marker": "s"},
          {"label": "without it", **OURS})
    low = 1.0
    axes.set_xlim(low, 150)
    for k, row in enumerate(rows):
        if float(row["without it (ms)"]) == 0.0:
            axes.plot([low, first[k]], [k, k], color="#bbbbbb", linewidth=2, zorder=1)
            axes.plot(low, k, markersize=7, clip_on=False, **{**OURS, "marker": "<"})
            axes.annotate("0 ms", (low, k), textcoords="offset points", xytext=(8, 4), fontsize=8)
    plain_ticks(axes.xaxis, [1, 2, 5, 10, 20, 50, 100])
    axes.set_xlabel("milliseconds of processor time per frame, all skins")
    legend_below(figure, axes, 2)
    return figure


def step_time(rows):
    looks = {"Bullet neo-Hookean (ms)": (GREY, "x", "-"), "Bullet linear (ms)": (GREY, "+", ":"),
             "XPBD (ms)": (ORANGE, "s", "--"), "tetskin (ms)": (BLUE, "o", "-")}
    figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
    for column, (colour, marker, style) in looks.items():
        own = [row for row in rows if row[column]]
        axes.plot([float(row["tets"]) for row in own], [float(row[column]) for row in own], color=colour, marker=marker,
                  linestyle=style, linewidth=1.5, markersize=6, label=column.removesuffix(" (ms)"))
    axes.set_yscale("log")
    tets_axis(axes, [float(row["tets"]) for row in rows])
    axes.set_yticks([0.1, 1, 10, 100, 1000 / 60], ["0.1", "1", "10", "100", "16.7 (60 Hz)"])
    axes.set_ylabel("milliseconds per frame of 1/60 s")
    axes.grid(True, **GRID)
    axes.legend(frameon=False, fontsize=9)
    return figure


def landing(rows):
    slowest, exploded = 0.0005, 20.0  # the value for a printed 0.000, and the one at which explosions are drawn
    looks = {"neo-Hookean": ("Bullet neo-Hookean", GREY, "x"), "linear": ("Bullet linear", ORANGE, "s"),
             "solver": ("tetskin", BLUE, "o")}
    figure, axes = plt.subplots(figsize=(8, 5.6), layout="constrained")
    for shift, (column, (label, colour, marker)) in zip((-0.2, 0.0, 0.2), looks.items()):
        points = [(exploded if row[column] == "explodes" else max(float(row[column]), slowest), k + shift)
                  for k, row in enumerate(rows) if row[column]]
        axes.plot(*zip(*points), linestyle="", markersize=5.5, color=colour, marker=marker, label=label)
    axes.set_xscale("log")
    axes.set_xticks([slowest, 0.001, 0.01, 0.1, 1, exploded], ["< 0.0005", "0.001", "0.01", "0.1", "1", "explodes"])
    axes.tick_params(axis="x", labelsize=9)
    axes.get_xticklabels()[0].set_ha("right")
    axes.minorticks_off()
    axes.set_yticks(range(len(rows)), [f"{int(row['tets']):,} tets, {row['steps per frame']} per frame, "
                                      f"{int(row['stiffness']):,}" for row in rows], fontsize=8)
    for k in range(1, len(rows)):
        if rows[k]["tets"] != rows[k - 1]["tets"]:
            axes.axhline(k - 0.5, color="#999999", linewidth=0.8)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.grid(True, **GRID)
    axes.set_ylabel("tets, steps per frame, stiffness")
    axes.set_xlabel("speed of the nodes, RMS over the last half second, body lengths per second")
    legend_below(figure, axes, 3)
    return figure


def gaps(rows):
    obstacles = list(dict.fromkeys(row["obstacle"] for row in rows))
    figure, panels = plt.subplots(1, 2, figsize=(9, 4), sharey=True, layout="constrained")
    kinds = (("nodes", {"label": "contact at the cage's nodes", **BULLET}, 0.17),
             ("surface", {"label": "contact at the surface", **OURS}, -0.17))
    titles = {"gap at rest": "at rest", "least gap in impact": "deepest moment of an impact"}
    for axes, (column, title) in zip(panels, titles.items()):
        for kind, look, shift in kinds:
            points = [(100 * float(row[f"{column} by {kind} (S)"]), obstacles.index(row["obstacle"]) + shift)
                      for row in rows if row[f"{column} by {kind} (S)"]]
            axes.plot(*zip(*points), linestyle="", markersize=5, alpha=0.7, **look)
        axes.axvline(0, color="black", linewidth=0.8)
        axes.set_xlabel("gap, % of the body's size")
        axes.set_title(title, fontsize=11, loc="left")
        axes.grid(True, axis="x", **GRID)
    panels[0].set_yticks(range(len(obstacles)), obstacles)
    panels[0].invert_yaxis()
    legend_below(figure, panels[0], 2)
    return figure


def share_of_allowance(row, column):
    """Measured value over the limit of a check: above 1 the check fails. Nothing where it was not measured."""
    if not row[column]:
        return None
    value, low, high = (float(row[name]) if row[name] else None for name in (column, "at least", "at most"))
    if math.isnan(value):
        return math.inf
    if low is not None and high is not None:
        centre, half = (low + high) / 2, (high - low) / 2
        return abs(value - centre) / half if half else (0.0 if value == centre else math.inf)
    if "over its start" in row["figure"]:
        return max(value - 1.0, 0.0) / (high - 1.0)
    if low is not None:
        return max(value / low, 0.0) if low < 0 else (low / value if value > 0 else math.inf)
    return max(value, 0.0) / high if high else (0.0 if value <= 0 else math.inf)


def contact_checks(rows):
    low, high = 1e-5, 1e5
    looks = {"Bullet": {"label": "Bullet's solver", **BULLET},
             "version 0.9.0": {"label": "version 0.9.0", "color": ORANGE, "marker": "s"},
             "tetskin": {"label": "tetskin", **OURS}}
    scenes = list(dict.fromkeys(row["scene"].split("/")[0] for row in rows))
    figure, axes = plt.subplots(figsize=(8, 6.2), layout="constrained")
    for shift, (column, look) in zip((-0.2, 0.0, 0.2), looks.items()):
        points = []
        for k, scene in enumerate(scenes):
            shares = [share_of_allowance(row, column) for row in rows if row["scene"].split("/")[0] == scene]
            shares = [share for share in shares if share is not None]
            if shares:
                points.append((min(max(max(shares), low), high), k + shift))
        axes.plot(*zip(*points), linestyle="", markersize=5, **look)
    axes.axvline(1, color="black", linewidth=1)
    axes.axvspan(1, 3 * high, color=ORANGE, alpha=0.07, linewidth=0)
    axes.set_xscale("log")
    axes.set_xlim(low / 2, 3 * high)
    axes.set_xticks([10.0 ** k for k in range(-4, 5, 2)] + [low, high],
                    ["0.0001", "0.01", "1", "100", "10,000", "0", "> 100,000"])
    axes.minorticks_off()
    axes.tick_params(axis="x", labelsize=9)
    axes.set_yticks(range(len(scenes)), scenes, fontsize=9)
    axes.set_ylim(len(scenes) - 0.4, -0.6)
    axes.grid(True, **GRID)
    axes.set_xlabel("worst check of each scene: deviation over what is allowed (above 1 it fails)")
    legend_below(figure, axes, len(looks))
    return figure


def solvers(rows):
    return draw_table(rows, f"The serpent, pinned by its coil, sags: {int(rows[0]['tets']):,} tets, all the same")


def peers_beam(rows):
    return peers.plot(peers.numbers(rows), "beam")


def peers_snake(rows):
    return peers.plot(peers.numbers(rows), "snake")


PLOTS = (cage_kinds, reduction, attach_update_build, crowd, solvers, step_time, landing, gaps, contact_checks,
         peers_beam, peers_snake)


def hash_of(table):
    return hashlib.sha256(table.read_bytes()).hexdigest()


def save(figure, path, source):
    """Reduces an image to few colours, which takes a third of the bytes."""
    drawn = io.BytesIO()
    figure.savefig(drawn, format="png", dpi=DPI, bbox_inches="tight")
    plt.close(figure)
    notes = PngInfo()
    notes.add_text("Source", source)
    Image.open(drawn).convert("RGB").quantize(48).save(path, optimize=True, pnginfo=notes)


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else TABLES
    folder.mkdir(parents=True, exist_ok=True)
    for plot in PLOTS:
        name = plot.__name__
        figure = plot(rows_of(name))
        save(figure, folder / f"{name}.png", f"{name}.csv sha256 {hash_of(TABLES / f'{name}.csv')}")


if __name__ == "__main__":
    main()
