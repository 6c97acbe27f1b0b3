#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""What `tests/run --change` tests with sanitizers and clang-tidy: what differs from the commit at which `tests/run --all`
last passed, and what uses it.

selection.py select BUILD              writes BUILD/changes/ and prints it in words
selection.py record COMMIT MINUTES [MORE]
                                       notes that everything passed, in tests/last_full_run: the commit, which must
                                       still be what is checked out, the day, the machine, the minutes, and MORE, such
                                       as the instruction sets that were not tested

BUILD is configured with an (empty) file BUILD/.cmake/api/v1/query/codemodel-v2: which file belongs to which target, and
which target uses which, is then what CMake says. In BUILD/changes:
  everything   only if all counts as changed: why
  tests        the folders of tests/ whose tests are run with sanitizers, separated by semicolons
  sources      the library's files that have changed, one per line
"""
import datetime
import json
import os
import platform
import re
import shutil
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
LAST = "tests/last_full_run"
# Files that are not compiled, and that --change tests in full, as it does pages, style and plots.
READ = re.compile(r"[.](md|csv|png|svg|jpg|html|js|css|py)$|^(LICENSE|[.]gitignore|[.]editorconfig|tests/pages/.*[.]txt)$")
# What makes the tests that --change runs in part or not at all: if it has changed, anything may have.
MACHINERY = re.compile(r"^([.]ci|tests/(tiers|fuzz|consumer|platforms))/|^demos/(setup[.]sh|run)$|^tests/run$|"
                       r"^tests/style/(tidy|alone)[.]py$|[.]cmake([.]in)?$|"
                       r"^((plugin/|tests/|demos/)?CMakeLists[.]txt|CMakePresets[.]json|[.]clang-tidy|[.]clang-format)$")
COMPILED = {"STATIC_LIBRARY", "SHARED_LIBRARY", "MODULE_LIBRARY", "OBJECT_LIBRARY", "EXECUTABLE"}


def fail(message):
    print(message, file=sys.stderr)
    sys.exit(2)


def git(*arguments):
    """The output of a command of git. Exits where there is no git, or this is no repository."""
    try:
        done = subprocess.run(["git", *arguments], cwd=REPOSITORY, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        fail("tests/run --change compares with an earlier commit, and needs git: install it, or run tests/run --all")
    if done.returncode != 0:
        fail(f"git {' '.join(arguments)}: {done.stderr.strip()}\n"
                 "tests/run --change compares with an earlier commit of the repository; tests/run --all does not")
    return done.stdout


def in_history(commit):
    """Whether HEAD came from this commit."""
    return subprocess.run(["git", "merge-base", "--is-ancestor", commit, "HEAD"], cwd=REPOSITORY, capture_output=True,
                          check=False).returncode == 0


def last_full_run():
    """The commit at which everything last passed, or None; and why there is none."""
    path = REPOSITORY / LAST
    if not path.exists():
        return None, f"there is no {LAST}: tests/run --all has not passed yet"
    found = re.search(r"^commit +([0-9a-f]{40})$", path.read_text(encoding="utf-8"), re.M)
    if not found:
        fail(f"{LAST}: no line 'commit' with 40 hexadecimal digits; run tests/run --all, which writes this file, or "
                 f"delete it: then everything is tested")
    git("rev-parse", "HEAD")
    if not in_history(found[1]):
        return None, f"commit {found[1][:12]}, at which tests/run --all last passed, is not in the history of this one"
    return found[1], ""


def changed_since(commit):
    """Paths that differ between the commit and the files as they are now, new ones included."""
    names = git("diff", "--name-only", "--no-renames", "-z", commit)
    names += git("ls-files", "--others", "--exclude-standard", "-z")
    return sorted(set(filter(None, names.split("\0"))) - {LAST})


class Graph:
    """CMake's own: files, targets, folders, and who uses whom."""

    def __init__(self, build):
        reply = build / ".cmake/api/v1/reply"
        indices = sorted(reply.glob("index-*.json"))
        if not indices:
            fail(f"{reply}: CMake has not written what it knows: configure {build} again")
        index = json.loads(indices[-1].read_text(encoding="utf-8"))
        model = json.loads((reply / index["reply"]["codemodel-v2"]["jsonFile"]).read_text(encoding="utf-8"))
        source = Path(model["paths"]["source"])
        if source.resolve() != REPOSITORY:
            fail(f"{build} was configured for {source}, not for {REPOSITORY}")
        self.folder, self.users, self.owners, by_id = {}, {}, {}, {}
        targets = [json.loads((reply / entry["jsonFile"]).read_text(encoding="utf-8"))
                   for entry in model["configurations"][0]["targets"]]
        for target in targets:
            by_id[target["id"]] = target["name"]
        for target in targets:
            name = target["name"]
            if target["type"] in COMPILED:
                self.folder[name] = target["paths"]["source"]
            for one in target.get("sources", []):
                if target["type"] in COMPILED and not one.get("isGenerated"):
                    self.owners.setdefault(one["path"], set()).add(name)
            for used in target.get("dependencies", []):
                self.users.setdefault(by_id[used["id"]], set()).add(name)

    def targets_of(self, file):
        """The targets that compile a file; if none lists it, those of the nearest folder that has any."""
        if file in self.owners:
            return self.owners[file]
        folder = os.path.dirname(file)
        while folder:
            found = {name for name, own in self.folder.items() if own == folder}
            if found:
                return found
            folder = os.path.dirname(folder)
        return set()

    def with_users(self, names):
        found, left = set(), list(names)
        while left:
            name = left.pop()
            if name not in found:
                found.add(name)
                left += self.users.get(name, ())
        return found

    def test_folders(self, names):
        """The folders of tests/ that test a library of their name with one of these targets."""
        folders = {self.folder[name] for name in names if name in self.folder}
        libraries = {folder[len("plugin/tetskin/"):] for folder in self.folder.values()}
        tests = {folder[len("tests/"):] for folder in folders if folder.startswith("tests/")}
        return sorted(tests & libraries)


def selected(graph, files):
    """The targets that changed, by file; or why everything counts as changed."""
    changed = {}
    for file in files:
        if MACHINERY.search(file):
            return {}, f"{file} has changed, on which all tests depend"
        if READ.search(file) and file not in graph.owners:
            continue
        changed[file] = graph.targets_of(file)
        if not changed[file]:
            return {}, f"{file} has changed, which belongs to no target"
    return changed, ""


def is_library_source(file):
    return file.startswith("plugin/tetskin/") and file.endswith((".h", ".cpp")) and (REPOSITORY / file).exists()


def write(build, everything, folders, sources):
    out = build / "changes"
    out.mkdir(parents=True, exist_ok=True)
    (out / "everything").unlink(missing_ok=True)
    if everything:
        (out / "everything").write_text(everything + "\n", encoding="utf-8")
    (out / "tests").write_text(";".join(folders), encoding="utf-8")
    (out / "sources").write_text("".join(f"{file}\n" for file in sources), encoding="utf-8")


def select(build):
    commit, why = last_full_run()
    if commit is None:
        write(build, why, [], [])
        print(f"Everything counts as changed: {why}.")
        return
    graph, files = Graph(build), changed_since(commit)
    changed, why = selected(graph, files)
    if why:
        write(build, why, [], [])
        print(f"Everything counts as changed since {commit[:12]}: {why}.")
        return
    own = set().union(*changed.values()) if changed else set()
    everyone = graph.with_users(own)
    folders = graph.test_folders(everyone)
    sources = [file for file in files if is_library_source(file)]
    write(build, "", folders, sources)
    print(f"Since {commit[:12]}, at which everything passed, {len(files)} files have changed.")
    if not changed:
        print("None of them is compiled.")
        return
    print("changed targets:       " + ", ".join(sorted(own)))
    print("what uses them:        " + (", ".join(sorted(everyone - own)) or "nothing"))
    print("tests with sanitizers: " + (", ".join(folders) or "none"))
    print(f"files for clang-tidy:  {len(sources)}")


def processor():
    """The processor's name, as the system gives it."""
    try:
        found = re.search(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.M)
    except OSError:
        found = None
    return found[1].strip() if found else platform.machine()


def why_not_noted(commit):
    """Why a pass does not say anything about this commit; empty if it does."""
    if not shutil.which("git") or not (REPOSITORY / ".git").exists():
        return "this is no repository of git"
    if git("rev-parse", "HEAD").strip() != commit:
        return "another commit was checked out meanwhile"
    dirty = [line[3:] for line in git("status", "--porcelain").splitlines() if line[3:] != LAST]
    return f"there are changes that are not committed: {', '.join(dirty[:5])}" if dirty else ""


def record(commit, minutes, more):
    why = why_not_noted(commit)
    if why:
        print(f"\nNot noted in {LAST}: {why}")
        return
    text = ("# Written by tests/run --all, which passed at this commit. tests/run --change tests what differs from it.\n"
            f"commit   {commit}\n"
            f"date     {datetime.date.today().isoformat()}\n"
            f"machine  {processor()}, {os.cpu_count()} processors{', ' + more if more else ''}\n"
            f"minutes  {minutes}\n")
    (REPOSITORY / LAST).write_text(text, encoding="utf-8")
    print(f"\nNoted in {LAST}: commit it, and tests/run --change starts from here.")


def main():
    if len(sys.argv) == 3 and sys.argv[1] == "select":
        select(Path(sys.argv[2]).resolve())
    elif len(sys.argv) in (4, 5) and sys.argv[1] == "record":
        record(sys.argv[2], sys.argv[3], sys.argv[4] if len(sys.argv) == 5 else "")
    else:
        fail(__doc__)


if __name__ == "__main__":
    main()
