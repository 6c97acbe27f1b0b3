#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""same_object.py BUILD COMPILER ARGUMENTS...: a compiler launcher for builds that compile what another one, in the
folder BUILD, has compiled already. Copies that build's object if the same compiler made it by the same options of the
same text; otherwise compiles, by ccache if there is one.

The text is what the preprocessor makes of the source, without the places that it comes from: by these, a compiler cache
takes the same text in another folder for another one. Options that only the preprocessor reads are in the text. BUILD
has a compile_commands.json. With options for debugging, which put places into the object, everything is compiled."""
import json
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

WITH_VALUE = ("-isystem", "-I", "-D", "-U", "-include", "-MF", "-MT", "-MQ", "-o", "-c", "-iquote", "--param")
NO_DIFFERENCE = ("-Werror", "-MD", "-MMD", "-Winvalid-pch")


class Command:
    """Of a compiler: its words, and what it makes of which source."""

    def __init__(self, words, folder):
        self.folder, self.values, self.compiles, self.words = Path(folder), {}, [], []
        words = list(words)
        while Path(words[0]).name == "ccache":
            words.pop(0)
        self.compiler = words[0]
        rest = iter(words[1:])
        for word in rest:
            if word in WITH_VALUE:
                value = next(rest, "")
                self.values[word] = value
                if word not in ("-MF", "-MT", "-MQ", "-o", "-c"):
                    self.words += [word, value]
                if word == "--param" and not value.startswith("ggc-"):  # the compiler's own memory
                    self.compiles += [word, value]
            elif word not in NO_DIFFERENCE:
                self.words.append(word)
                if not word.startswith(("-D", "-I", "-U", "-isystem")):
                    self.compiles.append(word)

    def output(self):
        return self.folder / self.values.get("-o", "")

    def name(self):
        """What CMake calls the object in any build: <target>.dir/<source>.o."""
        return str(self.output()).rpartition("/CMakeFiles/")[2]

    def text(self, dependencies=None):
        """What the preprocessor makes of the source; None if it fails. Writes the file of what it has read."""
        more = ["-MD", "-MF", dependencies, "-MT", self.values["-o"]] if dependencies else []
        done = subprocess.run([self.compiler, *self.words, *more, "-E", "-P", self.values["-c"]], cwd=self.folder,
                              capture_output=True, check=False)
        return done.stdout if done.returncode == 0 else None


def read_files(dependencies, folder):
    words = Path(folder, dependencies).read_text(encoding="utf-8").replace("\\\n", " ").split()
    return [Path(folder, word) for word in words[1:]]


def copied(build, own):
    """Whether the other build's object has been put where this one is wanted."""
    listed = Path(build) / "compile_commands.json"
    if not ("-c" in own.values and "-MF" in own.values and listed.exists()) or any(
            word.startswith("-g") for word in own.compiles):
        return False
    for entry in json.loads(listed.read_text(encoding="utf-8")):
        if own.name().partition("/")[0] in entry["command"]:
            other = Command(shlex.split(entry["command"]), entry["directory"])
            if other.name() == own.name():
                break
    else:
        return False
    if (other.compiler, other.compiles) != (own.compiler, own.compiles) or not other.output().exists():
        return False
    text = own.text(own.values["-MF"])
    if text is None or text != other.text():
        return False
    made = other.output().stat().st_mtime
    if any(file.stat().st_mtime > made for file in read_files(own.values["-MF"], own.folder)
           if "CMakeFiles" not in file.parts):
        return False  # that build has not been brought up to date
    shutil.copyfile(other.output(), own.output())
    return True


def main():
    build, words = sys.argv[1], sys.argv[2:]
    if not copied(build, Command(words, os.getcwd())):
        cache = [shutil.which("ccache")] if shutil.which("ccache") else []
        os.execvp((cache + words)[0], cache + words)


if __name__ == "__main__":
    main()
