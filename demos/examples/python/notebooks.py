#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Makes the notebooks of the demos from their scripts, runs them, and keeps their texts and small pictures.

    python demos/examples/python/notebooks.py [NAME ...]

In a script, `# %%` begins a cell of code, and `# %% [markdown]` one of text, in comments. A line after `#: ` is code of
the notebook alone, which has no command line: its options are the defaults. The pages that a notebook draws when it is
run are left out of what is kept, as one of them is larger than all the repository's notebooks. Needs nbclient and
ipykernel.
"""
from __future__ import annotations

import re
import sys
import tempfile
from pathlib import Path

import nbformat

FOLDER = Path(__file__).parent
SCRIPTS = ["drop", "gripper"]
"""The demos that are also notebooks."""
LARGEST = 200_000
"""Bytes of a notebook that is kept."""
_CELL = re.compile(r"^# %%(.*)\n", re.MULTILINE)


def notebook_of(name: str, arguments: tuple[str, ...] = ()) -> nbformat.NotebookNode:
    """The notebook of a script, not yet run. arguments: for its options."""
    text = (FOLDER / f"{name}.py").read_text()
    _, *parts = _CELL.split(text)
    cells = []
    for kind, source in zip(parts[::2], parts[1::2]):
        if kind.strip() == "[markdown]":
            words = "\n".join(line.removeprefix("#").removeprefix(" ") for line in source.strip().splitlines())
            cells.append(nbformat.v4.new_markdown_cell(words))
        else:
            source = source.replace("parser.parse_args()", f"parser.parse_args({list(arguments)!r})")
            cells.append(nbformat.v4.new_code_cell(re.sub(r"^( *)#: ", r"\1", source, flags=re.MULTILINE).strip()))
    for number, cell in enumerate(cells):
        cell["id"] = f"{name}-{number}"
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    told = {"kernelspec": kernel, "language_info": {"name": "python"}}
    notebook: nbformat.NotebookNode = nbformat.v4.new_notebook(cells=cells, metadata=told)
    return notebook


def run(notebook: nbformat.NotebookNode, folder: Path, timeout: int = 300) -> None:
    """Runs it in a folder, to which it writes. Raises what nbclient does when a cell fails."""
    from nbclient import NotebookClient

    NotebookClient(notebook, timeout=timeout, resources={"metadata": {"path": str(folder)}}).execute()


def kept(notebook: nbformat.NotebookNode) -> nbformat.NotebookNode:
    """Without data that differs from run to run for no reason, and without pages."""
    for cell in notebook.cells:
        cell.metadata.clear()
        outputs = cell.get("outputs", [])
        for output in outputs:
            output.get("data", {}).pop("text/html", None)
            if output.output_type == "stream":  # of a bar, the last state
                output.text = re.sub(r"[^\n]*\r", "", output.text)
        if cell.cell_type == "code":
            cell["outputs"] = [o for o in outputs if "data" not in o or "image/png" in o.data]
    return notebook


def main(names: list[str]) -> None:
    unknown = [name for name in names if name not in SCRIPTS]
    if unknown:
        sys.exit(f"no demo {unknown[0]}: there are {', '.join(SCRIPTS)}")
    for name in names or SCRIPTS:
        notebook = notebook_of(name)
        with tempfile.TemporaryDirectory() as folder:
            run(notebook, Path(folder))
        text = nbformat.writes(kept(notebook)) + "\n"
        if len(text) > LARGEST:
            sys.exit(f"{name}.ipynb would have {len(text)} bytes, more than {LARGEST}: make its pictures smaller")
        (FOLDER / f"{name}.ipynb").write_text(text)
        print(f"{name}.ipynb: {len(text)} bytes")


if __name__ == "__main__":
    main(sys.argv[1:])
