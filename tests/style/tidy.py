#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""tidy.py CLANG_TIDY BUILD_FOLDER [--files LIST]: runs the checks of .clang-tidy on the library, two files at a time:
on what was compiled, that is on many files at once where the build joins them by including them; or only on the files
named in LIST, one per line, with the commands of a build that does not join them. A header is checked as part of a
source that includes it.

The build folder's compile commands are GCC's: its default C++ is 17, clang's is not, and it has other warnings."""
import concurrent.futures
import json
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
LIBRARY = REPOSITORY / "plugin"
OPTIONS = ["--quiet", "--checks=-bugprone-suspicious-include", "--extra-arg=-std=c++17",
           "--extra-arg=-Wno-unknown-warning-option", "--extra-arg=-Wno-unused-command-line-argument"]


def compiled(build):
    """The files of the library, or those that include them, that this build compiles."""
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    return sorted({Path(entry["file"]) for entry in entries if "plugin" in Path(entry["file"]).parts})


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
    tidy, build = sys.argv[1], Path(sys.argv[2]).resolve()
    files = compiled(build)
    if not files:
        sys.exit(f"{build}: no compile commands of the library: look for them elsewhere")
    if len(sys.argv) == 5 and sys.argv[3] == "--files":
        files = to_check(Path(sys.argv[4]).read_text(encoding="utf-8").splitlines(), set(files))
        if not files:
            sys.exit(f"{sys.argv[4]} names no file of the library that is compiled here")
    elif len(sys.argv) != 3:
        sys.exit(__doc__)

    def check(file):
        return subprocess.run([tidy, "-p", str(build), *OPTIONS, str(file)], capture_output=True, text=True, check=False)

    # The largest first: otherwise one processor waits at the end.
    files.sort(key=lambda file: -file.read_text(encoding="utf-8").count("#include"))
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        done = list(zip(files, pool.map(check, files)))
    faults = [(file, run) for file, run in done if run.returncode != 0]
    for file, run in faults:
        print(f"{file}:\n{run.stdout}{run.stderr}")
    print(f"{len(files) - len(faults)} of {len(files)} files have no warnings")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
