# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The comparison of solvers: its table and its plot, from the rows of tetskin_error_vs_time --solvers, or from the table
that is kept of them in demos/lab/figures."""
import csv
import io

from look import BLUE, GREEN, GREY, ORANGE, PINK, SKY, plt

NAMES = {"tetskin": "tetskin", "xpbd": "XPBD, fitted", "xpbd_unfitted": "XPBD, not fitted",
         "bullet_neo_hookean": "Bullet neo-Hookean, explicit", "bullet_linear": "Bullet linear, explicit",
         "bullet_neo_hookean_implicit": "Bullet neo-Hookean, implicit",
         "bullet_linear_implicit": "Bullet linear, implicit"}
LOOKS = {"tetskin": (BLUE, "o", "-"), "xpbd": (ORANGE, "s", "--"), "xpbd_unfitted": ("#000000", "D", "--"),
         "bullet_neo_hookean": (GREY, "x", "-"), "bullet_linear": (GREEN, "+", "-"),
         "bullet_neo_hookean_implicit": (PINK, "v", ":"), "bullet_linear_implicit": (SKY, "^", ":")}
COLUMNS = ("solver", "tets", "substeps", "ms per frame", "with the skin (ms)", "error (% of the motion)",
           "error (% of the box's diagonal)", "by the solver (% of the motion)", "damping (ms)", "stiffness", "volumes")


def is_of_solvers(scene):
    return any(row["integrator"] in NAMES and row["integrator"] != "tetskin" for row in scene["rows"]) or any(
        row.get("damping_ms", 0) > 0 for row in scene["rows"])


def percent(share):
    return f"{100 * share:.2g}" if share < 0.1 else f"{100 * share:.0f}"


def volumes_of(row):
    if not row["integrator"].startswith("xpbd"):
        return ""
    return {0: "free", -1: "rigid"}.get(row["xpbd_volume_stiffness"], f"{row['xpbd_volume_stiffness']:.2g}")


def cells(row):
    """A row of the table, in the order of COLUMNS. If a solver has exploded, it has no errors."""
    motion = (row["error_total_rms_by_frame"] and row["error_of_motion"]) or 0
    errors = ["explodes", "", ""]
    if row["finite"]:
        by_solver = motion * row["error_time_rms"] / row["error_total_rms"]
        errors = [percent(motion), percent(row["error_total_rms"]), percent(by_solver)]
    return [row["integrator"], f"{row['tets']:.0f}", f"{row['substeps']:.0f}", f"{row['simulation_ms']:.3g}",
            f"{row['total_ms']:.3g}", *errors, f"{row['damping_ms']:.2g}",
            f"{row['xpbd_stiffness']:.3g}" if row["integrator"].startswith("xpbd") else "", volumes_of(row)]


def rows_of(scene):
    return [row for row in scene["rows"] if row["interpolation"] != "reference"]


def solvers_csv(scene):
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows(cells(row) for row in rows_of(scene))
    return text.getvalue()


def solvers_text(scene):
    """The same as Markdown, with the references and the meaning of the columns."""
    text = "| " + " | ".join(COLUMNS) + " |\n" + len(COLUMNS) * "|---" + "|\n"
    for row in rows_of(scene):
        text += "| " + " | ".join([NAMES[row["integrator"]], *cells(row)[1:]]) + " |\n"
    text += ("\nThe same cage, masses, pins, gravity and Young's modulus in all rows. Of the motion: over the RMS distance of the "
             "reference's surface from rest. By the solver: from the same cage in the reference's substeps, by tetskin. XPBD, "
             "fitted, has the constants with the least error in these substeps, else those that follow from the material: *stiffness* over that of an isotropic lattice of springs "
             "with the material's Young's modulus, *volumes* over the material's first Lame parameter.\n")
    for row in scene["rows"]:
        if row["interpolation"] == "reference":
            text += (f"\nReference: {row['tets']:,.0f} tets, {row['integrator']}, {row['substeps']:.0f} substeps, "
                     f"{row['simulation_ms']:.3g} ms per frame; distance from the reference of all rows "
                     f"{row['error_total_rms']:.1e} of the box's diagonal.\n")
    against = [(row["integrator"], row["error_against_bullet_rms"] / row["error_total_rms"]) for row in rows_of(scene)
               if row["error_against_bullet_rms"] > 0 and row["finite"]]
    if against:
        text += ("\nAgainst a reference of the same tets with Bullet's linear elasticity, instead, errors are these times as "
                 "large: " + ", ".join(f"{NAMES[name]} {ratio:.2f}" for name, ratio in against) + ".\n")
    return text


def draw_solvers(scene, title):
    return draw_table(list(csv.DictReader(io.StringIO(solvers_csv(scene)))), title)


def is_drawn(row):
    """Without rows that have exploded, or have a larger error than a body that does not move at all."""
    error = row["error (% of the motion)"]
    return error != "explodes" and float(error) < 100


def draw_table(rows, title):
    figure, axes = plt.subplots(figsize=(8, 4.4), layout="constrained")
    for name, (colour, marker, style) in LOOKS.items():
        own = [row for row in rows if row["solver"] == name and is_drawn(row)]
        if not own:
            continue
        points = [(float(row["ms per frame"]), float(row["error (% of the motion)"])) for row in own]
        axes.plot(*zip(*points), color=colour, marker=marker, linestyle=style, linewidth=1.5, markersize=6, label=NAMES[name])
        for row, point in zip(own, points):
            axes.annotate(row["substeps"], point, fontsize=8, color=colour, xytext=(3, 4), textcoords="offset points")
    axes.set_xscale("log")
    axes.set_yscale("log")
    for axis, limits, unit in ((axes.xaxis, axes.get_xlim(), ""), (axes.yaxis, axes.get_ylim(), " %")):
        ticks = [digit * 10.0 ** power for power in range(-3, 5) for digit in (1, 2, 5)]
        ticks = [tick for tick in ticks if limits[0] <= tick <= limits[1]]
        axis.set_ticks(ticks, [f"{tick:,g}{unit}" for tick in ticks])
        axis.set_ticks([], minor=True)
    axes.set_xlabel("milliseconds per frame of 1/60 s, simulation alone (numbers: substeps)")
    axes.set_ylabel("error, RMS, share of the motion")
    axes.set_title(title, fontsize=11, loc="left")
    axes.grid(True, color="#dddddd", linewidth=0.6)
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, fontsize=9)
    return figure
