# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""Compares what Blender makes of a run's GLB and PC2 with its OBJ frames: python3 blender.py FOLDER

FOLDER is the --out of a demo with one body that wrote --format obj,glb or obj,glb,pc2. Needs the module bpy (pip
install bpy). Exit status 1 if a vertex is farther off than 1e-4 of the body's size.
"""
import pathlib
import re
import sys

import bpy
import mathutils
import numpy as np

FRAME_RATE = 60
TOLERANCE = 1e-4


def frame_positions(path):
    """The vertices of an OBJ file, in Blender's space, where z is up."""
    lines = path.read_text().splitlines()
    x, y, z = np.array([line.split()[1:4] for line in lines if line.startswith('v ')], dtype=float).T
    return np.stack([x, -z, y], axis=1)


def shown_positions(thing):
    """The vertices of an object with its modifiers, in the world."""
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    points = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get('co', points)
    place = np.array(evaluated.matrix_world)
    return points.reshape(-1, 3) @ place[:3, :3].T + place[:3, 3]


def empty_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = FRAME_RATE
    return bpy.context.scene


def vertices_of_file(scene, frames, thing):
    """By vertex of Blender's mesh: its number in the OBJ. A GLB's vertices are split where materials meet."""
    number, path = frames[0]
    scene.frame_set(number)
    expected, shown = frame_positions(path), shown_positions(thing)
    if len(shown) == len(expected):
        return np.arange(len(expected))
    tree = mathutils.kdtree.KDTree(len(expected))
    for index, position in enumerate(expected):
        tree.insert(position, index)
    tree.balance()
    return np.array([tree.find(position)[1] for position in shown])


def compare(what, thing, scene, frames):
    worst = 0.0
    order = vertices_of_file(scene, frames, thing)
    for number, path in frames:
        scene.frame_set(number)
        expected = frame_positions(path)
        size = (expected.max(axis=0) - expected.min(axis=0)).max()
        worst = max(worst, np.linalg.norm(shown_positions(thing) - expected[order], axis=1).max() / size)
    print(f'{what}: {len(frames)} frames, at most {worst:.1e} of the body\'s size off')
    return worst < TOLERANCE


def main():
    folder = pathlib.Path(sys.argv[1])
    frames = [(int(re.findall(r'\d+', path.name)[0]), path) for path in sorted(folder.glob('frame_*.obj'))]
    scene = empty_scene()
    bpy.ops.import_scene.gltf(filepath=str(folder / 'animation.glb'), merge_vertices=False)
    skinned = [thing for thing in bpy.data.objects if thing.type == 'MESH' and thing.vertex_groups]
    good = compare('GLB', skinned[0], scene, frames)
    if (folder / 'animation.pc2').exists():
        scene = empty_scene()
        bpy.ops.wm.obj_import(filepath=str(folder / 'animation.obj'), use_split_objects=False)
        thing = next(thing for thing in bpy.data.objects if thing.type == 'MESH')
        cache = thing.modifiers.new('cache', 'MESH_CACHE')
        cache.cache_format = 'PC2'
        cache.filepath = str(folder / 'animation.pc2')
        cache.frame_start = 0
        cache.frame_scale = 1 / (frames[1][0] - frames[0][0])
        good = compare('PC2', thing, scene, frames) and good
    sys.exit(0 if good else 1)


main()
