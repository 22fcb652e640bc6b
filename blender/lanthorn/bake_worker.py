# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the jobs of bake.py in a headless Blender: blender -b --python bake_worker.py -- JOBS"""
import json
import math
import os
import sys
import threading

import bpy
import numpy

ATLAS = "lanthorn atlas"
SAMPLES_OF_A_TEXEL = 4
MANY_TEXELS = 1024  # along a side; larger images get one sample per texel
MARGIN = 3  # texels around a triangle, for bilinear interpolation
SAMPLES_OF_SKY = 4
TEXELS_OF_SUN = 128
FACTOR_OF_SUN_VIEW = 1.2  # field of view of the picture of the sun, in diameters of its disk


# Surfaces.

def mesh_of(arrays):
    mesh = bpy.data.meshes.new("mesh")
    mesh.from_pydata(arrays["vertices"].tolist(), [], arrays["triangles"].tolist())
    mesh.polygons.foreach_set("use_smooth", numpy.full(len(mesh.polygons), bool(arrays["is_smooth"])))
    for name in arrays.files:
        if name.startswith("uv:"):
            mesh.uv_layers.new(name=name[3:]).data.foreach_set("uv", arrays[name].ravel())
        elif name.startswith("color:"):
            mesh.color_attributes.new(name[6:], "FLOAT_COLOR", "CORNER").data.foreach_set("color", arrays[name].ravel())
    if mesh.uv_layers:
        mesh.uv_layers[0].active_render = True
    mesh.uv_layers.new(name=ATLAS).data.foreach_set("uv", arrays["atlas"].ravel())
    if "texspace" in arrays.files:
        mesh.use_auto_texspace = False
        mesh.texspace_location, mesh.texspace_size = arrays["texspace"]
    return mesh


def object_of(job):
    arrays = numpy.load(job["mesh"])
    made = bpy.data.objects.new(job.get("object", "object"), mesh_of(arrays))
    bpy.context.scene.collection.objects.link(made)
    if "to_world" in job:
        made.matrix_world = [tuple(column) for column in zip(*job["to_world"])]
    return made


def new_output(group):
    """Adds a colour output to a node group. Returns the input of the group's output node, and its name."""
    if hasattr(group, "interface"):
        name = group.interface.new_socket("lanthorn", in_out="OUTPUT", socket_type="NodeSocketColor").name
    else:
        name = group.outputs.new("NodeSocketColor", "lanthorn").name
    end = next(n for n in group.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output)
    return end.inputs[name], name


def as_number(tree, output):
    """Adds a node that converts a colour to a number as Blender's sockets do. Returns its output."""
    node = tree.nodes.new("ShaderNodeMath")
    node.operation = "ADD"
    node.inputs[1].default_value = 0
    tree.links.new(output, node.inputs[0])
    return node.outputs[0]


def emit(material, job):
    """Rewires the material so that it emits the values of the job's socket."""
    trees = [material.node_tree]
    for name in job["groups"]:
        node = trees[-1].nodes[name]
        node.node_tree = node.node_tree.copy()
        trees.append(node.node_tree)
    output = next(o for o in trees[-1].nodes[job["node"]].outputs if o.identifier == job["output"])
    if job["is_number"]:
        output = as_number(trees[-1], output)
    for depth in range(len(trees) - 1, 0, -1):
        end, name = new_output(trees[depth])
        trees[depth].links.new(output, end)
        output = trees[depth - 1].nodes[job["groups"][depth - 1]].outputs[name]
    nodes, links = material.node_tree.nodes, material.node_tree.links
    for node in [n for n in nodes if n.type == "OUTPUT_MATERIAL"]:
        nodes.remove(node)
    end, emission = nodes.new("ShaderNodeOutputMaterial"), nodes.new("ShaderNodeEmission")
    links.new(output, emission.inputs["Color"])
    links.new(emission.outputs[0], end.inputs["Surface"])


def load_images(files):
    for name, path in files.items():
        image = bpy.data.images.get(name)
        if image is not None and path is not None:
            space = image.colorspace_settings.name
            image.source, image.filepath = "FILE", path
            image.reload()
            image.colorspace_settings.name = space


def write(image, path):
    if path.endswith(".npz"):
        part, (width, height) = path + ".part.npz", image.size
        texels = numpy.empty(width * height * 4, dtype=numpy.float32)
        image.pixels.foreach_get(texels)
        numpy.savez(part, texels=texels.reshape(height, width, 4)[:, :, :3])
    else:
        part = path + ".part"
        image.file_format, image.filepath_raw = "OPEN_EXR", part
        image.save()
    os.replace(part, path)


def bake_surface(job):
    load_images(job["images"])
    made = object_of(job)
    original = bpy.data.materials[job["owner"]]
    # Animation and drivers of the copy are evaluated at the frame of the render.
    material = original.copy()
    emit(material, job)
    made.data.materials.append(material)
    image = bpy.data.images.new("baked", job["size"], job["size"], alpha=False, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    target = material.node_tree.nodes.new("ShaderNodeTexImage")
    target.image = image
    for node in material.node_tree.nodes:
        node.select = False
    target.select, material.node_tree.nodes.active = True, target
    made.data.uv_layers.active = made.data.uv_layers[ATLAS]
    for other in bpy.context.scene.objects:
        other.select_set(other == made)
    bpy.context.view_layer.objects.active = made
    bpy.context.scene.cycles.samples = SAMPLES_OF_A_TEXEL if job["size"] <= MANY_TEXELS else 1
    bpy.ops.object.bake(type="EMIT", margin=MARGIN, use_clear=True)
    write(image, job["path"])
    mesh = made.data
    bpy.data.objects.remove(made)
    bpy.data.meshes.remove(mesh)
    bpy.data.images.remove(image)
    bpy.data.materials.remove(material)


# Worlds.

def rendered(folder, width, height, samples):
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.filepath = os.path.join(folder, "world.exr")
    bpy.context.scene.cycles.samples = samples
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(render.filepath)
    pixels = numpy.empty(width * height * 4, dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[::-1, :, :3]


def new_camera():
    camera = bpy.data.cameras.new("camera")
    camera.type = "PANO"
    made = bpy.data.objects.new("camera", camera)
    bpy.context.scene.collection.objects.link(made)
    bpy.context.scene.camera = made
    return made


def panorama_settings(camera):
    """Returns the owner of panorama properties: Cycles' settings in Blender 3, the camera itself in Blender 4."""
    return camera if hasattr(camera, "panorama_type") else camera.cycles


def sun_nodes(tree):
    for node in tree.nodes:
        if node.type == "TEX_SKY" and node.sky_type == "NISHITA" and node.sun_disc:
            yield node
        elif node.type == "GROUP" and node.node_tree:
            yield from sun_nodes(node.node_tree)


def sun_of(world, camera, folder):
    """Returns the direction to the sun of a sky texture, its irradiance, and the angle of its diameter. Removes the sun's
    disk from the sky."""
    nodes = list(sun_nodes(world.node_tree)) if world.use_nodes else []
    if len(nodes) != 1:
        return []
    node = nodes[0]
    elevation, turn = node.sun_elevation, node.sun_rotation
    direction = numpy.array([math.sin(turn) * math.cos(elevation), math.cos(turn) * math.cos(elevation),
                             math.sin(elevation)])
    angle = FACTOR_OF_SUN_VIEW * node.sun_size
    panorama = panorama_settings(camera.data)
    panorama.panorama_type, panorama.fisheye_fov = "FISHEYE_EQUIDISTANT", angle
    angle = panorama.fisheye_fov  # Blender limits it
    camera.rotation_euler = (math.pi / 2 + elevation, 0, -turn)
    texel = (angle / TEXELS_OF_SUN) ** 2
    with_sun = rendered(folder, TEXELS_OF_SUN, TEXELS_OF_SUN, 16)
    node.sun_disc = False
    without = rendered(folder, TEXELS_OF_SUN, TEXELS_OF_SUN, 4)
    irradiance = (with_sun - without).sum(axis=(0, 1)) * texel
    return [*direction, *irradiance, node.sun_size]


def bake_world(job):
    world = bpy.data.worlds[job["owner"]]
    scene = bpy.context.scene
    scene.world = world
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 1
    folder, camera = os.path.dirname(job["path"]), new_camera()
    sun = sun_of(world, camera, folder)
    panorama_settings(camera.data).panorama_type = "EQUIRECTANGULAR"
    camera.rotation_euler = (math.pi / 2, 0, -math.pi / 2)
    texels = rendered(folder, job["size"], job["size"] // 2, SAMPLES_OF_SKY)
    numpy.savez(job["path"] + ".part.npz", texels=texels, sun=numpy.array(sun, dtype=numpy.float64))
    os.replace(job["path"] + ".part.npz", job["path"])
    bpy.data.objects.remove(camera)


def end_with_parent():
    sys.stdin.read()
    os._exit(1)


def main(list_file):
    threading.Thread(target=end_with_parent, daemon=True).start()
    with open(list_file, encoding="utf-8") as file:
        work = json.load(file)
    scene = bpy.context.scene
    for collection in (bpy.data.objects, bpy.data.materials, bpy.data.worlds):
        for made in list(collection):  # so that loaded data-blocks keep their names
            collection.remove(made)
    with bpy.data.libraries.load(work["library"]) as (there, wanted):
        wanted.materials, wanted.worlds = there.materials, there.worlds
    scene.frame_set(work["frame"])
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = "CPU", False, False
    scene.view_settings.view_transform = "Raw"
    for job in work["jobs"]:
        {"surface": bake_surface, "world": bake_world}[job["kind"]](job)


main(sys.argv[sys.argv.index("--") + 1])
