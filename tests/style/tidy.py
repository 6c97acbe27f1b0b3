#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""tidy.py CLANG_TIDY JOINED ALONE [--files LIST]: runs the checks of .clang-tidy on the library, two files at a time:
on what the build folder JOINED compiles, that is on many sources at once where it joins them by including them. Some
checks look only at the file that is compiled, and so see nothing in joined sources: these run on each source that has
anything for them, with the commands of ALONE, a build that does not join. With a LIST of files, one per line, only on
these, and on the sources that are joined with them. A header is checked as part of a source that includes it.

The build folders' compile commands are GCC's: its default C++ is 17, clang's is not, and it has other warnings."""
import concurrent.futures
import json
import re
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
LIBRARY = REPOSITORY / "plugin"
OPTIONS = ["--quiet", "--extra-arg=-std=c++17", "--extra-arg=-Wno-unknown-warning-option",
           "--extra-arg=-Wno-unused-command-line-argument"]
JOINED_CHECKS = "--checks=-bugprone-suspicious-include"
# Of all enabled checks, those that clang-tidy 14 does not apply to included files; and what they are about.
ALONE_CHECKS = "--checks=-*,misc-unused-using-decls,misc-unused-alias-decls,readability-redundant-preprocessor"
ALONE_SUBJECTS = re.compile(r"\busing\s+(?!namespace\b)[^=;]*;|\bnamespace\s+\w+\s*=|^\s*#\s*(el)?if", re.M)


def compiled(build):
    """By file that this build compiles for the library: the sources that it consists of."""
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    files = sorted({Path(entry["file"]) for entry in entries if "plugin" in Path(entry["file"]).parts})
    if not files:
        sys.exit(f"{build}: no compile commands of the library: look for them elsewhere")
    joined = {file: re.findall(r'^#include "(.*)"', file.read_text(encoding="utf-8"), re.M) for file in files
              if "Unity" in file.parts}
    return {file: {Path(name) for name in joined.get(file, [file])} for file in files}


def source_with(header, known):
    """A source that includes this header, directly or by other headers, that of its own name first; itself, if none."""
    left, seen = [header], set()
    while left:
        now = left.pop(0)
        if now.with_suffix(".cpp") in known:
            return now.with_suffix(".cpp")
        line = f"#include <{now.relative_to(LIBRARY)}>"
        users = [file for file in sorted(LIBRARY.rglob("*.h")) + sorted(known)
                 if file not in seen and line in file.read_text(encoding="utf-8")]
        source = next((file for file in users if file in known), None)
        if source:
            return source
        seen.update(users)
        left += users
    return header


def to_check(names, known):
    files = {REPOSITORY / name for name in names}
    return sorted({source_with(file, known) if file.suffix == ".h" else file for file in files
                   if file.suffix == ".h" or file in known})


def main():
    tidy, joined, alone = sys.argv[1], Path(sys.argv[2]).resolve(), Path(sys.argv[3]).resolve()
    units = compiled(joined)
    sources = set().union(*units.values())
    unknown = sorted(str(source) for source in sources - set(compiled(alone)))
    if unknown:
        sys.exit(f"{alone} does not compile {', '.join(unknown)}")
    if len(sys.argv) == 6 and sys.argv[4] == "--files":
        sources = set(to_check(Path(sys.argv[5]).read_text(encoding="utf-8").splitlines(), sources))
        if not sources:
            sys.exit(f"{sys.argv[5]} names no file of the library that is compiled here")
    elif len(sys.argv) != 4:
        sys.exit(__doc__)
    texts = {file: file.read_text(encoding="utf-8") for file in sources}
    # Otherwise one processor waits at the end.
    largest_first = sorted(units, key=lambda unit: -len(units[unit]))
    runs = [(unit, joined, JOINED_CHECKS) for unit in largest_first if units[unit] & sources]
    runs += [(file, alone, ALONE_CHECKS) for file in sorted(sources) if ALONE_SUBJECTS.search(texts[file])]

    def check(run):
        file, build, checks = run
        return subprocess.run([tidy, "-p", str(build), *OPTIONS, checks, str(file)], capture_output=True, text=True,
                              check=False)

    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        done = list(zip(runs, pool.map(check, runs)))
    faults = [(file, run) for (file, _, _), run in done if run.returncode != 0]
    for file, run in faults:
        print(f"{file}:\n{run.stdout}{run.stderr}")
    print(f"{len(sources)} sources, joined or alone: {len(done) - len(faults)} of {len(done)} files have no warnings")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
