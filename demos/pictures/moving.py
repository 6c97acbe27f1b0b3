#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Makes the moving picture of the drop; called by the script make.

moving.py frames VIEW.html FOLDER   draws all frames of the demo's page in Chromium, as FOLDER/0000.png, ...
moving.py join FOLDER WEBP          plays them at half their speed, rests, and fades into the first one
"""
import base64
import io
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

SIZE = 720, 405
OVERSAMPLING = 1.5
DIRECTION = (0.0, 0.32, 1.0)  # to the camera: from here the face is seen when the serpent lies
BATCH = 40                    # frames per start of Chromium, which hands all of them over at once
FRAMES_PER_SECOND = 30        # of 60 that were simulated
REST, FADE = 0.7, 9           # seconds that the last frame stays, and the frames from it to the first
QUALITY = 85
BLOCK, DIFFERENCE = 16, 8      # pixels per side of a block, and levels of grey that make it differ

# Appended to the page: draws frames without their surroundings, and leaves them in the page's document.
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


def chunk(name, contents):
    return name + len(contents).to_bytes(4, "little") + contents + bytes(len(contents) % 2)


def numbers(*values):
    return b"".join(int(value).to_bytes(3, "little") for value in values)


def encoded(pixels):
    """The chunks of a WebP picture that have its pixels."""
    with io.BytesIO() as file:
        Image.fromarray(pixels).save(file, "WEBP", quality=QUALITY, method=4, exact=True)
        data, at, found = file.getvalue(), 12, b""
    while at < len(data):
        end = at + 8 + int.from_bytes(data[at + 4:at + 8], "little")
        if data[at:at + 4] in (b"ALPH", b"VP8 "):
            found += data[at:end + end % 2]
        at = end + end % 2
    return found


def blocks(values):
    """The largest value in each block of a picture."""
    high, wide = (-(-side // BLOCK) * BLOCK for side in values.shape)
    whole = np.zeros((high, wide), values.dtype)
    whole[:values.shape[0], :values.shape[1]] = values
    return whole.reshape(high // BLOCK, BLOCK, wide // BLOCK, BLOCK).max(axis=(1, 3))


def frame_chunk(frame, shown, duration):
    """A frame: only the blocks that differ from the shown picture; the others stay. Updates `shown` to the new picture.
    Pillow's own encoder would leave lines where its rectangles end."""
    error = blocks(np.abs(frame.astype(int) - shown).max(axis=2))
    changed = error >= min(DIFFERENCE, error.max())
    rows, columns = (np.flatnonzero(changed.any(axis=axis)) for axis in (1, 0))
    top, left = BLOCK * rows[0], BLOCK * columns[0]
    part = np.s_[top:BLOCK * (rows[-1] + 1), left:BLOCK * (columns[-1] + 1)]
    pixels = lambda mask: np.kron(mask, np.ones((BLOCK, BLOCK), bool))[:SIZE[1]][part]
    opaque = pixels(changed)
    # Colours bleed by a pixel: blocks around them have their true ones, if unseen, and only those beyond have none.
    near = np.pad(changed, 1)
    near = np.any([near[y:y + changed.shape[0], x:x + changed.shape[1]] for y in range(3) for x in range(3)], axis=0)
    own = np.where(pixels(near)[..., None], frame[part], 128).astype(np.uint8)
    shown[part] = np.where(opaque[..., None], frame[part], shown[part])
    if not opaque.all():
        own = np.dstack([own, np.where(opaque, 255, 0).astype(np.uint8)])
    high, wide = opaque.shape
    head = numbers(left // 2, top // 2, wide - 1, high - 1, duration) + b"\0"  # drawn over what is there, which remains
    return chunk(b"ANMF", head + encoded(own))


def join(folder, target):
    paths = sorted(folder.glob("*.png"))
    frames = [Image.open(path).convert("RGB").resize(SIZE, Image.LANCZOS) for path in paths]
    first, last = frames[0], frames[-1]
    frames += [Image.blend(last, first, k / (FADE + 1)) for k in range(1, FADE + 1)]
    starts = [round(1000 * k / FRAMES_PER_SECOND) for k in range(len(frames) + 1)]
    durations = [end - start for start, end in zip(starts, starts[1:])]
    durations[len(paths) - 1] += round(1000 * REST)
    animated, has_alpha, no_background, for_ever = 0x02, 0x10, bytes(4), bytes(2)
    shown = np.full((SIZE[1], SIZE[0], 3), -1000)
    data = b"WEBP" + chunk(b"VP8X", bytes([animated | has_alpha, 0, 0, 0]) + numbers(SIZE[0] - 1, SIZE[1] - 1))
    data += chunk(b"ANIM", no_background + for_ever)
    for frame, duration in zip(frames, durations):
        data += frame_chunk(np.asarray(frame), shown, duration)
    target.write_bytes(chunk(b"RIFF", data))
    print(f"{target}: {target.stat().st_size // 1000} kB, {len(frames)} frames, {sum(durations) / 1000:g} s")


def main():
    what, source, target = sys.argv[1:]
    {"frames": draw_frames, "join": join}[what](Path(source), Path(target))


if __name__ == "__main__":
    main()
