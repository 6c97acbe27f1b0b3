#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The comparison of linear and quadratic tets: one table of the results of several models, which orders.csv in
demos/figures is, and its plot.

orders.py OUTPUT.csv RESULTS.json...

The results are those of tetskin_error_vs_time --orders, one file for each model.
"""
import csv
import json
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # leaves nothing in the repository
from look import BLUE, GREEN, GREY, ORANGE, plt  # noqa: E402

NAMES = {"uncalibrated": "linear", "calibrated": "linear, calibrated", "quadratic": "quadratic",
         "quadratic_calibrated": "quadratic, calibrated"}
LOOKS = {"linear": (GREY, "x", ":"), "linear, calibrated": (BLUE, "o", "--"), "quadratic": (ORANGE, "s", "-"),
         "quadratic, calibrated": (GREEN, "^", "-.")}
# What is measured, by the reference's row and by the others: column, key in the results.
MEASURES = {"swing": "error_of_motion", "rest": "error_at_rest", "frequencies": "frequency_error"}
COLUMNS = ("model", "tets are", "tets", "nodes", "substeps", "ms per frame", "error of the swing (%)", "in space (%)",
           "in time (%)", "error at rest (%)", "sags by more (%)", "error of frequencies (%)", "stiffness factor", "not resolved")
RESOLVED = 3.0  # errors are significant if they are this many times the reference's own


def is_of_orders(scene):
    return any(row["material"] in NAMES and row["material"] != "calibrated" for row in scene["rows"])


def percent(share):
    return f"{100 * share:.3g}"


def own_error(share):
    return percent(share) if share else "unknown"


def rows_of(scene):
    return [row for row in scene["rows"] if row["interpolation"] != "reference"]


def reference_of(scene):
    """The reference itself: it comes behind the same cage in fewer substeps."""
    return [row for row in scene["rows"] if row["interpolation"] == "reference"][-1]


def cells(row, reference, model):
    own = row["interpolation"] == "reference"
    motion = 0 if own or not row["error_total_rms"] else row["error_of_motion"] / row["error_total_rms"]
    error = own_error if own else percent
    unresolved = [] if own else [name for name, key in MEASURES.items() if row[key] < RESOLVED * reference[key]]
    space, time = ("", "") if own else (percent(motion * row["error_space_rms"]), percent(motion * row["error_time_rms"]))
    return [model, "the reference" if own else NAMES[row["material"]], f"{row['tets']:.0f}", f"{row['nodes']:.0f}",
            f"{row['substeps']:.0f}", f"{row['simulation_ms']:.3g}", error(row["error_of_motion"]), space, time,
            error(row["error_at_rest"]), "" if own else percent(row["sag_excess"]), error(row["frequency_error"]),
            f"{row['stiffness_factor']:.3f}", " ".join(unresolved)]


def order_rows(scene, model):
    reference = reference_of(scene)
    return [cells(row, reference, model) for row in [reference, *rows_of(scene)]]


def orders_table(scene, model):
    """The table as Markdown, and what its columns mean."""
    text = "| " + " | ".join(COLUMNS[1:]) + " |\n" + (len(COLUMNS) - 1) * "|---" + "|\n"
    for row in order_rows(scene, model):
        text += "| " + " | ".join(row[1:]) + " |\n"
    return text + ("\nQuadratic tets are counted as the eight tets of each. Errors are RMS, of the surface's way in the swing and at "
                   "rest, and of six frequencies of the free body. The reference's row has estimates of its own errors, from coarser "
                   "references; *not resolved* are errors of less than three times these.\n\n" + scene["order_advice"] + "\n")


def draw_orders(rows):
    """Error of the swing and at rest against time, for each model."""
    models = list(dict.fromkeys(row["model"] for row in rows))
    figure, panels = plt.subplots(2, len(models), figsize=(1.2 + 2.0 * len(models), 5.2), sharex="col", squeeze=False,
                                  layout="constrained")
    for column, model in enumerate(models):
        own = [row for row in rows if row["model"] == model]
        for axes, key in zip(panels[:, column], ("error of the swing (%)", "error at rest (%)")):
            draw_panel(axes, own, key)
            axes.set_ylabel(key if column == 0 else "")
        panels[0, column].set_title(model, fontsize=10, loc="left")
        panels[1, column].set_xlabel("ms per frame", fontsize=9)
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=5, frameon=False, fontsize=9)
    return figure


def draw_panel(axes, rows, key):
    axes.set_xscale("log")
    axes.set_yscale("log")
    for name, (colour, marker, style) in LOOKS.items():
        points = [(float(row["ms per frame"]), float(row[key])) for row in rows if row["tets are"] == name]
        if points:
            axes.plot(*zip(*points), color=colour, marker=marker, linestyle=style, linewidth=1.4, markersize=5, label=name)
    bottom, top = axes.get_ylim()
    own = next(row[key] for row in rows if row["tets are"] == "the reference")
    least = 0.0 if own == "unknown" else RESOLVED * float(own)
    if least > bottom:
        axes.axhspan(bottom, min(least, top), color="#000000", alpha=0.08, linewidth=0, label="not resolved by the reference")
    axes.set_ylim(bottom, top)
    for axis, limits in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, (bottom, top))):
        ticks = [digit * 10.0 ** power for power in range(-3, 4) for digit in (1, 3)]
        ticks = [tick for tick in ticks if limits[0] <= tick <= limits[1]]
        axis.set_ticks(ticks, [f"{tick:,g}" for tick in ticks])
        axis.set_ticks([], minor=True)
    axes.tick_params(labelsize=8)
    axes.grid(True, color="#dddddd", linewidth=0.6)


def write_orders(path, results):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for result in results:
            writer.writerows(order_rows(result["scenes"][0], result["model"]))


def main():
    output, *files = sys.argv[1:]
    write_orders(output, [json.loads(Path(name).read_text(encoding="utf-8")) for name in files])


if __name__ == "__main__":
    main()
