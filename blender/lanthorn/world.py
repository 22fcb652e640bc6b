# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""The world as an environment light."""
import numpy

from .bake import signature_of
from .textures import Textures

BAKED = "baked world"  # a light that must be replaced by those of its file
KNOWN_SPACES = {"sRGB", "Linear", "Linear Rec.709", "Non-Color", "Raw"}


def _source(socket):
    """The node behind a socket, reroutes aside; None if nothing is linked."""
    while socket.is_linked:
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return node
        socket = node.inputs[0]
    return None


BLACK = {}


def texels_of_image(image, strength, turn):
    """Blender's equirectangular pixels as Lanthorn's, in linear Rec.709. Blender has +x in the middle and turns
    clockwise as seen from above, Lanthorn has +x at the left edge and turns counter-clockwise. `turn`: radians about z."""
    width, height = image.size
    pixels = numpy.empty(width * height * 4, dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    rgb = pixels.reshape(height, width, 4)[::-1, ::-1, :3]
    if image.colorspace_settings.name == "sRGB" and not image.is_float:
        rgb = numpy.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    shift = width // 2 + int(round(turn / (2 * numpy.pi) * width))
    return numpy.ascontiguousarray(numpy.roll(rgb, shift, axis=1) * numpy.float32(strength))


def _turn_of(node):
    """Radians about z that the vector of an environment texture is turned; None if that is not all."""
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
    """A light, or None if the image must be baked."""
    image, turn = node.image, _turn_of(node)
    if image is None or image.size[0] == 0 or turn is None or node.projection != "EQUIRECTANGULAR":
        return None
    if image.size[0] != 2 * image.size[1] or image.colorspace_settings.name not in KNOWN_SPACES:
        return None
    return {"type": "infinite", "texels": texels_of_image(image, strength, turn)}


def _even(color):
    return {"world": {"type": "infinite", "radiance": {"spectrum": color}}} if max(color) > 0 else BLACK


def _of_nodes(node):
    """Lights of a Background shader that need no bake; None if there are none."""
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
    """What Cycles sees in all directions; the sun of a sky, which is smaller than a texel, by itself."""
    textures = Textures(None, report, None, bakes)
    output = world.node_tree.get_output_node("CYCLES") or world.node_tree.get_output_node("ALL")
    nodes = [node for node, _ in textures.nodes_behind([output.inputs["Surface"]])]
    names = sorted({node.bl_label for node in nodes} - {"Background", "Texture Coordinate", "Mapping"})
    report.note(world.name, f"the world is baked to an image ({', '.join(names)})")
    if any(node.type == "LIGHT_PATH" for node in nodes):
        report.note(world.name, "Light Path in a world counts as for rays of the camera")
    path = bakes.world(world, signature_of(textures.source(output.inputs["Surface"]), textures.source))
    if bakes.is_missing(path):
        return {BAKED: {"type": "infinite", "path": path}}
    return lights_of_bake(path)


def lights_of_bake(path):
    """Lights of the file that bake_worker.py has written; none if it has not."""
    try:
        with numpy.load(path) as file:
            texels, sun = file["texels"], file["sun"]
    except OSError:
        return {}
    height, width = texels.shape[:2]
    lights = {"world": {"type": "infinite",
                        "texels": numpy.ascontiguousarray(numpy.roll(texels[:, ::-1], width // 2, axis=1))}}
    if len(sun) and sun[3:].max() > 0:
        lights["world's sun"] = {"type": "distant", "from": sun[:3].tolist(), "to": [0, 0, 0],
                                 "radiance": {"spectrum": sun[3:].tolist()}}
    return lights


def lights_of_world(world, report, bakes):
    """Lights of Lanthorn by their names; that of the name BAKED refers to an image that is not there yet."""
    if not (world.use_nodes and world.node_tree):
        return _even(list(world.color))
    output = world.node_tree.get_output_node("CYCLES") or world.node_tree.get_output_node("ALL")
    if output is None:
        return BLACK
    if output.inputs["Volume"].is_linked:
        report.note(world.name, "the volume of a world has no counterpart: it is left out")
    node = _source(output.inputs["Surface"])
    if node is None:
        return BLACK
    lights = _of_nodes(node)
    return lights if lights is not None else _baked(world, report, bakes)
