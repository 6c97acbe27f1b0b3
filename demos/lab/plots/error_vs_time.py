#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Presents the results of tetskin_error_vs_time: tables, printed and as error_vs_time.md, and plots as PNG and SVG, beside
its JSON file (or in the folder given).

error_vs_time.py RESULTS.json [FOLDER] [--target-error X] [--tets N] [--no-surface] [--quiet]

For every scene: a table, the reference's own error, and the cheapest setting below an error of X;
SCENE_INTEGRATOR.png, error against time per frame; SCENE_INTEGRATOR_substeps.png, errors in space and in time over the
substeps; SCENE_INTEGRATOR_amplitude.png, error of reduced bodies over the
deformation; SCENE_INTEGRATOR_frames.png, error over the frames for the cage nearest to N tets (3,000); and, if f3d is
installed, SCENE_INTEGRATOR_surface.png: where on the surface the error is. For a comparison of solvers (--solvers): one
table, also as SCENE_solvers.csv, and SCENE_solvers.png. Needs python3-matplotlib; the surface f3d, xvfb and xauth as
well.
"""
import argparse
import json
import math
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib
from matplotlib.lines import Line2D

sys.dont_write_bytecode = True  # leaves nothing in the repository
from look import BLUE, DPI, GREEN, GREY, ORANGE, PINK, SKY, plt  # noqa: E402
from solvers import draw_solvers, is_of_solvers, solvers_csv, solvers_text  # noqa: E402

COLOURS = {"linear": BLUE, "quadratic": ORANGE}
MARKERS = {"linear": "o", "quadratic": "s"}
STYLES = {"same": "-", "same_calibrated": (0, (4, 1, 1, 1, 1, 1)), "split": ":", "filled": "-.", "calibrated": "--",
          "reduced": (0, (1, 1.5))}
# Kinds that only serve to separate causes of error, with one surface: distinguished by colour and marker as well.
KIND_COLOURS = {"same_calibrated": SKY, "split": GREEN, "filled": PINK, "reduced": "#000000"}
KIND_MARKERS = {"same_calibrated": "^", "split": "D", "filled": "v", "reduced": "*"}
# The text after a surface's name.
KINDS = {"same": "", "same_calibrated": ", bare, calibrated", "split": ", bare, split", "filled": ", filled",
         "calibrated": ", calibrated", "reduced": ", reduced"}

HEAD = ("| tets | duplicates | stiffness | surface | substeps | error, RMS | in space | in time | largest | embedding only | "
        "at the nodes | normals, degrees | simulation, ms | skin, µs | total, ms | speed-up | embedding, ms | memory, MB |"
        "{more}\n" + 18 * "|---" + "|{lines}\n")
AGAINST = " error against Bullet's reference | speed-up against it |"


def setting(row):
    """The name of a row's surface."""
    name = row["interpolation"] + KINDS[row["material"]]
    if not row["modes"]:
        return name
    left_out = f" ({row['modes_left_out']:.0f} left out)" if row["modes_left_out"] else ""
    return f"{name}, {row['modes']:.0f} modes{left_out}"


def tets_of(row):
    """A row's cage, as cells of a table."""
    factor = f"scaled by {row['stiffness_factor']:.3f}" if row["stiffness_factor"] != 1 else ""
    if row["calibration_left"] > 0:
        factor += f" (remaining error {row['calibration_left']:.1%})"
    return f"| {row['tets']:,.0f} | {row['copies']:,.0f} | {factor} |"


def substeps_of(row):
    return f"{row['substeps']:.0f} substep{'s' if row['substeps'] != 1 else ''}"


def is_choice(row):
    """Whether it is a setting that a user of the library may choose."""
    return row["interpolation"] != "reference" and row["finite"]


def reference_line(row, scene, against):
    whose, total, space, time = "reference", "", "", ""
    if row["integrator"] != scene["integrator"]:
        whose = f"reference, Bullet's elasticity, {row['integrator']}"
    elif row["error_time_rms"] > 0:
        whose, total, time = "the reference's tets", f"{row['error_total_rms']:.2e}", f"{row['error_time_rms']:.1e}"
    else:
        space, time = (f"about {scene[key]:.1e}" if scene[key] > 0 else "" for key in ("reference_error", "reference_time_error"))
    return (f"{tets_of(row)} {whose} | {row['substeps']:.0f} | {total} | {space} | {time} | | | | | {row['simulation_ms']:.3g} | | "
            f"{row['total_ms']:.3g} | {row['speedup']:.3g} | | {row['memory_bytes'] / 1e6:.1f} |{' | |' if against else ''}\n")


def table_line(row, scene, against):
    if row["interpolation"] == "reference":
        return reference_line(row, scene, against)
    surface = f"**{setting(row)}**" if row["pareto"] else setting(row)
    if not row["finite"]:
        surface += " (exploded)"
    total = f"{row['error_total_rms']:.2e}{'' if row['resolved'] else ' ~'}"
    return (f"{tets_of(row)} {surface} | {row['substeps']:.0f} | {total} | "
            f"{row['error_space_rms']:.1e} | {row['error_time_rms']:.1e} | {row['error_total_max']:.1e} | "
            f"{row['error_embedding_rms']:.1e} | {row['error_simulation_rms']:.1e} | {row['normal_error_mean_deg']:.2f} | "
            f"{row['simulation_ms']:.3g} | {row['skin_us']:.0f} | {row['total_ms']:.3g} | {row['speedup']:.3g} | "
            f"{row['attach_ms']:.3g} | {row['memory_bytes'] / 1e6:.1f} |"
            + (f" {row['error_against_bullet_rms']:.2e} | {row['speedup_against_bullet']:.4g} |" if against else "") + "\n")


NOT_REDUCED = ("\nNo reduced bodies: the ends of the bar are driven, and vibration modes cannot follow them; Bullet's constraint for "
               "the nodes of a reduced body keeps them at their initial positions.\n")


def reduction_text(scene):
    """Facts about reduced bodies that the table does not show, and whether to use one."""
    rows = [row for row in scene["rows"] if row["modes"]]
    if not rows:
        return NOT_REDUCED if scene["scene"] == "twist" else ""
    shown = max(row["tets"] for row in rows)
    text = f"\nReduced bodies: modes of the reference's tets, computed in {rows[0]['modes_ms'] / 1000:.3g} s; "
    text += "relative error of the modes at the cage's nodes: " + ", ".join(
        f"{row['projection_error']:.1%} ({row['modes']:.0f} modes)" for row in rows if row["tets"] == shown) + ". "
    limit = scene["reduction_limit"]
    if scene["scene"] == "sag" and limit["amplitude"] > 0:
        text += (f"Linear modes are usable up to a deformation of {limit['amplitude']:.2g} (RMS): beyond it, the error with "
                 f"{limit['modes']:.0f} modes exceeds a tenth of the deformation. ")
    return text + scene["reduction_advice"] + "\n"


def cheapest_text(scene, target):
    choices = [row for row in scene["rows"] if is_choice(row)]
    # The library's default, where it was measured.
    choices = [row for row in choices if row["material"] == "calibrated"] or choices
    good = [row for row in choices if row["error_total_rms"] <= target]
    if not good:
        return f"\nNo setting has an error below {target:g}.\n"
    best = min(good, key=lambda row: row["total_ms"])
    substeps = f", {substeps_of(best)}" if best["substeps"] else ""
    return (f"\nCheapest setting with an error below {target:g}: {best['tets']:,.0f} tets, {setting(best)}{substeps}: "
            f"{best['total_ms']:.3g} ms per frame, error {best['error_total_rms']:.2e}.\n")


def reference_text(reference):
    count = f"{reference['tets']:,} tets"
    if reference["from"] == "built":
        text = f"The reference is a built cage of about {count}, with duplicate elements and volume fractions, not fitted"
    else:
        whose = "made by formula" if reference["from"] == "formula" else f"from {reference['from']}"
        return f"The reference is a mesh of {count} {whose}, not a built cage.\n"
    return text + ": eight to each quadratic tet, and linear for Bullet's forces and for modes, then calibrated.\n"


KINDS_TEXT = ("Cages: without a note, bare tets, each entirely full of material, which fuse nearby components; *split*, with "
              "duplicate elements for such components; *filled*, with mass and stiffness weighted by how much of the mesh each "
              "tet contains; *calibrated*, split, filled and calibrated, as the library does by default; *bare, calibrated*, "
              "only calibrated.\n")


def tables(results, target):
    """Everything that the results say in words, as Markdown."""
    text = (f"# Error against run time: {results['model']}\n\n{results['vertices']:,} vertices, {results['triangles']:,} "
            "triangles. Errors are fractions of the diagonal of the mesh's bounding box, over all vertices and frames: *in space*, of "
            "the same cage in the reference's substeps; *in time*, how far the cage is from that; the whole error is at most their "
            "sum. Times are processor times in one thread, medians over the frames. Bold: no other setting is both faster and more "
            "accurate. "
            + reference_text(results["reference"]) + KINDS_TEXT)
    for scene in results["scenes"]:
        integrator = "" if scene["integrator"] == "none" else f", {scene['integrator']}"
        against = any(row["speedup_against_bullet"] > 0 for row in scene["rows"])
        text += f"\n## {scene['scene']}{integrator}\n\n"
        if is_of_solvers(scene):
            text += solvers_text(scene)
            continue
        text += HEAD.format(more=AGAINST if against else "", lines="---|---|" if against else "")
        text += "".join(table_line(row, scene, against) for row in scene["rows"])
        if against:
            text += ("\nTwo references with the same cage and material: one with the library's elasticity and solver, one with "
                     "Bullet's elasticity, which handles rotation and damping differently.\n")
        if scene["reference_error"] > 0:
            text += (f"\nThe error of the reference itself in space is about {scene['reference_error']:.1e}, estimated from "
                     "coarser ones made in the same way; errors below three times that are not resolved (~).\n")
        if scene["reference_time_error"] > 0:
            text += (f"\nThe error of the reference itself in time is about {scene['reference_time_error']:.1e}, estimated from "
                     f"the same tets in {substeps_of(scene)}.\n")
        text += reduction_text(scene)
        if target:
            text += cheapest_text(scene, target)
    return text


def title_of(scene):
    return f"{scene['scene'].capitalize()}: {scene['about']}"


def series(scene, interpolation, material):
    """The rows of one line, fastest first."""
    rows = [r for r in usual_rows(scene) if (r["interpolation"], r["material"]) == (interpolation, material) and r["finite"]]
    return sorted(rows, key=lambda row: row["total_ms"])


def usual_rows(scene):
    """Those in the substeps in which everything was simulated."""
    return [row for row in scene["rows"] if row["substeps"] == scene["substeps"]]


def series_in_time(scene):
    """The rows of each cage that was simulated with several numbers of substeps, fewest substeps first."""
    cages = {}
    for row in sorted(filter(is_choice, scene["rows"]), key=lambda row: row["substeps"]):
        if not row["modes"]:
            cages.setdefault((row["tets"], row["material"], row["interpolation"]), []).append(row)
    return [rows for _, rows in sorted(cages.items()) if len(rows) > 1]


def reference_of(scene):
    return next((row for row in scene["rows"] if row["interpolation"] == "reference"), None)


def look_of(interpolation, material):
    """Colour and marker of a line."""
    colour = KIND_COLOURS.get(material, COLOURS[interpolation])
    quadratic = interpolation == "quadratic"
    return dict(color=colour, marker=KIND_MARKERS.get(material, MARKERS[interpolation]),
                markersize=9 if quadratic else 5, markerfacecolor="none" if quadratic else colour)


def draw_totals(axes, scene):
    for interpolation in COLOURS:
        for material, style in STYLES.items():
            rows = series(scene, interpolation, material)
            if not rows:
                continue
            if material == "reduced":
                draw_reduced(axes, rows, look_of(interpolation, material))
                continue
            axes.plot([r["total_ms"] for r in rows], [r["error_total_rms"] for r in rows], linewidth=1.4,
                      linestyle=style, zorder=3, **look_of(interpolation, material))


def draw_reduced(axes, rows, look):
    """One line per cage, by the number of modes."""
    for tets in sorted({row["tets"] for row in rows}):
        line = sorted((row for row in rows if row["tets"] == tets), key=lambda row: row["modes"])
        axes.plot([r["total_ms"] for r in line], [r["error_total_rms"] for r in line], linewidth=1.2, zorder=4,
                  linestyle=STYLES["reduced"], **look)
        for row in line:
            axes.annotate(f"{row['modes']:.0f}", (row["total_ms"], row["error_total_rms"]), fontsize=7,
                          textcoords="offset points", xytext=(3, -9))


def draw_substeps(axes, scene):
    """One line per cage, by the number of substeps."""
    for line in series_in_time(scene):
        axes.plot([r["total_ms"] for r in line], [r["error_total_rms"] for r in line], color="#888888", linewidth=0.8,
                  marker=".", markersize=4, zorder=2)
        for row in line:
            axes.annotate(f"{row['substeps']:.0f}", (row["total_ms"], row["error_total_rms"]), fontsize=7, color="#555555",
                          textcoords="offset points", xytext=(-3, -9))


def draw_embedding(axes, scene):
    """Draws the embedding errors of one kind of cage, as they do not depend on the material."""
    for interpolation in ("linear", "quadratic"):
        rows = any_series(scene, (interpolation,))
        axes.plot([r["total_ms"] for r in rows], [r["error_embedding_rms"] for r in rows], color=COLOURS[interpolation],
                  linestyle="-", marker=MARKERS[interpolation], markersize=3, linewidth=0.7, alpha=0.4, zorder=2)


def draw_front(axes, scene):
    front = sorted((r for r in scene["rows"] if r["pareto"]), key=lambda row: row["total_ms"])
    axes.plot([r["total_ms"] for r in front], [r["error_total_rms"] for r in front], color="#F0E442", linewidth=7,
              alpha=0.75, solid_capstyle="round", zorder=1)


def any_series(scene, interpolations, materials=tuple(STYLES)):
    """The first of these series that is not empty."""
    return next(filter(None, (series(scene, i, m) for i in interpolations for m in materials)), [])


def label_sizes(axes, scene):
    rows = any_series(scene, ("linear", "quadratic"))
    for row in rows:
        axes.annotate(f"{row['tets']:,.0f}", (row["total_ms"], row["error_total_rms"]), textcoords="offset points",
                      xytext=(6, 9), fontsize=8, color="#333333")


def draw_reference(axes, scene):
    reference = reference_of(scene)
    if not reference:
        return
    axes.axvline(reference["total_ms"], color="black", linewidth=1)
    axes.annotate(f"{reference['tets']:,.0f} tets, {substeps_of(reference)}: {reference['total_ms']:,.0f} ms",
                  (reference["total_ms"], 0.03), xycoords=("data", "axes fraction"), rotation=90, ha="right",
                  va="bottom", fontsize=8, textcoords="offset points", xytext=(-2, 0))
    if scene["reference_error"] > 0:
        axes.axhspan(1e-12, scene["reference_error"] + scene["reference_time_error"], color="#000000", alpha=0.08, linewidth=0,
                     zorder=0)


def legend_of(axes, scene):
    entries = []
    for interpolation in ("linear", "quadratic"):
        if any_series(scene, (interpolation,)):
            for material, style in STYLES.items():
                if series(scene, interpolation, material):
                    modes = " (number: modes)" if material == "reduced" else ""
                    entries.append(Line2D([], [], linestyle=style, label=interpolation + KINDS[material] + modes,
                                          **look_of(interpolation, material)))
            entries.append(Line2D([], [], linewidth=0.7, alpha=0.4, label=f"{interpolation}, embedding only",
                                  color=COLOURS[interpolation], marker=MARKERS[interpolation], markersize=3))
    if series_in_time(scene):
        entries.append(Line2D([], [], color="#888888", linewidth=0.8, marker=".", markersize=4, label="number: substeps"))
    entries.append(Line2D([], [], color="#F0E442", linewidth=7, alpha=0.75, label="Pareto-optimal: none faster and more accurate"))
    if reference_of(scene) and scene["reference_error"] > 0:
        entries.append(Line2D([], [], color="#000000", alpha=0.12, linewidth=9, label="below the reference's own error"))
    axes.legend(handles=entries, loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, fontsize=9, handlelength=4)


def error_against_time(scene, name):
    figure, axes = plt.subplots(figsize=(8.6, 4.8))
    axes.set_xscale("log")
    axes.set_yscale("log")
    draw_front(axes, scene)
    if scene["integrator"] != "none":
        draw_embedding(axes, scene)
    draw_totals(axes, scene)
    draw_substeps(axes, scene)
    errors = [r[key] for r in scene["rows"] for key in ("error_total_rms", "error_embedding_rms") if r[key] > 0]
    if errors:
        axes.set_ylim(0.5 * min(errors), 2.5 * max(errors))
    label_sizes(axes, scene)
    draw_reference(axes, scene)
    axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
    axes.set_xlabel("milliseconds per frame (simulation and skin)" if reference_of(scene) else "milliseconds per frame (skin)")
    axes.set_ylabel("error, RMS, over the box's diagonal")
    axes.set_title(f"{title_of(scene)} ({name})", fontsize=11, loc="left")
    legend_of(axes, scene)
    return figure


def error_over_substeps(scene, name):
    """In space and in time, of each cage that was simulated with several numbers of substeps."""
    figure, axes = plt.subplots(figsize=(6.4, 3.6))
    for line, colour in zip(series_in_time(scene), 2 * (SKY, BLUE, GREEN, ORANGE, PINK, GREY)):
        substeps = [row["substeps"] for row in line]
        for key, style in (("error_total_rms", "-"), ("error_space_rms", ":"), ("error_time_rms", "--")):
            axes.plot(substeps, [row[key] for row in line], linestyle=style, color=colour, linewidth=1.4,
                      marker="o" if style == "-" else "", markersize=4)
        axes.plot([], [], color=colour, label=f"{line[0]['tets']:,.0f} tets, {line[0]['material']}")
    for label, style in (("both", "-"), ("in space", ":"), ("in time", "--")):
        axes.plot([], [], color="black", linestyle=style, linewidth=1.2, label=label)
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.xaxis.set_major_formatter("{x:.0f}")
    axes.set_xlabel("substeps per frame")
    axes.set_ylabel("error, RMS, over the box's diagonal")
    axes.set_title(f"{title_of(scene)} ({name})", fontsize=11, loc="left")
    axes.grid(True, color="#dddddd", linewidth=0.6)
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, fontsize=9)
    return figure


def error_over_frames(scene, name, tets):
    rows = [r for r in usual_rows(scene) if r["error_total_rms_by_frame"]]
    shown = {material: min((r["tets"] for r in rows if r["material"] == material), key=lambda n: abs(math.log(n / tets)))
             for material in {r["material"] for r in rows}}
    figure, axes = plt.subplots(figsize=(6.4, 3.6))
    for row in rows:
        if row["tets"] != shown[row["material"]]:
            continue
        errors = row["error_total_rms_by_frame"]
        wide = row["interpolation"] == "linear" and row["material"] not in KIND_COLOURS
        axes.plot([(k + 1) / 60 for k in range(len(errors))], errors, linestyle=STYLES[row["material"]], label=setting(row),
                  color=look_of(row["interpolation"], row["material"])["color"], linewidth=3 if wide else 1.4,
                  alpha=0.5 if wide else 1)
    axes.set_ylim(bottom=0)
    axes.set_xlabel("seconds")
    axes.set_ylabel("error, RMS, over the box's diagonal")
    axes.set_title(f"{title_of(scene)} ({name}, about {tets:,.0f} tets)", fontsize=11, loc="left")
    axes.grid(True, color="#dddddd", linewidth=0.6)
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, fontsize=9, handlelength=4)
    return figure


def error_over_amplitude(scene, name, tets):
    """Frame by frame: the errors of reduced bodies and of a cage, over the distance of the surface from rest."""
    figure, axes = plt.subplots(figsize=(6.4, 3.6))
    rows = [r for r in scene["rows"] if r["modes"] and r["finite"]]
    rows = [r for r in rows if r["tets"] == max(r["tets"] for r in rows)]
    cages = [r for r in usual_rows(scene) if r["material"] == "calibrated" and r["interpolation"] == rows[0]["interpolation"]]
    rows += sorted(cages, key=lambda r: abs(math.log(r["tets"] / tets)))[:1]
    for k, row in enumerate(rows):
        label = setting(row) if row["modes"] else f"{setting(row)}, {row['tets']:,.0f} tets"
        axes.plot(row["amplitude_rms_by_frame"], row["error_total_rms_by_frame"], ".", markersize=4,
                  color=str(0.75 - 0.75 * k / len(rows)) if row["modes"] else COLOURS[row["interpolation"]], label=label)
    axes.set_xscale("log")
    axes.set_yscale("log")
    low, high = axes.get_xlim()
    axes.plot([low, high], [0.1 * low, 0.1 * high], color="#999999", linewidth=0.8, label="a tenth of the deformation")
    axes.set_xlim(low, high)
    axes.set_xlabel("deformation: distance from rest, RMS, over the box's diagonal")
    axes.set_ylabel("error, RMS")
    axes.set_title(f"{title_of(scene)} ({name})", fontsize=11, loc="left")
    axes.grid(True, color="#dddddd", linewidth=0.6)
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, fontsize=9)
    return figure


def read_ply(path):
    """The value of the last colour of a mesh that the demo wrote, and its box: lowest and highest corner."""
    with open(path) as file:
        header = list(iter(lambda: next(file).strip(), "end_header"))
        count = int(next(line for line in header if line.startswith("element vertex")).split()[-1])
        points = [tuple(map(float, next(file).split()[:3])) for _ in range(count)]
    most = float(next(line for line in header if line.startswith("comment viridis")).split()[-1])
    return most, [min(axis) for axis in zip(*points)], [max(axis) for axis in zip(*points)]


def surface(path, name):
    """The coloured mesh as f3d draws it, with the scale of its colours."""
    most, low, high = read_ply(path)
    centre = [(a + b) / 2 for a, b in zip(low, high)]
    camera = [c + 1.45 * math.dist(low, high) * step for c, step in zip(centre, (-0.34, 0.40, 0.85))]
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "surface.png"
        subprocess.run(["xvfb-run", "-a", "f3d", "--dry-run", "--quiet", str(path), f"--output={picture}", "--up=+Y",
                        "--fxaa", "--resolution=1000,800", "--bg-color=1,1,1", "--scalars=RGB", "--comp=-2",
                        "--camera-position=%g,%g,%g" % tuple(camera), "--camera-focal-point=%g,%g,%g" % tuple(centre)],
                       check=True)
        image = plt.imread(picture)
    figure, axes = plt.subplots(figsize=(6.4, 4.4))
    axes.imshow(image)
    axes.set_axis_off()
    scale = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(0, most), "viridis")
    bar = figure.colorbar(scale, ax=axes, shrink=0.75)
    bar.set_label("error, RMS over the frames, over the box's diagonal")
    bar.ax.ticklabel_format(style="sci", scilimits=(-2, 2))
    axes.set_title(name, fontsize=11, loc="left")
    return figure


def save(figure, folder, name):
    for ending in ("png", "svg"):
        path = folder / f"{name}.{ending}"
        figure.savefig(path, dpi=DPI, bbox_inches="tight", metadata={"Date": None} if ending == "svg" else None)
    plt.close(figure)
    return folder / f"{name}.png"


def coloured_mesh(name, *folders):
    """The mesh that the demo coloured, if it is there and can be drawn."""
    found = [folder / name for folder in folders if (folder / name).exists()]
    return found[0] if found and shutil.which("f3d") and shutil.which("xvfb-run") else None


def draw(scene, model, arguments, folder):
    """All plots of a scene; returns their paths."""
    integrated = scene["integrator"] != "none"
    base = f"{scene['scene']}_{scene['integrator']}" if integrated else scene["scene"]
    name = f"{model}, {scene['integrator']}" if integrated else model
    if is_of_solvers(scene):
        yield save(draw_solvers(scene, f"{title_of(scene)} ({model})"), folder, f"{scene['scene']}_solvers")
        return
    yield save(error_against_time(scene, name), folder, base)
    if series_in_time(scene):
        yield save(error_over_substeps(scene, name), folder, f"{base}_substeps")
    if integrated and any(row["error_total_rms_by_frame"] for row in scene["rows"]):
        yield save(error_over_frames(scene, name, arguments.tets), folder, f"{base}_frames")
    if scene["scene"] == "sag" and any(row["modes"] for row in scene["rows"]):
        yield save(error_over_amplitude(scene, name, arguments.tets), folder, f"{base}_amplitude")
    mesh = None if arguments.no_surface else coloured_mesh(f"error_{base}.ply", folder, arguments.results.parent)
    if mesh:
        try:
            yield save(surface(mesh, title_of(scene)), folder, f"{base}_surface")
        except (OSError, subprocess.CalledProcessError) as error:
            print(f"error_vs_time.py: warning: {mesh} is not drawn: {error}", file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=Path)
    parser.add_argument("folder", type=Path, nargs="?")
    parser.add_argument("--target-error", type=float, default=0)
    parser.add_argument("--tets", type=float, default=3000)
    parser.add_argument("--no-surface", action="store_true")
    parser.add_argument("--quiet", action="store_true")
    arguments = parser.parse_args()
    if not arguments.tets > 0:
        parser.error("--tets must be above 0")
    try:
        results = json.loads(arguments.results.read_text(encoding="utf-8"))
        if not all("reduction_advice" in scene and scene["rows"] for scene in results["scenes"]):
            raise ValueError("of an older version")
    except (OSError, ValueError, KeyError, TypeError) as error:
        parser.error(f"{arguments.results} is not what tetskin_error_vs_time writes ({error}); run that again")
    folder = arguments.folder or arguments.results.parent
    folder.mkdir(parents=True, exist_ok=True)
    text = tables(results, arguments.target_error)
    (folder / "error_vs_time.md").write_text(text, encoding="utf-8")
    said = (lambda *words: None) if arguments.quiet else (lambda *words: print(*words, flush=True))
    said(text)
    said(folder / "error_vs_time.md")
    for scene in filter(is_of_solvers, results["scenes"]):
        path = folder / f"{scene['scene']}_solvers.csv"
        path.write_text(solvers_csv(scene), encoding="utf-8")
        said(path)
    for scene in results["scenes"]:
        for path in draw(scene, Path(results["model"]).stem, arguments, folder):
            said(path)


if __name__ == "__main__":
    main()
