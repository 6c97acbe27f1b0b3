#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""same_object.py BUILD COMPILER ARGUMENTS...: a compiler launcher that reuses objects of another build, in the folder
BUILD. Copies that build's object if the same compiler made it with the same options from the same text; otherwise
compiles, with ccache if available.

The text is the preprocessed source without the names of its files. A compiler cache includes these names, and so treats
the same text in another folder as different. Options that only the preprocessor reads are contained in the text. BUILD
was made by Ninja, which has recorded what each object depends on, and has a compile_commands.json. With debug options,
which put paths into the object, everything is compiled."""
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
    """A compiler's command line: its words, and which object it makes from which source."""

    def __init__(self, words, folder):
        self.folder, self.values, self.compiles, self.words = Path(folder), {}, [], []
        words = list(words)
        launcher = next((k for k, word in enumerate(words) if Path(word).name == "same_object.py"), None)
        if launcher is not None:
            words = words[launcher + 2:]
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

    def program(self):
        """The compiler's real path; it may have several names, such as c++ and g++."""
        return os.path.realpath(shutil.which(self.compiler) or self.compiler)

    def output(self):
        return self.folder / self.values.get("-o", "")

    def name(self):
        """CMake's name for the object in any build: <target>.dir/<source>.o."""
        return str(self.output()).rpartition("/CMakeFiles/")[2]

    def text(self, dependencies=None):
        """The preprocessed source; None if it fails. Writes the dependency file."""
        more = ["-MD", "-MF", dependencies, "-MT", self.values["-o"]] if dependencies else []
        done = subprocess.run([self.compiler, *self.words, *more, "-E", "-P", self.values["-c"]], cwd=self.folder,
                              capture_output=True, check=False)
        return done.stdout if done.returncode == 0 else None


def is_current(build, other):
    """Whether Ninja would keep the other build's object: its command and all files that it has read are unchanged. Ninja
    does not check the time of the compiler."""
    ninja = shutil.which("ninja")
    if not (ninja and other.output().exists() and os.path.exists(other.program())):
        return False
    said = subprocess.run([ninja, "-C", str(build), "-n", other.values["-o"]], capture_output=True, text=True, check=False)
    is_made = said.returncode == 0 and said.stdout.splitlines()[-1:] == ["ninja: no work to do."]
    return is_made and os.stat(other.program()).st_ctime <= other.output().stat().st_mtime


def copied(build, own):
    """Copies the other build's object to the place of this one; returns whether it did."""
    build = Path(build)
    listed = build / "compile_commands.json"
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
    if other.program() != own.program() or other.compiles != own.compiles or other.output() == own.output():
        return False
    if not is_current(build, other):
        return False
    text = own.text(own.values["-MF"])
    if text is None or text != other.text():
        return False
    beside = f"{own.output()}.copy"
    shutil.copyfile(other.output(), beside)
    os.replace(beside, own.output())
    return True


def main():
    build, words = sys.argv[1], sys.argv[2:]
    try:
        done = copied(build, Command(words, os.getcwd()))
    except (OSError, ValueError, KeyError):  # takes nothing from a build in an unexpected state
        done = False
    if not done:
        cache = [shutil.which("ccache")] if shutil.which("ccache") else []
        os.execvp((cache + words)[0], cache + words)


if __name__ == "__main__":
    main()
