#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""lines.py [--release NUMBER]: prints the lines of code of each library, of the packages, the demos and the tests,
compared with the last release in lines.txt. Lines that are empty or only a comment do not count.

A row there with several names, joined by +, was one folder, which has been split since: its lines are compared with
their sum. With --release, before a release, rewrites lines.txt. Fails only where lines.txt does not name what there is:
how many lines a feature is worth is for people to say."""
import re
import subprocess
import sys
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
NOTED = Path(__file__).with_name("lines.txt")
KINDS = {".cpp", ".h", ".py", ".js", ".mjs", ".ts", ".cmake", ".sh", ".html", ".css"}
OTHERS = ("plugin/facade", "plugin/python", "plugin/js", "demos", "tests")


def is_script(file):
    return not file.suffix and file.open("rb").read(2) == b"#!"


def code_in(text, suffix):
    """The number of lines that are neither empty nor part of a comment. A string of Python's that is a statement is a
    comment."""
    if suffix in (".py", ".cmake", ".sh", ""):
        text = re.sub(r'^\s*r?"""(.|\n)*?"""', "", text, flags=re.M) if suffix == ".py" else text
        comment = re.compile(r"\s*(#|$)")
    else:
        text = re.sub(r"^\s*(/\*(.|\n)*?\*/|<!--(.|\n)*?-->)", "", text, flags=re.M)
        comment = re.compile(r"\s*(//|$)")
    return sum(not comment.match(line) for line in text.split("\n"))


def counted():
    """Lines by folder, of the files that git has or would have."""
    listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "plugin", "demos", "tests"]
    try:
        names = subprocess.run(listed, cwd=SOURCE, check=True, capture_output=True, text=True).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"not counted: git does not list the files ({error})")
        sys.exit(77)
    lines = {}
    for name in set(filter(None, names.split("\0"))):
        file = SOURCE / name
        library = re.match(r"plugin/tetskin/[^/]+(?=/)", name)
        folder = library[0] if library else next((other for other in OTHERS if name.startswith(other + "/")), None)
        if folder and file.is_file() and (file.suffix in KINDS or file.name == "CMakeLists.txt" or is_script(file)):
            kind = ".cmake" if file.name == "CMakeLists.txt" else file.suffix
            lines[folder] = lines.get(folder, 0) + code_in(file.read_text(encoding="utf-8"), kind)
    return lines


def noted():
    """The release, and its lines by folder."""
    rows = [line.split() for line in NOTED.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return rows[0][1], {folder: int(lines) for folder, lines in rows[1:]}


def folders_of(name):
    """The folders of a row in lines.txt."""
    above, _, last = name.rpartition("/")
    return [f"{above}/{one}" if above else one for one in last.split("+")]


def check_itself():
    for text, suffix, wanted in (("int f();\n\n// why\nint g(); // what\n", ".h", 2), ("/* a\nb */\nint f();\n", ".cpp", 1),
                                 ('"""A\nB"""\nimport os\n# why\nos.x("""\n""")\n', ".py", 3), ("set -eu\n# why\n", "", 1)):
        if code_in(text, suffix) != wanted:
            sys.exit(f"This counts {code_in(text, suffix)} lines of code, not {wanted}, in\n{text}")


def main():
    check_itself()
    now = counted()
    if sys.argv[1:2] == ["--release"] and len(sys.argv) == 3:
        NOTED.write_text("# Lines of code of the last release, by tests/style/lines.py --release NUMBER.\n"
                         f"release {sys.argv[2]}\n" + "".join(f"{folder} {now[folder]}\n" for folder in sorted(now)),
                         encoding="utf-8")
    elif sys.argv[1:]:
        sys.exit(__doc__)
    release, before = noted()
    libraries = [folder for folder in now if folder.startswith("plugin/tetskin/")]
    rows = {name: folders_of(name) for name in before}
    known = {folder for folders in rows.values() for folder in folders}
    rows.update({folder: [folder] for folder in now if folder not in known})
    print(f"{'lines of code':38}{release:>8}{'now':>8}")
    then, here = (sum(lines for name, lines in one.items() if name.startswith("plugin/tetskin/")) for one in (before, now))
    print(f"{'the library':38}{then:8}{here:8}{here - then:+8}")
    for name, folders in sorted(rows.items()):
        then, here = before.get(name, 0), sum(now.get(folder, 0) for folder in folders)
        print(f"{name:38}{then:8}{here:8}{here - then:+8}")
        for folder in folders if len(folders) > 1 else []:
            print(f"  {folder:36}{'':8}{now.get(folder, 0):8}")
    unknown = sorted(known - set(now))
    if len(libraries) < 5 or unknown:
        sys.exit(f"{NOTED.name} and the repository do not name the same folders: {', '.join(unknown)}; take the rows of what has gone out")


if __name__ == "__main__":
    main()
