# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Headless Chromium, driven over the DevTools protocol through two pipes: no port, no WebSocket, no package.

Input enters where the operating system's would, so that a page's own pointer handlers are tested. What a page and its
workers say in the console, throw, or ask of the network is recorded.
"""
import base64
import fcntl
import json
import os
import select
import shutil
import signal
import struct
import tempfile
import time
import zlib
from pathlib import Path

PROGRAM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
# Drawn without a graphics card; no calls home; no prompts; timers of an invisible page run normally.
FLAGS = ["--headless", "--no-sandbox", "--remote-debugging-pipe", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--disable-extensions", "--disable-background-timer-throttling", "--disable-backgrounding-occluded-windows",
         "--disable-renderer-backgrounding", "--disable-dev-shm-usage", "--hide-scrollbars", "--mute-audio"]
WITHOUT_WEBGL = ["--disable-gpu", "--disable-3d-apis", "--disable-software-rasterizer"]
WITH_32_MB = ["--js-flags=--wasm-max-mem-pages=512"]
WITHOUT_SIMD = ["--js-flags=--no-enable-sse4-1"]  # V8 then refuses modules with SIMD


class Fault(Exception):
    """Chromium refused a command, ended, or did not answer in time."""


class Chromium:
    """A separate browser, with a temporary profile.

    flags    besides FLAGS; a flag `-NAME` takes one of these away
    patience seconds that a single answer may take
    """

    def __init__(self, flags=(), patience=120.0):
        if PROGRAM is None:
            raise Fault("no Chromium in the path")
        self.patience = patience
        self.folder = tempfile.TemporaryDirectory(prefix="tetskin_live_", ignore_cleanup_errors=True)
        self.log = Path(self.folder.name) / "log.txt"
        taken = {flag[1:] for flag in flags if flag.startswith("-") and not flag.startswith("--")}
        command = [PROGRAM, *(flag for flag in FLAGS if flag not in taken),
                   *(flag for flag in flags if flag[1:] not in taken),
                   f"--user-data-dir={self.folder.name}/profile", "about:blank"]
        read_commands, self.commands = os.pipe()
        self.answers, write_answers = os.pipe()
        # An end may be 3 or 4 itself: above these, none is overwritten before it is copied.
        ends = [fcntl.fcntl(end, fcntl.F_DUPFD_CLOEXEC, 10) for end in (read_commands, write_answers)]
        actions = [(os.POSIX_SPAWN_DUP2, ends[0], 3), (os.POSIX_SPAWN_DUP2, ends[1], 4),
                   (os.POSIX_SPAWN_OPEN, 1, str(self.log), os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600),
                   (os.POSIX_SPAWN_DUP2, 1, 2)]
        self.process = os.posix_spawn(PROGRAM, command, os.environ, file_actions=actions, setpgroup=0)
        for end in (read_commands, write_answers, *ends):
            os.close(end)
        self.rest, self.number, self.replies, self.pages = b"", 0, {}, {}
        self.ended = False

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Ends the browser and all of its processes."""
        if not self.ended:
            self.ended = True
            os.close(self.commands)
            os.close(self.answers)
            try:
                os.killpg(self.process, signal.SIGKILL)
            except ProcessLookupError:
                pass
            os.waitpid(self.process, 0)
            self.folder.cleanup()

    def send(self, method, session=None, **parameters):
        """Sends a command, and returns its number without waiting for the answer."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        try:
            data = json.dumps(message).encode() + b"\0"
            while data:
                data = data[os.write(self.commands, data):]
        except BrokenPipeError:
            raise Fault(f"Chromium has ended: {self.last_words()}") from None
        return self.number

    def call(self, method, session=None, patience=None, **parameters):
        """The answer to a command, as a dictionary."""
        number = self.send(method, session, **parameters)
        self.wait(lambda: number in self.replies, patience or self.patience, f"{method} was not answered")
        reply = self.replies.pop(number)
        if "error" in reply:
            raise Fault(f"{method}: {reply['error'].get('message')} {reply['error'].get('data', '')}")
        return reply["result"]

    def wait(self, condition, seconds, what):
        """Reads what Chromium sends until the condition holds."""
        end = time.monotonic() + seconds
        while not condition():
            left = end - time.monotonic()
            if left <= 0:
                raise Fault(f"{what} within {seconds:.0f} s")
            self.read(left)

    def listen(self, seconds):
        """Reads what Chromium sends for this time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.read(end - time.monotonic())

    def read(self, seconds):
        if not select.select([self.answers], [], [], max(0.0, seconds))[0]:
            return
        data = os.read(self.answers, 1 << 20)
        if not data:
            raise Fault(f"Chromium has ended: {self.last_words()}")
        *messages, self.rest = (self.rest + data).split(b"\0")
        for message in messages:
            self.take(json.loads(message))

    def take(self, message):
        if "id" in message:
            self.replies[message["id"]] = message
        elif message.get("sessionId") in self.pages:
            self.pages[message["sessionId"]].take(message["method"], message["params"], message["sessionId"])

    def last_words(self):
        return self.log.read_text(errors="replace")[-2000:] if self.log.exists() else ""

    def open(self, address, width=1280, height=800, phone=False, early="", patience=None):
        """A page that has loaded, in a tab of its own.

        width, height  in CSS pixels
        phone  with a finger instead of a mouse, two pixels of the screen to each of CSS, and a phone's user agent
        early  JavaScript that runs before the page's own
        """
        target = self.call("Target.createTarget", url="about:blank", newWindow=True)["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        page = Page(self, target, session)
        page.prepare(width, height, phone, early)
        if address:
            page.load(address, patience or self.patience)
        return page


class Page:
    """A tab: its console, its workers, and actions with mouse, finger and keys. Positions are in CSS pixels from the
    upper left corner of the visible part."""

    def __init__(self, browser, target, session):
        self.browser, self.target, self.session = browser, target, session
        self.phone = False
        self.workers = {}    # session -> address
        self.said = []       # (kind, text) of the console, of the page and its workers
        self.faults = []     # uncaught exceptions, and errors in the console
        self.requests = []   # addresses that the page or a worker has asked for
        self.loaded = 0
        self.finger = None
        browser.pages[session] = self

    def take(self, method, parameters, session):
        if method == "Page.loadEventFired":
            self.loaded += 1
        elif method == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            self.faults.append(details.get("exception", {}).get("description") or details.get("text", "?"))
        elif method == "Runtime.consoleAPICalled":
            text = " ".join(str(one.get("value", one.get("description", one.get("type")))) for one in parameters["args"])
            self.said.append((parameters["type"], text))
            if parameters["type"] in ("error", "assert"):
                self.faults.append(f"console.{parameters['type']}: {text}")
        elif method == "Log.entryAdded":
            entry = parameters["entry"]
            self.said.append((entry["level"], entry["text"]))
            if entry["level"] == "error":
                self.faults.append(f"{entry['source']}: {entry['text']} {entry.get('url', '')}")
        elif method == "Network.requestWillBeSent":
            self.requests.append(parameters["request"]["url"])
        elif method == "Target.attachedToTarget":
            self.attach(parameters)
        elif method == "Target.detachedFromTarget":
            self.workers.pop(parameters["sessionId"], None)
            self.browser.pages.pop(parameters["sessionId"], None)
        elif method == "Inspector.targetCrashed":
            self.faults.append("the page has crashed")

    def attach(self, parameters):
        """A worker, which waits until it is listened to: nothing that it says is missed."""
        session = parameters["sessionId"]
        if parameters["targetInfo"]["type"] == "worker":
            self.workers[session] = parameters["targetInfo"]["url"]
        self.browser.pages[session] = self
        for method in ("Runtime.enable", "Network.enable"):
            self.browser.send(method, session)
        self.browser.send("Target.setAutoAttach", session, autoAttach=True, waitForDebuggerOnStart=True, flatten=True)
        self.browser.send("Runtime.runIfWaitingForDebugger", session)

    def call(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def prepare(self, width, height, phone, early):
        for domain in ("Page", "Runtime", "Network", "Log", "Inspector"):
            self.call(f"{domain}.enable")
        self.call("Target.setAutoAttach", autoAttach=True, waitForDebuggerOnStart=True, flatten=True)
        self.resize(width, height, phone)
        if phone:
            self.call("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=5)
            self.call("Emulation.setUserAgentOverride", platform="Linux armv8l",
                      userAgent="Mozilla/5.0 (Linux; Android 14) AppleWebKit/537.36 Chrome/156.0.0.0 Mobile Safari/537.36")
        if early:
            self.call("Page.addScriptToEvaluateOnNewDocument", source=early)

    def resize(self, width, height, phone=False):
        self.phone = phone
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=2 if phone else 1,
                  mobile=phone)

    def load(self, address, patience=120.0):
        before = self.loaded
        answer = self.call("Page.navigate", url=address)
        if answer.get("errorText"):
            raise Fault(f"{address}: {answer['errorText']}")
        self.browser.wait(lambda: self.loaded > before, patience, f"{address} has not loaded")

    def evaluate(self, expression, patience=None, session=None):
        """The value of a JavaScript expression; for a promise, its result."""
        answer = self.browser.call("Runtime.evaluate", session or self.session, patience, expression=expression,
                                   returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise Fault(details.get("exception", {}).get("description") or details.get("text"))
        return answer["result"].get("value")

    def until(self, expression, seconds=60.0, interval=0.05):
        """Waits until a JavaScript expression is true, and returns its value."""
        end = time.monotonic() + seconds
        while True:
            value = self.evaluate(expression)
            if value:
                return value
            if time.monotonic() > end:
                raise Fault(f"not within {seconds:.0f} s: {expression}; the page says: {self.faults[:3]}")
            self.browser.listen(interval)

    def frame(self):
        """Waits until the page has drawn once more."""
        self.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))")

    def mouse(self, kind, x, y, button="left", **more):
        down = kind == "mousePressed" or (kind == "mouseMoved" and more.pop("held", False))
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button if kind != "mouseMoved" or down else "none",
                  buttons={"left": 1, "right": 2, "middle": 4}[button] if down else 0,
                  clickCount=1 if kind != "mouseMoved" else 0, **more)

    def touch(self, kind, *points):
        self.call("Input.dispatchTouchEvent", type=kind,
                  touchPoints=[{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(points)])

    def press(self, x, y):
        """Mouse button or finger goes down, and stays."""
        self.finger = (x, y)
        if self.phone:
            self.touch("touchStart", (x, y))
        else:
            self.mouse("mouseMoved", x, y)
            self.mouse("mousePressed", x, y)

    def move(self, x, y, steps=10, pause=0.02):
        """Moves the pressed pointer in steps, as a hand does."""
        x0, y0 = self.finger
        for step in range(1, steps + 1):
            at = (x0 + (x - x0) * step / steps, y0 + (y - y0) * step / steps)
            if self.phone:
                self.touch("touchMove", at)
            else:
                self.mouse("mouseMoved", *at, held=True)
            self.browser.listen(pause)
        self.finger = (x, y)

    def release(self):
        if self.phone:
            self.browser.listen(0.1)  # a finger that is lifted in motion throws the page, and the next tap would only stop it
            self.touch("touchEnd")
        else:
            self.mouse("mouseReleased", *self.finger)
        self.finger = None

    def click(self, x, y):
        """A click, or a tap on a phone."""
        self.press(x, y)
        self.release()

    def middle(self, selector):
        """The middle of an element, scrolled to first where it is not visible."""
        found = self.evaluate(f"""(() => {{
          const one = document.querySelector({json.dumps(selector)});
          if (!one) return null;
          one.scrollIntoView({{block: 'nearest', inline: 'nearest'}});
          // What is pressed is what has been drawn.
          return new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => {{
            const box = one.getBoundingClientRect();
            done([box.x + box.width / 2, box.y + box.height / 2, box.width, box.height]);
          }})));
        }})()""")
        if found is None:
            raise Fault(f"there is no {selector}")
        if not found[2] * found[3]:
            raise Fault(f"{selector} is not shown")
        return found[:2]

    def click_on(self, selector):
        self.click(*self.middle(selector))

    def key(self, key, text=None):
        """Presses and releases a key, named as in KeyboardEvent.key."""
        codes = {"Enter": 13, "Escape": 27, "ArrowLeft": 37, "ArrowRight": 39, "Home": 36, "End": 35, "Tab": 9, " ": 32}
        more = {"windowsVirtualKeyCode": codes.get(key, ord(key[0].upper())), "key": key}
        if text or len(key) == 1:
            more["text"] = text or key
        self.call("Input.dispatchKeyEvent", type="keyDown", **more)
        self.call("Input.dispatchKeyEvent", type="keyUp", **more)

    def drop_files(self, files, x, y):
        """Drops files from outside on the page."""
        data = {"items": [], "files": [str(file) for file in files], "dragOperationsMask": 1}
        for kind in ("dragEnter", "dragOver", "drop"):
            self.call("Input.dispatchDragEvent", type=kind, x=x, y=y, data=data)

    def screenshot(self, path=None):
        """The visible part, as PNG; written to a file if one is given."""
        data = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        if path is not None:
            Path(path).parent.mkdir(parents=True, exist_ok=True)
            Path(path).write_bytes(data)
        return data

    def javascript_memory(self):
        """Bytes of JavaScript's heaps in use after a collection, with those of arrays, which are outside of them, in the page
        and in its workers together."""
        self.browser.listen(0.2)  # ended workers are reported
        total = 0
        for session in (self.session, *self.workers):
            self.browser.call("HeapProfiler.collectGarbage", session)
            usage = self.browser.call("Runtime.getHeapUsage", session)
            total += usage["usedSize"] + usage["backingStorageSize"]
        return total

    def close(self):
        self.browser.call("Target.closeTarget", targetId=self.target)


def pixels(png):
    """Width, height and rows of a PNG as Chromium writes it: 8 bits, RGB or RGBA, not interlaced. Rows are bytes of
    width * channels; channels is the third value."""
    at, data, width, height, channels = 8, b"", 0, 0, 3
    while at < len(png):
        (size,), kind = struct.unpack(">I", png[at:at + 4]), png[at + 4:at + 8]
        if kind == b"IHDR":
            width, height, depth, colours = struct.unpack(">IIBB", png[at + 8:at + 18])
            assert depth == 8 and colours in (2, 6), "an unexpected kind of PNG"
            channels = 3 if colours == 2 else 4
        elif kind == b"IDAT":
            data += png[at + 8:at + 8 + size]
        at += size + 12
    raw, stride, rows = zlib.decompress(data), width * channels, []
    before = bytearray(stride)
    for y in range(height):
        row = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        unfilter(raw[y * (stride + 1)], row, before, channels)
        rows.append(bytes(row))
        before = row
    return width, height, channels, rows


def unfilter(kind, row, before, channels):
    """Undoes one of PNG's five filters, in place."""
    for channel in range(channels if kind else 0):
        left = corner = 0
        for i in range(channel, len(row), channels):
            above = before[i]
            if kind == 1:
                guess = left
            elif kind == 2:
                guess = above
            elif kind == 3:
                guess = (left + above) // 2
            else:
                to_left, to_above, to_corner = abs(above - corner), abs(left - corner), abs(left + above - 2 * corner)
                guess = above if to_above <= to_corner else corner
                if to_left <= to_above and to_left <= to_corner:
                    guess = left
            left = row[i] = (row[i] + guess) & 255
            corner = above
