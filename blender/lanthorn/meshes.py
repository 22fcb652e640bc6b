# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Evaluated meshes as arrays."""
import numpy


def _get(collection, name, count, dtype):
    values = numpy.empty(count, dtype=dtype)
    collection.foreach_get(name, values)
    return values


def _corner_normals(mesh, count):
    if hasattr(mesh, "corner_normals"):  # from Blender 4.1 on
        return _get(mesh.corner_normals, "vector", 3 * count, numpy.float32).reshape(-1, 3)
    mesh.calc_normals_split()
    return _get(mesh.loops, "normal", 3 * count, numpy.float32).reshape(-1, 3)


def _is_smooth(mesh):
    return bool(_get(mesh.polygons, "use_smooth", len(mesh.polygons), bool).any())


def _subset(triangles, corners):
    """The triangles with the corners that they have alone."""
    used, inverse = numpy.unique(triangles, return_inverse=True)
    part = {name: values[used] for name, values in corners.items()}
    part["triangles"] = inverse.reshape(-1, 3).astype(numpy.uint32)
    return part


def triangle_meshes(mesh):
    """The triangles of each material slot: a dict from the slot's index to a mesh of Lanthorn, whose vertices are
    the corners of Blender's."""
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    if count == 0:
        return {}
    loops = len(mesh.loops)
    vertices = _get(mesh.loops, "vertex_index", loops, numpy.int32)
    positions = _get(mesh.vertices, "co", 3 * len(mesh.vertices), numpy.float32).reshape(-1, 3)
    is_smooth = _is_smooth(mesh)
    triangles = _get(mesh.loop_triangles, "loops", 3 * count, numpy.int32).reshape(-1, 3)
    slots = _get(mesh.loop_triangles, "material_index", count, numpy.int32)
    if not is_smooth and mesh.uv_layers.active is None:
        corners = {"positions": positions}
        triangles = vertices[triangles]
    else:
        corners = {"positions": positions[vertices]}
        if is_smooth:
            corners["normals"] = _corner_normals(mesh, loops)
        uvs = mesh.uv_layers.active  # not before: the normals add a layer, which moves the others
        if uvs is not None:
            corners["uvs"] = _get(uvs.data, "uv", 2 * loops, numpy.float32).reshape(-1, 2)
    return {int(slot): _subset(triangles[slots == slot], corners) for slot in numpy.unique(slots)}
