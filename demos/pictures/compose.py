#!/usr/bin/env python3
"""Draws the pictures from the files that the demos wrote; called by the script make.

compose.py drop  FOLDER PNG FRAME...         moments of the drop demo's sequence in FOLDER, side by side
compose.py gap   FOLDER PNG FOLDER FRAME     the same moment of two sequences from nearby, by the cage's nodes and by the
                                             surface
compose.py pile  FOLDER PNG FRAME            a moment of the pile demo's sequence, from two sides
compose.py pit   FOLDER PNG FRAME            a moment of its ball pit, and a heavy ball there from nearby
compose.py cages MESH.obj PNG CAGE.vtk...    cages around their mesh, side by side
compose.py turn  CAGE.vtk TURNED.vtk         a cage twisted about its z axis, for tetskin_deform
compose.py twist MESH.obj PNG MESH.obj       two surfaces that followed it, with their normals, side by side
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFilter, ImageFont

PANEL = 500       # pixels per side
GAP = 6           # pixels between panels
OVERSAMPLING = 2  # drawn larger and scaled down, as f3d's own smoothing leaves the edges of scales ragged
BACKGROUND = (244, 242, 238)
INK = (84, 86, 92)
SUN = np.array((0.30, -1.0, -0.25))  # the direction of the sun's light, for the shadows
FLOOR_HALF_SIDE = 8.0

# Position, focus, angle. The drop is seen from where the serpent looks to when it lies.
DROP_VIEW = (0.35, 1.75, 5.15), (0.06, -0.10, 0.1), 28.5
GAP_VIEW = (-0.5, -0.80, 5.5), (-0.05, -0.72, 0.0), 20.0
PILE_VIEWS = ((0.0, 5.5, 13.0), (0.0, 1.5, 0.0), 29.0), ((13.0, 5.0, -3.0), (0.0, 1.5, 0.0), 29.0)
PIT_VIEWS = ((4.4, 4.3, 6.6), (0.0, 0.15, 0.15), 32.0), ((2.0, 1.3, 2.5), (0.75, 0.45, 0.45), 29.0)
PIT_FRONT = np.array((1.0, 0.0, 1.0))  # walls on this side are left out, as they would hide the mat

TWIST = 1.8  # radians per unit of length
TWIST_VIEW = (0.9, 1.5, 4.2), (0.12, 0.44, 0.0), 22.0  # position, focus, angle

# The hand of demos/scenes/hand.cpp: its fingers go from its palm along `HAND_UP`, and bend towards `HAND_FRONT`.
HAND_UP, HAND_FRONT = np.array((0.0, np.cos(np.radians(50)), np.sin(np.radians(50)))), np.array((0.0, -np.sin(np.radians(50)), np.cos(np.radians(50))))
FINGER_X = np.array((-0.5, -0.25, 0.0, 0.25, 0.5))
ROOT, LENGTH = 1.0, 0.7
CURL = np.array((1.9, 0.0, 0.0, 1.9, 1.9))        # radians, for a whole finger's length
SPREAD = np.array((0.0, 0.22, -0.22, 0.0, 0.0))   # radians, to the side
HAND_VIEW = (-0.6, 4.2, 2.4), (0.0, 0.62, 0.72), 27.0

# Diffuse, ambient and specular colour, the last two as a share of the first. f3d has only a light beside the camera:
# without an ambient component, surfaces that face upwards would be black.
MATERIALS = {
    "scales": ((0.10, 0.44, 0.27), 1.0, 0.25, 0.25),
    "horn": ((0.80, 0.60, 0.34), 0.9, 0.25, 0.2),
    "ivory": ((0.95, 0.92, 0.80), 0.9, 0.2, 0.2),
    "eye": ((1.00, 0.62, 0.05), 0.9, 0.3, 0.3),
    "pupil": ((0.02, 0.02, 0.02), 1.0, 0.0, 0.3),
    "ramp": ((0.66, 0.74, 0.84), 0.4, 0.7, 0.0),
    "dome": ((0.93, 0.66, 0.50), 0.4, 0.7, 0.0),
    "floor": (tuple(c / 255 for c in BACKGROUND), 0.0, 1.0, 0.0),
    "cage": ((0.95, 0.45, 0.12), 0.0, 1.0, 0.0),
    "wall": ((0.78, 0.80, 0.82), 0.4, 0.7, 0.0),
    "pole": ((0.35, 0.36, 0.40), 0.6, 0.5, 0.2),
    "serpent": ((0.10, 0.44, 0.27), 1.0, 0.25, 0.25),
    "hand": ((0.86, 0.58, 0.42), 0.9, 0.3, 0.1),
    "bar": ((0.22, 0.38, 0.62), 0.9, 0.3, 0.1),
    "mat": ((0.62, 0.78, 0.80), 0.8, 0.4, 0.0),
    "mat_chequer": ((0.36, 0.60, 0.66), 0.8, 0.4, 0.0),
    "ball": ((0.93, 0.62, 0.22), 0.9, 0.25, 0.3),
    "heavy_ball": ((0.42, 0.43, 0.47), 0.9, 0.25, 0.4),
}


def read_obj(path):
    """Vertices, and the triangles of each (group, material), in order; a vertex is followed by its normal, if any."""
    vertices, normals, parts, group, material, triangles = [], [], [], "", "", None
    for line in open(path):
        word, _, rest = line.partition(" ")
        if word == "v":
            vertices.append(rest)
        elif word == "vn":
            normals.append(rest)
        elif word in ("g", "usemtl"):
            group, material = (rest.strip(), material) if word == "g" else (group, rest.strip())
            triangles = None
        elif word == "f":
            if triangles is None:
                triangles = []
                parts.append((group, material, triangles))
            triangles.append([int(corner.split("/")[0]) - 1 for corner in rest.split()])
    columns = [np.array([point.split() for point in points], float) for points in (vertices, normals) if points]
    return np.hstack(columns), [(g, m, np.array(t)) for g, m, t in parts]


def read_cage(path):
    """Nodes and tets of a legacy VTK file."""
    words = Path(path).read_text().split()
    at = words.index("POINTS")
    count = int(words[at + 1])
    nodes = np.array(words[at + 3:at + 3 + 3 * count], float).reshape(-1, 3)
    at = words.index("CELLS")
    count = int(words[at + 1])
    return nodes, np.array(words[at + 3:at + 3 + 5 * count], int).reshape(-1, 5)[:, 1:]


def smooth_normals(vertices, triangles):
    """Normals of the vertices, without which f3d would shade each triangle flat."""
    corners = vertices[triangles]
    face = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(normals, triangles[:, k], face)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)


class Scene:
    """Collects triangles by material, and has f3d draw them."""

    def __init__(self):
        self.lines, self.count = [], 0

    def add(self, material, vertices, triangles, uv=None):
        own = vertices[:, 3:]
        vertices = vertices[:, :3]
        normals = own if own.size else smooth_normals(vertices, triangles)
        uv = np.zeros((len(vertices), 2)) if uv is None else uv
        self.lines += ["v %.6f %.6f %.6f" % tuple(v) for v in vertices]
        self.lines += ["vn %.4f %.4f %.4f" % tuple(n) for n in normals]
        self.lines += ["vt %.5f %.5f" % tuple(t) for t in uv]
        self.lines += [f"g {material}", f"usemtl {material}"]
        for a, b, c in triangles + self.count + 1:
            self.lines.append(f"f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}")
        self.count += len(vertices)

    def draw(self, position, focus, angle, shadows=None):
        """One panel, seen from a position. Shadows: images by material, see shadow()."""
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            # f3d finds the materials by the name of the file, not by an mtllib line.
            (folder / "scene.obj").write_text("\n".join(self.lines) + "\n")
            with open(folder / "scene.mtl", "w") as out:
                for name, (colour, diffuse, ambient, specular) in MATERIALS.items():
                    out.write(f"newmtl {name}\nNs 40\n")
                    for key, part in (("Kd", diffuse), ("Ka", ambient)):
                        out.write("%s %g %g %g\n" % (key, *[part * c for c in colour]))
                    out.write("Ks %g %g %g\n" % (3 * (specular,)))
                    if shadows and name in shadows:
                        out.write(f"map_Kd {name}.png\n")
                        shadows[name].save(folder / f"{name}.png")
            # No --ssao: it darkens the floor towards the horizon.
            subprocess.run(
                ["xvfb-run", "-a", "f3d", "--dry-run", "--quiet", "scene.obj", "--output=scene.png", "--up=+Y",
                 "--fxaa", "--resolution=%d,%d" % (2 * (OVERSAMPLING * PANEL,)),
                 "--bg-color=%g,%g,%g" % tuple(c / 255 for c in BACKGROUND), "--camera-position=%g,%g,%g" % position,
                 "--camera-focal-point=%g,%g,%g" % focus, f"--camera-view-angle={angle}"], cwd=folder, check=True)
            return Image.open(folder / "scene.png").convert("RGB").resize((PANEL, PANEL), Image.LANCZOS)


def on_floor(points, floor):
    """The positions on the floor, as texture coordinates, of the shadows of points."""
    p = points + (floor - points[:, 1:2]) / SUN[1] * SUN
    return 0.5 + 0.5 * p[:, (0, 2)] / FLOOR_HALF_SIDE


def shadow(size, *surfaces):
    """A texture: white, and darker where a surface shades the floor. f3d itself casts no shadows."""
    image = Image.new("L", (size, size), 255)
    draw = ImageDraw.Draw(image)
    for uv, triangles in surfaces:
        for a, b, c in (uv * (1, -1) + (0, 1))[triangles] * size:
            draw.polygon([tuple(a), tuple(b), tuple(c)], fill=150)
    return image.filter(ImageFilter.GaussianBlur(0.005 * size)).convert("RGB")


def add_mesh(scene, vertices, parts):
    for _, material, triangles in parts:
        used, renumbered = np.unique(triangles, return_inverse=True)
        scene.add(material, vertices[used], renumbered.reshape(-1, 3))


def drop_panel(folder, frame, view):
    vertices, parts = read_obj(folder / f"frame_{frame:04d}.obj")
    points, ((_, _, base), (_, _, ramp), (_, _, dome)) = read_obj(folder / "obstacles.obj")
    floor = points[base, 1].max()
    scene = Scene()
    add_mesh(scene, vertices, parts)
    square = FLOOR_HALF_SIDE * np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]]) + (0, floor, 0)
    scene.add("floor", square, np.array([[0, 1, 2], [0, 2, 3]]), on_floor(square, floor))
    corners = points[ramp.ravel()]  # not shared by faces, as its edges are sharp
    scene.add("ramp", corners, np.arange(len(corners)).reshape(-1, 3), on_floor(corners, floor))
    used, renumbered = np.unique(dome, return_inverse=True)
    scene.add("dome", points[used], renumbered.reshape(-1, 3), on_floor(points[used], floor))

    serpent = on_floor(vertices, floor), np.concatenate([triangles for _, _, triangles in parts])
    # The rest of the sphere lies below the floor. The ramp's shadow falls behind it, out of sight.
    cap = on_floor(points, floor), dome[points[dome, 1].min(axis=1) > floor]
    shadows = {"floor": shadow(2048, serpent, cap), "ramp": shadow(2048, serpent), "dome": shadow(2048, serpent)}
    return scene.draw(*view, shadows)


def pile_panel(folder, frame, view):
    """A panel of the pile, without the wall that is between the viewer and the bodies."""
    scene = Scene()
    vertices, parts = read_obj(folder / f"frame_{frame:04d}.obj")
    add_mesh(scene, vertices, [(group, group, triangles) for group, _, triangles in parts])
    points, boxes = read_obj(folder / "obstacles.obj")
    floor = points[boxes[0][2], 1].max()
    square = FLOOR_HALF_SIDE * np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]]) + (0, floor, 0)
    bodies = on_floor(vertices, floor), np.concatenate([triangles for _, _, triangles in parts])
    scene.add("floor", square, np.array([[0, 1, 2], [0, 2, 3]]), on_floor(square, floor))
    for k, (_, _, box) in enumerate(boxes[1:]):
        corners = points[box.ravel()]
        is_pole = k % 3 == 2  # on each side: a wall that leans, one that does not, a pole
        if not is_pole and corners.mean(axis=0) @ (view[0] * np.array((1, 0, 1))) > 0:
            continue
        scene.add("pole" if is_pole else "wall", corners, np.arange(len(corners)).reshape(-1, 3))
    return scene.draw(*view, {"floor": shadow(2048, bodies)})


def pit_panel(folder, frame, view):
    scene = Scene()
    add_mesh(scene, *read_obj(folder / f"frame_{frame:04d}.obj"))
    points, boxes = read_obj(folder / "obstacles.obj")
    floor = points[boxes[0][2], 1].max()
    square = FLOOR_HALF_SIDE * np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]]) + (0, floor, 0)
    scene.add("floor", square, np.array([[0, 1, 2], [0, 2, 3]]))
    for _, _, box in boxes[1:]:
        corners = points[box.ravel()]
        if corners.mean(axis=0) @ PIT_FRONT < 0:
            scene.add("wall", corners, np.arange(len(corners)).reshape(-1, 3))
    return scene.draw(*view)


def cage_panel(mesh, cage):
    """The cage's boundary over the mesh, and its number of tets. Only faces towards the viewer: the rest is clutter."""
    position, focus = (-1.3, 2.0, 4.1), (-0.03, 0.45, 0.05)
    scene = Scene()
    add_mesh(scene, *read_obj(mesh))
    nodes, tets = read_cage(cage)
    faces = np.concatenate([tets[:, k] for k in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))])
    inside = np.tile(tets.sum(axis=1), 4) - faces.sum(axis=1)  # the tet's fourth node
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    faces, inside = faces[first[count == 1]], inside[first[count == 1]]
    a, b, c = (nodes[faces[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    normal *= -np.sign(np.sum(normal * (nodes[inside] - a), axis=1, keepdims=True))
    faces = faces[np.sum(normal * (position - a), axis=1) > 0]
    edges = np.unique(np.sort(np.concatenate([faces[:, (0, 1)], faces[:, (1, 2)], faces[:, (2, 0)]]), axis=1), axis=0)

    # f3d draws either surfaces or edges, so an edge is a thin prism.
    start, end = nodes[edges[:, 0]], nodes[edges[:, 1]]
    along = (end - start) / np.linalg.norm(end - start, axis=1, keepdims=True)
    aside = np.cross(along, np.where(np.abs(along[:, 1:2]) < 0.9, (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)))
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    above = np.cross(along, aside)
    # The more edges there are, the thinner they are: otherwise a fine cage hides its mesh.
    radius = min(0.005, 0.012 * len(edges) ** -0.22)
    ring = [radius * (np.cos(t) * aside + np.sin(t) * above) for t in 2 * np.pi / 3 * np.arange(3)]
    points = np.stack([tip + r for tip in (start, end) for r in ring], axis=1)
    prism = np.array([[0, 1, 3], [1, 2, 4], [2, 0, 5], [1, 4, 3], [2, 5, 4], [0, 3, 5]])
    scene.add("cage", points.reshape(-1, 3), (6 * np.arange(len(edges))[:, None, None] + prism).reshape(-1, 3))
    return scene.draw(position, focus, 25.5), len(tets)


def write_cage(nodes, tets, target):
    with open(target, "w") as out:
        out.write("# vtk DataFile Version 2.0\nmoved\nASCII\nDATASET UNSTRUCTURED_GRID\n")
        out.write(f"POINTS {len(nodes)} double\n")
        np.savetxt(out, nodes, "%.17g")
        out.write(f"CELLS {len(tets)} {5 * len(tets)}\n")
        np.savetxt(out, np.insert(tets, 0, 4, axis=1), "%d")
        out.write(f"CELL_TYPES {len(tets)}\n" + len(tets) * "10\n")


def turn(cage, target):
    """Writes a cage with its nodes turned about the z axis through their mean, in proportion to z."""
    nodes, tets = read_cage(cage)
    centre = nodes.mean(axis=0)
    x, y, z = (nodes - centre).T
    angle = TWIST * z
    turned = centre + np.stack([np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y, z], axis=1)
    write_cage(turned, tets, target)


def parts_beyond(tets, beyond):
    """A number for each node: the least index of the nodes connected with it by tets beyond the fingers' roots."""
    part = np.arange(len(beyond))
    tets = tets[beyond[tets].all(axis=1)]
    while True:
        least = part[tets].min(axis=1)
        before = part.copy()
        for k in range(4):
            np.minimum.at(part, tets[:, k], least)
        if (part == before).all():
            return part


def open_hand(cage, target):
    """Writes a cage of the hand with some fingers bent and two spread. Nodes move with the finger that they belong to:
    that of their component, or, where the cage joins all fingers in one component, the nearest."""
    nodes, tets = read_cage(cage)
    x, up, front = nodes[:, 0], nodes @ HAND_UP, nodes @ HAND_FRONT
    part = parts_beyond(tets, up > ROOT)
    where = x.copy()
    for number in np.unique(part):
        same = part == number
        if np.ptp(x[same]) < 0.4:
            where[same] = x[same].mean()
    finger = np.abs(where[:, None] - FINGER_X).argmin(axis=1)
    along = np.maximum(up - ROOT, 0.0)
    bend, aside = np.maximum(CURL[finger], 1e-6) * along / LENGTH, SPREAD[finger] * np.minimum(along / 0.25, 1.0)
    radius = LENGTH / np.maximum(CURL[finger], 1e-6)
    up = np.where(along > 0, ROOT + (radius - front) * np.sin(bend), up)
    front = np.where(along > 0, radius - (radius - front) * np.cos(bend), front)
    across, high = x - FINGER_X[finger], up - ROOT
    moved_x = FINGER_X[finger] + np.cos(aside) * across - np.sin(aside) * high
    moved_up = np.where(along > 0, ROOT + np.sin(aside) * across + np.cos(aside) * high, up)
    moved = moved_x[:, None] * np.array((1.0, 0.0, 0.0)) + moved_up[:, None] * HAND_UP + front[:, None] * HAND_FRONT
    write_cage(moved, tets, target)


def twist_panel(path):
    scene = Scene()
    add_mesh(scene, *read_obj(path))
    return scene.draw(*TWIST_VIEW)


def hand_panel(path):
    scene = Scene()
    vertices, parts = read_obj(path)
    add_mesh(scene, vertices, [(group, "hand", triangles) for group, _, triangles in parts])
    return scene.draw(*HAND_VIEW)


def save(panels, labels, gap, path):
    """The panels side by side, each with its label in a corner, in 256 colours, which takes a quarter of the size."""
    sheet = Image.new("RGB", (len(panels) * (PANEL + gap) - gap, PANEL), "white")
    draw = ImageDraw.Draw(sheet)
    font = ImageFont.truetype("DejaVuSans.ttf", 20)
    for k, (panel, label) in enumerate(zip(panels, labels)):
        x = k * (PANEL + gap)
        sheet.paste(panel, (x, 0))
        draw.text((x + 18, 14), label, INK, font)
    # The commonest colours alone would omit the eyes; the most different ones alone, soft shadows.
    common, different = sheet.quantize(155), sheet.quantize(100, Image.MAXCOVERAGE)
    palette = Image.new("P", (1, 1))
    palette.putpalette([*BACKGROUND, *common.getpalette()[:3 * 155], *different.getpalette()[:3 * 100]])
    sheet.quantize(palette=palette).save(path, optimize=True)
    print(f"{path}: {Path(path).stat().st_size // 1000} kB")


def main():
    what, source, target, *rest = sys.argv[1:]
    if what == "drop":
        frames = [int(frame) for frame in rest]
        labels = [f"{frame / 60:.1f} s" for frame in frames]
        save([drop_panel(Path(source), frame, DROP_VIEW) for frame in frames], labels, GAP, target)
    elif what == "gap":
        panels = [drop_panel(Path(folder), int(rest[1]), GAP_VIEW) for folder in (source, rest[0])]
        save(panels, ["by the cage's nodes", "by the surface"], GAP, target)
    elif what == "pile":
        save([pile_panel(Path(source), int(rest[0]), view) for view in PILE_VIEWS], ["", ""], GAP, target)
    elif what == "pit":
        save([pit_panel(Path(source), int(rest[0]), view) for view in PIT_VIEWS], ["", ""], GAP, target)
    elif what == "turn":
        turn(source, target)
    elif what == "open":
        open_hand(source, target)
    elif what == "hand":
        save([hand_panel(path) for path in (source, *rest)], ["a whole cage", "split"], GAP, target)
    elif what == "twist":
        save([twist_panel(path) for path in (source, *rest)], ["linear", "quadratic"], GAP, target)
    else:
        panels, tets = zip(*[cage_panel(source, cage) for cage in rest])
        save(panels, [f"{count:,} tets" for count in tets], 0, target)


if __name__ == "__main__":
    main()
