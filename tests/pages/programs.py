# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The programs' own descriptions."""
import functools
import re
import subprocess


@functools.lru_cache(maxsize=None)
def help_of(build, program):
    """The program's --help in two parts: up to its examples, and the examples."""
    text = subprocess.run([build / "demos" / program, "--help"], check=True, capture_output=True, text=True).stdout
    options, separator, end = text.partition("\nExamples:\n")
    if not separator:
        raise SystemExit(f"{program} --help has no examples")
    return options, end


def options(build, program):
    return set(re.findall(r"--[a-z][\w-]*", help_of(build, program)[0]))


def examples(build, program):
    return re.findall(rf"^  ({program}\b.*)$", help_of(build, program)[1], re.MULTILINE)
