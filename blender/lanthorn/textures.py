# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Translates the values of sockets to constants and textures."""
import math
import os
import struct
import zlib

import bpy
import numpy

from . import blackbody


def source_of(socket):
    """Returns the output that is linked to `socket`, or None."""
    return socket.links[0].from_socket if socket.is_linked else None


def linear_map(mapping):
    """Returns the matrix and the offset by which a Mapping node transforms (u, v)."""
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
    """Writes a PNG file. `pixels` has the shape (height, width, 4), 8 bits, rows from the top."""
    height, width = pixels.shape[:2]
    rows = numpy.zeros((height, 1 + 4 * width), dtype=numpy.uint8)  # the first byte of each row is its filter: none
    rows[:, 1:] = pixels.reshape(height, -1)
    chunks = ((b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)),
              (b"IDAT", zlib.compress(rows.tobytes(), 1)), (b"IEND", b""))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for name, data in chunks:
            file.write(struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)))


def _written(image, path):
    """Writes the pixels of an image without a file. Returns the path, with its extension."""
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
    """Provides files for images. Images without a file are written to a folder, once each."""

    def __init__(self, folder):
        self.folder, self._written = folder, {}

    def path_of(self, image):
        """Returns the path of the image's file, or None if the image has no pixels."""
        path = bpy.path.abspath(image.filepath, library=image.library)
        if image.source == "FILE" and image.packed_file is None and not image.is_dirty and os.path.isfile(path):
            return path
        if image.size[0] == 0:
            return None
        key = image.name_full
        if key not in self._written or image.is_dirty:
            self._written[key] = _written(image, os.path.join(self.folder, f"image{len(self._written)}"))
        return self._written[key]


# Nodes whose values depend on the ray or the light path.
OF_THE_RAY = {"FRESNEL", "LAYER_WEIGHT", "CAMERA", "LIGHT_PATH"}
TRUE_RAYS = {"Is Camera Ray"}
# Three-dimensional textures, which use Generated coordinates by default.
SOLID = {"TEX_NOISE", "TEX_VORONOI", "TEX_MUSGRAVE", "TEX_WAVE", "TEX_MAGIC", "TEX_GRADIENT", "TEX_WHITE_NOISE",
         "TEX_BRICK", "TEX_CHECKER", "TEX_POINTDENSITY", "TEX_IES"}
# Nodes whose values depend on more than texture coordinates.
OF_A_PLACE = {"NEW_GEOMETRY", "AMBIENT_OCCLUSION", "BEVEL", "WIREFRAME", "TANGENT", "ATTRIBUTE", "PARTICLE_INFO",
              "HAIR_INFO", "OBJECT_INFO", "UVALONGSTROKE", "VERTEX_COLOR", "CURVES_INFO"}
NATIVE = {"RGB", "VALUE", "BLACKBODY", "TEX_IMAGE", "MAPPING", "TEX_COORD", "UVMAP", "NORMAL_MAP", "BUMP", "DISPLACEMENT"}
# Nodes whose values depend on the place in the world.
OF_THE_WORLD = {"NEW_GEOMETRY", "OBJECT_INFO", "CAMERA", "AMBIENT_OCCLUSION"}
WORLD_OUTPUTS = {"Camera", "Window", "Reflection"}  # of Texture Coordinate
SIDE_OF_A_CONSTANT = 4  # texels along a side of the image of a constant
GREY_OF_MAGENTA = 0.2848


def is_native(node):
    """Returns whether a node's values never need a baked image."""
    if node.type in {"MIX_RGB", "MIX"}:
        return node.blend_type in {"MIX", "MULTIPLY"} and getattr(node, "data_type", "RGBA") == "RGBA"
    return node.type in NATIVE or node.type in OF_THE_RAY or node.bl_idname.startswith(("ShaderNodeBsdf", "ShaderNodeVolume"))


def mean_fresnel(eta):
    """Returns the hemispherical reflectance of a smooth dielectric surface, by Schlick's approximation. From inside (eta
    below 1), it follows from reciprocity: the flux that passes is the same both ways."""
    if eta < 1:
        return 1 - (1 - mean_fresnel(1 / max(eta, 1e-3))) * eta**2
    head_on = ((eta - 1) / (eta + 1)) ** 2
    return head_on + (1 - head_on) / 21


def _magenta(is_color, channel):
    """Returns the colour, or a channel of it, that Cycles shows for a missing image."""
    if is_color:
        return [1, 0, 1]
    return {"Alpha": 1.0, "Red": 1.0, "R": 1.0, "Green": 0.0, "G": 0.0, "Blue": 1.0, "B": 1.0}.get(channel, GREY_OF_MAGENTA)


class Textures:
    """Adds textures to the parts of a scene. The value of a socket is a number, a list, or a reference to a texture.
    Unsupported nodes are baked to an image: over the UV square if they depend on UV only, otherwise into an atlas of the
    triangles. In the second case, all textures of the material are baked, because they share the atlas."""

    def __init__(self, parts, report, images, bakes):
        self.parts, self.report, self.images, self.bakes = parts, report, images, bakes
        self.groups = []  # group nodes that `source` has entered
        self.uses_colors = None  # name of the colour attribute in use
        self.color_at_root = None  # the colour of images at the root of hair

    def begin(self, material, surface, slot, is_atlas, prefix):
        """Starts the translation of a material on a slot of a surface. Names of parts begin with the prefix."""
        self.material, self.surface, self.slot = material, surface, slot
        self.is_atlas, self.prefix = is_atlas, prefix
        self.groups, self.uses_colors = [], None

    def nodes_behind(self, sockets):
        """Returns all nodes behind these sockets, in breadth-first order, each with the set of its outputs in use."""
        met, waiting = {}, list(sockets)
        while waiting:
            output = self.source(waiting.pop(0))
            if output is None:
                continue
            key = (output.node.id_data.name, output.node.name)
            if key not in met:
                met[key] = output.node, set()
                waiting += list(output.node.inputs)
            met[key][1].add(output.name)
        return list(met.values())

    @staticmethod
    def is_solid(node, outputs):
        """Returns whether a node's values depend on more than texture coordinates."""
        if node.type == "TEX_COORD":
            return bool(outputs - {"UV"})
        if node.type == "TEX_IMAGE":
            return node.projection != "FLAT"
        return node.type in OF_A_PLACE or (node.type in SOLID and not node.inputs["Vector"].is_linked)

    def _baked(self, output, is_number, owner):
        """Returns a texture with a baked image of this output; None if it cannot be baked."""
        nodes = self._nodes_behind_output(output)
        of_ray = [node for node, _ in nodes if node.type in OF_THE_RAY]
        if self.surface is None or of_ray:
            return None
        for node, _ in nodes:
            if node.type == "ATTRIBUTE" and not self.surface.has_attribute(node.attribute_name):
                self.report.note(owner, f"the mesh has no attribute {node.attribute_name}: its value is 0")
        is_varying = any(node.type in OF_A_PLACE or node.type in SOLID or node.type in {"TEX_COORD", "TEX_IMAGE", "UVMAP"}
                         for node, _ in nodes)
        domain, place = self._domain(is_number, is_varying, self._is_of_world(nodes))
        path = self.bakes.image(self.material, output, self._path_of_groups(output.node), self, domain)
        self.report.note(owner, f"{output.node.bl_label} is baked to an image")
        name = f"{self.prefix}/{os.path.basename(path)}"
        texture = {"type": "image", "filename": path, "encoding": "linear", "wrap": "clamp", **place}
        self.parts["float_textures" if is_number else "spectrum_textures"][name] = texture
        return {"texture": name}

    def varies_in_space(self, output):
        """Returns whether a socket of a volume varies over space."""
        return any(node.type in OF_A_PLACE or node.type in SOLID or node.type in {"TEX_COORD", "TEX_IMAGE"}
                   for node, _ in self._nodes_behind_output(output))

    def baked_field(self, output, grid, owner):
        """Returns the path of a baked file with the socket's value in each cell of a grid."""
        nodes = self._nodes_behind_output(output)
        arrays = {**grid.arrays(), "texspace": self.surface.texture_space()}
        mesh, job = self.bakes.store(arrays), {"is_number": False, "object": self.surface.object_name}
        if self._is_of_world(nodes):
            job["to_world"] = self.surface.to_world
        self.report.note(owner, f"{output.node.bl_label} of a volume is baked to a grid of "
                                f"{' × '.join(map(str, grid.counts))} cells")
        domain = {"key": f"{mesh} {job} field", "size": grid.size, "extension": "npz",
                  "job": lambda: {**job, "mesh": mesh}}
        return self.bakes.image(self.material, output, self._path_of_groups(output.node), self, domain)

    @staticmethod
    def _is_of_world(nodes):
        return any(node.type in OF_THE_WORLD or (node.type == "TEX_COORD" and (node.object or outputs & WORLD_OUTPUTS))
                   for node, outputs in nodes)

    def _nodes_behind_output(self, output):
        own = (output.node, {output.name})
        return [own, *self.nodes_behind(output.node.inputs)]

    def _domain(self, is_number, is_varying, is_of_world):
        """Returns the domain of a bake (see Bakes.image), and the members of a texture that maps its image."""
        surface, slot = self.surface, self.slot
        job = {"is_number": is_number, "object": surface.object_name}
        if self.is_atlas:
            mesh, size = surface.stored(self.bakes, slot)
            if is_of_world:
                job["to_world"] = surface.to_world
            return {"key": f"{mesh} {is_number} {job}", "size": size, "job": lambda: {**job, "mesh": mesh}}, {}
        low, high = surface.uv_bounds(slot)
        extent = high - low
        mesh = self.bakes.store(surface.square_arrays(low, high))
        place = {}
        if low.any() or (extent != 1).any():
            place = {"mapping": {"type": "uv", "linear": [[1 / extent[0], 0], [0, 1 / extent[1]]],
                                 "offset": [float(-low[0] / extent[0]), float(-low[1] / extent[1])]}}
        domain = {"key": f"{mesh} {is_number}", "job": lambda: {**job, "mesh": mesh}}
        if not is_varying:
            domain["size"] = SIDE_OF_A_CONSTANT
        return domain, place

    def _path_of_groups(self, node):
        """Returns the names of the group nodes on the way from the material's tree to the node."""
        path, tree = [], node.id_data
        while tree != self.material.node_tree:
            group = next(g for g in reversed(self.groups) if g.node_tree == tree)
            path.insert(0, group.name)
            tree = group.id_data
        return path

    def source(self, socket):
        """Returns the output that feeds `socket`, through reroutes and groups; None if nothing is linked."""
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
        """Returns the colour of a socket: [r, g, b] or {"texture": name}."""
        output = self.source(socket)
        made = self.color_of(output, owner) if output is not None else None
        return made if made is not None else self._constant(socket)

    def color_of(self, output, owner):
        """Returns the colour of an output; None, with a note, if it is not supported."""
        of_ray = self._of_the_ray(output, owner)
        if of_ray is not None:
            return [of_ray] * 3
        made = None
        if self.color_at_root is not None and output.node.type == "TEX_IMAGE" and output.name == "Color":
            return list(self.color_at_root)
        if not self.is_atlas or not self._is_texture(output):
            made = self._color_node(output, owner)
        if made is None:
            made = self._baked(output, False, owner)
        if made is None:
            self.report.note(owner, f"the node {output.node.bl_label} is not supported here: the socket's own value is used")
        return made

    def number(self, socket, owner):
        """Returns the number of a socket: a float or {"texture": name}."""
        output = self.source(socket)
        if output is None:
            return self._number(socket)
        of_ray = self._of_the_ray(output, owner)
        if of_ray is not None:
            return of_ray
        made = None
        if not self.is_atlas or not self._is_texture(output):
            made = self._number_node(output, owner)
        if made is None:
            made = self._baked(output, True, owner)
        if made is not None:
            return made
        self.report.note(owner, f"the node {output.node.bl_label} is not supported here: the socket's own value is used")
        return self._number(socket)

    def constant(self, socket, owner, what):
        """Returns the number of a socket that must be constant."""
        output = self.source(socket)
        if output is None:
            return self._number(socket)
        made = self._of_the_ray(output, owner)
        if made is None and not self._is_texture(output):
            made = self._number_node(output, owner)
        if made is None or isinstance(made, dict):
            self.report.note(owner, f"{what} must be constant: the socket's own value is used")
            return self._number(socket)
        return made

    def constant_color(self, socket, owner, what):
        """Returns the colour [r, g, b] of a socket that must be constant."""
        output = self.source(socket)
        if output is None:
            return self._constant(socket)
        made = None
        if not self._is_texture(output):
            made = self._color_node(output, owner)
        if made is None:
            self.report.note(owner, f"{what} must be constant: the socket's own value is used")
            return self._constant(socket)
        return made

    def _is_texture(self, output):
        return output.node.type not in {"RGB", "VALUE", "BLACKBODY"}

    def _of_the_ray(self, output, owner):
        """Returns a constant that replaces a value that depends on the ray; None for other values."""
        node = output.node
        if node.type not in OF_THE_RAY:
            return None
        if node.type == "FRESNEL":
            value = mean_fresnel(self._number(node.inputs["IOR"]))
        elif node.type == "LAYER_WEIGHT":
            blend = min(0.999, self._number(node.inputs["Blend"]))
            value = mean_fresnel(1 / (1 - blend)) if output.name == "Fresnel" else blend
        else:
            value = 1.0 if output.name in TRUE_RAYS else 0.0
        self.report.note(owner, f"{node.bl_label} depends on the ray: its mean, or the value for camera rays, is used")
        return value

    def _number_node(self, output, owner):
        """Returns the number of an output without a bake; None if it is not supported."""
        node = output.node
        if node.type == "VALUE":
            return output.default_value
        if node.type == "TEX_IMAGE":
            return self._image(node, owner, is_color=False, channel="Alpha" if output.name == "Alpha" else None)
        if node.type in {"RGBTOBW", "SEPRGB", "SEPARATE_COLOR"}:
            inner = self.source(node.inputs[0])
            is_rgb = getattr(node, "mode", "RGB") == "RGB"
            if is_rgb and inner is not None and inner.node.type == "TEX_IMAGE" and inner.name == "Color":
                channel = None if node.type == "RGBTOBW" else output.name
                return self._image(inner.node, owner, is_color=False, channel=channel)
        if node.type == "RGB":
            return sum(output.default_value[:3]) / 3
        if node.type == "MATH":
            return self._math(node, owner)
        return None

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
            return self._image(node, owner, is_color=True) if output.name == "Color" else None
        if node.type == "TEX_CHECKER":
            return self._checker(node, owner) if output.name == "Color" else None
        if node.type in {"MIX_RGB", "MIX"}:
            return self._mix(node, owner)
        if node.type in {"VERTEX_COLOR", "ATTRIBUTE"} and output.name == "Color":
            return self._vertex_colors(node)
        if node.type == "BLACKBODY":
            return blackbody.color(self.constant(node.inputs["Temperature"], owner, "the temperature of a black body"))
        return None

    def _color_name(self, node):
        """Returns the name of the colour attribute that a node reads; None if the surface does not have it."""
        name = node.layer_name if node.type == "VERTEX_COLOR" else node.attribute_name
        name = name or self.surface.color_name
        return name if name in self.surface.colors else None

    def _vertex_colors(self, node):
        name = self._color_name(node) if self.surface is not None else None
        if name is None or self.uses_colors not in (None, name):
            return None
        self.uses_colors = name
        self.parts["spectrum_textures"]["vertex colours"] = {"type": "vertexcolor"}
        return {"texture": "vertex colours"}

    def _mapping(self, node, owner):
        """Returns the mapping of (u, v) for the vector of a texture node; None if the vector depends on more than UV."""
        output = self.source(node.inputs["Vector"])
        mapping = {}
        if output is not None and output.node.type == "MAPPING":
            if any(self.source(socket) is not None for socket in list(output.node.inputs)[1:]):
                return None
            linear, offset = linear_map(output.node)
            mapping = {"type": "uv", "linear": linear, "offset": offset}
            output = self.source(output.node.inputs["Vector"])
        is_by_uv = output is None or output.node.type == "UVMAP" or (output.node.type == "TEX_COORD" and output.name == "UV")
        return mapping if is_by_uv else None

    def _name(self, node, suffix):
        return f"{self.prefix}/{node.id_data.name}/{node.name}{suffix}"

    def _image(self, node, owner, is_color, channel=None):
        mapping = self._mapping(node, owner)
        if mapping is None:
            return None
        if node.image is None:
            return _magenta(is_color, channel)
        filename = self.images.path_of(node.image)
        if filename is None:
            self.report.note(owner, f"the image {node.image.name} is missing: it is magenta")
            return _magenta(is_color, channel)
        name = self._name(node, f":{channel}" if channel else "")
        wraps = {"REPEAT": "repeat", "EXTEND": "clamp", "CLIP": "black", "MIRROR": "mirror"}
        texture = {"type": "image", "filename": filename, "wrap": wraps.get(node.extension, "repeat"),
                   "filter": "point" if node.interpolation == "Closest" else "bilinear",
                   "encoding": "srgb" if node.image.colorspace_settings.name == "sRGB" else "linear"}
        if mapping:
            texture["mapping"] = mapping
        if channel:
            texture["channel"] = {"Red": 0, "R": 0, "Green": 1, "G": 1, "Blue": 2, "B": 2, "Alpha": 3}[channel]
        self.parts["spectrum_textures" if is_color else "float_textures"][name] = texture
        return {"texture": name}

    def _checker(self, node, owner):
        name = self._name(node, "")
        mapping = self._mapping(node, owner)
        if mapping is None or not node.inputs["Vector"].is_linked or node.inputs["Scale"].is_linked:
            return None
        scale = node.inputs["Scale"].default_value
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
        if node.blend_type not in {"MIX", "MULTIPLY"} or getattr(node, "use_clamp", False):
            return None
        name = self._name(node, "")
        if node.blend_type == "MULTIPLY" and (factor.is_linked or factor.default_value != 1):
            return None
        one, two, amount = self.color(first, owner), self.color(second, owner), self.number(factor, owner)
        if node.blend_type == "MIX":
            self.parts["spectrum_textures"][name] = {"type": "mix", "tex1": one, "tex2": two, "amount": amount}
        else:
            self.parts["spectrum_textures"][name] = {"type": "scalebyspectrum", "tex": one, "scale": two}
        return {"texture": name}

    def _math(self, node, owner):
        if node.operation not in {"ADD", "SUBTRACT", "MULTIPLY", "DIVIDE", "MINIMUM", "MAXIMUM"} or node.use_clamp:
            return None
        is_textured = any(fed is not None and self._is_texture(fed) for fed in map(self.source, node.inputs[:2]))
        if is_textured and node.operation != "MULTIPLY":
            return None
        one, two = (self.number(socket, owner) for socket in node.inputs[:2])
        if isinstance(one, dict) or isinstance(two, dict):
            if node.operation != "MULTIPLY":
                return None
            if not isinstance(one, dict):
                one, two = two, one
            name = self._name(node, "")
            self.parts["float_textures"][name] = {"type": "scale", "tex": one, "scale": two}
            return {"texture": name}
        operations = {"ADD": one + two, "SUBTRACT": one - two, "MULTIPLY": one * two,
                      "DIVIDE": one / two if two else 0, "MINIMUM": min(one, two), "MAXIMUM": max(one, two)}
        return operations.get(node.operation)

    def squared(self, value, owner):
        """Returns the square of a number or texture, which converts Blender's roughness to the alpha of microfacets."""
        if not isinstance(value, dict):
            return value * value
        name = f"{value['texture']}^2"
        self.parts["float_textures"][name] = {"type": "scale", "tex": value, "scale": value}
        return {"texture": name}

    def normal_map(self, node, owner):
        """Returns the normal map of a Normal Map node, or None."""
        output = self.source(node.inputs["Color"])
        if output is None:
            return None
        strength = self.constant(node.inputs["Strength"], owner, "the strength of a normal map")
        if node.space != "TANGENT" or self.is_atlas:
            self.report.note(owner, "normal maps are supported in tangent space of UV only: it is left out")
            return None
        mapping = self._mapping(output.node, owner) if output.node.type == "TEX_IMAGE" else None
        if mapping is None or output.node.image is None:
            baked = self._baked(output, False, owner)
            if baked is None:
                return None
            texture = self.parts["spectrum_textures"].pop(baked["texture"])
            return {"image": {k: v for k, v in texture.items() if k != "type"}, "strength": strength}
        filename = self.images.path_of(output.node.image)
        if filename is None:
            return None
        image = {"filename": filename, "encoding": "linear"}
        if mapping:
            image["mapping"] = mapping
        return {"image": image, "strength": strength}
