# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Translates the world to an environment light and a medium."""
import numpy

from . import lights as lamps, media
from .bake import signature_of
from .textures import Textures

BAKED = "baked world"  # a placeholder for the lights of a baked file
KNOWN_SPACES = {"sRGB", "Linear", "Linear Rec.709", "Non-Color", "Raw"}


def _source(socket):
    """Returns the node behind a socket, through reroutes; None if nothing is linked."""
    while socket.is_linked:
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return node
        socket = node.inputs[0]
    return None


BLACK = {}


def texels_of_image(image, strength, turn):
    """Converts Blender's equirectangular pixels to Lanthorn's, in linear Rec. 709. Seen from above, Blender's turn
    clockwise, with +x in the middle; Lanthorn's turn counter-clockwise, with +x at the left edge. `turn` is the rotation
    about z in radians."""
    width, height = image.size
    pixels = numpy.empty(width * height * 4, dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    rgb = pixels.reshape(height, width, 4)[::-1, ::-1, :3]
    if image.colorspace_settings.name == "sRGB" and not image.is_float:
        rgb = numpy.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    shift = width // 2 + int(round(turn / (2 * numpy.pi) * width))
    return numpy.ascontiguousarray(numpy.roll(rgb, shift, axis=1) * numpy.float32(strength))


def _turn_of(node):
    """Returns the rotation about z, in radians, of an environment texture; None for other mappings."""
    fed = _source(node.inputs["Vector"])
    if fed is None:
        return 0
    if fed.type != "MAPPING" or any(socket.is_linked for socket in list(fed.inputs)[1:]):
        return None if fed.type != "TEX_COORD" else 0
    x, y, z = fed.inputs["Rotation"].default_value
    place, scale = fed.inputs["Location"].default_value, fed.inputs["Scale"].default_value
    inner = _source(fed.inputs["Vector"])
    is_turn = x == y == 0 and not any(place) and tuple(scale) == (1, 1, 1) and (inner is None or inner.type == "TEX_COORD")
    return -z if is_turn else None


def _environment(node, strength):
    """Returns a light, or None if the texture must be baked."""
    image, turn = node.image, _turn_of(node)
    if image is None or image.size[0] == 0 or turn is None or node.projection != "EQUIRECTANGULAR":
        return None
    if image.size[0] != 2 * image.size[1] or image.colorspace_settings.name not in KNOWN_SPACES:
        return None
    return {"type": "infinite", "texels": texels_of_image(image, strength, turn)}


def _even(color):
    return {"world": {"type": "infinite", "radiance": {"spectrum": color}}} if max(color) > 0 else BLACK


def _of_nodes(node):
    """Returns the lights of a Background shader, or None if it must be baked."""
    if node.type != "BACKGROUND" or _source(node.inputs["Strength"]) is not None:
        return None
    strength, fed = node.inputs["Strength"].default_value, _source(node.inputs["Color"])
    if strength <= 0:
        return BLACK
    if fed is None or fed.type == "RGB":
        color = (node.inputs["Color"] if fed is None else fed.outputs[0]).default_value[:3]
        return _even([strength * c for c in color])
    light = _environment(fed, strength) if fed.type == "TEX_ENVIRONMENT" else None
    return {"world": light} if light is not None else None


def _baked(world, report, bakes):
    """Bakes the world to an image. The sun of a sky texture, which is smaller than a texel, becomes a light of its own."""
    textures = Textures(None, report, None, bakes)
    output = world.node_tree.get_output_node("CYCLES") or world.node_tree.get_output_node("ALL")
    nodes = [node for node, _ in textures.nodes_behind([output.inputs["Surface"]])]
    names = sorted({node.bl_label for node in nodes} - {"Background", "Texture Coordinate", "Mapping"})
    report.note(world.name, f"the world is baked to an image ({', '.join(names)})")
    if any(node.type == "LIGHT_PATH" for node in nodes):
        report.note(world.name, "Light Path in a world is evaluated for camera rays")
    path = bakes.world(world, signature_of(textures.source(output.inputs["Surface"]), textures.source))
    if bakes.is_missing(path):
        return {BAKED: {"type": "infinite", "path": path}}
    return lights_of_bake(path)


def lights_of_bake(path):
    """Returns the lights of a file of bake_worker.py; none if there is no file."""
    try:
        with numpy.load(path) as file:
            texels, sun = file["texels"], file["sun"]
    except OSError:
        return {}
    height, width = texels.shape[:2]
    lights = {"world": {"type": "infinite",
                        "texels": numpy.ascontiguousarray(numpy.roll(texels[:, ::-1], width // 2, axis=1))}}
    if len(sun) and sun[3:6].max() > 0:
        lights["world's sun"] = lamps.sun(sun[:3].tolist(), sun[3:6].tolist(), sun[6])
    return lights


def volume_of_world(world, report):
    """Returns the world's volume as `media.Volume.of` does, or None."""
    if not (world.use_nodes and world.node_tree):
        return None
    output = world.node_tree.get_output_node("CYCLES") or world.node_tree.get_output_node("ALL")
    textures = Textures(None, report, None, None)
    textures.begin(world, None, 0, False, world.name)
    source = textures.source(output.inputs["Volume"]) if output is not None else None
    if source is None:
        return None
    made = media.Volume(world.name, textures, report).of(source.node)
    return made if any(numpy.max(made[name]) > 0 for name in ("sigma_a", "sigma_s", "emission")) else None


def lights_of_world(world, report, bakes):
    """Returns lights by name. A light named BAKED refers to an image that is still to be baked."""
    if not (world.use_nodes and world.node_tree):
        return _even(list(world.color))
    output = world.node_tree.get_output_node("CYCLES") or world.node_tree.get_output_node("ALL")
    if output is None:
        return BLACK
    node = _source(output.inputs["Surface"])
    if node is None:
        return BLACK
    lights = _of_nodes(node)
    return lights if lights is not None else _baked(world, report, bakes)
