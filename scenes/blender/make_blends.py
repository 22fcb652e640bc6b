# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the .blend files of docs/from-cycles.md (a glass of water, a ring, a pool, a lamp), of docs/comparison.md (also
beams in fog) and of tests/blender, one for each theme of the add-on.

Usage: blender -b --factory-startup --python make_blends.py -- FOLDER [NAME...]
"""
import math
import os
import sys

import bpy


STEPS = 96  # of a full turn


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


def scattering(name, density, anisotropy):
    """A volume without a surface."""
    made = material(name, "Diffuse")
    tree = made.node_tree
    tree.nodes.remove(next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE"))
    medium = tree.nodes.new("ShaderNodeVolumeScatter")
    medium.inputs["Density"].default_value, medium.inputs["Anisotropy"].default_value = density, anisotropy
    tree.links.new(medium.outputs[0], next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL").inputs["Volume"])
    return made


def mesh(name, points, faces, made_of, is_smooth=True):
    made = bpy.data.meshes.new(name)
    made.from_pydata(points, [], faces)
    made.materials.append(made_of)
    for polygon in made.polygons:
        polygon.use_smooth = is_smooth
    if hasattr(made, "use_auto_smooth"):  # up to Blender 4.0; edges sharper than 30 degrees keep their normals
        made.use_auto_smooth, made.auto_smooth_angle = True, math.radians(30)
    return made


def lathe(name, profile, made_of, steps=STEPS):
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


def ball_profile(radius, steps=48):
    """Returns the profile of a sphere from the bottom up. Reversed, the sphere faces inwards."""
    return [(max(1e-5, radius * math.sin(math.pi * k / steps)), -radius * math.cos(math.pi * k / steps))
            for k in range(steps + 1)]


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
    made.lens, made.clip_start = lens, 1e-3
    bpy.context.scene.camera = put("camera", made, location, rotation)


def glass_of_water():
    start()
    put("table", plane(3, material("table", "Principled", **{"Base Color": (0.55, 0.42, 0.32, 1), "Roughness": 0.5})))
    glass = material("glass", "Glass", IOR=1.5, Roughness=0.0)
    # Outside up, inside down: a wall of 3 mm and a bottom of 1 cm. A shader's index is that of the side from which its
    # normals point away over that of the other: where water touches the glass, 1.5 / 1.33.
    profile = [(1e-5, 0.001), (0.034, 0.001), (0.0355, 0.002), (0.036, 0.004), (0.04, 0.12), (0.0395, 0.1213),
               (0.0385, 0.1218), (0.0375, 0.1213), (0.037, 0.12), (0.0358, 0.085), (0.0335, 0.013), (0.033, 0.0116),
               (0.031, 0.011), (1e-5, 0.011)]
    tumbler = lathe("tumbler", profile, glass)
    tumbler.materials.append(material("glass under water", "Glass", IOR=1.5 / 1.33, Roughness=0.0))
    first_wet_row = profile.index((0.0358, 0.085))
    for polygon in tumbler.polygons:
        polygon.material_index = int(polygon.index // STEPS >= first_wet_row)
    put("tumbler", tumbler)
    put("water", lathe("water", [(0.0358, 0.085), (1e-5, 0.085)], material("water", "Glass", IOR=1.33, Roughness=0.0)))
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
    tiles = material("tiles", "Diffuse", Color=(0.55, 0.75, 0.8, 1))
    put("floor", plane(8, tiles, z=-1.2))
    # Without walls, light would enter the water from the sides without refraction, which renderers treat differently.
    corners = [(-4, -4), (4, -4), (4, 4), (-4, 4)]
    put("walls", mesh("walls", [(x, y, z) for z in (-1.2, 0.05) for x, y in corners],
                      [(i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4) for i in range(4)], tiles, is_smooth=False))
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
    put("bulb", lathe("bulb", ball_profile(0.12), glass), (0, 0.3, 0.45))
    put("bulb inside", lathe("bulb inside", ball_profile(0.112)[::-1], glass), (0, 0.3, 0.45))
    lamp("POINT", 15, (0, 0.3, 0.45), shadow_soft_size=0.02)
    camera((0.2, -1.9, 0.75), (math.radians(80), 0, math.radians(5)), lens=45)


def tile_with_hole(size, radius, made_of, steps=64):
    """A square in the plane z = 0 with a round hole in its middle."""
    points, faces = [], []
    for i in range(steps):
        c, s = math.cos(2 * math.pi * (i + 0.5) / steps), math.sin(2 * math.pi * (i + 0.5) / steps)
        edge = size / 2 / max(abs(c), abs(s))
        points += [(radius * c, radius * s, 0), (edge * c, edge * s, 0)]
    corners = [(x * size / 2, y * size / 2, 0) for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
    for i in range(steps):
        a, b = 2 * i, 2 * ((i + 1) % steps)
        faces.append((a, a + 1, b + 1, b))
        if (i + 1) % (steps // 4) == steps // 8:
            faces.append((a + 1, 2 * steps + i // (steps // 4), b + 1))
    return mesh("tile", points + corners, faces, made_of, is_smooth=False)


def lens(radius, curvature, made_of, steps=24):
    """A lens whose two sides are parts of spheres; its rim is sharp."""
    half = math.asin(radius / curvature)
    sides = [(curvature * math.sin(half * k / steps), curvature * (math.cos(half * k / steps) - math.cos(half)))
             for k in range(steps + 1)]
    profile = [(max(1e-5, r), -z) for r, z in sides] + [(max(1e-5, r), z) for r, z in reversed(sides[:-1])]
    return lathe("lens", profile, made_of)


def beams():
    """Fog below a board with three holes: light passes freely through one, through a ball and a lens in the others."""
    scene = start()
    scene.world.color = (0.004, 0.005, 0.007)
    put("floor", plane(8, material("floor", "Diffuse", Color=(0.5, 0.5, 0.5, 1))))
    wood = material("board", "Diffuse", Color=(0.2, 0.15, 0.1, 1))
    board = tile_with_hole(0.7, 0.15, wood)
    for x in (-0.7, 0, 0.7):
        put("board", board, (x, 0, 1.5))
    for x, y, width, depth in ((0, -1.35, 6, 2), (0, 1.35, 6, 2), (-2.025, 0, 1.95, 0.7), (2.025, 0, 1.95, 0.7)):
        put("board", plane(1, wood), (x, y, 1.5)).scale = (width, depth, 1)
    put("ball", lathe("ball", ball_profile(0.16), material("water", "Glass", IOR=1.33, Roughness=0.0)), (0, 0, 1.5))
    put("lens", lens(0.16, 0.45, material("glass", "Glass", IOR=1.5, Roughness=0.0)), (0.7, 0, 1.5))
    cube("fog", 1, (0, 0, 0.69), scattering("fog", 0.5, 0.3)).scale = (3, 1.2, 1.3)
    lamp("AREA", 900, (0, 0, 3.2), shape="DISK", size=0.05)
    camera((0, -3.6, 0.8), (math.radians(88), 0, 0), lens=42)


def ball(name, radius, location, made_of, steps=48):
    """A smooth sphere."""
    return put(name, lathe(name, ball_profile(radius, steps), made_of, 2 * steps), location)


def cube(name, size, location, made_of, rotation=(0, 0, 0)):
    s = size / 2
    points = [(x, y, z) for x in (-s, s) for y in (-s, s) for z in (-s, s)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return put(name, mesh(name, points, faces, made_of, is_smooth=False), location, rotation)


def stage():
    """A floor under a bright sky and a sun, and a camera."""
    scene = start()
    scene.world.color = (0.5, 0.55, 0.6)
    put("floor", plane(8, material("floor", "Diffuse", Color=(0.6, 0.58, 0.55, 1))))
    lamp("SUN", 2, (0, 0, 3), (math.radians(40), 0, math.radians(35)), angle=0)
    camera((0, -4.5, 2.2), (math.radians(68), 0, 0), lens=45)
    return scene


def colored(name, *color):
    return material(name, "Diffuse", Color=(*color, 1))


def modifiers():
    stage()
    arrayed = cube("arrayed", 0.5, (-1.3, 0.3, 0.25), colored("red", 0.7, 0.15, 0.1))
    array = arrayed.modifiers.new("array", "ARRAY")
    array.count, array.relative_offset_displace = 3, (0.3, 0.2, 1.05)
    rounded = cube("rounded", 0.9, (0.3, 0.2, 0.5), colored("green", 0.2, 0.6, 0.2))
    rounded.modifiers.new("subdivision", "SUBSURF").render_levels = 3
    solid = put("solid", plane(0.8, colored("blue", 0.15, 0.25, 0.7)), (1.4, 0.2, 0.4), (0.9, 0.3, 0.5))
    solid.modifiers.new("solidify", "SOLIDIFY").thickness = 0.15


def instances():
    stage()
    pair = bpy.data.collections.new("pair")
    for i, color in enumerate(((0.8, 0.5, 0.1), (0.1, 0.5, 0.8))):
        part = ball(f"part{i}", 0.15, (0.35 * i, 0, 0.15 + 0.1 * i), colored(f"part{i}", *color), 16)
        bpy.context.scene.collection.objects.unlink(part)
        pair.objects.link(part)
    for i in range(12):
        empty = put(f"place{i}", None, (i % 4 - 1.6, i // 4 - 0.8, 0), (0, 0, 0.5 * i))
        empty.instance_type, empty.instance_collection = "COLLECTION", pair
        empty.scale = (1, 1, 1 + 0.1 * i)


def text_and_curves():
    stage()
    text = bpy.data.curves.new("text", "FONT")
    text.body, text.size, text.extrude = "Lanthorn", 0.7, 0.06
    text.materials.append(colored("ink", 0.1, 0.2, 0.5))
    put("text", text, (-1.5, 0.4, 0.1), (math.radians(80), 0, 0))
    wire = bpy.data.curves.new("wire", "CURVE")
    wire.dimensions, wire.bevel_depth = "3D", 0.05
    spline = wire.splines.new("BEZIER")
    spline.bezier_points.add(3)
    for i, point in enumerate(spline.bezier_points):
        point.co = (i - 1.5, -0.7, 0.25 + 0.2 * (i % 2))
        point.handle_left_type = point.handle_right_type = "AUTO"
    wire.materials.append(colored("copper", 0.8, 0.4, 0.2))
    put("wire", wire)


def sky():
    scene = stage()
    bpy.data.objects.remove(bpy.data.objects["sun"])
    scene.world.use_nodes = True
    tree = scene.world.node_tree
    texture = tree.nodes.new("ShaderNodeTexSky")
    texture.sky_type, texture.sun_elevation, texture.sun_rotation = "NISHITA", math.radians(40), math.radians(140)
    background = tree.nodes["Background"]
    background.inputs["Strength"].default_value = 0.05
    tree.links.new(texture.outputs[0], background.inputs["Color"])
    ball("ball", 0.6, (0, 0, 0.6), colored("white", 0.8, 0.8, 0.8))


def noise():
    stage()
    made = colored("stone", 1, 1, 1)
    tree = made.node_tree
    texture, ramp = tree.nodes.new("ShaderNodeTexNoise"), tree.nodes.new("ShaderNodeValToRGB")
    texture.inputs["Scale"].default_value = 3
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.1, 0.2, 0.1, 1), (0.9, 0.8, 0.6, 1)
    ramp.color_ramp.elements[0].position, ramp.color_ramp.elements[1].position = 0.4, 0.6
    tree.links.new(texture.outputs["Fac"], ramp.inputs["Fac"])
    tree.links.new(ramp.outputs["Color"], next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE").inputs["Color"])
    ball("ball", 0.7, (-0.8, 0, 0.7), made)
    cube("cube", 1.0, (0.9, 0, 0.5), made, (0, 0, 0.6))


def hair():
    stage()
    head = ball("head", 0.6, (0, 0, 0.9), colored("skin", 0.5, 0.3, 0.2), 24)
    head.data.materials.append(material("hair", "HairPrincipled", Color=(0.35, 0.2, 0.1, 1)))
    head.modifiers.new("hair", "PARTICLE_SYSTEM")
    settings = head.particle_systems[0].settings
    settings.type, settings.count, settings.hair_length, settings.material = "HAIR", 600, 0.4, 2
    settings.root_radius, settings.tip_radius, settings.radius_scale = 1.0, 0.4, 0.03


def fog():
    scene = start()
    scene.world.color = (0.02, 0.02, 0.02)
    put("floor", plane(8, colored("floor", 0.5, 0.5, 0.5)))
    cube("fog", 2.0, (0, 0, 1.05), scattering("fog", 0.4, 0.3))
    lamp("AREA", 150, (1.8, -0.5, 3.2), (math.radians(-8), math.radians(35), 0), size=0.4)
    camera((0, -6, 2.0), (math.radians(80), 0, 0), lens=50)


def metals():
    stage()
    for i, roughness in enumerate((0.1, 0.3, 0.6)):
        made = material(f"metal{i}", "Principled", **{"Base Color": (0.9, 0.6, 0.3, 1), "Metallic": 1.0,
                                                      "Roughness": roughness})
        ball(f"ball{i}", 0.45, (1.1 * i - 1.1, 0, 0.45), made)


def lamps():
    scene = stage()
    scene.world.color = (0.02, 0.02, 0.03)
    bpy.data.objects.remove(bpy.data.objects["sun"])
    glow = material("glow", "Diffuse")
    glow.node_tree.nodes.remove(next(n for n in glow.node_tree.nodes if n.type == "BSDF_DIFFUSE"))
    emission = glow.node_tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value, emission.inputs["Strength"].default_value = (1, 0.5, 0.2, 1), 4
    glow.node_tree.links.new(emission.outputs[0], next(n for n in glow.node_tree.nodes if n.type == "OUTPUT_MATERIAL").inputs[0])
    cube("glowing", 0.4, (-1.2, 0, 0.5), glow)
    lamp("SPOT", 120, (1.4, -0.6, 2.5), (math.radians(15), math.radians(15), 0), spot_size=0.7, shadow_soft_size=0)
    lamp("AREA", 25, (0, 1.0, 2.5), (math.radians(-20), 0, 0), shape="RECTANGLE", size=1.2, size_y=0.4)
    ball("ball", 0.4, (0.4, 0, 0.4), colored("white", 0.8, 0.8, 0.8))


def focus():
    stage()
    for i in range(5):
        ball(f"ball{i}", 0.3, (0.6 * i - 1.2, 0.9 * i - 1.6, 0.3), colored(f"c{i}", 0.2 * i, 0.4, 0.9 - 0.2 * i), 24)
    lens = bpy.context.scene.camera.data
    lens.dof.use_dof, lens.dof.focus_distance, lens.dof.aperture_fstop = True, 4.8, 0.2


def deformed():
    stage()
    bent = ball("bent", 0.6, (0, 0, 0.8), colored("clay", 0.7, 0.4, 0.3))
    bent.shape_key_add(name="rest")
    key = bent.shape_key_add(name="stretched")
    for point in key.data:
        point.co.z *= 1.3
        point.co.x += 0.3 * point.co.z
    key.value = 0.8
    bones = put("bones", bpy.data.armatures.new("bones"))
    bpy.context.view_layer.objects.active = bones
    bpy.ops.object.mode_set(mode="EDIT")
    bone = bones.data.edit_bones.new("bone")
    bone.head, bone.tail = (0, 0, 0), (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    bones.pose.bones["bone"].location = (0.5, 0, 0)
    bent.vertex_groups.new(name="bone").add(range(len(bent.data.vertices)), 1.0, "REPLACE")
    bent.modifiers.new("armature", "ARMATURE").object = bones


SCENES = {"glass-of-water": glass_of_water, "ring": ring, "pool": pool, "lamp": lamp_with_shade, "beams": beams,
          "modifiers": modifiers, "instances": instances, "text-and-curves": text_and_curves, "sky": sky, "noise": noise,
          "hair": hair, "fog": fog, "metals": metals, "lamps": lamps, "focus": focus, "deformed": deformed}

if __name__ == "__main__":
    folder, *names = sys.argv[sys.argv.index("--") + 1:]
    folder = os.path.abspath(folder)  # Blender refuses relative paths
    os.makedirs(folder, exist_ok=True)
    for name in names or SCENES:
        SCENES[name]()
        bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, f"{name}.blend"), compress=True)
