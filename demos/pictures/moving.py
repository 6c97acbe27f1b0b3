#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Makes the moving picture of the drop; called by the script make.

moving.py frames VIEW.html FOLDER   draws all frames of the demo's page in Chromium, as FOLDER/0000.png, ...
moving.py join FOLDER WEBP          plays them at half their speed, rests, and fades into the first one
"""
import base64
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

SIZE = 720, 405
OVERSAMPLING = 1.5
DIRECTION = (0.0, 0.32, 1.0)  # to the camera: from here the face is seen when the serpent lies
BATCH = 40                    # frames per start of Chromium, which hands all of them over at once
FRAMES_PER_SECOND = 30        # of 60 that were simulated
REST, FADE = 0.7, 9           # seconds that the last frame stays, and the frames from it to the first
QUALITY = 66

# Appended to the page: draws frames without what is around them, and leaves them in the page's document.
PROBE = """
const {size: [width, height], direction, first, end} = JOB, {player} = window, {stage} = player, frames = [];
player.play(false);
stage.renderer.setPixelRatio(1);
stage.renderer.setSize(width, height, false);
stage.camera.clearViewOffset();
stage.camera.aspect = width / height;
stage.freeHeight = 1;
stage.resetView(direction);
stage.camera.updateProjectionMatrix();
for (let frame = first; frame < Math.min(end, player.data.moments); ++frame) {
  player.seek(frame);
  stage.draw();
  frames.push(stage.canvas.toDataURL());
}
const report = document.createElement('pre');
report.id = 'report';
report.textContent = JSON.stringify({moments: player.data.moments, frames});
document.body.append(report);
"""


def drawn(page, first, end, folder):
    """The number of all frames, and PNGs of those from first to end."""
    job = {"size": [round(OVERSAMPLING * side) for side in SIZE], "direction": DIRECTION, "first": first, "end": end}
    probe = "<script>{" + PROBE.replace("JOB", json.dumps(job)) + "}</script>\n"
    at = page.rindex("</body>")
    (folder / "page.html").write_text(page[:at] + probe + page[at:])
    document = subprocess.run(
        ["chromium", "--headless", "--no-sandbox", f"--user-data-dir={folder}/profile", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", "--dump-dom", f"file://{folder}/page.html"],
        check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    report = json.loads(re.search(r'<pre id="report">(.*?)</pre>', document, re.DOTALL).group(1))
    return report["moments"], [base64.b64decode(frame.partition(",")[2]) for frame in report["frames"]]


def draw_frames(view, target):
    page = view.read_text()
    target.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        first, count = 0, 1
        while first < count:
            count, frames = drawn(page, first, first + BATCH, Path(folder))
            for k, frame in enumerate(frames, first):
                (target / f"{k:04d}.png").write_bytes(frame)
            first += BATCH


def join(folder, target, quality=QUALITY):
    paths = sorted(folder.glob("*.png"))
    frames = [Image.open(path).convert("RGB").resize(SIZE, Image.LANCZOS) for path in paths]
    first, last = frames[0], frames[-1]
    frames += [Image.blend(last, first, k / (FADE + 1)) for k in range(1, FADE + 1)]
    starts = [round(1000 * k / FRAMES_PER_SECOND) for k in range(len(frames) + 1)]
    durations = [end - start for start, end in zip(starts, starts[1:])]
    durations[len(paths) - 1] += round(1000 * REST)
    # Large key frames and few of them: each one would let the still floor flicker.
    first.save(target, save_all=True, append_images=frames[1:], duration=durations, loop=0, quality=quality, method=6,
               minimize_size=False, kmin=len(frames) + 1, kmax=len(frames) + 2)
    print(f"{target}: {target.stat().st_size // 1000} kB, {len(frames)} frames, {sum(durations) / 1000:g} s")


def main():
    what, source, target = sys.argv[1:]
    {"frames": draw_frames, "join": join}[what](Path(source), Path(target))


if __name__ == "__main__":
    main()
