# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the grids of volume objects (OpenVDB) and fluid domains. Reading OpenVDB files needs OpenVDB's Python module,
which later versions of Blender contain (in Debian: python3-openvdb)."""
from dataclasses import dataclass

import bpy
import numpy

from .voxels import Grid

LARGEST = 160  # cells along a side; finer grids are averaged
SIDES = numpy.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])


@dataclass
class Fields:
    """Holds arrays of shape (n, 3) by name, with one row for each cell of a grid; x varies fastest."""
    grid: Grid
    values: dict


class Box:
    """The box around a grid, with the interface of meshes.Surface."""
    color_name, colors, uv_name = None, {}, None

    def __init__(self, key, fields):
        self.key = self.object_name = key
        self.fields, self.to_world = fields, None
        low, high = fields.grid.low, fields.grid.high
        self.positions = numpy.array([(high if i >> axis & 1 else low)[axis] for i in range(8) for axis in range(3)],
                                     dtype=numpy.float32).reshape(8, 3)

    def texture_space(self):
        low, high = self.fields.grid.low, self.fields.grid.high
        return numpy.array([(low + high) / 2, (high - low) / 2])

    def has_attribute(self, name):
        return name in self.fields.values

    def shape(self):
        triangles = numpy.concatenate([SIDES[:, [0, 1, 2]], SIDES[:, [0, 2, 3]]]).astype(numpy.uint32)
        return {"type": "triangles", "positions": self.positions, "triangles": triangles}


def _averaged(values, factor):
    """Averages blocks of factor³ cells of an array (z, y, x, channels). Zeros fill incomplete blocks."""
    if factor == 1:
        return values
    padded = numpy.pad(values, [(0, -n % factor) for n in values.shape[:3]] + [(0, 0)])
    z, y, x = (n // factor for n in padded.shape[:3])
    return padded.reshape(z, factor, y, factor, x, factor, -1).mean(axis=(1, 3, 5))


def _fields(arrays, low, cell):
    """Makes Fields of arrays (z, y, x, channels) of equal shape. `low` is the lowest corner, `cell` a cell's size."""
    shape = next(iter(arrays.values())).shape[:3]
    factor = -(-max(shape) // LARGEST)
    arrays = {name: _averaged(values, factor) for name, values in arrays.items()}
    counts = numpy.array(next(iter(arrays.values())).shape[2::-1])
    grid = Grid(low, low + counts * factor * cell, counts)
    return Fields(grid, {name: numpy.broadcast_to(values, (*values.shape[:3], 3)).reshape(-1, 3)
                         for name, values in arrays.items()})


def openvdb_module():
    """Returns the Python module of OpenVDB under either of its names; None if it is not installed."""
    for name in ("openvdb", "pyopenvdb"):
        try:
            return __import__(name)
        except ImportError:
            pass
    return None


def of_volume(object, report):
    """Returns the Fields of a volume object; None, with a note, if they cannot be read."""
    data, vdb = object.data, openvdb_module()
    if vdb is None:
        report.note(object.name, "the volume is left out: it needs OpenVDB's Python module (Debian: python3-openvdb)")
        return None
    data.grids.load()
    path = data.grids.frame_filepath or bpy.path.abspath(data.filepath, library=data.library)
    try:
        grids = [grid for grid in vdb.readAllGridMetadata(path)]
        read = {grid.name: vdb.read(path, grid.name) for grid in grids if grid.valueTypeName in {"float", "vec3s"}}
    except (OSError, RuntimeError, KeyError):
        read = {}
    boxes = [grid.evalActiveVoxelBoundingBox() for grid in read.values() if grid.activeVoxelCount()]
    if not boxes:
        report.note(object.name, "the OpenVDB file is empty or cannot be read: it is left out")
        return None
    first, last = numpy.min([b[0] for b in boxes], axis=0), numpy.max([b[1] for b in boxes], axis=0)
    arrays = {}
    for name, grid in read.items():
        values = numpy.zeros((*(last - first + 1), *((3,) if grid.valueTypeName == "vec3s" else ())), dtype=numpy.float32)
        grid.copyToArray(values, ijk=tuple(int(i) for i in first))
        arrays[name] = numpy.moveaxis(values.reshape(*(last - first + 1), -1), 2, 0).swapaxes(1, 2)
    place = next(iter(read.values())).transform
    # As in Cycles, cell i extends from i to i + 1.
    low, high = (numpy.array(place.indexToWorld(tuple(float(i) for i in corner))) for corner in (first, first + 1))
    return _fields(arrays, low, high - low)


def of_fluid(object):
    """Returns the Fields of an object's fluid domain; None without a domain or smoke."""
    for modifier in object.modifiers:
        domain = modifier.domain_settings if modifier.type == "FLUID" and modifier.fluid_type == "DOMAIN" else None
        if domain is None or domain.domain_type != "GAS":
            continue
        counts = numpy.array(domain.domain_resolution)
        arrays = {name: _of_domain(getattr(domain, f"{name}_grid"), counts) for name in ("density", "flame", "color", "heat")}
        arrays = {name: values for name, values in arrays.items() if values is not None}
        if "density" not in arrays:
            continue
        low, cell = numpy.array(domain.start_point), numpy.array(domain.cell_size)
        fine = numpy.array(arrays["density"].shape[2::-1])
        arrays = {name: values for name, values in arrays.items() if values.shape[:3] == arrays["density"].shape[:3]}
        return _fields(arrays, low, cell * counts / fine)
    return None


def _of_domain(values, counts):
    """Returns a flat grid of the domain as an array (z, y, x, channels); None if its length does not fit. The resolution
    may be a multiple of the domain's. Of the four channels of colours, three are kept."""
    values = numpy.array(values, dtype=numpy.float32)
    for channels in (1, 4):
        factor = round((len(values) / channels / max(1, counts.prod())) ** (1 / 3))
        if factor > 0 and len(values) == channels * counts.prod() * factor**3:
            return values.reshape(*(counts[::-1] * factor), channels)[..., :3]
    return None
