#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Files dropped on the live page: good ones become bodies, damaged ones get a message, and the scene continues."""
import base64
import itertools
import json
import math
import tempfile
import unittest
from pathlib import Path

import meshes
from live import WithBrowser


class Dropped(WithBrowser):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def stored(self, name, data):
        path = self.folder / name
        path.write_bytes(data)
        return path

    def drop(self, live, name, data):
        """By the hook: resolves when the file is a body, or was refused."""
        live.page.evaluate(f"tetskinLive.drop({json.dumps(name)}, Uint8Array.from(atob('{base64.b64encode(data).decode()}'), "
                           "c => c.charCodeAt(0)))", patience=120)

    def test_each_format_becomes_a_body_that_is_simulated(self):
        live = self.live(False, "serpent", tets=300)
        before = live.state()
        for count, (name, data) in enumerate(meshes.good(), start=1):
            with self.subTest(name):
                live.page.drop_files([self.stored(name, data)], 480, 300)
                live.page.until(f"tetskinLive.state().bodies === {before['bodies'] + count}", 120)
                state = live.step(60)
                self.assertGreater(state["triangles"], before["triangles"] + 1000 * count)
                self.assertEqual(live.page.faults, [])
        live.page.frame()
        live.picture("dropped")
        nodes = live.page.evaluate("simulation.parts.slice(-3).map(({body}) => [...body.nodes])", session=live.worker())
        middles = [[sum(one[k::3]) / (len(one) // 3) for k in range(3)] for one in nodes]
        for a, b in itertools.combinations(middles, 2):
            self.assertGreater(math.dist(a, b), 0.5, "balls of radius 0.5 touch each other, and do not share a place")
        self.assertEqual(live.call("reset")["bodies"], before["bodies"])

    def test_a_dropped_body_can_be_held_and_comes_back_to_the_bit(self):
        live = self.live()
        self.drop(live, *meshes.good()[0])
        state = live.step(0)
        self.assertEqual(state["bodies"], 2)
        first = live.step(20)
        live.step(40)
        self.assertEqual(live.call("rewind", 40)["hash"], first["hash"])

    def test_damaged_files_get_a_sentence_and_the_scene_goes_on(self):
        live = self.live()
        bodies = live.state()["bodies"]
        for name, data in meshes.damaged():
            with self.subTest(name):
                live.page.evaluate("document.getElementById('notice').hidden = true")
                self.drop(live, name, data)
                sentence = live.call("notice")
                self.assertTrue(sentence, "nothing is said")
                self.assertIn(name, sentence)
                self.assertNotRegex(sentence, r"undefined|RuntimeError|object Object|unreachable|null|exception|\bfile\.")
                frame = live.state()["frame"]
                state = live.step(2)
                self.assertEqual((state["frame"], state["bodies"]), (frame + 2, bodies))
                self.assertEqual(live.page.faults, [])
        live.picture("damaged")

    def test_a_refusal_goes_when_the_next_file_falls(self):
        live = self.live()
        self.drop(live, *meshes.damaged()[0])
        self.assertTrue(live.call("notice"))
        self.drop(live, *meshes.good()[0])
        self.assertEqual((live.call("notice"), live.step(0)["bodies"]), ("", 2))
        self.drop(live, *meshes.damaged()[0])
        live.open("stack")
        self.assertEqual(live.call("notice"), "", "and with its scene")

    def test_damaged_files_leave_no_memory_behind(self):
        live = self.live()
        for _ in range(2):
            for name, data in meshes.damaged()[:6]:
                self.drop(live, name, data)
        before = live.call("memory")["module"], live.page.javascript_memory()
        for _ in range(3):
            for name, data in meshes.damaged()[:6]:
                self.drop(live, name, data)
        after = live.call("memory")["module"], live.page.javascript_memory()
        self.assertEqual(after[0], before[0])
        self.assertLess(after[1] - before[1], 1e6)
        self.assertEqual(len(live.page.workers), 1, "workers that make cages have ended")

    def test_a_large_mesh_shows_its_progress_and_can_be_cancelled(self):
        live = self.live()
        bodies = live.state()["bodies"]
        shape = meshes.ball(500, 600)
        live.page.drop_files([self.stored("large.ply", meshes.ply(*shape))], 480, 300)
        live.page.until("!document.getElementById('work').hidden", 60)
        frame = live.state()["frame"]
        self.assertEqual(live.step(5)["frame"], frame + 5, "the scene goes on meanwhile")
        live.page.until("!document.querySelector('#work button').hidden", 60)
        live.page.click_on("#work button")
        live.page.until("document.getElementById('work').hidden", 60)
        self.assertEqual(live.step(1)["bodies"], bodies)
        self.drop(live, *meshes.good()[1])
        self.assertEqual(live.step(1)["bodies"], bodies + 1)

    def test_a_file_that_is_chosen_is_read_as_a_dropped_one(self):
        live = self.live()
        name, data = meshes.good()[0]
        path = self.stored(name, data)
        document = live.page.call("DOM.getDocument")["root"]["nodeId"]
        node = live.page.call("DOM.querySelector", nodeId=document, selector="#file")["nodeId"]
        live.page.call("DOM.setFileInputFiles", nodeId=node, files=[str(path)])
        live.page.until("tetskinLive.state().bodies === 2", 120)


if __name__ == "__main__":
    unittest.main()
