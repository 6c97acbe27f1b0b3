# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Shows worlds in a notebook, or as a page: one HTML file that any browser opens without a network."""
from __future__ import annotations

import html as _html
import os
from pathlib import Path
from typing import Callable

from ._core import Body, PageWriter, World

_FOLDER = Path(__file__).with_name("view")
_FRAME = (
    '<div><iframe srcdoc="{}" width="100%" height="{}" style="border: 0" allow="fullscreen" '
    'title="tetskin"></iframe></div>'
)


class Film:
    """A run of a world, shown in a notebook or as a page.

        film = ts.Film(world)
        for frame in range(240):
            world.step(1/60)
            film.add_frame()
        film.show()                 # or film.save("drop.html")

    The first frame decides what is shown: the surfaces of all soft bodies, rigid bodies that move, and fixed ones where
    they are in that frame. Objects added later are not shown. A frame takes 8 bytes of the page for each node of a
    cage, and none for vertices: the page skins. If frames would take more than 16 MB, the page has every second one, or
    every fourth, and so on, and moves from one to the next. The world's gravity defines what is up.
    """

    def __init__(self, world: World, *, frames_per_second: float = 60.0, title: str = "") -> None:
        """frames_per_second: per second of simulated time, for playback; title: shown above the scene."""
        self._writer = PageWriter(world, frames_per_second=frames_per_second, title=title)

    def __len__(self) -> int:
        """Number of frames added."""
        return self._writer.frame_count

    def __repr__(self) -> str:
        return f"<tetskin.Film: {len(self)} frame{'s' * (len(self) != 1)}>"

    def add_frame(self) -> None:
        """Adds the world's current state. Raises an Error, and adds nothing, if something shown was removed or
        exploded."""
        self._writer.add_frame()

    def html(self) -> str:
        """The page: about 1 MB plus meshes and frames."""
        return _page_of(self._writer)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page."""
        _write(path, self.html())

    def show(self, *, height: int = 480) -> None:
        """Plays the film in a notebook, which keeps the page. height: pixels. Needs IPython; elsewhere: save."""
        _display(self.html, height, "save(path)")


def has_three() -> bool:
    """Whether the package was built with three.js: without it, pages cannot be made."""
    return all((_FOLDER / name).exists() for name in ("three.min.js", "OrbitControls.js"))


def _page_of(writer: PageWriter) -> str:
    if not has_three():
        raise RuntimeError(
            "this package was built without three.js: pages cannot be made. Install three.js (Debian, Ubuntu: "
            "libjs-three), and build the package again"
        )
    return writer.html(os.fspath(_FOLDER))


def _write(path: str | os.PathLike[str], page: str) -> None:
    """Complete or not at all."""
    path = Path(path)
    beside = path.with_name(path.name + ".part")
    try:
        beside.write_text(page, encoding="utf-8", newline="\n")
        os.replace(beside, path)
    except OSError:
        beside.unlink(missing_ok=True)
        raise


def _display(make_page: Callable[[], str], height: int, instead: str) -> None:
    if not 50 <= height <= 10000:
        raise ValueError("height: must be from 50 to 10000 pixels")
    try:
        from IPython import get_ipython
        from IPython.display import HTML, display
    except ImportError:
        raise ModuleNotFoundError(
            f"show() draws in a notebook, and needs IPython: pip install ipykernel. Elsewhere, {instead} writes the "
            "page as a file, which any browser opens"
        ) from None
    if get_ipython() is None:
        raise RuntimeError(
            f"show() draws in a notebook, and here is none: {instead} writes the page as a file, which any browser "
            "opens"
        )
    display(HTML(frame(make_page(), height)))


def frame(page: str, height: int = 480) -> str:
    """HTML of a frame that holds a page, for viewers of HTML such as notebooks and reports. height: pixels."""
    return _FRAME.format(_html.escape(page), height)


def _now(world: World, body: Body | None) -> str:
    writer = PageWriter(world, body)
    writer.add_frame()
    return _page_of(writer)


def show_world(world: World, body: Body | None = None, *, height: int = 480) -> None:
    """World.show and Body.show."""
    _display(lambda: _now(world, body), height, "save_page(path)")


def save_world(world: World, path: str | os.PathLike[str], body: Body | None = None) -> None:
    """World.save_page and Body.save_page."""
    _write(path, _now(world, body))
