#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""A hand's actions on the live page: hold and drag by mouse and finger, push, throw, turn the view, and every
control."""
import math
import re
import unittest

import chromium
from live import PHONE, WithBrowser

CLOSE = 0.02  # of the body's size


def distance(a, b):
    return math.dist(a, b)


class Dragging(WithBrowser):
    def drag_the_horn(self, phone):
        """Takes the serpent by its horn, and moves the pointer up and aside. Returns the page, the horn before, its tip's
        distance from the held point on the way, and where the pointer is."""
        live = self.live(phone, "serpent")
        live.step(90)  # it lies on the ramp and the dome
        live.page.frame()
        horn = live.call("horn")
        x, y = self.point_on_body(live, horn["screen"])
        live.page.press(x, y)
        self.addCleanup(lambda: live.page.finger and live.page.release())  # also if the test fails: others have this page
        live.page.until("live.hands.held !== null", 60)
        to = (x - 60, y - 90) if phone else (x - 90, y - 120)
        for step in range(1, 7):  # time continues while the hand moves, and then
            live.page.move(*(a + (b - a) * step / 6 for a, b in zip((x, y), to)), steps=2)
            live.page.frame()
            live.step(10)
        grip = distance(live.call("horn")["world"], live.state()["held"])
        live.step(240)
        live.page.frame()
        live.picture("phone_drag" if phone else "drag")
        return live, horn, grip, to

    def point_on_body(self, live, screen):
        """The horn's tip is on the outline: the nearest pixel at which a ray meets the serpent."""
        found = live.page.evaluate(f"""(async () => {{
          for (let ring = 0; ring < 14; ++ring) {{
            for (let k = 0; k < Math.max(1, 6 * ring); ++k) {{
              const turn = 2 * Math.PI * k / (6 * ring || 1);
              const at = [{screen[0]} + ring * Math.cos(turn), {screen[1]} + ring * Math.sin(turn)];
              const {{from, to}} = live.stage.rayThrough(...at), hit = await live.port.ask('pick', {{rays: [{{from, to}}]}});
              await live.port.ask('letGo');
              if (hit) return at;
            }}
          }}
        }})()""")
        self.assertIsNotNone(found, "no ray near the horn meets the serpent")
        return found

    def check_drag(self, phone):
        live, before, grip, to = self.drag_the_horn(phone)
        held = live.state()["held"]
        self.assertIsNotNone(held, "it is still held")
        after = live.call("horn")
        pixels_per_size = self.pixels_per_length(live, held) * after["size"]
        # The held point of the surface is where the pointer is; and the horn's tip as near to that point as it was.
        self.assertLess(distance(live.call("onScreen", held), to), CLOSE * pixels_per_size)
        self.assertLess(distance(after["screen"], to), CLOSE * pixels_per_size + grip / after["size"] * pixels_per_size)
        self.assertLess(abs(distance(after["world"], held) - grip), CLOSE * after["size"])
        self.assertGreater(distance(after["world"], before["world"]), 0.1 * after["size"], "it was dragged")
        live.page.release()
        live.page.until("tetskinLive.state().held === null || live.hands.held === null", 60)
        fallen = live.step(90)
        self.assertIsNone(fallen["held"])
        self.assertLess(live.call("horn")["world"][1], after["world"][1] - 0.05 * after["size"], "and it falls again")

    def pixels_per_length(self, live, point):
        """Of a length across the view, at a point in the world."""
        return max(distance(live.call("onScreen", [x + (0.01 if i == k else 0) for i, x in enumerate(point)]),
                            live.call("onScreen", point)) for k in range(3)) / 0.01

    def test_the_mouse_brings_the_horn_to_the_pointer(self):
        self.check_drag(phone=False)

    def test_a_finger_brings_the_horn_to_the_pointer(self):
        self.check_drag(phone=True)

    def test_beside_the_body_the_view_turns_and_nothing_else(self):
        for phone in (False, True):
            with self.subTest(phone=phone):
                live = self.live(phone, "stack")
                before = live.state()["hash"]
                eye = live.page.evaluate("live.stage.camera.position.toArray()")
                live.page.press(30, 300)
                live.page.move(150, 320)
                live.page.release()
                live.page.frame()
                self.assertGreater(distance(live.page.evaluate("live.stage.camera.position.toArray()"), eye), 0.1)
                self.assertEqual(live.step(0)["hash"], before)

    def test_while_a_body_is_dragged_the_view_does_not_turn(self):
        live = self.live(False, "stack")
        x, y = live.call("onScreen", [0, 0.37, 0.3])
        live.page.press(x, y)
        live.page.until("live.hands.held !== null", 60)
        eye = live.page.evaluate("live.stage.camera.position.toArray()")
        live.page.move(x + 80, y - 40)
        live.page.frame()
        self.assertEqual(live.page.evaluate("live.stage.camera.position.toArray()"), eye)
        live.page.release()

    def test_a_second_finger_lets_go_and_zooms(self):
        live = self.live(True, "stack")
        x, y = live.call("onScreen", [0, 0.37, 0.3])
        live.page.press(x, y)
        live.page.until("live.hands.held !== null", 60)
        eye = live.page.evaluate("live.stage.camera.position.length()")
        live.page.touch("touchStart", (x, y), (x + 40, y))
        for step in range(1, 8):
            live.page.touch("touchMove", (x - 10 * step, y), (x + 40 + 10 * step, y))
            self.browser.listen(0.03)
        live.page.touch("touchEnd")
        live.page.frame()
        self.assertIsNone(live.page.evaluate("live.hands.held"))
        self.assertNotAlmostEqual(live.page.evaluate("live.stage.camera.position.length()"), eye, 3)


class Tools(WithBrowser):
    def test_a_push_moves_what_it_meets(self):
        for phone in (False, True):
            with self.subTest(phone=phone):
                live = self.live(phone, "stack")
                still = live.step(0)
                live.page.click_on("#tools button[data-tool=push]")
                live.page.click(*live.call("onScreen", [0, 1.11, 0.3]))
                live.page.until(f"tetskinLive.state().hash !== '{still['hash']}'", 60)

    def test_balls_are_thrown_and_the_oldest_come_back(self):
        live = self.live(False, "stack")
        live.page.click_on("#tools button[data-tool=ball]")
        for count in range(1, 15):
            live.page.click(480, 300)
            live.page.until(f"tetskinLive.state().balls === {min(count, 12)}", 60)
            live.step(2)
        live.page.frame()
        live.picture("balls")
        self.assertEqual(live.call("reset")["balls"], 0)

    def test_a_thrown_ball_hits_the_stack(self):
        live = self.live(False, "stack")
        alone = live.step(60)["hash"]
        nodes = "simulation.parts.map(({body}) => [...body.nodes])"
        before = live.page.evaluate(nodes, session=live.worker())
        live.call("reset")
        live.page.click_on("#tools button[data-tool=ball]")
        live.page.click(*live.call("onScreen", [0, 1.8, 0.3]))
        live.page.until("tetskinLive.state().balls === 1", 60)
        self.assertNotEqual(live.step(60)["hash"], alone)
        after = live.page.evaluate(nodes, session=live.worker())
        self.assertGreater(max(abs(a - b) for one, other in zip(before, after) for a, b in zip(one, other)), 0.05)

    def test_comes_back_with_balls_in_the_air(self):
        live = self.live(False, "stack")
        live.page.click_on("#tools button[data-tool=ball]")
        live.page.click(480, 300)
        live.page.until("tetskinLive.state().balls === 1", 60)
        first = live.step(30)
        live.page.click(450, 280)
        live.page.until("tetskinLive.state().balls === 2", 60)
        live.step(30)
        back = live.call("rewind", 60)
        self.assertIn(back["balls"], (0, 1))
        self.assertEqual(live.step(0)["bodies"], first["bodies"])


class Controls(WithBrowser):
    """Every control does what it says, and says what it does."""

    def setUp(self):
        self.one = self.live(False, "serpent", tets=300)

    def said(self, identifier):
        return self.one.text(f"#{identifier} + output")

    def slide(self, identifier, share):
        """Presses a slider at a share of its width."""
        page = self.one.page
        page.middle(f"#{identifier}")
        box = page.evaluate(f"(({{x, y, width, height}}) => [x, y, width, height])"
                            f"(document.getElementById('{identifier}').getBoundingClientRect())")
        page.click(box[0] + share * box[2], box[1] + box[3] / 2)
        page.frame()

    def worker(self, expression):
        return self.one.page.evaluate(expression, session=self.one.worker())

    def test_pause_and_play(self):
        page = self.one.page
        page.click_on("#play")
        page.until("tetskinLive.state().playing && tetskinLive.state().frame > 3", 60)
        page.click_on("#play")
        page.until("!tetskinLive.state().playing", 60)
        frame = self.one.step(0)["frame"]
        self.browser.listen(0.3)
        self.assertEqual(self.one.state()["frame"], frame)
        page.key(" ")
        page.until(f"tetskinLive.state().frame > {frame}", 60)
        page.key(" ")
        page.until("!tetskinLive.state().playing", 60)

    def test_one_step(self):
        page = self.one.page
        for count in (1, 2, 3):
            page.click_on("#step")
            page.until(f"tetskinLive.state().frame === {count}", 60)
        page.key("ArrowRight")
        page.until("tetskinLive.state().frame === 4", 60)
        self.assertFalse(self.one.state()["playing"])

    def test_from_the_start(self):
        first = self.one.state()["hash"]
        self.one.step(25)
        self.one.page.click_on("#restart")
        self.one.page.until("tetskinLive.state().frame === 0", 60)
        self.assertEqual(self.one.state()["hash"], first)

    def test_ten_seconds_back(self):
        self.one.step(700)
        self.one.page.click_on("#back")
        self.one.page.until("tetskinLive.state().frame === 100", 60)
        self.one.page.click_on("#back")
        self.one.page.until("tetskinLive.state().frame === tetskinLive.state().first", 60)

    def test_the_slider_of_time(self):
        self.one.step(200)
        self.slide("slider", 0.5)
        self.one.page.until("Math.abs(tetskinLive.state().frame - 100) < 15", 60)
        self.assertFalse(self.one.state()["playing"])

    def test_stiffness_damping_and_gravity(self):
        for identifier, get in (("stiffness", "simulation.parts[0].body.youngsModulus"),
                                ("damping", "simulation.parts[0].body.stiffnessDamping"),
                                ("gravity", "-simulation.world.gravity[1]")):
            with self.subTest(identifier):
                seen = []
                for share in (0.15, 0.85):
                    self.slide(identifier, share)
                    self.one.step(1)
                    seen.append((self.said(identifier), self.worker(get)))
                self.assertNotEqual(seen[0][0], seen[1][0], "what is said")
                self.assertGreater(seen[1][1], 1.5 * seen[0][1])
        self.slide("gravity", 0.5)
        self.one.step(1)
        self.assertAlmostEqual(float(self.said("gravity")), self.worker("-simulation.world.gravity[1]"), delta=0.06)

    def test_clay_muscle_and_tyre_have_a_slider_each(self):
        weight = """(({nodes, cage: {nodes: rest}}) => {
          const heights = nodes.filter((_, i) => i % 3 === 1 && rest[i - 1] > 0.9);
          return heights.reduce((sum, y) => sum + y / heights.length, 0);
        })(simulation.parts[0].body)"""
        # The scene, its slider, what it changes, frames until it has, by how much it does from a tenth to nine tenths.
        cases = [("clay", "yield", "Math.max(...simulation.parts[0].body.plasticStrains)", 270, -0.2),
                 ("muscle", "activation", weight, 240, 0.4),
                 ("tyre", "pressure", "simulation.world.poses()[8]", 300, 0.03)]
        identifiers = [identifier for _, identifier, *_ in cases]
        for scene, identifier, get, frames, change in cases:
            with self.subTest(scene):
                self.one.open(scene)
                start = self.one.state()["hash"]
                shown = [one for one in identifiers if not self.one.page.evaluate(
                    f"document.getElementById('{one}').parentElement.hidden")]
                self.assertEqual(shown, [identifier])
                seen = []
                for share in (0.1, 0.9):
                    self.one.call("reset")
                    self.slide(identifier, share)
                    self.one.step(frames)
                    self.one.page.frame()
                    self.one.picture(f"{scene}_{share}")
                    seen.append(self.worker(get))
                self.assertGreater((seen[1] - seen[0]) / change, 1, seen)
                words = f"`#{scene}&{identifier}=${{Number(live.settings.{identifier}.toPrecision(3))}}`"
                self.one.page.until(f"location.hash.startsWith({words})", 60)
                self.assertEqual(self.one.call("reset")["hash"], start)
        self.one.open("stack", tets=0)
        self.assertIsNotNone(self.one.step(30)["compared"], "settings of other scenes change nothing here")
        self.one.page.until("location.hash === '#stack&skin=linear'", 60)

    def test_tets_and_elements(self):
        for tets in ("100", "1000", "0"):
            with self.subTest(tets):
                self.one.choose("tets", tets)
                self.one.page.until(f"simulation_tets = tetskinLive.state().tets, live.settings.tets === {tets} && "
                                    f"live.description.settings.tets === {tets}", 60)
                wanted = int(tets) or 1000
                self.assertTrue(0.5 * wanted < self.one.state()["tets"] < 1.7 * wanted, self.one.state()["tets"])
                self.assertIn(f"{self.one.state()['tets']:,}", self.one.text("#facts"))
        self.one.choose("elements", "quadratic")
        self.one.page.until("live.description.settings.elements === 'quadratic'", 60)
        self.assertEqual(self.worker("simulation.parts[0].body.cage.quadraticTet.length"), self.one.state()["tets"])
        self.assertEqual(self.one.step(60)["frame"], 60)

    def test_skin_surface_and_cage(self):
        pictures = {}

        def look(name):
            self.one.step(0)
            self.one.page.frame()
            _, _, channels, rows = chromium.pixels(self.one.picture(f"look_{name}"))
            pictures[name] = b"".join(row[:690 * channels] for row in rows[80:480])  # without the panel and its marks

        self.one.step(60)
        look("surface")
        self.one.choose("skin", "quadratic")
        self.one.page.until("tetskinLive.step(0).then(() => live.state.skin === 'quadratic')", 60)
        look("quadratic")
        for cage in ("outer", "all", "tets"):
            self.one.choose("cage", cage)
            look(cage)
        self.assertFalse(self.one.page.evaluate("document.getElementById('cuts').hidden"))
        self.slide("cut", 0.8)
        look("cut")
        self.one.page.click_on("#surface")
        look("without_surface")
        self.assertEqual(len(set(pictures.values())), len(pictures), "each looks different")

    def test_reset_of_the_view(self):
        page, eye = self.one.page, "live.stage.camera.position.toArray()"
        first = page.evaluate(eye)
        page.press(30, 300)
        page.move(200, 350)
        page.release()
        page.frame()
        self.assertGreater(distance(page.evaluate(eye), first), 1)
        page.click_on("#view")
        page.until(f"Math.hypot(...{eye}.map((x, k) => x - {first}[k])) < 0.3", 60)  # the turn's last swing may follow

    def test_figures_tell_milliseconds_of_each_stage_and_the_hash(self):
        state = self.one.step(30)
        figures = self.one.text("#figures")
        for stage in ("elasticity", "contact rows", "contact solve", "bones"):
            self.assertIn(stage, figures)
        self.assertIn(state["hash"], self.one.text("#hash"))
        self.assertGreater(state["times"]["prediction"], 0)
        self.assertAlmostEqual(sum(state["times"].values()), state["milliseconds"], delta=1e-6)
        self.assertTrue(all(share >= 0 for share in state["times"].values()), state["times"])
        self.assertEqual(self.one.step(0)["times"], state["times"], "what is seen again took no time")

    def shown_times(self):
        """The milliseconds of the table, of the stages and of all."""
        *stages, whole = map(float, re.findall(r"(\d+\.\d\d) ms", self.one.text("#figures")))
        return stages, whole

    def test_milliseconds_add_up_and_begin_anew_with_each_scene(self):
        self.one.open("serpent")
        self.one.step(60)
        stages, whole = self.shown_times()
        self.assertAlmostEqual(sum(stages), whole, delta=0.005 * (len(stages) + 1))
        self.one.open("twist")
        self.assertEqual(self.shown_times(), ([0] * len(stages), 0))
        self.one.step(1)
        state = self.one.state()
        self.assertAlmostEqual(self.shown_times()[1], state["milliseconds"], delta=0.006, msg="nothing of the serpent's")

    def test_arrows_show_forces_and_change_none(self):
        hashes = [self.one.open("stack", forces=forces) and self.one.step(240)["hash"] for forces in (False, True)]
        self.assertEqual(hashes[0], hashes[1])
        arrows = self.one.page.evaluate("[...live.state.forces]")
        top = [arrows[k + 3:k + 6] for k in range(0, len(arrows), 6) if arrows[k + 1] > 1.6]
        self.assertEqual(len(top), 1, "one thing carries the highest cushion")
        self.assertLess(distance(top[0], [0, 1, 0]), 0.03, "by its weight")
        shown = "live.stage.arrows.filter(arrow => arrow.visible).length"
        self.assertEqual(self.one.page.evaluate(shown), len(arrows) / 6)
        self.one.page.key("a")
        self.one.page.until(f"tetskinLive.step(0).then(() => {shown} === 0)", 60)

    def test_frames_per_second_are_told(self):
        self.one.call("play", True)
        self.one.page.until("/of 60<td>\\d/.test(document.getElementById('figures').innerHTML) || "
                            "/of 60<\\/td><td>\\d/.test(document.getElementById('figures').innerHTML)", 60)
        self.one.call("play", False)

    def test_full_screen_and_back(self):
        page = self.one.page
        page.click_on("#full")
        page.until("document.fullscreenElement !== null", 60)
        page.key("f")
        page.until("document.fullscreenElement === null", 60)

    def test_every_control_has_a_word_about_it(self):
        silent = self.one.page.evaluate("""[...document.querySelectorAll('button, input, select, #figures, #hash')]
          .filter(one => !one.closest('[title]') && !one.closest('#scenes') && !one.closest('#work'))
          .map(one => one.id || one.outerHTML)""")
        self.assertEqual(silent, [])

    def test_the_panel_is_shown_and_hidden(self):
        hidden = "document.getElementById('panel').hidden"
        before = self.one.page.evaluate(hidden)
        self.one.page.click_on("#settings")
        self.assertEqual(self.one.page.evaluate(hidden), not before)
        self.one.page.click_on("#settings")
        self.assertEqual(self.one.page.evaluate(hidden), before)

    def test_numbers_choose_scenes(self):
        self.one.page.key("3")
        self.one.page.until("tetskinLive.state().scene === 'pit'", 60)


class OnAPhone(WithBrowser):
    def test_everything_fits_the_screen(self):
        live = self.live(True)
        page = live.page
        self.assertFalse(page.evaluate("document.documentElement.scrollWidth > innerWidth"))
        for selector in ("#play", "#step", "#back", "#restart", "#settings", "#tools", "#slider"):
            box = page.evaluate(f"(({{left, right, top, bottom}}) => [left, right, top, bottom])"
                                f"(document.querySelector('{selector}').getBoundingClientRect())")
            self.assertTrue(box[0] >= 0 and box[1] <= 390 and box[2] >= 0 and box[3] <= 844, (selector, box))
        live.picture("phone")
        for selector in ("#about", "#hint"):
            box = page.evaluate(f"document.querySelector('{selector}').getBoundingClientRect().height")
            self.assertLess(box, 30, f"{selector} is one line")
        page.click_on("#settings")
        page.frame()
        live.picture("phone_settings")
        page.click_on("#gravity")
        self.assertFalse(page.evaluate("document.documentElement.scrollWidth > innerWidth"))

    def test_turned_it_fits_too(self):
        live = self.live(True)
        self.addCleanup(live.page.resize, *PHONE, phone=True)
        live.page.resize(844, 390, phone=True)
        live.page.frame()
        live.step(1)
        live.page.frame()
        live.picture("phone_turned")
        self.assertFalse(live.page.evaluate("document.documentElement.scrollWidth > innerWidth"))


if __name__ == "__main__":
    unittest.main()
