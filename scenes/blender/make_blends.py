# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the .blend files of docs/blender.md: a glass of water, a ring, a pool, a lamp.

Usage: blender -b --factory-startup --python make_blends.py -- FOLDER
"""
import math
import os
import sys

import bpy


def start(width=480, height=360):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.view_settings.view_transform = "Filmic"
    scene.world = bpy.data.worlds.new("world")
    scene.world.color = (0.03, 0.035, 0.045)
    return scene


def put(name, data, location=(0, 0, 0), rotation=(0, 0, 0)):
    made = bpy.data.objects.new(name, data)
    made.location, made.rotation_euler = location, rotation
    bpy.context.scene.collection.objects.link(made)
    return made


def material(name, kind, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    shader = tree.nodes.new(f"ShaderNodeBsdf{kind}")
    for key, value in inputs.items():
        shader.inputs[key].default_value = value
    tree.links.new(shader.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return made


def mesh(name, points, faces, made_of, is_smooth=True):
    made = bpy.data.meshes.new(name)
    made.from_pydata(points, [], faces)
    made.materials.append(made_of)
    for polygon in made.polygons:
        polygon.use_smooth = is_smooth
    return made


def lathe(name, profile, made_of, steps=96):
    """A surface of revolution about z. `profile`: (radius, z); from the axis to the axis, outside on the right."""
    points, faces = [], []
    for radius, z in profile:
        for i in range(steps):
            angle = 2 * math.pi * i / steps
            points.append((radius * math.cos(angle), radius * math.sin(angle), z))
    for row in range(len(profile) - 1):
        for i in range(steps):
            j = (i + 1) % steps
            a, b = row * steps, (row + 1) * steps
            faces.append((a + i, a + j, b + j, b + i))
    return mesh(name, points, faces, made_of)


def plane(size, made_of, z=0.0):
    s = size / 2
    return mesh("plane", [(-s, -s, z), (s, -s, z), (s, s, z), (-s, s, z)], [(0, 1, 2, 3)], made_of)


def lamp(kind, energy, location, rotation=(0, 0, 0), **members):
    light = bpy.data.lights.new(kind.lower(), kind)
    light.energy = energy
    for name, value in members.items():
        setattr(light, name, value)
    return put(kind.lower(), light, location, rotation)


def camera(location, rotation, lens=50):
    made = bpy.data.cameras.new("camera")
    made.lens = lens
    bpy.context.scene.camera = put("camera", made, location, rotation)


def glass_of_water():
    start()
    put("table", plane(3, material("table", "Principled", **{"Base Color": (0.55, 0.42, 0.32, 1), "Roughness": 0.5})))
    glass = material("glass", "Glass", IOR=1.5, Roughness=0.0)
    # Outside up, inside down: a wall of 3 mm and a bottom of 1 cm.
    put("tumbler", lathe("tumbler", [(1e-5, 0.001), (0.034, 0.001), (0.036, 0.004), (0.04, 0.12), (0.0385, 0.1215),
                                     (0.037, 0.12), (0.0335, 0.013), (0.031, 0.011), (1e-5, 0.011)], glass))
    # The water is a little wider than the inside of the glass, so that no air is between them.
    put("water", lathe("water", [(1e-5, 0.0105), (0.0315, 0.0105), (0.034, 0.0135), (0.0364, 0.085), (1e-5, 0.085)],
                       material("water", "Glass", IOR=1.33, Roughness=0.0)))
    lamp("AREA", 3, (-0.35, 0.25, 0.45), (math.radians(-32), math.radians(-36), 0), size=0.06)
    camera((0.05, -0.5, 0.26), (math.radians(66), 0, math.radians(4)), lens=55)


def ring():
    start()
    put("paper", plane(3, material("paper", "Diffuse", Color=(0.8, 0.78, 0.74, 1))))
    gold = material("gold", "Principled", **{"Base Color": (1, 0.77, 0.34, 1), "Metallic": 1.0, "Roughness": 0.05})
    profile = [(0.0102, 0.0), (0.0108, 0.0005), (0.0108, 0.0045), (0.0102, 0.005), (0.0098, 0.0045), (0.0098, 0.0005),
               (0.0102, 0.0)]
    put("ring", lathe("ring", profile, gold, steps=192), (0, 0, 0.0001))
    lamp("SUN", 4, (0, 0, 1), (math.radians(55), 0, math.radians(40)), angle=0)
    camera((0.0, -0.06, 0.055), (math.radians(46), 0, 0), lens=60)


def pool():
    scene = start()
    scene.world.color = (0.35, 0.5, 0.8)
    put("floor", plane(8, material("tiles", "Diffuse", Color=(0.55, 0.75, 0.8, 1)), z=-1.2))
    n = 160
    points, faces = [], []
    for j in range(n + 1):
        for i in range(n + 1):
            x, y = 8 * i / n - 4, 8 * j / n - 4
            z = 0.018 * math.sin(3.1 * x + 1.3 * y) + 0.012 * math.sin(5.3 * y - 2.1 * x) + 0.008 * math.sin(9 * x + 7 * y)
            points.append((x, y, z))
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i
            faces.append((a, a + 1, a + n + 2, a + n + 1))
    put("surface", mesh("surface", points, faces, material("water", "Glass", IOR=1.33, Roughness=0.0)))
    lamp("SUN", 4, (0, 0, 3), (math.radians(30), math.radians(15), 0), angle=0)
    camera((0, -3.2, 2.2), (math.radians(50), 0, 0), lens=35)


def lamp_with_shade():
    start()
    put("wall", plane(6, material("wall", "Diffuse", Color=(0.7, 0.7, 0.68, 1))), (0, 1.0, 0), (math.pi / 2, 0, 0))
    put("table", plane(6, material("table", "Diffuse", Color=(0.5, 0.35, 0.25, 1))))
    glass = material("bulb glass", "Glass", IOR=1.5, Roughness=0.0)
    def ball(radius, sign):
        steps = 48
        return [(max(1e-5, radius * math.sin(math.pi * k / steps)), -sign * radius * math.cos(math.pi * k / steps))
                for k in range(steps + 1)]
    put("bulb", lathe("bulb", ball(0.12, 1), glass), (0, 0.3, 0.45))
    put("bulb inside", lathe("bulb inside", ball(0.112, -1), glass), (0, 0.3, 0.45))
    lamp("POINT", 15, (0, 0.3, 0.45), shadow_soft_size=0.02)
    camera((0.2, -1.9, 0.75), (math.radians(80), 0, math.radians(5)), lens=45)


SCENES = {"glass-of-water": glass_of_water, "ring": ring, "pool": pool, "lamp": lamp_with_shade}

if __name__ == "__main__":
    folder = sys.argv[sys.argv.index("--") + 1]
    os.makedirs(folder, exist_ok=True)
    for name, make in SCENES.items():
        make()
        bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, f"{name}.blend"), compress=True)
