# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The notebooks are those of the scripts, have been run, and show their films."""

import sys
import textwrap
from pathlib import Path

import pytest

nbformat = pytest.importorskip("nbformat")
pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")
FOLDER = Path(__file__).parents[3] / "demos/examples/python"
sys.path.insert(0, str(FOLDER))
import notebooks  # noqa: E402


def sources(notebook):
    return [(cell.cell_type, cell.source) for cell in notebook.cells]


@pytest.mark.parametrize("name", notebooks.SCRIPTS)
def test_a_kept_notebook_is_that_of_its_script_and_small(name):
    path = FOLDER / f"{name}.ipynb"
    kept = nbformat.read(path, as_version=4)
    assert sources(kept) == sources(notebooks.notebook_of(name)), "run demos/examples/python/notebooks.py"
    assert path.stat().st_size <= notebooks.LARGEST
    outputs = [output for cell in kept.cells for output in cell.get("outputs", [])]
    assert any("image/png" in output.get("data", {}) for output in outputs)
    assert not any(output.output_type == "error" or "text/html" in output.get("data", {}) for output in outputs)


@pytest.mark.parametrize("name", notebooks.SCRIPTS)
def test_a_notebook_runs_and_plays_its_film(name, tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")
    notebook = notebooks.notebook_of(name, ("--quick", "--output", str(tmp_path / "written")))
    nbformat.validate(notebook)
    notebooks.run(notebook, tmp_path)
    pages = [output.data["text/html"] for cell in notebook.cells for output in cell.get("outputs", [])
             if "text/html" in output.get("data", {})]
    assert len(pages) == 1 and "<iframe srcdoc=" in pages[0] and "class Stage" in pages[0]
    assert list((tmp_path / "written").glob("*.html"))


def test_the_interrupt_button_cancels_a_long_call(tmp_path):
    """The kernel receives the button's message, while it makes cages forever."""
    from jupyter_client.manager import start_new_kernel

    code = textwrap.dedent("""
        import numpy as np, tetskin as ts
        u, v = np.meshgrid(np.arange(600) * 2 * np.pi / 600, np.arange(300) * 2 * np.pi / 300, indexing="ij")
        ring = 1 + 0.35 * np.cos(v)
        points = np.stack([ring * np.cos(u), 0.35 * np.sin(v), -ring * np.sin(u)], -1).reshape(-1, 3)
        i, j = np.meshgrid(np.arange(600), np.arange(300), indexing="ij")
        a, b = i * 300 + j, (i + 1) % 600 * 300 + j
        c, d = (i + 1) % 600 * 300 + (j + 1) % 300, i * 300 + (j + 1) % 300
        triangles = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
        while True:
            ts.create_cage(ts.TriangleMesh(points, triangles), target_tets=20000, progress=True)
    """)
    manager, client = start_new_kernel(cwd=str(tmp_path))
    try:
        asked = client.execute(code)
        while True:  # until the bar has appeared
            message = client.get_iopub_msg(timeout=60)
            if message["msg_type"] == "stream" and "cage [" in message["content"]["text"]:
                break
            assert message["msg_type"] != "error", message["content"]
        manager.interrupt_kernel()
        while True:
            answer = client.get_shell_msg(timeout=60)
            if answer["parent_header"]["msg_id"] == asked:
                break
        assert answer["content"]["ename"] == "KeyboardInterrupt"
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)
