#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Browsers that lack a feature which the live page needs: it says so, in a message that names the cure."""
import base64
import unittest

import chromium
import meshes
from live import PAGE, Live


class Lacking(unittest.TestCase):
    def sentence(self, flags, words, early=""):
        """The page's message in such a browser, which must contain these words and be visible."""
        with chromium.Chromium(flags) as browser:
            live = Live(browser, early=early)
            self.assertIsNotNone(live.trouble, "the page thinks that all is well")
            for word in words:
                self.assertIn(word, live.trouble)
            shown = live.page.evaluate("(one => one && !one.hidden && one.getBoundingClientRect().height > 10 && "
                                       "one.textContent)(document.getElementById('trouble'))")
            self.assertEqual(shown, live.trouble)
            width, _, channels, rows = chromium.pixels(live.picture(f"lacking_{words[0].lower()}"))
            self.assertGreater(min(rows[len(rows) // 8][channels * width // 8:][:3]), 200, "dark words on a light page")
            crashes = [fault for fault in live.page.faults if "WebGL" not in fault]
            self.assertEqual(crashes, [])

    def test_webgl(self):
        self.sentence(chromium.WITHOUT_WEBGL, ["WebGL", "hardware acceleration"])

    def test_simd(self):
        self.sentence(chromium.WITHOUT_SIMD, ["SIMD", "Chrome"])

    def test_webassembly(self):
        self.sentence(["--js-flags=--jitless"], ["WebAssembly"])

    def test_decompression(self):
        self.sentence([], ["Chrome"], early="delete globalThis.DecompressionStream")

    def test_memory_for_the_page(self):
        self.sentence(["--js-flags=--wasm-max-mem-pages=64"], ["memory"])


class LittleMemory(unittest.TestCase):
    def test_what_does_not_fit_gets_a_sentence_and_the_scene_goes_on(self):
        """In four megabytes more than the first scene needs."""
        address = PAGE.as_uri() + "#twist"
        with chromium.Chromium() as browser:
            needed = Live(browser, address=address).call("memory")["module"]
        pages = needed // 65536 + 64
        with chromium.Chromium([f"--js-flags=--wasm-max-mem-pages={pages}"]) as browser:
            live = Live(browser, address=address)
            self.assertIsNone(live.trouble, live.trouble)
            frame = live.step(10)["frame"]
            live.page.evaluate("live.settings.tets = 5000, live.change('heap')", patience=300)
            self.assertRegex(live.notice(60), "memory.*fewer tets")
            self.assertEqual(live.state()["scene"], "twist")
            self.assertEqual(live.step(10)["frame"], frame + 10)
            data = base64.b64encode(meshes.ply(*meshes.ball(300, 400))).decode()
            live.page.evaluate("document.getElementById('notice').hidden = true, live.settings.tets = 0")
            live.page.evaluate(f"tetskinLive.drop('large.ply', Uint8Array.from(atob('{data}'), c => c.charCodeAt(0)))",
                               patience=300)
            self.assertRegex(live.notice(60), "large.ply.*memory.*fewer triangles")
            self.assertEqual(live.step(10)["frame"], frame + 20)
            live.picture("little_memory")
            self.assertEqual(live.page.faults, [])


if __name__ == "__main__":
    unittest.main()
