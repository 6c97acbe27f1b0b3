# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""demos/lab/peers with matplotlib: its drawings and remarks on a table."""
import csv
import subprocess
import sys
from pathlib import Path

PEERS = Path(__file__).parents[3] / "demos/lab/peers"


def test_a_run_ends_with_plots_and_tables(tmp_path):
    done = subprocess.run([sys.executable, "-B", PEERS / "compare.py", "--quick", "--only", "skin", "--peers", "tetskin",
                           "--out", tmp_path], capture_output=True, text=True)
    assert done.returncode == 0 and "no plots" not in done.stdout, done.stdout + done.stderr
    told = (tmp_path / "tables.md").read_text()
    assert "| 60,000 triangles: attached in ms |" in told and "## Lost\n\nNothing." in told
    assert not list(tmp_path.glob("*.png"))  # no errors, no plot


def test_what_a_peer_does_better_is_told_and_drawn(tmp_path):
    run = {"scene": "beam", "version": "1", "curve": "c", "mesh": "m", "example": 0, "figure": "error in time",
           "ms_least": 1, "ms_most": 9, "runs": 3, "status": "ok", "why": "", "load": "", "date": "today", "machine": "m"}
    rows = [{**run, "peer": peer, "setting": str(time), "ms_per_frame": time, "value": error}
            for peer, time, error in (("tetskin", 2, 1.0), ("tetskin", 4, 0.5), ("rapier", 3, 0.7), ("mujoco", 5, 0.2))]
    with open(tmp_path / "peers.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, list(rows[0]))
        table.writeheader()
        table.writerows(rows)
    subprocess.run([sys.executable, "-B", PEERS / "draw.py", tmp_path / "peers.csv"], check=True)
    assert (tmp_path / "peers_beam.png").stat().st_size > 5000
    lost = (tmp_path / "tables.md").read_text().partition("## Lost")[2]
    assert "Rapier (c, 3) has 0.7 in 3 ms, in 1/1.3 of our time" in lost
    assert "MuJoCo (c, 5) has 0.2 in 5 ms, which we reach with no setting" in lost and lost.count("- beam") == 2
