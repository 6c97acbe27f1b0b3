#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Tests of tests/run --change and of selection.py, in a small project of this one's layout: two libraries of which one
uses the other, and their tests, with CMake's own graph of them."""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import types
import unittest
from pathlib import Path

import selection

REPOSITORY = Path(__file__).resolve().parents[2]
SCRIPTS = ("tests/run", "tests/tiers/selection.py", "demos/setup.sh")
FILES = {
    "CMakeLists.txt": "cmake_minimum_required(VERSION 3.21)\nproject(small LANGUAGES CXX)\n"
                      "add_subdirectory(plugin/tetskin/core)\nadd_subdirectory(plugin/tetskin/contact)\n"
                      "add_subdirectory(plugin/tetskin/threads)\nadd_subdirectory(plugin/tetskin/io)\n"
                      "add_subdirectory(tests)\nadd_subdirectory(demos)\n",
    "plugin/tetskin/core/CMakeLists.txt": "add_library(tetskin_core STATIC core.h core.cpp)\n",
    "plugin/tetskin/core/core.h": "", "plugin/tetskin/core/core.cpp": "", "plugin/tetskin/core/listed_nowhere.h": "",
    "plugin/tetskin/contact/CMakeLists.txt": "add_library(tetskin_contact STATIC contact.cpp)\n"
                                             "target_link_libraries(tetskin_contact PUBLIC tetskin_core)\n",
    "plugin/tetskin/contact/contact.cpp": "",
    "plugin/tetskin/threads/CMakeLists.txt": "add_library(tetskin_threads STATIC threads.cpp)\n"
                                             "target_link_libraries(tetskin_threads PUBLIC tetskin_core)\n",
    "plugin/tetskin/threads/threads.cpp": "",
    "plugin/tetskin/io/CMakeLists.txt": "add_library(tetskin_io STATIC io.cpp)\n"
                                        "target_link_libraries(tetskin_io PUBLIC tetskin_core)\n",
    "plugin/tetskin/io/io.cpp": "", "plugin/README.md": "", "plugin/tetskin/tetskin.h": "",
    "tests/CMakeLists.txt": "add_library(support STATIC support/support.cpp)\n"
                            "add_subdirectory(core)\nadd_subdirectory(contact)\nadd_subdirectory(threads)\n"
                            "add_subdirectory(io)\n",
    "tests/support/support.cpp": "", "tests/support/more.h": "", "tests/io/shared.h": "",
    "tests/contact/other.h": '#include "io/shared.h"\n', "tests/style/layers.cmake": "",
    "tests/pages/commands.txt": "",
    "demos/CMakeLists.txt": "add_executable(demo_drop examples/drop.cpp)\ntarget_link_libraries(demo_drop tetskin_core)\n",
    "demos/examples/drop.cpp": "int main() {}\n",
    "README.md": "",
}
FILES["plugin/tetskin/io/io.cpp"] = "int io();\n"
for folder in ("core", "contact", "io"):
    FILES[f"tests/{folder}/CMakeLists.txt"] = (f"add_executable(test_{folder} test.cpp)\n"
                                               f"target_link_libraries(test_{folder} support tetskin_{folder})\n")
    FILES[f"tests/{folder}/test.cpp"] = "int main() {}\n"
FILES["tests/threads/CMakeLists.txt"] = ("add_executable(test_threads test.cpp)\n"
                                         "target_link_libraries(test_threads support tetskin_threads tetskin_contact)\n")
FILES["tests/threads/test.cpp"] = '#include "../contact/other.h"\nint main() {}\n'


def run(command, folder, **more):
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, **more)


class InASmallProject(unittest.TestCase):
    """Each test changes a copy of the project, of which one commit is said to have passed."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name).resolve() / "project"
        for name, text in FILES.items():
            (cls.root / name).parent.mkdir(parents=True, exist_ok=True)
            (cls.root / name).write_text(text, encoding="utf-8")
        for name in SCRIPTS:
            (cls.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(REPOSITORY / name, cls.root / name)
        (cls.root / ".gitignore").write_text("/build/\n", encoding="utf-8")
        query = cls.root / "build/.cmake/api/v1/query"
        query.mkdir(parents=True)
        (query / "codemodel-v2").touch()
        done = run(["cmake", "-S", ".", "-B", "build"], cls.root)
        assert done.returncode == 0, done.stderr
        cls.git("init", "-q")
        cls.commit("all")
        cls.first = cls.git("rev-parse", "HEAD").strip()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def git(cls, *arguments):
        identity = ["-c", "user.name=nobody", "-c", "user.email=nobody@example.org", "-c", "commit.gpgsign=false"]
        done = run(["git", *identity, *arguments], cls.root)
        assert done.returncode == 0, done.stderr
        return done.stdout

    @classmethod
    def commit(cls, message):
        cls.git("add", "-A")
        cls.git("commit", "-q", "-m", message)

    def setUp(self):
        self.git("checkout", "-q", "--force", "-B", "main", self.first)
        self.git("clean", "-q", "-f", "-d")
        shutil.rmtree(self.root / "build/changes", ignore_errors=True)
        self.note(self.first)

    def note(self, commit):
        (self.root / "tests/last_full_run").write_text(f"# note\ncommit   {commit}\nminutes  1\n", encoding="utf-8")

    def write(self, name, text="// changed\n"):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text, encoding="utf-8")

    def select(self):
        return run([sys.executable, "-B", "tests/tiers/selection.py", "select", "build"], self.root)

    def result(self):
        """Test folders, sources, and why everything is tested."""
        done = self.select()
        self.assertEqual(done.returncode, 0, done.stderr)
        out = self.root / "build/changes"
        why = (out / "everything").read_text(encoding="utf-8") if (out / "everything").exists() else ""
        return (out / "tests").read_text(encoding="utf-8"), (out / "sources").read_text(encoding="utf-8").split(), why


class Selection(InASmallProject):
    def test_without_changes_nothing_is_selected(self):
        self.assertEqual(self.result(), ("", [], ""))
        self.assertIn("None of them is compiled", self.select().stdout)

    def test_a_source_selects_its_library_and_what_uses_it(self):
        self.write("plugin/tetskin/contact/contact.cpp")
        self.assertEqual(self.result(), ("contact;threads", ["plugin/tetskin/contact/contact.cpp"], ""))

    def test_what_all_use_selects_all(self):
        self.write("plugin/tetskin/core/core.h")
        self.assertEqual(self.result()[0], "contact;core;io;threads")

    def test_a_header_that_no_target_lists_belongs_to_its_folder(self):
        self.write("plugin/tetskin/core/listed_nowhere.h")
        self.assertEqual(self.result()[0], "contact;core;io;threads")

    def test_what_tests_share_selects_all_tests(self):
        self.write("tests/support/more.h")
        self.assertEqual(self.result(), ("contact;core;io;threads", [], ""))

    def test_a_test_selects_itself(self):
        self.write("tests/io/test.cpp", "int main() { return 0; }\n")
        self.assertEqual(self.result(), ("io", [], ""))

    def test_a_header_of_tests_selects_those_of_other_folders_that_include_it(self):
        self.write("tests/contact/other.h", '#include "io/shared.h"\n// more\n')
        self.assertEqual(self.result(), ("contact;threads", [], ""))
        self.setUp()
        self.write("tests/io/shared.h")
        self.assertEqual(self.result(), ("contact;io;threads", [], ""))

    def test_demos_have_no_tests_with_sanitizers(self):
        self.write("demos/examples/drop.cpp", "int main() { return 0; }\n")
        self.assertEqual(self.result(), ("", [], ""))
        self.assertIn("demo_drop", self.select().stdout)

    def test_committed_new_deleted_and_renamed_files_count(self):
        self.write("plugin/tetskin/io/io.cpp")
        self.commit("io")
        self.assertEqual(self.result()[0], "io")
        self.write("plugin/tetskin/contact/new.h")  # not added to the repository
        self.assertEqual(self.result()[0], "contact;io;threads")
        (self.root / "plugin/tetskin/contact/new.h").unlink()
        self.setUp()
        self.git("mv", "plugin/tetskin/io/io.cpp", "plugin/tetskin/threads/other.cpp")
        tests, sources, _ = self.result()
        self.assertEqual(tests, "io;threads", "where it was, and where it is")
        self.assertEqual(sources, ["plugin/tetskin/threads/other.cpp"])

    def test_what_git_is_told_to_ignore_counts_where_it_may_be_compiled(self):
        (self.root / ".git/info/exclude").write_text("*.h\n", encoding="utf-8")
        self.git("config", "status.showUntrackedFiles", "no")
        self.write("plugin/tetskin/io/new.h")
        self.assertEqual(self.result()[0], "io")
        self.assertIn("plugin/tetskin/io/new.h", self.all_passes().stdout)
        (self.root / ".git/info/exclude").unlink()
        self.git("config", "--unset", "status.showUntrackedFiles")

    def test_names_may_have_blanks_and_any_letter(self):
        self.write("plugin/tetskin/io/a b \u00e9.h")
        self.select()
        self.assertEqual((self.root / "build/changes/sources").read_text(encoding="utf-8"), "plugin/tetskin/io/a b \u00e9.h\n")

    def test_a_librarys_list_of_files_counts_as_the_library(self):
        with open(self.root / "plugin/tetskin/io/CMakeLists.txt", "a", encoding="utf-8") as file:
            file.write("# more\n")
        self.assertEqual(self.result()[0], "io")

    def test_what_is_only_read_selects_nothing(self):
        for name in ("README.md", "plugin/README.md", "plugin/docs/step.svg", "tests/BULLET_DEFECTS.md",
                     "tests/pages/commands.txt"):
            self.write(name)
        self.assertEqual(self.result(), ("", [], ""))

    def test_the_python_package_selects_nothing_that_is_compiled(self):
        python = self.root / "build/changes/python"
        for name in ("plugin/python/src/skins.cpp", "plugin/facade/shapes.cpp", "plugin/python/cmake/bullet.cmake",
                     "plugin/python/CMakeLists.txt", "demos/examples/python/drop.py",
                     "demos/examples/python/drop.ipynb", "tests/python/run", "tests/python/test_drop.py", "plugin/docs/python.md"):
            with self.subTest(name):
                self.setUp()
                self.write(name)
                self.assertEqual(self.result(), ("", [], ""))
                self.assertEqual(python.read_text(encoding="utf-8"), "package\n")
        for name in ("plugin/tetskin/io/io.cpp", "plugin/tetskin/io/CMakeLists.txt", "plugin/docs/peers.md",
                     "demos/view/page.html"):
            with self.subTest(name):
                self.setUp()
                before = (self.root / name).read_text(encoding="utf-8") if (self.root / name).exists() else ""
                self.write(name, before + "\n")
                self.result()
                self.assertEqual(python.read_text(encoding="utf-8"), "library\n")
        self.setUp()
        self.write("README.md")
        self.result()
        self.assertFalse(python.exists())

    def test_module_and_live_page_select_their_own_tests_and_nothing_that_is_compiled(self):
        wanted = {"module page": ("plugin/js/src/bodies.cpp", "plugin/facade/shapes.cpp", "plugin/js/CMakeLists.txt",
                                  "tests/live/run"),
                  "page": ("demos/examples/live/page.js", "demos/examples/live/serpent.cpp", "tests/live/test_page.py"),
                  "module": ("tests/js/run", "tests/js/test.mjs", "plugin/js/README.md", "plugin/docs/javascript.md")}
        web = self.root / "build/changes/web"
        for tests, names in wanted.items():
            for name in names:
                with self.subTest(name):
                    self.setUp()
                    self.write(name)
                    self.assertEqual(self.result(), ("", [], ""))
                    self.assertEqual(web.read_text(encoding="utf-8"), f"{tests}\n")
        self.setUp()
        self.write("plugin/tetskin/io/io.cpp")
        self.result()
        self.assertEqual(web.read_text(encoding="utf-8"), "module scene\n")
        self.write("demos/examples/live/page.js")
        self.result()
        self.assertEqual(web.read_text(encoding="utf-8"), "module page\n", "the page, and the library too")
        shared = {"page": ("demos/scenes/serpent.cpp", "demos/scenes/serpent_tube.h", "demos/scenes/materials.cpp",
                           "demos/scenes/angles.h", "demos/view/view_page.h"),
                  "module scene": ("plugin/python/cmake/bullet.cmake", "plugin/python/cmake/tinygltf.cmake",
                                   "plugin/python/fetch_bullet", "plugin/python/licences/bullet.txt", "CMakeLists.txt",
                                   "plugin/CMakeLists.txt", "plugin/cmake/options.cmake", "demos/run", "demos/setup.sh",
                                   "tests/configurations.cmake", "tests/run"),
                  "": ("demos/examples/drop.cpp", "demos/scenes/world.cpp", "plugin/python/cmake/wheel.cmake")}
        for tests, names in shared.items():
            for name in names:
                with self.subTest(name):
                    self.setUp()
                    before = (self.root / name).read_text(encoding="utf-8") if (self.root / name).exists() else ""
                    self.write(name, before + "\n")
                    self.result()
                    self.assertEqual(web.read_text(encoding="utf-8").strip() if web.exists() else "", tests)

    def test_sources_of_bindings_that_a_target_compiles_select_its_tests(self):
        graph = types.SimpleNamespace(owners={"plugin/facade/bytes.cpp"}, targets_of=lambda file: {"test_core"})
        self.assertEqual(selection.selected(graph, ["plugin/facade/bytes.cpp", "plugin/facade/shapes.cpp"]),
                         ({"plugin/facade/bytes.cpp": {"test_core"}}, ""))

    def test_pages_that_tests_of_a_binding_read_select_these(self):
        for folder, suffix, chosen, wanted in (("python", "py", selection.python_tests, ("package", "library")),
                                               ("python/beside", "py", selection.python_tests, ("package",)),
                                               ("js", "mjs", selection.web_tests, ("module",))):
            texts = [path.read_text(encoding="utf-8") for path in (REPOSITORY / "tests" / folder).glob(f"*.{suffix}")]
            pages = {f"plugin/docs/{name}.md" for text in texts for name in re.findall(r'docs/(\w+)[.]md"', text)}
            self.assertGreater(len(pages), 0)
            for page in pages:
                self.assertIn(chosen([page]), wanted, page)

    def test_tests_are_left_out_only_where_all_that_has_changed_is_known_not_to_matter_to_them(self):
        unaffected = self.root / "build/changes/unaffected"
        for names, wanted in ((["plugin/tetskin/contact/contact.cpp"], "core|demos|io"),
                              (["tests/io/test.cpp"], "contact|core|demos|threads"),
                              (["plugin/tetskin/core/listed_nowhere.h"], ""),
                              (["demos/examples/drop.cpp"], "contact|core|io|threads"),
                              (["plugin/README.md"], "contact|core|demos|io|threads"),
                              (["plugin/tetskin/io/io.cpp", "tests/platforms/hashes.txt"], ""),
                              (["demos/view/page.html"], ""),
                              (["plugin/tetskin/io/CMakeLists.txt"], ""), (["tests/run"], ""), ([], "")):
            with self.subTest(names):
                self.setUp()
                for name in names:
                    before = (REPOSITORY / name).read_text(encoding="utf-8") if name == "tests/run" else ""
                    self.write(name, before + "# more\n" if before else "//\n")
                self.result()
                self.assertEqual(unaffected.read_text(encoding="utf-8"), wanted)

    ALL = "contact;core;io;threads"

    def test_the_machinery_of_the_tests_selects_all_libraries(self):
        for name in ("CMakeLists.txt", "tests/CMakeLists.txt", "tests/run", "demos/setup.sh",
                     "tests/tiers/selection.py", ".clang-tidy", "tests/configurations.cmake", "tests/without_sanitizers.txt",
                     "tests/style/alone.py", "tests/style/tidy.py", "tests/support/sanitized.cmake"):
            with self.subTest(name):
                self.setUp()
                before = (self.root / name).read_text(encoding="utf-8") if (self.root / name).exists() else ""
                self.write(name, before + "# more\n")
                self.assertIn(f"{name} has changed, on which all tests depend", self.select().stdout)
                self.assertEqual(self.result(), (self.ALL, [], ""))

    def test_what_makes_other_tests_only_selects_nothing(self):
        for name in ("tests/style/layers.cmake", "tests/style/comments.py", "tests/fuzz/corpus/obj/seed",
                     "tests/pages/page.py", "tests/models/run", "tests/consumer/readme.py", "tests/platforms/msvc",
                     "plugin/packages/conan/conanfile.py"):
            with self.subTest(name):
                self.setUp()
                before = (self.root / name).read_text(encoding="utf-8") if (self.root / name).exists() else ""
                self.write(name, before + "# more\n")
                self.assertEqual(self.result(), ("", [], ""))

    def test_a_file_of_no_target_selects_all_libraries(self):
        for name, sources in (("plugin/tetskin/tetskin.h", ["plugin/tetskin/tetskin.h"]), ("new.cpp", [])):
            with self.subTest(name):
                self.setUp()
                self.write(name)
                self.assertIn(f"{name} has changed, which belongs to no target", self.select().stdout)
                self.assertEqual(self.result(), (self.ALL, sources, ""))

    def test_a_commit_that_is_unknown_or_elsewhere_selects_everything(self):
        self.note("0" * 40)
        self.assertIn("not in the history", self.result()[2])
        self.write("plugin/tetskin/io/io.cpp")
        self.commit("elsewhere")
        elsewhere = self.git("rev-parse", "HEAD").strip()
        self.setUp()
        self.note(elsewhere)
        self.assertIn("not in the history", self.result()[2])

    def test_without_the_note_everything_is_selected(self):
        (self.root / "tests/last_full_run").unlink()
        self.assertIn("there is no tests/last_full_run", self.result()[2])

    def test_a_damaged_note_is_an_error(self):
        self.write("tests/last_full_run", "commit   soon\n")
        done = self.select()
        self.assertEqual(done.returncode, 2)
        self.assertIn("tests/last_full_run: no line 'commit'", done.stderr)

    def test_outside_a_repository_says_so(self):
        hidden = self.root.parent / "hidden"
        shutil.move(self.root / ".git", hidden)
        try:
            done = self.select()
        finally:
            shutil.move(hidden, self.root / ".git")
        self.assertEqual(done.returncode, 2)
        self.assertIn("tests/run --all does not", done.stderr)

    def test_a_build_without_the_graph_says_so(self):
        reply = self.root / "build/.cmake/api/v1/reply"
        shutil.move(reply, self.root.parent / "reply")
        try:
            done = self.select()
        finally:
            shutil.move(self.root.parent / "reply", reply)
        self.assertEqual(done.returncode, 2)
        self.assertIn("configure", done.stderr)

    def all_passes(self, meanwhile=lambda: None):
        """What tests/run --all does before and after its tests."""
        selection = [sys.executable, "-B", "tests/tiers/selection.py"]
        started = run([*selection, "start", "build"], self.root)
        self.assertEqual(started.returncode, 0, started.stderr)
        meanwhile()
        log = self.root / "build/log"
        log.write_text(" 1/3 Test #1: core.A ........   Passed    0.01 sec\n"
                       " 2/3 Test #2: core.Kernels/avx512 ...***Skipped   0.01 sec\n"
                       " 3/3 Test #3: consumer.flags ...***Not Run (Disabled)   0.00 sec\n", encoding="utf-8")
        return run([*selection, "record", "build", "24", str(log)], self.root)

    def test_a_pass_is_noted_with_what_was_skipped(self):
        self.write("plugin/tetskin/io/io.cpp")
        self.commit("io")
        self.assertEqual(self.result()[0], "io")
        self.assertIn("commit it", self.all_passes().stdout)
        noted = (self.root / "tests/last_full_run").read_text(encoding="utf-8")
        self.assertIn("skipped   consumer.flags core.Kernels/avx512\n", noted)
        self.assertIn("minutes   24\n", noted)
        self.assertEqual(self.result(), ("", [], ""))

    def test_a_pass_of_what_is_not_committed_is_not_noted(self):
        self.write("plugin/tetskin/io/io.cpp")
        self.assertIn("not committed: plugin/tetskin/io/io.cpp", self.all_passes().stdout)
        done = self.all_passes(meanwhile=lambda: self.git("checkout", "-q", "plugin"))
        self.assertIn("not committed: plugin/tetskin/io/io.cpp", done.stdout, "as it was when the tests began")
        done = self.all_passes(meanwhile=lambda: self.write("plugin/tetskin/io/io.cpp"))
        self.assertIn("not committed: plugin/tetskin/io/io.cpp", done.stdout)
        self.setUp()

        def commit():
            self.write("plugin/tetskin/io/io.cpp")
            self.commit("io")

        self.assertIn("another commit", self.all_passes(commit).stdout)
        self.assertIn(self.first, (self.root / "tests/last_full_run").read_text(encoding="utf-8"))


class Script(InASmallProject):
    """tests/run itself, with stand-ins for apt, cmake and ctest that note how they were called."""

    def run_script(self, *arguments, without=(), ctest=""):
        tools = self.root.parent / "tools"
        shutil.rmtree(tools, ignore_errors=True)
        tools.mkdir()
        calls = self.root.parent / "calls"
        calls.unlink(missing_ok=True)
        for name, body in {"dpkg-query": "echo installed", "apt-get": "", "apt-cache": "", "cmake": "",
                           "ctest": ctest or "case \"$*\" in *show-only*) echo '  Test #1: consumer.shared'; "
                                            "echo '  Test #2: consumer.readme' ;; esac"}.items():
            (tools / name).write_text(f"#!/bin/bash\necho {name} \"$@\" >>{calls}\n{body}\n", encoding="utf-8")
            (tools / name).chmod(0o755)
        for name in ("bash", "sh", "env", "git", "dirname", "cat", "mkdir", "touch", "nproc", "awk", "sed", "sort", "tee",
                     "tail", "head", "grep", "paste", "id", "python3", "uname"):
            found = sys.executable if name == "python3" else shutil.which(name)
            if name not in without and found:
                os.symlink(found, tools / name)
        done = run([shutil.which("bash"), "tests/run", *arguments], self.root, env={"PATH": str(tools), "HOME": "/tmp"})
        return done, calls.read_text(encoding="utf-8") if calls.exists() else ""

    def ctest_call(self, calls):
        found = [line for line in calls.splitlines() if line.startswith("ctest") and "show-only" not in line]
        self.assertEqual(len(found), 1, calls)
        return found[0]

    def test_change_runs_what_the_change_needs_and_prints_the_rest(self):
        self.write("plugin/tetskin/contact/contact.cpp")
        done, calls = self.run_script("--change")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("--label-exclude ^full$|^single$ -C programs --exclude-regex ^(consumer[.]readme_changes|"
                      "python[.]beside_others|live[.]page|live[.]driver|(core|demos|io)[.].*)$", self.ctest_call(calls))
        self.assertIn("tests of core, demos, io: nothing that they use has changed", done.stdout)
        self.assertIn("consumer.shared: part of tests/run --all alone", done.stdout)
        self.assertIn("consumer.readme: the first page has not changed", done.stdout)

    def test_change_leaves_out_what_nothing_has_changed_for_and_says_why(self):
        self.write("plugin/tetskin/io/io.cpp")
        done, calls = self.run_script("--change")
        self.assertIn("--exclude-regex ^(configuration[.]thread_sanitized|consumer[.]readme_changes|python[.]beside_others|"
                      "live[.]page|live[.]driver|(contact|core|demos|threads)[.].*)$",
                      self.ctest_call(calls))
        self.assertIn("configuration.thread_sanitized: nothing that is tested on several threads", done.stdout)
        self.setUp()
        self.write("README.md")
        done, calls = self.run_script("--change")
        self.assertIn("^(configuration[.]sanitized_changes|configuration[.]thread_sanitized|style[.]tidy_changes|"
                      "style[.]alone_changes|python[.]beside_others|python[.]package|python[.]wheel|js[.]module|"
                      "live[.]page|live[.]driver|live[.]one_scene|(contact|core|demos|io|threads)[.].*)$", self.ctest_call(calls))
        self.assertIn("configuration.sanitized_in_double: no library has changed", done.stdout)

    def test_change_runs_the_demos_of_the_python_package_if_one_of_its_files_has_changed(self):
        self.write("tests/python/test_drop.py")
        done, calls = self.run_script("--change")
        self.assertNotIn("python[.]beside_others", self.ctest_call(calls))
        self.assertIn("style[.]tidy_changes", self.ctest_call(calls))

    def test_change_tests_one_scene_of_the_live_page_with_the_library_and_all_with_the_page(self):
        self.write("plugin/tetskin/io/io.cpp")
        done, calls = self.run_script("--change")
        self.assertNotIn("live[.]one_scene", self.ctest_call(calls))
        self.assertNotIn("js[.]module", self.ctest_call(calls))
        self.assertIn("live.page: the page has not changed", done.stdout)
        self.write("demos/examples/live/page.js")
        done, calls = self.run_script("--change")
        self.assertIn("|live[.]one_scene)$", self.ctest_call(calls))
        for name in ("live[.]page", "live[.]driver", "js[.]module"):
            self.assertNotIn(name, self.ctest_call(calls))
        self.assertNotIn("live.page: ", done.stdout)
        self.setUp()
        self.write("demos/examples/live/page.js")
        done, calls = self.run_script("--change")
        self.assertIn("|js[.]module|live[.]one_scene)$", self.ctest_call(calls))
        self.assertIn("--label-exclude ^full$|^single$", self.ctest_call(calls))

    def test_change_is_all_where_everything_counts_as_changed(self):
        self.note("0" * 40)
        done, calls = self.run_script("--change")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("Everything counts as changed", done.stdout)
        self.assertIn("--label-exclude ^change$|^single$ -C programs", self.ctest_call(calls))

    def test_all_notes_that_it_has_passed(self):
        done, calls = self.run_script("--all")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("--label-exclude ^change$|^single$ -C programs", self.ctest_call(calls))
        self.assertIn("Noted in tests/last_full_run", done.stdout)
        self.setUp()
        done, calls = self.run_script("--all", "-R", "Weld")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("--label-exclude ^change$ -R Weld", self.ctest_call(calls), "one by one")
        self.assertNotIn("Noted", done.stdout, "a part has passed, not all")

    def test_change_takes_no_arguments(self):
        done, calls = self.run_script("--change", "-R", "Weld")
        self.assertEqual(done.returncode, 2)
        self.assertIn("takes no arguments", done.stderr)
        self.assertNotIn("ctest", calls)

    def test_a_missing_tool_stops_the_script(self):
        self.assertEqual(self.run_script("--coverage", "-R", "Weld")[0].returncode, 2)
        for tool in ("python3", "git"):
            with self.subTest(tool):
                self.setUp()
                done, calls = self.run_script("--change", without=[tool])
                self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                self.assertIn(tool, done.stderr)
                self.assertNotIn("ctest", calls)

    def test_a_test_that_fails_fails_the_script_and_is_not_noted(self):
        self.write("README.md")
        done, _ = self.run_script("--change", ctest="exit 8")
        self.assertEqual(done.returncode, 8, done.stdout + done.stderr)
        self.setUp()
        done, _ = self.run_script("--all", ctest="exit 8")
        self.assertEqual(done.returncode, 8, done.stdout + done.stderr)
        self.assertNotIn("Noted", done.stdout)
        self.assertIn(self.first, (self.root / "tests/last_full_run").read_text(encoding="utf-8"))


@unittest.skipUnless(shutil.which("clang-tidy-14"), "no clang-tidy-14")
class Tidy(unittest.TestCase):
    """style.tidy and style.tidy_changes, in a library of three sources, of which two are joined."""

    def test_both_find_what_shows_only_in_a_source_alone_and_what_shows_in_joined_ones(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder).resolve()
            using = "namespace n { class C; }\nusing n::C;\n"
            files = {"plugin/tetskin/core/a.cpp": using + "C* c = 0;\n", "plugin/tetskin/core/c.cpp": "int d;\n",
                     "plugin/tetskin/core/b.cpp": using,
                     "joined/plugin/Unity/unity_0_cxx.cxx": "".join(
                         f'#include "{root}/plugin/tetskin/core/{name}.cpp"\n' for name in "ab"),
                     "changed_b": "plugin/tetskin/core/b.cpp\n", "changed_c": "plugin/tetskin/core/c.cpp\n"}
            for name in ("tests/style/tidy.py", ".clang-tidy"):
                files[name] = (REPOSITORY / name).read_text(encoding="utf-8")
            sources = [root / f"plugin/tetskin/core/{name}.cpp" for name in "abc"]
            units = [root / "joined/plugin/Unity/unity_0_cxx.cxx", sources[2]]
            for build, compiled in (("alone", sources), ("joined", units)):
                files[f"{build}/compile_commands.json"] = json.dumps(
                    [{"directory": folder, "file": str(file), "command": f"c++ -c {file}"} for file in compiled])
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text, encoding="utf-8")
            check = [sys.executable, "-B", "tests/style/tidy.py", "clang-tidy-14", "joined", "alone"]
            for more, found in (([], [True, True]), (["--files", "changed_b"], [True, True]),
                                (["--files", "changed_c"], [False, False])):
                said = run([*check, *more], root).stdout
                self.assertEqual(["unused-using" in said, "use-nullptr" in said], found, said)
                self.assertNotRegex(said, r"a[.]cpp:.*unused-using")


if __name__ == "__main__":
    unittest.main()
