# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""The world as an environment light."""
import numpy


def _source(socket):
    """The node behind a socket, reroutes aside; None if nothing is linked."""
    while socket.is_linked:
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return node
        socket = node.inputs[0]
    return None


def _background(world, report):
    """Node, or None: a world without nodes has its color alone."""
    if not (world.use_nodes and world.node_tree):
        return None
    output = world.node_tree.get_output_node("CYCLES") or world.node_tree.get_output_node("ALL")
    node = _source(output.inputs["Surface"]) if output else None
    if node is not None and node.type != "BACKGROUND":
        report.note(world.name, f"the world's node {node.bl_label} has no counterpart: the world is black")
        return False
    return node if node is not None else False


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


def _environment(node, strength, world, report):
    image = node.image
    if image is None or image.size[0] == 0:
        report.note(world.name, "the environment texture has no image: the world is black")
        return None
    if node.projection != "EQUIRECTANGULAR" or image.size[0] != 2 * image.size[1]:
        report.note(world.name, "environment textures that are not equirectangular, twice as wide as high, are left out")
        return None
    turn = 0
    mapping = _source(node.inputs["Vector"])
    if mapping is not None and mapping.type == "MAPPING":
        turn = -mapping.inputs["Rotation"].default_value[2]
    return {"type": "infinite", "texels": texels_of_image(image, strength, turn)}


def light_of_world(world, report):
    """A light of Lanthorn; None for a black world."""
    background = _background(world, report)
    if background is False:
        return None
    if background is None:
        color, strength = list(world.color), 1
    else:
        strength_node = _source(background.inputs["Strength"])
        if strength_node is not None:
            report.note(world.name, "nodes at the strength of the background are left out")
        strength = background.inputs["Strength"].default_value
        color_node = _source(background.inputs["Color"])
        if color_node is not None and color_node.type == "TEX_ENVIRONMENT":
            return _environment(color_node, strength, world, report)
        if color_node is not None and color_node.type == "RGB":
            color = list(color_node.outputs[0].default_value)[:3]
        else:
            if color_node is not None:
                report.note(world.name, f"the world's node {color_node.bl_label} has no counterpart: "
                                        "its socket's own color is used")
            color = list(background.inputs["Color"].default_value)[:3]
    color = [strength * c for c in color]
    return {"type": "infinite", "radiance": {"spectrum": color}} if max(color) > 0 else None
