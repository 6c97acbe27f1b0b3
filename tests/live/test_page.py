#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The live page: its file, its scenes, time that goes back, memory, and the bits of its nodes."""
import gzip
import json
import re
import unittest

from live import DESKTOP, NATIVE, PAGE, USUAL, Server, WithBrowser, colours
from native import COMPARED, FRAMES, HASHES, native_hashes

SCENES = ["serpent", "heap", "pit", "gripper", "stack", "twist", "clay", "muscle", "tyre"]
MEGABYTE = 1e6


class File(unittest.TestCase):
    """The page as it lies on disk."""

    @classmethod
    def setUpClass(cls):
        cls.text = PAGE.read_text(encoding="utf-8")

    def test_is_below_1_9_megabytes_compressed(self):
        self.assertLess(len(gzip.compress(self.text.encode(), 9)), 1.9 * MEGABYTE)

    def test_refers_to_nothing_outside(self):
        for pattern in (r'<(script|link|img|iframe)[^>]*(src|href)="(?!data:)[^"]*"', r"@import", r"url\((?!['\"]?data:)"):
            head = re.sub(r"<script.*?</script>", "", self.text, flags=re.S)
            self.assertEqual(re.findall(pattern, head), [], pattern)

    def test_shows_the_licences_of_all_that_is_inside(self):
        shown = re.search(r'id="licences".*?<pre>(.*?)</pre>', self.text, re.S)[1]
        for part, words in {
            "tetskin": "tetskin", "Bullet": "Bullet", "Eigen": "Mozilla Public License", "three.js": "three.js",
            "tinygltf": "Syoyo Fujita", "JSON for Modern C++": "Niels Lohmann", "Emscripten": "Emscripten",
            "musl": "musl", "libc++": "LLVM Exceptions",
        }.items():
            with self.subTest(part):
                self.assertIn(words.lower(), shown.lower())


class OneScene(WithBrowser):
    """Tests of each scene, for the serpent; tests of the page as a whole."""
    scene = "serpent"

    def test_runs_300_frames_and_is_seen(self):
        live = self.live(scene=self.scene)
        at_start = live.state()
        self.assertEqual((at_start["scene"], at_start["frame"], at_start["playing"]), (self.scene, 0, False))
        self.assertGreater(at_start["tets"], 0)
        after = live.step(300)
        self.assertEqual(after["frame"], 300)
        self.assertNotEqual(after["hash"], at_start["hash"])
        live.page.frame()
        seen = colours(live.picture(self.scene))
        self.assertGreater(len(seen), 40, "shaded bodies have many colours")

    def test_goes_on_by_itself_and_stops(self):
        live = self.live(scene=self.scene)
        live.play_until("state.frame > 20")
        frame = live.state()["frame"]
        self.browser.listen(0.3)
        self.assertEqual(live.state()["frame"], frame)

    def test_comes_back_to_the_bit(self):
        live = self.live(scene=self.scene)
        start = live.state()
        hashes = {start["frame"]: start["hash"]}
        for _ in range(9):
            state = live.step(15)
            hashes[state["frame"]] = state["hash"]
        self.assertEqual(len(set(hashes.values())), 10, "it moves")
        for back in (15, 45, 30):
            state = live.call("rewind", back)
            self.assertEqual(state["hash"], hashes[state["frame"]])
        last = live.step(135 - state["frame"])
        self.assertEqual((last["frame"], last["hash"]), (135, hashes[135]), "and goes on as it did")
        self.assertEqual(live.call("reset")["hash"], start["hash"])
        self.assertEqual(live.step(60)["hash"], hashes[60])

    def test_the_same_run_in_another_page_has_the_same_bits(self):
        first = self.live(scene=self.scene).step(60)["hash"]
        other = self.new_page()
        other.open(self.scene)
        self.assertEqual(other.step(60)["hash"], first)

    @unittest.skipUnless(NATIVE, "no live_native: built with the tests of a folder that is configured")
    def test_states_are_those_of_a_native_run_which_are_shown_beside_them(self):
        live = self.live(scene=self.scene)
        hashes = native_hashes(live, self.scene, 120)
        for half_second, native in enumerate(hashes, start=1):
            state = live.step(30)
            self.assertEqual((state["frame"], state["hash"]), (30 * half_second, native))
            self.assertEqual(state["compared"], {"frame": state["frame"], "hash": native})
            self.assertEqual(live.text("#native"), f"frame {state['frame']}: {native}, in C++ the same")
        self.assertEqual(hashes, json.loads(HASHES.read_text(encoding="utf-8"))[self.scene][:4],
                         "what the page has of native runs is old: tests/live/native.py writes it")


class OtherScenes(WithBrowser):
    def choose(self, live, scene):
        """A scene by its button, as a person opens it."""
        live.page.click_on(f"#scenes button[data-scene={scene}]")
        live.page.until(f"tetskinLive.state().scene === '{scene}'", 60)

    def test_each_is_chosen_by_its_button_runs_300_frames_is_seen_and_comes_back_to_the_bit(self):
        live = self.live()
        self.assertEqual(live.page.evaluate("tetskinLive.scenes"), SCENES)
        for scene in reversed(SCENES):
            with self.subTest(scene):
                self.choose(live, scene)
                hashes = [live.step(75)["hash"] for _ in range(4)]
                self.assertEqual(live.state()["frame"], 300)
                live.page.frame()
                self.assertGreater(len(colours(live.picture(scene))), 40)
                self.assertEqual(live.call("rewind", 150)["hash"], hashes[1])
                self.assertEqual(live.step(150)["hash"], hashes[3])
                self.assertEqual(live.page.faults, [])

    def test_each_is_chosen_by_its_button_on_a_phone(self):
        live = self.live(phone=True)
        for scene in reversed(SCENES):
            with self.subTest(scene):
                self.choose(live, scene)
                live.step(60)
                live.page.frame()
                live.picture(f"phone_{scene}")

    @unittest.skipUnless(NATIVE, "no live_native")
    def test_soft_bodies_alone_have_the_bits_of_a_native_run_for_ten_seconds(self):
        live, shown = self.live(), json.loads(HASHES.read_text(encoding="utf-8"))
        self.assertEqual(tuple(shown), COMPARED)
        for scene in COMPARED:
            with self.subTest(scene):
                live.open(scene)
                hashes = native_hashes(live, scene, FRAMES)
                self.assertEqual([live.step(30)["hash"] for _ in hashes], hashes)
                self.assertEqual(hashes, shown[scene], "tests/live/native.py writes what the page shows")

    def test_what_was_touched_is_not_compared(self):
        live = self.live(scene="stack")
        hidden = "document.getElementById('native').hidden"
        live.step(30)
        self.assertFalse(live.page.evaluate(hidden))
        live.call("push", *live.call("onScreen", [0, 1.11, 0.3]))
        self.assertEqual(live.step(60)["compared"]["frame"], 30)
        live.call("rewind", 80)
        self.assertEqual(live.step(20)["compared"]["frame"], 30, "before it was touched")
        live.call("reset")
        self.assertTrue(live.page.evaluate(hidden))
        live.open("stack", stiffness=100)
        self.assertIsNone(live.step(30)["compared"])
        self.assertTrue(live.page.evaluate(hidden))

    def test_another_hash_than_the_native_one_is_seen(self):
        live = self.live(scene="stack")
        self.addCleanup(live.page.evaluate, "live.data.native.stack[0] = kept, 0")
        live.page.evaluate("kept = live.data.native.stack[0], live.data.native.stack[0] = 'another', 0")
        live.step(30)
        self.assertIn("in C++ another", live.text("#native"))
        self.assertTrue(live.page.evaluate("document.getElementById('native').classList.contains('differs')"))

    def test_a_scene_is_opened_by_its_name_in_the_address(self):
        live = self.new_page(address=PAGE.as_uri() + "#twist")
        self.assertEqual(live.state()["scene"], "twist")
        self.assertEqual(live.page.evaluate("live.settings.skin"), "quadratic", "a linear one is lumpy there")
        live.open("stack")
        self.assertEqual(live.page.evaluate("live.settings.skin"), "linear")

    def test_the_address_keeps_scene_and_settings(self):
        live = self.live(scene="stack", stiffness=120.04, tets=300, elements="quadratic")
        words = "#stack&stiffness=120&tets=300&elements=quadratic&skin=linear"
        live.page.until(f"location.hash === '{words}'", 60)
        other = self.new_page(address=PAGE.as_uri() + words)
        self.assertEqual(other.page.evaluate("live.description.settings"),
                         {**USUAL, "stiffness": 120, "tets": 300, "elements": "quadratic"})
        other.page.evaluate("location.hash = '#twist&gravity=1.6&stiffness=1e9&tets=7&skin=round&other', 0")
        other.page.until("tetskinLive.state().scene === 'twist'", 60)
        self.assertEqual(other.page.evaluate("live.description.settings"), {**USUAL, "gravity": 1.6},
                         "what is no setting's value is left out")

    def test_what_is_loading_is_seen_before_the_first_picture(self):
        early = """addEventListener('DOMContentLoaded', () => requestAnimationFrame(() => {
          const box = one => one.getBoundingClientRect(), work = document.getElementById('work');
          window.first = {
            work: work.textContent.trim(), shown: box(work).width > 50, about: document.getElementById('about').textContent,
            canvas: getComputedStyle(document.getElementById('canvas')).visibility, drawn: Boolean(live.stage),
            scenes: [...document.querySelectorAll('#scenes button')].filter(one => box(one).width > 50).length,
            background: getComputedStyle(document.body).backgroundColor};
        }))"""
        live = self.new_page(address=PAGE.as_uri() + "#gripper", early=early)
        first = live.page.evaluate("first")
        self.assertRegex(first.pop("work"), "^Gripper: loading")
        self.assertIn("tetskin", first.pop("about"))
        self.assertEqual(first, {"shown": True, "canvas": "hidden", "drawn": False, "scenes": len(SCENES),
                                 "background": "rgb(244, 242, 238)"})
        live.page.frame()
        self.assertTrue(live.page.evaluate("document.getElementById('work').hidden"))
        self.assertEqual(live.page.evaluate("getComputedStyle(document.getElementById('canvas')).visibility"), "visible")


class Memory(WithBrowser):
    @staticmethod
    def used(live):
        """Bytes of WebAssembly's memory, and of JavaScript's without the snapshots, whose number and memory are
        bounded, and which grow with the contacts."""
        memory = live.call("memory")
        return memory["module"], live.page.javascript_memory() - memory["snapshots"]

    def test_is_flat_over_700_frames(self):
        live = self.live()
        for scene in SCENES:
            with self.subTest(scene):
                live.open(scene)
                live.step(700)  # ten seconds of snapshots, and what grows at first
                before = self.used(live)
                live.step(700)
                after = self.used(live)
                self.assertEqual(after[0], before[0], "WebAssembly's memory")
                self.assertLess(after[1] - before[1], 0.2 * MEGABYTE, "heaps of JavaScript")
                self.assertLess(live.call("memory")["snapshots"], 70 * MEGABYTE)

    def test_is_flat_over_many_scenes(self):
        live = self.live()

        def round_trip():
            for scene in SCENES:
                live.open(scene)
                live.step(5)

        for _ in range(2):
            round_trip()
        before = self.used(live)
        for _ in range(2):
            round_trip()
        after = self.used(live)
        self.assertLess(after[0] - before[0], 2 * MEGABYTE)
        self.assertLess(after[1] - before[1], 2 * MEGABYTE)


class Served(WithBrowser):
    def test_asks_for_nothing_but_itself_from_a_file(self):
        live = self.new_page()
        live.step(10)
        own = [one for one in live.page.requests if not one.startswith(("blob:", "data:"))]
        self.assertEqual(own, [PAGE.as_uri()])

    def test_asks_for_nothing_but_itself_by_http(self):
        with Server(PAGE.parent) as server:
            address = server.address(PAGE.name)
            live = self.new_page(address=address)
            live.step(10)
            own = [one for one in live.page.requests if not one.startswith(("blob:", "data:"))]
            self.assertEqual(own, [address])
            self.assertEqual(server.asked, [f"/{PAGE.name}"])

    def test_works_without_a_network(self):
        page = self.browser.open("", *DESKTOP)
        page.call("Network.emulateNetworkConditions", offline=True, latency=0, downloadThroughput=0, uploadThroughput=0)
        page.load(PAGE.as_uri())
        self.assertIsNone(page.evaluate("tetskinLive.ready", patience=180))
        self.assertEqual(page.faults, [])
        page.close()


if __name__ == "__main__":
    unittest.main()
