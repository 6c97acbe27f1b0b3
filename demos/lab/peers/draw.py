#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Draws what compare.py has measured: FOLDER/peers_SCENE.png, error against time, and tables.md, a short one first.

draw.py peers.csv [FOLDER]

In a plot every run is a point, each peer a colour, and a line joins those of its runs that none of its other runs beats
in both. A star is the setting of the peer's own example. Needs matplotlib.
"""
import csv
import math
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "plots"))
from look import BLUE, DPI, GREEN, GREY, ORANGE, PINK, plt  # noqa: E402

COLOURS = {"tetskin": BLUE, "mujoco": ORANGE, "rapier": GREEN, "pybullet": GREY, "newton": PINK}
NAMES = {"tetskin": "tetskin", "mujoco": "MuJoCo", "rapier": "Rapier", "pybullet": "pybullet", "newton": "Newton"}
MARKERS = "osD^vPX<>h"
LABELS = {("beam", "error in time"): "error of the tip's way in time alone, %\nof the largest (the same 3,000 tets)",
          ("beam", "error in all"): "error of the tip's way in all, %\nof the largest",
          ("snake", "error"): "distance of the drawn surface from\ntetskin in 64 substeps, % of its size"}


# The table for a first page: label, scene, figure, and the error that the quickest run must have, or None: the figure
# in the setting of the peer's own example. Without a figure: its time.
SUMMARY = [("beam: ms for 1 % error in time", "beam", "error in time", 1.0),
           ("beam: ms for 0.1 %", "beam", "error in time", 0.1),
           ("beam: ms for 1 % error in all", "beam", "error in all", 1.0),
           ("stiff beam at rest: error of the sag, %", "sag", "error of the sag, %", None),
           ("free spin: error of the angular momentum, %", "spin", "error of the angular momentum, %", None),
           ("snake that lands: ms", "snake", "", None), ("gap of its surface, mm", "snake", "gap, mm", None),
           ("ms as it lies there", "snake", "ms at rest", None),
           ("box slides on a soft slab: share of Coulomb's way", "slide", "way, share of Coulomb's", None),
           ("box on a soft slab: ms", "slide", "", None), ("three boxes in a stack: ms", "stack", "", None),
           ("26 balls in a heap: ms", "heap", "", None), ("50 balls on a mat: ms", "pit", "", None),
           ("60,000 triangles: attached in ms", "skin", "bind, ms", None), ("moved in ms", "skin", "", None)]


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return numbers(csv.DictReader(file))


def numbers(rows):
    """The table's rows, with numbers where there are numbers."""
    rows = list(rows)
    for row in rows:
        for name in ("value", "ms_per_frame", "ms_least", "ms_most"):
            row[name] = float(row[name]) if row[name] else math.nan
        row["example"] = row["example"] == "1"
    return rows


def front(points):
    """Those (time, error) that no other beats in both, in the order of time."""
    best, kept = math.inf, []
    for time, error in sorted(points):
        if error < best:
            best = error
            kept.append((time, error))
    return kept


def good(rows, scene, figure):
    return [row for row in rows if (row["scene"], row["figure"]) == (scene, figure) and row["status"] == "ok"]


def plot(rows, scene):
    """A figure of the scene's errors against time, side by side; None if none was measured."""
    kinds = [figure for of, figure in LABELS if of == scene and good(rows, scene, figure)]
    if not kinds:
        return None
    canvas, panels = plt.subplots(1, len(kinds), figsize=(4 + 4 * len(kinds), 4.6), layout="constrained", squeeze=False)
    for axes, figure in zip(panels[0], kinds):
        draw_errors(axes, good(rows, scene, figure))
        axes.set_ylabel(LABELS[scene, figure])
    panels[0][0].legend(frameon=False, fontsize=9)
    return canvas


def draw_errors(axes, rows):
    for peer, colour in COLOURS.items():
        own = [row for row in rows if row["peer"] == peer and row["value"] > 0]
        if not own:
            continue
        line = front([(row["ms_per_frame"], row["value"]) for row in own])
        axes.plot(*zip(*line), color=colour, linewidth=1.5, label=NAMES[peer], zorder=2)
        for marker, curve in zip(MARKERS, dict.fromkeys((row["curve"], row["mesh"]) for row in own)):
            points = [row for row in own if (row["curve"], row["mesh"]) == curve]
            x, y = [row["ms_per_frame"] for row in points], [row["value"] for row in points]
            spread = [[row["ms_per_frame"] - row["ms_least"] for row in points],
                      [row["ms_most"] - row["ms_per_frame"] for row in points]]
            axes.errorbar(x, y, xerr=spread, fmt=marker, color=colour, markersize=4, alpha=0.55, linewidth=0.8)
        stars = [(row["ms_per_frame"], row["value"]) for row in own if row["example"]]
        if stars:
            axes.plot(*zip(*stars), "*", color=colour, markersize=13, markeredgecolor="white", zorder=4)
    axes.set(xscale="log", yscale="log", xlabel="processor time per frame of 1/60 s, ms")
    axes.grid(color="#dddddd", linewidth=0.6)


def number(value):
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:,.0f}"


def scene_table(rows, scene):
    """All of a scene: a row for each case."""
    rows = [row for row in rows if row["scene"] == scene]
    figures = [name for name in dict.fromkeys(row["figure"] for row in rows) if name]
    cases = {}
    for row in rows:
        cases.setdefault((row["peer"], row["curve"], row["mesh"], row["setting"]), []).append(row)
    lines = [
        f"| peer | what, mesh | setting | ms per frame | {' | '.join(figures)} |", "|---" * (4 + len(figures)) + "|"
    ]
    for (peer, curve, mesh, setting), own in cases.items():
        first = own[0]
        what, star = ", ".join(words for words in (curve, mesh) if words), " *" if first["example"] else ""
        begin = f"| {NAMES[peer]} {first['version']} | {what} | {setting}{star} |"
        if first["status"] != "ok":
            told = f"{first['status']}: {first['why']}".replace("|", "/")
            lines.append(f"{begin} | {told} |" + " |" * (len(figures) - 1))
            continue
        values = {row["figure"]: number(row["value"]) for row in own}
        spread = f" ({number(first['ms_least'])} to {number(first['ms_most'])})" if int(first["runs"]) > 1 else ""
        cells = " | ".join([f"{number(first['ms_per_frame'])}{spread}", *(values.get(name, "") for name in figures)])
        lines.append(f"{begin} {cells} |")
    return "\n".join(lines)


def summary(rows):
    """The table for a first page, of the scenes that were run."""
    lines = [f"| | {' | '.join(NAMES.values())} |", "|---" * (1 + len(NAMES)) + "|"]
    for label, scene, figure, most in SUMMARY:
        cells = [summary_cell([row for row in rows if (row["scene"], row["peer"]) == (scene, peer)], figure, most)
                 for peer in NAMES]
        if any(cells):
            lines.append(f"| {label} | {' | '.join(cells)} |")
    return "\n".join(lines)


def summary_cell(rows, figure, most):
    """Of the runs of a scene by one peer."""
    if most is not None:
        times = [row["ms_per_frame"] for row in rows if row["figure"] == figure and row["value"] <= most]
        return number(min(times)) if times else ("not reached" if rows else "")
    own = [row for row in rows if row["example"]] or rows
    good_ones = [row for row in own if row["status"] == "ok" and (row["figure"] == figure or not figure)]
    if good_ones:
        first = min(good_ones, key=lambda row: row["ms_per_frame"])
        return number(first["value"] if figure else first["ms_per_frame"])
    return own[0]["status"] if own else ""


def losses(rows):
    """The cases in which a peer has less error in less time than any run of ours, or takes less time in its example's
    setting."""
    found = []
    for scene, figure in dict.fromkeys((row["scene"], row["figure"]) for row in rows if "error" in row["figure"]):
        table = good(rows, scene, figure)
        ours = front([(row["ms_per_frame"], row["value"]) for row in table if row["peer"] == "tetskin"])
        worst = {}
        for row in table:
            enough = [time for time, error in ours if error <= row["value"]]
            times = min(enough) / row["ms_per_frame"] if enough else math.inf
            key = row["peer"], times < math.inf
            if row["peer"] != "tetskin" and times > 1 and times >= worst.get(key, (0,))[0]:
                worst[key] = times, row
        for (peer, reached), (times, row) in sorted(worst.items(), key=lambda item: item[0]):
            how = f"in 1/{times:.1f} of our time" if reached else "which we reach with no setting that was run"
            found.append(
                f"- {scene}, {figure}: {NAMES[peer]} ({row['curve']}, {row['setting']}) has {number(row['value'])} "
                f"in {number(row['ms_per_frame'])} ms, {how}.")
    for label, scene, figure, _ in SUMMARY:
        cells = {peer: summary_cell([row for row in rows if (row["scene"], row["peer"]) == (scene, peer)], "", None)
                 for peer in NAMES} if not figure else {}
        times = {peer: float(cell.replace(",", "")) for peer, cell in cells.items() if cell[:1].isdigit()}
        found += [f"- {label}: {NAMES[peer]} {cells[peer]}, tetskin {cells['tetskin']}." for peer, time in times.items()
                  if time < times.get("tetskin", math.inf)]
    return found


def draw(path, folder):
    rows, folder = rows_of(path), Path(folder)
    for scene in dict.fromkeys(scene for scene, _ in LABELS):
        canvas = plot(rows, scene)
        if canvas:
            canvas.savefig(folder / f"peers_{scene}.png", dpi=DPI, metadata={"Software": ""})
            plt.close(canvas)
    where = "; ".join(dict.fromkeys(f"{row['date']}, {row['machine']}" for row in rows))
    text = [f"Measured {where}. A star is the setting of the peer's own example.", "", summary(rows), ""]
    for scene in dict.fromkeys(row["scene"] for row in rows):
        text += [f"## {scene}", "", scene_table(rows, scene), ""]
    text += ["## Lost", "", *(losses(rows) or ["Nothing."]), ""]
    (folder / "tables.md").write_text("\n".join(text), encoding="utf-8")


if __name__ == "__main__":
    draw(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else Path(sys.argv[1]).parent)
