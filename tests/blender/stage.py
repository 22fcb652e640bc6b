# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Shared by the scripts in headless Blender: makes scenes, renders them with either engine, and returns pictures as
arrays."""
import math
import os
import sys
import tempfile

import bpy
import numpy

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def enable_addon():
    sys.path.insert(0, os.path.join(ROOT, "blender"))
    import lanthorn
    lanthorn.register()
    bpy.ops.preferences.addon_enable(module="cycles")


def empty_scene(width=64, height=48):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="cycles")
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.render.use_persistent_data = False
    scene.world = bpy.data.worlds.new("world")
    scene.world.color = (0, 0, 0)
    scene.view_settings.view_transform = "Standard"
    return scene


def link(name, data, matrix=None, location=(0, 0, 0), rotation=(0, 0, 0)):
    made = bpy.data.objects.new(name, data)
    made.location, made.rotation_euler = location, rotation
    bpy.context.scene.collection.objects.link(made)
    if matrix is not None:
        made.matrix_world = matrix
    return made


def add_camera(location, rotation, **members):
    camera = bpy.data.cameras.new("camera")
    for name, value in members.items():
        setattr(camera, name, value)
    made = link("camera", camera, location=location, rotation=rotation)
    bpy.context.scene.camera = made
    return made


def camera_from_above(height=4.0, angle=40.0):
    return add_camera((0, 0, height), (0, 0, 0), angle=math.radians(angle))


def node_material(name, kind, **inputs):
    """A material whose surface is one shader node."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    shader = nodes.new(kind)
    for key, value in inputs.items():
        shader.inputs[key].default_value = value
    links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def diffuse(name="grey", color=(0.8, 0.8, 0.8)):
    return node_material(name, "ShaderNodeBsdfDiffuse", Color=(*color, 1))


def add_plane(size=4.0, z=0.0, material=None):
    s = size / 2
    mesh = bpy.data.meshes.new("plane")
    mesh.from_pydata([(-s, -s, z), (s, -s, z), (s, s, z), (-s, s, z)], [], [(0, 1, 2, 3)])
    mesh.uv_layers.new()
    mesh.materials.append(material or diffuse())
    return link("plane", mesh)


def add_ball(radius=0.5, location=(0, 0, 0.6), material=None, is_smooth=True):
    import bmesh
    mesh = bpy.data.meshes.new("ball")
    shape = bmesh.new()
    bmesh.ops.create_uvsphere(shape, u_segments=64, v_segments=32, radius=radius)
    shape.to_mesh(mesh)
    shape.free()
    for polygon in mesh.polygons:
        polygon.use_smooth = is_smooth
    mesh.materials.append(material)
    return link("ball", mesh, location=location)


def add_light(kind, energy, location=(0, 0, 0), rotation=(0, 0, 0), **members):
    light = bpy.data.lights.new(kind.lower(), kind)
    light.energy = energy
    for name, value in members.items():
        setattr(light, name, value)
    return link(kind.lower(), light, location=location, rotation=rotation)


def render(engine, **settings):
    """Renders the scene. Returns an array (height, width, 4) of linear values, rows from the top. `settings` are
    attributes of `scene.cycles` or `scene.lanthorn`."""
    scene = bpy.context.scene
    scene.render.engine = engine
    group = scene.cycles if engine == "CYCLES" else scene.lanthorn
    if engine == "CYCLES":
        group.device, group.use_denoising, group.use_adaptive_sampling = "CPU", False, False
    for name, value in settings.items():
        setattr(group, name, value)
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = os.path.join(folder, "picture.exr")
        bpy.ops.render.render(write_still=True)
        return read_picture(scene.render.filepath)


def read_picture(path):
    image = bpy.data.images.load(path)
    width, height = image.size
    pixels = numpy.empty(width * height * 4, dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[::-1]


def save_png(path, *pictures, exposure=1.0):
    """Saves pictures side by side, in sRGB."""
    row = numpy.concatenate([p[:, :, :3] for p in pictures], axis=1) * exposure
    row = numpy.clip(row, 0, 1)
    row = numpy.where(row <= 0.0031308, row * 12.92, 1.055 * row ** (1 / 2.4) - 0.055)
    height, width = row.shape[:2]
    rgba = numpy.concatenate([row, numpy.ones((height, width, 1))], axis=2).astype(numpy.float32)
    image = bpy.data.images.new("png", width, height)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(numpy.ascontiguousarray(rgba[::-1]).ravel())
    image.filepath_raw, image.file_format = path, "PNG"
    image.save()
    bpy.data.images.remove(image)
