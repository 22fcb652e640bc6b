# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Renders a .blend file of make_blends.py by a method for a given processor time: the pictures of docs/comparison.md.

Usage: blender -b --factory-startup --python equal_time.py -- FOLDER NAME METHOD SECONDS WIDTH [SEED]
METHOD: "cycles-default"; "cycles", with no setting that darkens caustics; "cycles-mnee", also with shadow caustics;
"cycles-mnee-point", the same with lamps of size 0, since Cycles 3.4 finds no lamp with a size inside two surfaces;
or a method of Lanthorn: "path", "bdpt", "auto".
Reads FOLDER/NAME.blend; writes FOLDER/NAME-METHOD.exr (linear), .png (as Blender shows it) and .json (measurements).
A seed other than 0 is part of these names. Two short renders, whose time does not count, determine how many samples or
passes take SECONDS of processor time.

Usage: blender -b --factory-startup --python equal_time.py -- FOLDER NAME bare
Renders the scene without its glass or metal by Cycles and by `path`, and prints the ratio of the means: 1 if both
render lamps, cameras, fog and floors alike.
"""
import json
import os
import resource
import sys
import tempfile
import time

import bpy
import numpy

BOUNCES = 32
LEAST = 2     # samples or passes of the first short render
SHARE = 0.12  # of the time, for the second
THROWS_CAUSTICS = {"BSDF_GLASS", "BSDF_PRINCIPLED"}  # shaders of the glass and the metal in these scenes


def enable():
    sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "blender"))
    import lanthorn
    lanthorn.register()


def throws_caustics(thing):
    materials = [slot.material for slot in thing.material_slots if slot.material]
    return any(node.type in THROWS_CAUSTICS for m in materials for node in m.node_tree.nodes)


def set_cycles(scene, has_mnee):
    """Turns off all settings that darken caustics."""
    cycles = scene.cycles
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy, cycles.sample_clamp_direct, cycles.sample_clamp_indirect = 0, 0, 0
    for kind in ("max", "diffuse", "glossy", "transmission", "volume"):
        setattr(cycles, f"{kind}_bounces", BOUNCES)
    for thing in bpy.data.objects:
        if thing.type == "LIGHT":
            thing.data.cycles.is_caustics_light = has_mnee
        elif thing.type == "MESH":
            is_glass = throws_caustics(thing)
            thing.cycles.is_caustics_caster, thing.cycles.is_caustics_receiver = has_mnee and is_glass, has_mnee and not is_glass


def choose(method, seed):
    """Sets the scene for the method. Returns a function that sets the number of samples or passes."""
    scene = bpy.context.scene
    if method.startswith("cycles"):
        cycles = scene.cycles
        scene.render.engine, cycles.device, cycles.seed, cycles.time_limit = "CYCLES", "CPU", seed, 0
        # Adaptive sampling stops at pixels that no caustic path has reached yet.
        cycles.use_denoising = cycles.use_adaptive_sampling = False
        if method != "cycles-default":
            set_cycles(scene, has_mnee="mnee" in method)
        if method == "cycles-mnee-point":
            for light in bpy.data.lights:
                light.shadow_soft_size = 0
        return lambda count: setattr(cycles, "samples", count)
    scene.render.engine = "LANTHORN"
    ours = scene.lanthorn
    ours.method, ours.seed, ours.noise, ours.seconds, ours.denoise = method, seed, 0, 0, False
    return lambda count: setattr(ours, "passes", count)


def processor_time():
    return sum(usage.ru_utime + usage.ru_stime for usage in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))


def render():
    """Returns seconds of processor time and of the clock."""
    processor, clock = processor_time(), time.monotonic()
    bpy.ops.render.render()
    return processor_time() - processor, time.monotonic() - clock


def count_for(seconds, set_count):
    """Returns how many samples or passes take this time, measured by two short renders."""
    counts, times = [LEAST], []
    for _ in range(2):
        set_count(counts[-1])
        times.append(render()[0])
        counts.append(max(3 * LEAST, round(SHARE * seconds / (times[0] / LEAST))))
    each = (times[1] - times[0]) / (counts[1] - counts[0])
    before = times[0] - counts[0] * each
    print(f"{before:.2f} s and {each:.3f} s for each sample or pass", flush=True)
    return max(1, round((seconds - before) / each))


def save(path, kind):
    settings = bpy.context.scene.render.image_settings
    settings.file_format = kind
    settings.color_depth = "32" if kind == "OPEN_EXR" else "8"
    bpy.data.images["Render Result"].save_render(path)


def measure(folder, name, method, seconds, width, seed):
    set_size(width)
    set_count = choose(method, seed)
    count = count_for(seconds, set_count)
    set_count(count)
    processor, clock = render()
    stem = os.path.join(folder, f"{name}-{method}" + (f"-{seed}" if seed else ""))
    save(stem + ".exr", "OPEN_EXR")
    save(stem + ".png", "PNG")
    with open(stem + ".json", "w") as file:
        json.dump({"count": count, "seconds": round(processor, 1), "clock": round(clock, 1)}, file)
    print(f"{stem}: {count} samples or passes in {processor:.1f} s of processor time, {clock:.1f} s", flush=True)


def set_size(width):
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, width * 3 // 4, 100


def blocks(method, count):
    """Means of 8 x 8 pixels, red, green and blue."""
    set_count = choose(method, 0)
    set_count(count)
    render()
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "picture.exr")
        save(path, "OPEN_EXR")
        image = bpy.data.images.load(path)
        width, height = image.size
        pixels = numpy.array(image.pixels[:]).reshape(height // 8, 8, width // 8, 8, 4)
        return pixels[..., :3].mean(axis=(1, 3))


def compare_bare(name):
    set_size(160)
    for thing in bpy.data.objects:
        if thing.type == "MESH" and throws_caustics(thing):
            thing.hide_render = True
    ours, cycles = blocks("path", 64), blocks("cycles", 64)
    ratio = ours.mean(axis=(0, 1)) / cycles.mean(axis=(0, 1))
    print(f"{name} without glass and metal, path / cycles in red, green and blue: " + " ".join(f"{r:.4f}" for r in ratio), flush=True)


if __name__ == "__main__":
    folder, name, method, *numbers = sys.argv[sys.argv.index("--") + 1:]
    folder = os.path.abspath(folder)  # Blender refuses relative paths
    enable()
    bpy.ops.wm.open_mainfile(filepath=os.path.join(folder, f"{name}.blend"))
    if method == "bare":
        compare_bare(name)
    else:
        seconds, width, *seed = numbers
        measure(folder, name, method, float(seconds), int(width), int(seed[0]) if seed else 0)
