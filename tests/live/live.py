# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Code shared by tests of the live page: the page, for a person or its hook `tetskinLive`; its files; its pictures."""
import functools
import http.server
import json
import os
import re
import threading
import unittest
from pathlib import Path

import chromium

REPOSITORY = Path(__file__).resolve().parents[2]
PAGE = Path(os.environ.get("TETSKIN_LIVE_PAGE", REPOSITORY / "out/live/live.html")).resolve()
NATIVE = os.environ.get("TETSKIN_LIVE_NATIVE")
PICTURES = REPOSITORY / "build/live/pictures"
DESKTOP, PHONE = (960, 640), (390, 844)
USUAL = {"stiffness": 50, "damping": 0.02, "gravity": 9.81, "yield": 1, "activation": 0.5,
         "pressure": 1500, "tets": 0, "elements": "linear", "skin": "linear",
         "forces": False}


class Live:
    """The page, loaded and ready; paused, so that every frame is asked for."""

    def __init__(self, browser, phone=False, address=None, early=""):
        width, height = PHONE if phone else DESKTOP
        self.page = browser.open(address or PAGE.as_uri(), width, height, phone, early)
        self.browser = browser
        self.trouble = self.page.evaluate("tetskinLive.ready", patience=180)
        if self.trouble is None:
            self.call("play", False)

    def call(self, method, *arguments, patience=180):
        """Calls a method of the hook."""
        return self.page.evaluate(f"tetskinLive.{method}({', '.join(map(json.dumps, arguments))})", patience)

    def state(self):
        return self.call("state")

    def open(self, name, **settings):
        return self.call("open", name, settings)

    def step(self, frames, patience=300):
        return self.call("step", frames, patience=patience)

    def play_until(self, condition, seconds=60):
        """Has time go on until a condition on the state holds, and stops it; the state then."""
        self.call("play", True)
        try:
            self.page.until(f"(() => {{ const state = tetskinLive.state(); return {condition}; }})()", seconds)
        finally:
            self.call("play", False)
        return self.step(0)

    def notice(self, seconds=60):
        """The sentence that is shown, once there is one."""
        return self.page.until("tetskinLive.notice()", seconds)

    def text(self, selector):
        return self.page.evaluate(f"document.querySelector({json.dumps(selector)}).textContent")

    def choose(self, identifier, value):
        """Chooses from a list. A headless browser opens none: this is the event that it would send."""
        self.page.evaluate(f"(() => {{ const list = document.getElementById({json.dumps(identifier)}); "
                           f"list.value = {json.dumps(value)}; list.dispatchEvent(new Event('input', {{bubbles: true}})); "
                           "list.dispatchEvent(new Event('change', {bubbles: true})); })()")

    def worker(self):
        """The session of the worker that simulates: the first one."""
        return next(iter(self.page.workers))

    def picture(self, name):
        return self.page.screenshot(PICTURES / f"{name}.png")

    def close(self):
        self.page.close()


class WithBrowser(unittest.TestCase):
    """Tests that share a browser, and the page in it: to load it takes longer than most of them. After each test, the
    console must be without an error."""

    @classmethod
    def setUpClass(cls):
        cls.browser = chromium.Chromium()
        cls.pages = {}

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()

    def live(self, phone=False, scene="twist", **settings):
        """The page, as if it was just loaded, with a scene: paused, at its first frame."""
        if phone not in self.pages:
            self.pages[phone] = Live(self.browser, phone)
        live = self.pages[phone]
        live.page.call("Page.bringToFront")
        live.page.evaluate("live.choose('hold'), live.tell(''), document.getElementById('notice').hidden = true, "
                           "tetskinLive.look({}).then(() => 0)")
        live.call("open", scene, {**USUAL, **settings})
        live.page.evaluate("live.resetView()")
        self.addCleanup(self.check_console, live)
        return live

    def new_page(self, **more):
        """A separate page."""
        live = Live(self.browser, **more)
        self.addCleanup(live.close)
        self.addCleanup(self.check_console, live)
        return live

    def check_console(self, live):
        faults, live.page.faults = live.page.faults, []
        errors = live.page.evaluate("tetskinLive.errors.splice(0)")
        self.assertEqual(faults, [], "in the console")
        self.assertEqual(errors, [], "in the page's own list")


def colours(png):
    """The number of a picture's pixels of each colour, with 16 shades per channel; every fourth row."""
    width, _, channels, rows = chromium.pixels(png)
    counts = {}
    for row in rows[::4]:
        for x in range(0, width, 4):
            colour = tuple(value >> 4 for value in row[x * channels:x * channels + 3])
            counts[colour] = counts.get(colour, 0) + 1
    return counts


def script_of(page, name):
    """The text of an element of the page's source, by its id."""
    found = re.search(rf'id="{name}"[^>]*>(.*?)</(script|pre)>', page, re.S)
    return found[1] if found else ""


class Server:
    """The page's folder, served on this machine alone. Records the request."""

    def __init__(self, folder):
        asked = self.asked = []

        class Handler(http.server.SimpleHTTPRequestHandler):
            def log_message(self, *_):
                asked.append(self.path)

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, directory=str(folder)))
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def address(self, name):
        return f"http://127.0.0.1:{self.server.server_address[1]}/{name}"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.server.shutdown()
        self.server.server_close()
