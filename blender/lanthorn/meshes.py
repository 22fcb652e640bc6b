# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Copies evaluated meshes to arrays."""
import numpy

from . import atlas


def _get(collection, name, count, dtype):
    values = numpy.empty(count, dtype=dtype)
    collection.foreach_get(name, values)
    return values


def _has_normals_of_vertices(mesh, smooth):
    """Returns whether all corners of a vertex share its normal. `smooth` has a flag for each polygon."""
    if hasattr(mesh, "normals_domain"):  # from Blender 4.1 on
        return mesh.normals_domain == "POINT"
    return bool(smooth.all()) and not mesh.use_auto_smooth


def _vertex_normals(mesh):
    return _get(mesh.vertex_normals, "vector", 3 * len(mesh.vertices), numpy.float32).reshape(-1, 3)


def _corner_normals(mesh, count):
    if hasattr(mesh, "corner_normals"):  # from Blender 4.1 on
        return _get(mesh.corner_normals, "vector", 3 * count, numpy.float32).reshape(-1, 3)
    mesh.calc_normals_split()
    return _get(mesh.loops, "normal", 3 * count, numpy.float32).reshape(-1, 3)


def _smooth_polygons(mesh):
    return _get(mesh.polygons, "use_smooth", len(mesh.polygons), bool)


def _slots(mesh, count):
    """Returns the material slot of each triangle."""
    if len(mesh.materials) < 2:  # larger indices refer to the last slot
        return numpy.zeros(count, dtype=numpy.int32)
    return _get(mesh.loop_triangles, "material_index", count, numpy.int32)


def _corner_colors(mesh, attribute, vertices):
    """Returns linear colours and alpha of the corners; None for other domains than points and corners."""
    if attribute.domain not in {"POINT", "CORNER"} or not len(attribute.data):
        return None
    colors = _get(attribute.data, "color", 4 * len(attribute.data), numpy.float32).reshape(-1, 4)
    return colors[vertices] if attribute.domain == "POINT" else colors


VALUES_OF = {"FLOAT": ("value", 1), "FLOAT_VECTOR": ("vector", 3)}


def _corner_values(mesh, attribute, vertices):
    """Returns a numeric or vector attribute of the corners, as colours; None for other types."""
    if attribute.data_type not in VALUES_OF or attribute.name.startswith(".") or attribute.name == "position":
        return None
    member, count = VALUES_OF[attribute.data_type]
    values = _get(attribute.data, member, count * len(attribute.data), numpy.float32).reshape(-1, count)
    if attribute.domain == "POINT":
        values = values[vertices]
    elif attribute.domain == "FACE":
        values = numpy.repeat(values, _get(mesh.polygons, "loop_total", len(mesh.polygons), numpy.int32), axis=0)
    if len(values) != len(vertices):
        return None
    colors = numpy.ones((len(values), 4), dtype=numpy.float32)
    colors[:, :3] = values
    return colors


class Surface:
    """Holds a copy of a mesh for shapes and bakes, because Blender's own is temporary."""

    def __init__(self, mesh, key, texspace=None):
        self.key, self.texspace = key, texspace
        self.object_name, self.to_world = key, None
        self.fields = None  # volumes.Fields of fluid domains
        self._stored, self._atlases, self._shapes, self._bounds = {}, {}, {}, {}
        mesh.calc_loop_triangles()
        count, loops = len(mesh.loop_triangles), len(mesh.loops)
        self.is_empty = count == 0
        if self.is_empty:
            return
        self.vertices = _get(mesh.loops, "vertex_index", loops, numpy.int32)
        self.positions = _get(mesh.vertices, "co", 3 * len(mesh.vertices), numpy.float32).reshape(-1, 3)
        self.triangles = _get(mesh.loop_triangles, "loops", 3 * count, numpy.int32).reshape(-1, 3)
        self.slots = _slots(mesh, count)
        smooth = _smooth_polygons(mesh)
        self.is_smooth = bool(smooth.any())
        self.vertex_normals = self.normals = None
        if self.is_smooth and _has_normals_of_vertices(mesh, smooth):
            self.vertex_normals = _vertex_normals(mesh)
            self.normals = self.vertex_normals[self.vertices]
        elif self.is_smooth:
            self.normals = _corner_normals(mesh, loops)
        # UV layers are read last: computing normals adds a layer, which moves the others.
        self.uv_layers = {layer.name: _get(layer.data, "uv", 2 * loops, numpy.float32).reshape(-1, 2)
                          for layer in mesh.uv_layers}
        # In Blender 3.4, geometry nodes turn UV maps into attributes.
        self.uv_layers.update({a.name: _get(a.data, "vector", 2 * loops, numpy.float32).reshape(-1, 2)
                               for a in mesh.attributes if self._is_uv_map(a)})
        shown = next((layer.name for layer in mesh.uv_layers if layer.active_render), None)
        self.uv_name = shown if shown is not None else next(iter(self.uv_layers), None)
        colors = {a.name: _corner_colors(mesh, a, self.vertices) for a in mesh.color_attributes}
        self.colors = {name: values for name, values in colors.items() if values is not None}
        values = {a.name: _corner_values(mesh, a, self.vertices) for a in mesh.attributes if a.name not in colors}
        self.values = {name: array for name, array in values.items() if array is not None}  # for bakes only
        active = mesh.color_attributes.active_color
        self.color_name = active.name if active is not None and active.name in self.colors else None

    def _is_uv_map(self, attribute):
        is_of_corners = attribute.data_type == "FLOAT2" and attribute.domain == "CORNER"
        return is_of_corners and attribute.name not in self.uv_layers and not attribute.name.startswith(".")

    def stored(self, bakes, slot):
        """Returns the path of a file with `atlas_arrays`, and the size of their image."""
        key = slot, bakes.size
        if key not in self._stored:
            self._stored[key] = bakes.store(self.atlas_arrays(slot, bakes.size)), self._atlas(slot, bakes.size)[1]
        return self._stored[key]

    def used_slots(self):
        return [] if self.is_empty else numpy.flatnonzero(numpy.bincount(self.slots)).tolist()

    def shape(self, slot, color_name=None, is_welded=False, tangent=None):
        """Returns the triangles of a slot as a mesh of Lanthorn, with one vertex for each corner in Blender. If welded,
        equal corners share a vertex. `tangent` has the arguments of `_tangents`. Each call returns the same arrays, which
        makes comparisons cheap."""
        key = slot, color_name, is_welded, tangent
        if key not in self._shapes:
            self._shapes[key] = self._shape(*key)
        return self._shapes[key]

    def _triangles_of(self, slot):
        chosen = self.slots == slot
        return self.triangles if chosen.all() else self.triangles[chosen]

    def _shape(self, slot, color_name, is_welded, tangent):
        triangles = self._triangles_of(slot)
        colors = self.colors.get(color_name)
        if self.uv_name is None and colors is None and tangent is None and (not self.is_smooth or self.vertex_normals is not None):
            normals = {"normals": self.vertex_normals} if self.is_smooth else {}
            return _subset(self.vertices[triangles], {"positions": self.positions, **normals})
        corners = {"positions": self.positions[self.vertices]}
        if self.is_smooth:
            corners["normals"] = self.normals
        if self.uv_name is not None:
            corners["uvs"] = self.uv_layers[self.uv_name]
        if colors is not None:
            corners["colors"] = colors
        if tangent is not None:
            corners["tangents"] = self._tangents(*tangent)
        return _subset(_welded(triangles, self.vertices, corners) if is_welded else triangles, corners)

    def atlas_shape(self, slot, size, tangent=None):
        """Returns the same with the texture coordinates of the atlas."""
        key = "atlas", slot, size, tangent
        if key not in self._shapes:
            self._shapes[key] = self._atlas_shape(slot, size, tangent)
        return self._shapes[key]

    def _atlas_shape(self, slot, size, tangent):
        corners = self._triangles_of(slot).reshape(-1)
        shape = {"positions": self.positions[self.vertices[corners]], "uvs": self._atlas(slot, size)[0].reshape(-1, 2),
                 "triangles": numpy.arange(len(corners), dtype=numpy.uint32).reshape(-1, 3)}
        if self.is_smooth:
            shape["normals"] = self.normals[corners]
        if tangent is not None:
            shape["tangents"] = self._tangents(*tangent)[corners]
        return shape

    def _tangents(self, kind, name, turn):
        """Returns the tangent of anisotropy at each corner. A tangent of kind RADIAL runs around the axis `name` of the
        texture space, one of kind UV along u of the layer `name`. `turn` is the rotation around the normal, in full
        turns."""
        around = self._around(name) if kind == "RADIAL" else self._along_u(name)
        if turn == 0:
            return around  # the program makes it perpendicular to the normal
        normals = self.normals if self.is_smooth else self._facets()
        along = around - normals * (around * normals).sum(axis=1, keepdims=True)
        angle = 2 * numpy.pi * turn
        return (numpy.cos(angle) * along + numpy.sin(angle) * numpy.cross(normals, along)).astype(numpy.float32)

    def _around(self, axis):
        middle, size = self.texture_space()
        x, y, z = ((self.positions[self.vertices] - middle) / numpy.maximum(size, 1e-6)).T
        zero = numpy.zeros_like(x)
        columns = {"X": (zero, -z, y), "Y": (-z, zero, x), "Z": (-y, x, zero)}[axis]
        return numpy.stack(columns, axis=1).astype(numpy.float32)

    def _along_u(self, name):
        uvs = self.uv_layers.get(name, self.uv_layers.get(self.uv_name))
        if uvs is None:
            return self._around("Z")
        points, places = self.positions[self.vertices[self.triangles]], uvs[self.triangles]
        (e1, e2), (d1, d2) = ([values[:, i] - values[:, 0] for i in (1, 2)] for values in (points, places))
        along = e1 * d2[:, 1:] - e2 * d1[:, 1:]
        along *= numpy.sign(d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0])[:, None]
        return self._of_corners(along)

    def _facets(self):
        points = self.positions[self.vertices[self.triangles]]
        return self._of_corners(numpy.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]))

    def _of_corners(self, vectors):
        """Normalizes the vectors of triangles and copies them to the corners."""
        vectors = vectors / numpy.maximum(numpy.linalg.norm(vectors, axis=1, keepdims=True), 1e-20)
        of_corners = numpy.zeros((len(self.vertices), 3), dtype=numpy.float32)
        of_corners[self.triangles] = vectors[:, None, :]
        return of_corners

    def texture_space(self):
        """Returns the centre and the half extent of the box of Generated coordinates."""
        if self.texspace is not None:
            return numpy.array(self.texspace)
        low, high = self.positions.min(axis=0), self.positions.max(axis=0)
        return numpy.array([(low + high) / 2, numpy.maximum((high - low) / 2, 1e-6)])

    def _atlas(self, slot, size):
        if (slot, size) not in self._atlases:
            points = self.positions[self.vertices[self._triangles_of(slot)]]
            self._atlases[slot, size] = atlas.places(points, size)
        return self._atlases[slot, size]

    def has_attribute(self, name):
        return name in self.colors or name in self.values or name in self.uv_layers

    def uv_bounds(self, slot):
        """Returns the bounds of a slot's texture coordinates, which contain the unit square."""
        if slot not in self._bounds:
            self._bounds[slot] = self._uv_bounds(slot)
        return self._bounds[slot]

    def _uv_bounds(self, slot):
        if self.uv_name is None:
            return numpy.zeros(2), numpy.ones(2)
        uvs = self.uv_layers[self.uv_name][self._triangles_of(slot).reshape(-1)]
        low, high = uvs.min(axis=0).astype(numpy.float64), uvs.max(axis=0).astype(numpy.float64)
        low, high = numpy.floor(numpy.minimum(low, 0) + 1e-4), numpy.ceil(numpy.maximum(high, 1) - 1e-4)
        return low, high

    def atlas_arrays(self, slot, size):
        """Returns the arrays with which bake_worker.py bakes the slot."""
        chosen = self._triangles_of(slot)
        corners = chosen.reshape(-1)
        used, inverse = numpy.unique(self.vertices[corners], return_inverse=True)
        arrays = {"vertices": self.positions[used], "triangles": inverse.reshape(-1, 3), "is_smooth": self.is_smooth,
                  "atlas": self._atlas(slot, size)[0].reshape(-1, 2)}
        names = sorted(self.uv_layers, key=lambda name: name != self.uv_name)
        arrays.update({f"uv:{name}": self.uv_layers[name][corners] for name in names})
        arrays.update({f"color:{name}": values[corners] for name, values in {**self.values, **self.colors}.items()})
        arrays["texspace"] = self.texture_space()
        return arrays

    def square_arrays(self, low, high):
        """Returns the arrays of a square that fills its image and has texture coordinates from `low` to `high`."""
        uvs = numpy.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], low[1]],
                           [high[0], high[1]], [low[0], high[1]]], dtype=numpy.float32)
        unit = numpy.array([[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]], dtype=numpy.float32)
        vertices = numpy.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=numpy.float32)
        names = list(self.uv_layers) or ["UVMap"]
        return {"vertices": vertices, "triangles": numpy.array([[0, 1, 2], [0, 2, 3]]), "is_smooth": False, "atlas": unit,
                **{f"uv:{name}": uvs for name in names}}


def _welded(triangles, vertices, corners):
    """Replaces each corner of the triangles by the first of all equal corners."""
    columns = [vertices[:, None].astype(numpy.float64)]
    columns += [numpy.round(values, 5) for name, values in corners.items() if name != "positions"]
    _, first, inverse = numpy.unique(numpy.concatenate(columns, axis=1), axis=0, return_index=True, return_inverse=True)
    return first[inverse.reshape(-1)][triangles]


def _subset(triangles, corners):
    """Returns the triangles, with only the corners that they use."""
    used = numpy.zeros(len(corners["positions"]), dtype=bool)
    used[triangles] = True
    if used.all():
        return {**corners, "triangles": triangles.astype(numpy.uint32)}
    numbers = numpy.cumsum(used, dtype=numpy.uint32) - 1
    return {**{name: values[used] for name, values in corners.items()}, "triangles": numbers[triangles]}
