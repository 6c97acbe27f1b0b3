#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""What `tests/run --change` tests: with sanitizers and clang-tidy, what differs from the commit at which
`tests/run --all` last passed, and what uses it; which unit tests it leaves out; which tests of the bindings it runs.

selection.py select BUILD              writes BUILD/changes/ and prints it in words
selection.py start BUILD               before tests/run --all: what is tested, and whether it is a commit
selection.py record BUILD MINUTES LOG  after it has passed: notes in tests/last_full_run the commit, the day, the machine,
                                       the compiler, the minutes, and which tests ctest's LOG says were skipped

BUILD is configured with an (empty) file BUILD/.cmake/api/v1/query/codemodel-v2: which file belongs to which target, and
which target uses which, is then what CMake says. In BUILD/changes:
  everything   only if all is tested that tests/run --all tests, since no commit is known at which it passed: why
  tests        the folders of tests/ whose tests are run with sanitizers, separated by semicolons
  sources      the library's files that have changed, one per line; those that were removed are not among them
  page         only if the first page has changed, whose commands and programs are followed
  unaffected   the folders of tests/ whose programs are those that passed, separated by |; none, if anything has changed
               that is neither compiled nor a page
  python       only if the Python package, its demos or tests, or pages that they read have changed ("package"), or else
               the library that it is built from, or a page that its own tests read ("library")
  web          which tests of JavaScript are run, if any: "module", "page", and "scene", one scene of the page
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
READ = re.compile(r"[.](md|csv|png|svg|jpg|html|js|css)$|^(LICENSE|[.]gitignore|[.]editorconfig|tests/pages/.*[.]txt)$|"
                  r"^demos/lab/plots/.*[.]py$")
# What makes the tests with sanitizers and clang-tidy: if it has changed, all libraries count as changed. Of tests/, all but
# sources and the lists of those; and but what makes other tests only, which are run in full, or which tests/run --all
# alone runs.
ORDINARY_TEST = re.compile(r"^tests/[^/]+/([^/]+[.](cpp|h|js|md)|CMakeLists[.]txt)$|^tests/[^/]+[.]md$|^tests/pages/.*[.]txt$")
OTHER_TEST = re.compile(r"^tests/(consumer|platforms|fuzz|golden|glb|models|pages|clients)/|^tests/style/(?!alone|tidy)|"
                        r"^tests/coverage[.]py$|^plugin/packages/")
MACHINERY = re.compile(r"^([.]ci|tests/tiers)/|^demos/(setup[.]sh|run)$|[.]cmake([.]in)?$|"
                       r"^((plugin/|tests/|demos/)?CMakeLists[.]txt|CMakePresets[.]json|[.]clang-tidy|[.]clang-format)$")
PAGE = "README.md"
# The Python package and its demos, which are built and tested as a whole, by tests of their own; with what it shares
# with the module for JavaScript.
PYTHON = re.compile(r"^((plugin|demos/examples|tests)/python|demos/lab/peers|plugin/facade)/|"
                    r"^tests/platforms/common[.]sh$|^plugin/docs/(python|pybullet|many_runs)[.]md$")
# What builds or runs the package and the module for JavaScript.
BUILDS = r"(plugin/)?CMakeLists[.]txt|plugin/cmake/.*|demos/setup[.]sh|tests/(configurations[.]cmake|run)"
# What else is in the package or its tests: the library, what draws the package's pages, and peers.md, whose figures a
# test compares.
IN_PYTHON = re.compile(rf"^(plugin/tetskin/.*[.](cpp|h|txt)|demos/view/.*|plugin/docs/peers[.]md|{BUILDS})$")
# The module for JavaScript and the page that is made with it: these, too, have tests of their own.
WEB = re.compile(r"^(plugin/js|plugin/facade|demos/examples/live|tests/js|tests/live)/|^tests/platforms/common[.]sh$")
# What they share with others: Bullet and tinygltf by the Python package; scenes that are compiled into the page.
IN_WEB = re.compile(rf"^(plugin/python/(cmake/(bullet|tinygltf)[.]cmake|fetch_bullet|licences/.*)|demos/run|{BUILDS})$")
IN_PAGE = re.compile(r"^demos/(scenes/(serpent\w*|materials|angles)|view/view_page)[.](cpp|h)$")
OF_MODULE_ALONE = re.compile(r"^(tests/js/|plugin/js/README[.]md$|plugin/docs/javascript[.]md$)")
OF_PAGE_ALONE = re.compile(r"^(demos/examples/live/|tests/live/.*[.](py|js)$)")
COMPILED = {"STATIC_LIBRARY", "SHARED_LIBRARY", "MODULE_LIBRARY", "OBJECT_LIBRARY", "EXECUTABLE"}


def fail(message):
    print(message, file=sys.stderr)
    sys.exit(2)


def run_git(*arguments):
    return subprocess.run(["git", "-c", "core.fileMode=true", *arguments], cwd=REPOSITORY, capture_output=True, text=True,
                          check=False)


def git(*arguments):
    """The output of a command of git. Exits where there is no git, or this is no repository."""
    if not shutil.which("git"):
        fail("tests/run --change compares with an earlier commit, and needs git: install it, or run tests/run --all")
    done = run_git(*arguments)
    if done.returncode != 0:
        fail(f"git {' '.join(arguments)}: {done.stderr.strip()}\n"
             "tests/run --change compares with an earlier commit of the repository; tests/run --all does not")
    return done.stdout


def differing(commit):
    """Paths that differ between the commit and the files as they are now: new ones, too, also those that git ignores by
    a user's settings, but may be compiled."""
    names = git("diff", "--name-only", "--no-renames", "-z", commit)
    names += git("ls-files", "--others", "--exclude-standard", "-z")
    names += git("ls-files", "--others", "-z", "--", "plugin", "demos", "tests")
    return sorted(name for name in set(filter(None, names.split("\0"))) if name != LAST and "__pycache__/" not in name)


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
    if run_git("merge-base", "--is-ancestor", found[1], "HEAD").returncode != 0:
        shallow = git("rev-parse", "--is-shallow-repository").strip() == "true"
        return None, (f"commit {found[1][:12]}, at which tests/run --all last passed, is not in the history of this one" +
                      (", of which this clone has only a part" if shallow else ""))
    return found[1], ""


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
        """The targets that compile a file; if none lists it, those of the nearest folder that has any. A header of tests
        also belongs to the tests that include it, in whatever folder: these do not always list it."""
        if file.startswith("tests/") and file.endswith(".h"):
            return set().union(self.own_targets_of(file), *map(self.own_targets_of, tests_with(file)))
        return self.own_targets_of(file)

    def own_targets_of(self, file):
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


def tests_with(header):
    """The sources and headers of tests that include a header of this name, directly or by others."""
    texts = {path: path.read_text(encoding="utf-8") for path in (REPOSITORY / "tests").glob("*/*") if path.suffix in (".h", ".cpp")}
    found, left = set(), [Path(header).name]
    while left:
        include = re.compile(r'^#include ["<](.*/)?' + re.escape(left.pop()) + '[">]', re.M)
        users = {path for path, text in texts.items() if path not in found and include.search(text)}
        found |= users
        left += [path.name for path in users if path.suffix == ".h"]
    return {str(path.relative_to(REPOSITORY)) for path in found}


def selected(graph, files):
    """The targets that changed, by file; or why all libraries count as changed."""
    changed = {}
    for file in files:
        if file not in graph.owners and any(kind.search(file) for kind in (PYTHON, WEB, OTHER_TEST)):
            continue
        if MACHINERY.search(file) or (file.startswith("tests/") and not ORDINARY_TEST.search(file)):
            return {}, f"{file} has changed, on which all tests depend"
        if READ.search(file) and file not in graph.owners:
            continue
        changed[file] = graph.targets_of(file)
        if not changed[file]:
            return {}, f"{file} has changed, which belongs to no target"
    return changed, ""


def is_library_source(file):
    return file.startswith("plugin/tetskin/") and file.endswith((".h", ".cpp")) and (REPOSITORY / file).exists()


def web_tests(files):
    """Which tests of JavaScript and the live page a change of these files needs."""
    own = [file for file in files if WEB.search(file) or OF_MODULE_ALONE.search(file)]
    library = any(file.startswith("plugin/tetskin/") and not READ.search(file) or IN_WEB.search(file) for file in files)
    page = any(not OF_MODULE_ALONE.search(file) for file in own) or any(IN_PAGE.search(file) for file in files)
    module = library or any(not OF_PAGE_ALONE.search(file) for file in own)
    return " ".join(["module"] * module + ["page"] * page + ["scene"] * (library and not page))


def python_tests(files):
    """Which tests of the Python package a change of these files needs: "package", all; "library", those of itself."""
    if any(PYTHON.search(file) for file in files):
        return "package"
    return "library" if any(IN_PYTHON.search(file) for file in files) else ""


def write(build, everything, folders, sources, page=False, python="", web="", unaffected=()):
    out = build / "changes"
    out.mkdir(parents=True, exist_ok=True)
    for name, text in (("everything", everything), ("page", PAGE if page else ""),
                       ("python", python), ("web", web)):
        (out / name).unlink(missing_ok=True)
        if text:
            (out / name).write_text(text + "\n", encoding="utf-8")
    (out / "tests").write_text(";".join(folders), encoding="utf-8")
    (out / "unaffected").write_text("|".join(unaffected), encoding="utf-8")
    (out / "sources").write_text("".join(f"{file}\n" for file in sources), encoding="utf-8")


def select(build):
    commit, why = last_full_run()
    if commit is None:
        write(build, why, [], [])
        print(f"Everything counts as changed: {why}.")
        return
    graph, files = Graph(build), differing(commit)
    changed, why = selected(graph, files)
    if why:
        changed = {why: set(graph.folder)}
        print(f"All libraries count as changed since {commit[:12]}: {why}.")
    own = set().union(*changed.values()) if changed else set()
    everyone = graph.with_users(own)
    folders = graph.test_folders(everyone)
    sources = [file for file in files if is_library_source(file)]
    known = bool(files) and all(file.endswith(".md") or file in graph.owners or file in sources for file in files)
    left = set(graph.test_folders(graph.folder)) - set(folders)
    if not any(graph.folder.get(name, "").startswith(("demos", "tests/demos")) for name in everyone):
        left.add("demos")
    unaffected = sorted(left) if known and not why else []
    write(build, "", folders, sources, PAGE in files, python_tests(files), web_tests(files), unaffected)
    print(f"Since {commit[:12]}, at which everything passed, {len(files)} files have changed.")
    if not changed:
        print("None of them is compiled.")
        return
    print("changed targets:       " + ", ".join(sorted(own)))
    print("what uses them:        " + (", ".join(sorted(everyone - own)) or "nothing"))
    print("tests left out:        " + (", ".join(unaffected) or "none"))
    print("tests with sanitizers: " + (", ".join(folders) or "none"))
    print(f"files for clang-tidy:  {len(sources)}")


def processor():
    """The processor's name, as the system gives it."""
    try:
        found = re.search(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.M)
    except OSError:
        found = None
    return found[1].strip() if found else platform.machine()


def state():
    """The commit that the files are, and why they are none: one of both is empty."""
    if not shutil.which("git") or run_git("rev-parse", "HEAD").returncode != 0:
        return "", "git knows no commit of these files"
    commit = git("rev-parse", "HEAD").strip()
    files = differing(commit)
    return ("", f"there are changes that are not committed: {', '.join(files[:5])}") if files else (commit, "")


def start(build):
    (build / "changes").mkdir(parents=True, exist_ok=True)
    (build / "changes/start").write_text("\n".join(state()), encoding="utf-8")


def record(build, minutes, log):
    before, why = (build / "changes/start").read_text(encoding="utf-8").split("\n")
    commit, why_now = state()
    why = why or why_now or ("" if before == commit else "another commit was checked out meanwhile")
    if why:
        print(f"\nNot noted in {LAST}: {why}")
        return
    skipped = sorted(set(re.findall(r"Test +#\d+: (\S+) [.]*[*]{3}(?:Skipped|Not Run)", log.read_text(errors="replace"))))
    compiler = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", (build / "CMakeCache.txt").read_text(encoding="utf-8"), re.M)
    version = subprocess.run([compiler[1], "--version"], capture_output=True, text=True, check=False).stdout if compiler else ""
    text = ("# Written by tests/run --all, which passed at this commit. tests/run --change tests what differs from it.\n"
            f"commit    {commit}\n"
            f"date      {datetime.date.today().isoformat()}\n"
            f"machine   {processor()}, {os.cpu_count()} processors\n"
            f"compiler  {version.partition(chr(10))[0]}\n"
            f"minutes   {minutes}\n"
            f"skipped   {' '.join(skipped) or 'none'}\n")
    (REPOSITORY / LAST).write_text(text, encoding="utf-8")
    print(f"\nNoted in {LAST}: commit it, and tests/run --change starts from here.")


def main():
    command, arguments = sys.argv[1:2], [Path(word).resolve() for word in sys.argv[2:]]
    if command == ["select"] and len(arguments) == 1:
        select(arguments[0])
    elif command == ["start"] and len(arguments) == 1:
        start(arguments[0])
    elif command == ["record"] and len(arguments) == 3:
        record(arguments[0], sys.argv[3], arguments[2])
    else:
        fail(__doc__)


if __name__ == "__main__":
    main()
