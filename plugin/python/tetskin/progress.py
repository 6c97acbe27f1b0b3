# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The bar that `progress=True` prints."""
import sys
import time

_WIDTH = 30
_SECONDS = 0.1


class Bar:
    """A plain text bar on the standard output, which terminals and notebooks redraw in place."""

    def __init__(self, what: str) -> None:
        """what: the task, in a word."""
        self._what = what
        self._next = 0.0
        self._ended = False

    def __call__(self, fraction: float) -> None:
        """fraction: 0 to 1. Prints ten times a second, and at the end."""
        now = time.monotonic()
        ends = fraction >= 1.0
        if self._ended or (now < self._next and not ends):
            return
        self._next, self._ended = now + _SECONDS, ends
        full = int(_WIDTH * min(fraction, 1.0))
        bar = "#" * full + "." * (_WIDTH - full)
        print(f"\r{self._what} [{bar}] {100 * fraction:3.0f} %", end="\n" if ends else "", file=sys.stdout, flush=True)
