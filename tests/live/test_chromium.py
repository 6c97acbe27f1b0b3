#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The driver itself, with a page that records its input: no test of a page could find an omission of the driver."""
import tempfile
import unittest
from pathlib import Path

import chromium

PAGE = """<!doctype html><meta name="viewport" content="width=device-width">
<body style="margin:0; height:3000px; background:#fff">
<canvas id="canvas" width="300" height="300" style="touch-action:none; background:#0a0"></canvas>
<button id="low" style="position:absolute; top:2500px" onclick="clicked = true">low</button>
<script>
  const seen = [], dropped = [];
  let clicked = false;
  for (const kind of ['pointerdown', 'pointermove', 'pointerup']) {
    canvas.addEventListener(kind, ({pointerType, clientX, clientY, buttons}) =>
      seen.push([kind, pointerType, Math.round(clientX), Math.round(clientY), buttons]));
  }
  addEventListener('dragover', e => e.preventDefault());
  addEventListener('drop', async e => {
    e.preventDefault();
    for (const file of e.dataTransfer.files) dropped.push([file.name, await file.text()]);
  });
  const start = text => new Worker(URL.createObjectURL(new Blob([text])));
</script>"""
# A function that returns a vector of WebAssembly's SIMD.
SIMD = ("WebAssembly.validate(new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, "
        "8, 0, 65, 0, 253, 15, 253, 98, 11]))")
WEBGL = "document.createElement('canvas').getContext('webgl2') !== null"
MEMORY = "(() => { try { new WebAssembly.Memory({initial: 1000}); return true; } catch { return false; } })()"


@unittest.skipUnless(chromium.PROGRAM, "no Chromium")
class Driver(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.page_file = Path(cls.folder.name) / "page.html"
        cls.page_file.write_text(PAGE, encoding="utf-8")
        cls.browser = chromium.Chromium()

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.folder.cleanup()

    def open(self, **more):
        page = self.browser.open(self.page_file.as_uri(), 400, 700, **more)
        self.addCleanup(page.close)
        return page

    def test_mouse_and_finger_reach_the_pages_handlers(self):
        for phone, kind in ((False, "mouse"), (True, "touch")):
            with self.subTest(kind):
                page = self.open(phone=phone)
                page.press(10, 20)
                page.move(100, 120, steps=3)
                page.release()
                seen = [one for one in page.evaluate("seen") if one[0] != "pointermove" or one[4]]
                self.assertEqual([one[:2] for one in seen], [["pointerdown", kind]] + 3 * [["pointermove", kind]] +
                                 [["pointerup", kind]])
                self.assertEqual(seen[0][2:], [10, 20, 1])
                self.assertEqual(seen[-2][2:], [100, 120, 1])
                page.click_on("#low")
                page.until("clicked", 10)  # scrolled to, and pressed

    def test_files_are_dropped_with_their_names_and_contents(self):
        page = self.open()
        file = Path(self.folder.name) / "some thing.obj"
        file.write_text("v 1 2 3\n", encoding="utf-8")
        page.drop_files([file], 50, 50)
        page.until("dropped.length", 5)
        self.assertEqual(page.evaluate("dropped"), [["some thing.obj", "v 1 2 3\n"]])

    def test_what_goes_wrong_is_recorded_in_workers_too(self):
        for text, expected in (("console.error('of the page')", "of the page"),
                               ("setTimeout(() => { throw new Error('thrown'); }) && 0", "thrown"),
                               ("Promise.reject(new Error('refused')) && 0", "refused"),
                               ("start('console.error(\"of the worker\")') && 0", "of the worker"),
                               ("start('throw new Error(\"first line\")') && 0", "first line"),
                               ("start('Promise.reject(new Error(\"late\"))') && 0", "late")):
            with self.subTest(text):
                page = self.open()
                page.evaluate(text)
                self.browser.wait(lambda page=page: page.faults, 10, "no fault was recorded")
                self.assertIn(expected, page.faults[0])
        page = self.open()
        page.evaluate("console.log('fine'), console.warn('well'), 0")
        self.browser.listen(0.3)
        self.assertEqual(page.faults, [])
        self.assertEqual(page.said, [("log", "fine"), ("warning", "well")])

    def test_requests_are_recorded_in_workers_too(self):
        page = self.open()
        self.assertEqual(page.requests, [self.page_file.as_uri()])
        page.evaluate("fetch('http://127.0.0.1:9/page').catch(() => 0)")
        page.evaluate("start('fetch(\"http://127.0.0.1:9/worker\").catch(() => 0)') && 0")
        self.browser.wait(lambda: "http://127.0.0.1:9/worker" in page.requests, 10, "no request was recorded")
        self.assertIn("http://127.0.0.1:9/page", page.requests)

    def test_memory_is_that_of_page_and_workers(self):
        page = self.open()
        page.evaluate("start('const kept = Array(1e6).fill(0).map((_, i) => i + 0.5); postMessage(0); onmessage = () => kept')"
                      ".onmessage = () => ready = true, ready = false, 0")
        page.until("ready", 10)
        self.assertGreater(page.javascript_memory(), 7e6)
        before = page.javascript_memory()
        page.evaluate("more = new Array(1e6).fill(0).map((_, i) => i + 0.5), 0")
        self.assertGreater(page.javascript_memory(), before + 7e6)
        before = page.javascript_memory()
        page.evaluate("arrays = [1, 2, 3].map(() => new Float32Array(1e6).fill(1)), 0")
        self.assertGreater(page.javascript_memory(), before + 11e6, "arrays are outside of the heap")

    def test_screenshots_have_the_pages_colours(self):
        for phone, scale in ((False, 1), (True, 2)):
            page = self.open(phone=phone)
            width, height, channels, rows = chromium.pixels(page.screenshot())
            self.assertEqual((width, height), (400 * scale, 700 * scale))
            at = 100 * scale * channels
            self.assertEqual(rows[100 * scale][at:at + 3], bytes([0, 0xaa, 0]))

    def test_values_promises_and_what_they_throw(self):
        page = self.open()
        self.assertEqual(page.evaluate("new Promise(done => setTimeout(() => done([1, {a: null}]), 10))"), [1, {"a": None}])
        with self.assertRaisesRegex(chromium.Fault, "nothing_such"):
            page.evaluate("nothing_such")
        with self.assertRaisesRegex(chromium.Fault, "there is no #none"):
            page.click_on("#none")
        with self.assertRaisesRegex(chromium.Fault, "not within"):
            page.until("false", 0.2)
        with self.assertRaisesRegex(chromium.Fault, "nothing.html"):
            self.browser.open(self.page_file.with_name("nothing.html").as_uri())

    def test_a_page_that_hangs_is_a_fault(self):
        with chromium.Chromium(patience=20) as browser:
            page = browser.open(self.page_file.as_uri())
            with self.assertRaisesRegex(chromium.Fault, "was not answered within 2 s"):
                page.evaluate("while (true);", patience=2)

    def test_a_browser_without_webgl_simd_or_memory(self):
        for flags, missing in (((), None), (chromium.WITHOUT_WEBGL, WEBGL), (chromium.WITHOUT_SIMD, SIMD),
                               (chromium.WITH_32_MB, MEMORY)):
            with self.subTest(flags), chromium.Chromium(flags) as browser:
                page = browser.open(self.page_file.as_uri())
                for what in (WEBGL, SIMD, MEMORY):
                    self.assertEqual(page.evaluate(what), what != missing, what)


if __name__ == "__main__":
    unittest.main()
