#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""alone.py BUILD_FOLDER [--compiler CLANG] [FILE... | --files LIST]: checks that each source and each header of the
library compiles by itself, not only after the files that a unity build puts before it. Uses the compile commands of a
build without unity; checks only FILE..., or those named in LIST, one per line, and those that include them, if any are
named.

Clang, if it is given, takes a third of GCC's time, and also finds constants and functions that nothing uses. Both have
the same standard library, so an include that is missing is missing for both. Eigen is precompiled, except for public
headers: it takes most of the time, and everything includes it through core's types."""
import concurrent.futures
import json
import pathlib
import shlex
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
LIBRARY = SOURCE / "plugin" / "tetskin"
EIGEN = "#include <Eigen/Core>\n#include <Eigen/Geometry>\n"
# What clang says of the file that it compiles only: for joined sources, it is silent.
CLANGS = ["-Wno-everything", "-Werror=unused-const-variable", "-Werror=unneeded-internal-declaration"]


def options_of(entry, compiler):
    """The compiler, that of the entry unless one is given, and the options that affect whether a file compiles."""
    words = shlex.split(entry["command"])
    kept = [w for w in words[1:] if w.startswith(("-D", "-I", "-m", "-f", "-std")) and w != "-fPIC"]
    for place, word in enumerate(words):
        if word == "-isystem":
            kept += words[place:place + 2]
    program = compiler or next(word for word in words if not word.endswith("ccache"))
    return [program, "-std=c++17"] + kept + (CLANGS if compiler else ["-w"])


def kind_of(options):
    """The options with which a precompiled header must have been made: without the macros of single parts."""
    return tuple(option for option in options if option.startswith(("-m", "-f")) or
                 (option.startswith("-D") and not option.startswith("-DTETSKIN")))


def precompile(options, folder):
    """Eigen, for sources of these options."""
    folder.mkdir(parents=True, exist_ok=True)
    header = folder / "eigen.h"
    header.write_text(EIGEN, encoding="utf-8")
    # Only macros that are defined for everything: others are defined for some files and not for others.
    options = [option for option in options if not option.startswith("-DTETSKIN")]
    subprocess.run(options + ["-x", "c++-header", str(header), "-o", str(header) + ".gch"], check=True)
    return ["-include", str(header)]


def is_public(file):
    return file.suffix == ".h" and "src" not in file.relative_to(LIBRARY).parts


def compile_alone(options, file):
    """The compiler's errors, if any. A source's own header comes first, so that it is checked by itself as well."""
    header = file.with_suffix(".h") if file.suffix == ".cpp" else file
    first = ["-include", str(header)] if header.exists() and (header == file or not is_public(header)) else []
    main = ["-x", "c++", "/dev/null"] if header == file else [str(file)]
    done = subprocess.run(options + first + ["-fsyntax-only"] + main, capture_output=True, text=True, check=False)
    return done.stderr if done.returncode else ""


def including(names):
    """The library's files that include one of these headers: what they need may have come from it."""
    lines = [f"#include <{pathlib.Path(name).relative_to('plugin')}>" for name in names if name.endswith(".h")]
    files = [*LIBRARY.rglob("*.h"), *LIBRARY.rglob("*.cpp")]
    return [str(file) for file in files if any(line in file.read_text(encoding="utf-8") for line in lines)]


def main():
    build = pathlib.Path(sys.argv[1])
    names, compiler = sys.argv[2:], None
    if names[:1] == ["--compiler"]:
        compiler, names = names[1], names[2:]
    if len(names) == 2 and names[0] == "--files":
        names = pathlib.Path(names[1]).read_text(encoding="utf-8").splitlines()
        if not names:
            sys.exit("The list of files is empty")
        names += including(names)
    wanted = {pathlib.Path(name).resolve() for name in names}
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    options = {pathlib.Path(e["file"]): options_of(e, compiler) for e in entries
               if LIBRARY in pathlib.Path(e["file"]).parents}
    plain = {}  # by library: the options with which its headers are compiled
    for file, own in options.items():
        library = file.relative_to(LIBRARY).parts[0]
        if not any(option.startswith("-m") for option in own):
            plain.setdefault(library, own)
    # Headers, and sources that another configuration compiles (without Assimp): like the other sources of their
    # library.
    for file in [*sorted(LIBRARY.rglob("*.h")), *sorted(LIBRARY.rglob("*.cpp"))]:
        library = file.relative_to(LIBRARY).parts[0]
        options.setdefault(file, plain.get(library, plain["bullet"]))  # tetskin.h, export.h: with a user's options
    # Two kinds, as elastic's Eigen has another name. Kernels of other processors are few, and read Eigen themselves.
    eigen = {kind_of(plain[name]): precompile(plain[name], build / "alone" / name) for name in ("bullet", "elastic")}
    if not wanted and len(options) < 300:
        sys.exit(f"Only {len(options)} files found: look for them elsewhere")

    def check(file):
        return compile_alone(options[file] + ([] if is_public(file) else eigen.get(kind_of(options[file]), [])), file)

    unknown = sorted(str(file) for file in wanted if file not in options)
    if unknown:
        sys.exit(f"{build} does not compile {', '.join(unknown)}")
    files = sorted(wanted or options)
    with_source = {file.with_suffix(".h") for file in files if file.suffix == ".cpp"}
    files = [file for file in files if is_public(file) or file not in with_source]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        faults = [(file, said) for file, said in zip(files, pool.map(check, files)) if said]
    for file, said in faults:
        print(f"{file.relative_to(SOURCE)} does not compile by itself:\n{said}")
    print(f"{len(files) - len(faults)} of {len(files)} files, {len(options)} with their headers, compile by themselves")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
