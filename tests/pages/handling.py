# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Reads commands.txt, which says how the tests treat certain commands."""
import fnmatch
import re
from pathlib import Path

LIST = Path(__file__).with_name("commands.txt")


class Handling:
    def __init__(self):
        lines = LIST.read_text().splitlines()
        rows = [re.split(r" {2,}", line, maxsplit=2) for line in lines if line and not line.startswith("#")]
        unclear = [row for row in rows if len(row) < 3 or row[0] not in ("leave_out", "shorten", "option")]
        if unclear:
            raise SystemExit(f"{LIST.name}: unclear: {unclear[0]}")
        self.rows = [tuple(row) for row in rows]
        self.used = set()

    def _matching(self, kind, text):
        rows = [row for row in self.rows if row[0] == kind and fnmatch.fnmatchcase(text, row[1])]
        self.used.update(rows)
        return rows

    def left_out(self, command):
        """Why the command is not run; empty if it is run."""
        return " ".join(why for _, _, why in self._matching("leave_out", plain(command)))

    def extra(self, command):
        """Arguments that are added after the command's own."""
        return " ".join(arguments for _, _, arguments in self._matching("shorten", plain(command)))

    def is_known_option(self, option):
        return bool(self._matching("option", option))

    def unused(self):
        return [row for row in self.rows if row not in self.used]


def plain(command):
    """The command without the program's folder."""
    return re.sub(r"^(\./)?build/demos/", "", command)
