# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Values of sockets: constants, and textures that nodes describe."""
import math
import os
import struct
import zlib

import bpy
import numpy


def source_of(socket):
    """(socket of the node that feeds `socket`, stack of groups entered), reroutes and muted nodes aside; None."""
    return socket.links[0].from_socket if socket.is_linked else None


def linear_map(mapping):
    """The matrix and the offset of (u, v) of a Mapping node."""
    angle = mapping.inputs["Rotation"].default_value[2]
    sx, sy = mapping.inputs["Scale"].default_value[:2]
    cos, sin = math.cos(angle), math.sin(angle)
    location = mapping.inputs.get("Location")
    tx, ty = location.default_value[:2] if location else (0, 0)
    if mapping.vector_type == "TEXTURE":
        sx, sy = 1 / (sx or 1), 1 / (sy or 1)
        rows = [[cos * sx, sin * sx], [-sin * sy, cos * sy]]
        return rows, [-(r[0] * tx + r[1] * ty) for r in rows]
    return [[cos * sx, -sin * sy], [sin * sx, cos * sy]], [tx, ty]


def _png(path, pixels):
    """Writes (height, width, 4) of 8 bits, rows from the top."""
    height, width = pixels.shape[:2]
    rows = numpy.zeros((height, 1 + 4 * width), dtype=numpy.uint8)  # each after its filter: none
    rows[:, 1:] = pixels.reshape(height, -1)
    chunks = ((b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)),
              (b"IDAT", zlib.compress(rows.tobytes(), 1)), (b"IEND", b""))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for name, data in chunks:
            file.write(struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)))


def _written(image, path):
    """Writes the pixels of an image that is no file. Returns the name, with its extension."""
    width, height = image.size
    pixels = numpy.empty(width * height * 4, dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    if not image.is_float:
        _png(path + ".png", (pixels.reshape(height, width, 4)[::-1].clip(0, 1) * 255 + 0.5).astype(numpy.uint8))
        return path + ".png"
    copy = bpy.data.images.new("lanthorn", width, height, alpha=True, float_buffer=True)
    try:
        copy.pixels.foreach_set(pixels)
        copy.file_format, copy.filepath_raw = "OPEN_EXR", path + ".exr"
        copy.save()
    finally:
        bpy.data.images.remove(copy)
    return path + ".exr"


class ImageFiles:
    """Images as files that Lanthorn reads; images without a file are written to a folder, once."""

    def __init__(self, folder):
        self.folder, self._written = folder, {}

    def path_of(self, image):
        """Returns None if the image has no pixels."""
        path = bpy.path.abspath(image.filepath, library=image.library)
        if image.source == "FILE" and image.packed_file is None and not image.is_dirty and os.path.isfile(path):
            return path
        if image.size[0] == 0:
            return None
        key = image.name_full
        if key not in self._written or image.is_dirty:
            self._written[key] = _written(image, os.path.join(self.folder, f"image{len(self._written)}"))
        return self._written[key]


class Textures:
    """Adds textures to the parts of a scene. The values of sockets are numbers, lists, or references to textures."""

    def __init__(self, parts, report, images):
        self.parts, self.report, self.images = parts, report, images
        self.groups = []  # group nodes that were entered

    def source(self, socket):
        """The output socket that feeds `socket`, through reroutes and groups; None if nothing does."""
        output = source_of(socket)
        while output is not None:
            node = output.node
            if node.type == "REROUTE":
                output = source_of(node.inputs[0])
            elif node.type == "GROUP" and node.node_tree:
                inner = next((n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output), None)
                if inner is None:
                    return None
                if node not in self.groups:
                    self.groups.append(node)
                output = source_of(inner.inputs[output.name])
            elif node.type == "GROUP_INPUT" and self.groups:
                outer = next((g for g in reversed(self.groups) if g.node_tree == node.id_data), None)
                if outer is None:
                    return None
                output = source_of(outer.inputs[output.name])
            else:
                return output
        return None

    def color(self, socket, owner):
        """[r, g, b] or {"texture": name}."""
        output = self.source(socket)
        if output is None:
            return self._constant(socket)
        made = self._color_node(output, owner)
        if made is not None:
            return made
        self.report.note(owner, f"the node {output.node.bl_label} has no counterpart: the socket's own value is used")
        return self._constant(socket)

    def number(self, socket, owner):
        """A number or {"texture": name}."""
        output = self.source(socket)
        if output is None:
            return self._number(socket)
        node = output.node
        if node.type == "VALUE":
            return output.default_value
        if node.type == "TEX_IMAGE":
            return self._image(node, owner, is_color=False, channel="Alpha" if output.name == "Alpha" else None)
        if node.type in {"RGBTOBW", "SEPRGB", "SEPARATE_COLOR"}:
            inner = self.source(node.inputs[0])
            if inner is not None and inner.node.type == "TEX_IMAGE":
                channel = None if node.type == "RGBTOBW" else output.name
                return self._image(inner.node, owner, is_color=False, channel=channel)
        if node.type == "RGB":
            return sum(output.default_value[:3]) / 3
        if node.type == "MATH":
            made = self._math(node, owner)
            if made is not None:
                return made
        self.report.note(owner, f"the node {node.bl_label} has no counterpart: the socket's own value is used")
        return self._number(socket)

    @staticmethod
    def _constant(socket):
        value = socket.default_value
        return [value] * 3 if isinstance(value, (float, int)) else [max(0.0, c) for c in value[:3]]

    @staticmethod
    def _number(socket):
        value = socket.default_value
        return float(value) if isinstance(value, (float, int)) else sum(value[:3]) / 3

    def _color_node(self, output, owner):
        node = output.node
        if node.type == "RGB":
            return list(output.default_value[:3])
        if node.type == "VALUE":
            return [output.default_value] * 3
        if node.type == "TEX_IMAGE":
            return self._image(node, owner, is_color=True)
        if node.type == "TEX_CHECKER":
            return self._checker(node, owner)
        if node.type in {"MIX_RGB", "MIX"}:
            return self._mix(node, owner)
        if node.type in {"VERTEX_COLOR", "ATTRIBUTE"}:
            return None
        if node.type == "BLACKBODY":
            return {"blackbody": node.inputs["Temperature"].default_value}
        return None

    def _mapping(self, node, owner):
        """Of (u, v), for the vector of a texture node."""
        output = self.source(node.inputs["Vector"])
        mapping = {}
        if output is not None and output.node.type == "MAPPING":
            linear, offset = linear_map(output.node)
            mapping = {"type": "uv", "linear": linear, "offset": offset}
            output = self.source(output.node.inputs["Vector"])
        if output is not None and not (output.node.type == "UVMAP" or output.name == "UV"):
            self.report.note(owner, f"textures by {output.name} coordinates are put on by UV")
        return mapping

    def _name(self, owner, node, suffix):
        tree = node.id_data.name
        return f"{owner}/{tree}/{node.name}{suffix}"

    def _image(self, node, owner, is_color, channel=None):
        if node.image is None:
            return [1, 0, 1] if is_color else 0.0
        filename = self.images.path_of(node.image)
        if filename is None:
            self.report.note(owner, f"the image {node.image.name} is not there: magenta stands in")
            return [1, 0, 1] if is_color else 0.0
        name = self._name(owner, node, f":{channel}" if channel else "")
        wraps = {"REPEAT": "repeat", "EXTEND": "clamp", "CLIP": "black", "MIRROR": "mirror"}
        texture = {"type": "image", "filename": filename, "wrap": wraps.get(node.extension, "repeat"),
                   "filter": "point" if node.interpolation == "Closest" else "bilinear",
                   "encoding": "srgb" if node.image.colorspace_settings.name == "sRGB" else "linear"}
        mapping = self._mapping(node, owner)
        if mapping:
            texture["mapping"] = mapping
        if channel:
            texture["channel"] = {"Red": 0, "R": 0, "Green": 1, "G": 1, "Blue": 2, "B": 2, "Alpha": 3}[channel]
        self.parts["spectrum_textures" if is_color else "float_textures"][name] = texture
        return {"texture": name}

    def _checker(self, node, owner):
        name = self._name(owner, node, "")
        scale = node.inputs["Scale"].default_value
        mapping = self._mapping(node, owner)
        linear = [[scale * x for x in row] for row in mapping.get("linear", [[1, 0], [0, 1]])]
        offset = [scale * x for x in mapping.get("offset", [0, 0])]
        self.parts["spectrum_textures"][name] = {
            "type": "checkerboard", "mapping": {"type": "uv", "linear": linear, "offset": offset},
            "tex1": self.color(node.inputs["Color1"], owner), "tex2": self.color(node.inputs["Color2"], owner)}
        return {"texture": name}

    def _mix(self, node, owner):
        if node.type == "MIX":
            if node.data_type != "RGBA":
                return None
            factor, first, second = node.inputs[0], node.inputs[6], node.inputs[7]
        else:
            factor, first, second = node.inputs[:3]
        name = self._name(owner, node, "")
        one, two, amount = self.color(first, owner), self.color(second, owner), self.number(factor, owner)
        if node.blend_type == "MIX":
            self.parts["spectrum_textures"][name] = {"type": "mix", "tex1": one, "tex2": two, "amount": amount}
        elif node.blend_type == "MULTIPLY" and amount == 1:
            self.parts["spectrum_textures"][name] = {"type": "scalebyspectrum", "tex": one, "scale": two}
        else:
            return None
        return {"texture": name}

    def _math(self, node, owner):
        one, two = (self.number(socket, owner) for socket in node.inputs[:2])
        if isinstance(one, dict) or isinstance(two, dict):
            if node.operation != "MULTIPLY":
                return None
            name = self._name(owner, node, "")
            self.parts["float_textures"][name] = {"type": "scale", "tex": one, "scale": two}
            return {"texture": name}
        operations = {"ADD": one + two, "SUBTRACT": one - two, "MULTIPLY": one * two,
                      "DIVIDE": one / two if two else 0, "MINIMUM": min(one, two), "MAXIMUM": max(one, two)}
        return operations.get(node.operation)

    def squared(self, value, owner):
        """The square of a number or a texture: Blender's roughness to the width of the distribution of facets."""
        if not isinstance(value, dict):
            return value * value
        name = f"{value['texture']}^2"
        self.parts["float_textures"][name] = {"type": "scale", "tex": value, "scale": value}
        return {"texture": name}

    def normal_map(self, node, owner):
        """The normal map of a Normal Map node; None if there is none."""
        output = self.source(node.inputs["Color"])
        if output is None or output.node.type != "TEX_IMAGE" or output.node.image is None:
            return None
        filename = self.images.path_of(output.node.image)
        if filename is None:
            return None
        image = {"filename": filename, "encoding": "linear"}
        mapping = self._mapping(output.node, owner)
        if mapping:
            image["mapping"] = mapping
        return {"image": image, "strength": node.inputs["Strength"].default_value}
