# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Renders the .blend files of make_blends.py with Cycles and with Lanthorn, in the same time: the pictures of
docs/from-cycles.md. The add-on must be enabled, or lie in ../../blender.

Usage: blender -b --factory-startup --python render_both.py -- FOLDER SECONDS NAME...
Reads FOLDER/NAME.blend; writes FOLDER/NAME-cycles.png and FOLDER/NAME-lanthorn.png.
"""
import os
import sys
import time

import bpy

WIDTH, HEIGHT = 320, 240


def enable():
    sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "blender"))
    import lanthorn
    lanthorn.register()


def render(engine, path, seconds):
    scene = bpy.context.scene
    scene.render.engine = engine
    if engine == "CYCLES":  # Blender's defaults, but for the end
        scene.cycles.device, scene.cycles.use_denoising = "CPU", False
        scene.cycles.time_limit, scene.cycles.samples = seconds, 1 << 20
        scene.cycles.use_adaptive_sampling = False
    else:
        scene.lanthorn.noise, scene.lanthorn.seconds = 0, seconds
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = path
    start = time.monotonic()
    bpy.ops.render.render(write_still=True)
    print(f"{os.path.basename(path)}: {time.monotonic() - start:.1f} s", flush=True)


if __name__ == "__main__":
    folder, seconds, *names = sys.argv[sys.argv.index("--") + 1:]
    folder = os.path.abspath(folder)  # Blender refuses relative paths
    enable()
    for name in names:
        bpy.ops.wm.open_mainfile(filepath=os.path.join(folder, f"{name}.blend"))
        bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = WIDTH, HEIGHT
        for engine in ("CYCLES", "LANTHORN"):
            render(engine, os.path.join(folder, f"{name}-{engine.lower()}.png"), float(seconds))
