# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Hair of particle systems and curves objects as curves of Lanthorn."""
import numpy

THINNEST = 1e-7  # metres


def bezier(lines, radii):
    """Curves through points. `lines`, `radii`: for each hair its points (n, 3), n > 1, and radii (n). Inner tangents are
    those of Catmull and Rom, a third of them leads to the control points."""
    points, segments, start = [], [], 0
    for line, radius in zip(lines, radii):
        tangents = numpy.gradient(line, axis=0) / 3
        thirds = numpy.gradient(radius) / 3
        controls = numpy.empty((3 * len(line) - 2, 4), dtype=numpy.float32)
        controls[::3, :3], controls[::3, 3] = line, radius
        controls[1::3, :3], controls[1::3, 3] = line[:-1] + tangents[:-1], radius[:-1] + thirds[:-1]
        controls[2::3, :3], controls[2::3, 3] = line[1:] - tangents[1:], radius[1:] - thirds[1:]
        points.append(controls)
        segments.append(start + numpy.arange(0, len(controls) - 1, 3, dtype=numpy.uint32))
        start += len(controls)
    points = numpy.concatenate(points)
    points[:, 3] = numpy.maximum(points[:, 3], 0)
    return {"type": "curves", "kind": "flat", "points": points, "segments": numpy.concatenate(segments)}


def _particle_lines(object, system, is_viewport):
    settings = system.settings
    steps = 2 ** (settings.display_step if is_viewport else settings.render_step) + 1
    count, parents = len(system.child_particles), len(system.particles)
    first = parents if count and not settings.use_parent_particles else 0
    for number in range(first, parents + count):
        line = numpy.array([system.co_hair(object, particle_no=number, step=step) for step in range(steps)])
        used = numpy.r_[True, (numpy.abs(numpy.diff(line, axis=0)).max(axis=1) > 0)]
        used[1:] &= numpy.abs(line[1:]).max(axis=1) > 0  # steps that a shorter hair lacks
        if used.sum() > 1:
            yield line[used]


def _particle_radii(settings, count):
    """Radii from root to tip. Blender's names say radius; its values are diameters."""
    root, tip = (settings.radius_scale * 0.5 * r for r in (settings.root_radius, settings.tip_radius))
    along = numpy.linspace(0, 1, count)
    shape = settings.shape
    along = along ** (1 + shape) if shape < 0 else 1 - (1 - along) ** (1 - shape) if shape > 0 else along
    radii = root + (tip - root) * along
    if settings.use_close_tip:
        radii[-1] = 0
    return numpy.maximum(radii, THINNEST)


def _is_hair(system):
    return system.settings.type == "HAIR" and system.settings.render_type == "PATH"


def particle_shapes(object, is_viewport):
    """(name, number of the material's slot, curves in world space) of each particle system."""
    for system in object.particle_systems:
        if not _is_hair(system):
            continue
        lines = list(_particle_lines(object, system, is_viewport))
        if lines:
            radii = [_particle_radii(system.settings, len(line)) for line in lines]
            yield system.name, system.settings.material - 1, bezier(lines, radii)


def curves_shape(object):
    """The curves of a curves object, in its own space; None if it has none."""
    data = object.data
    count = len(data.points)
    if count == 0:
        return None
    points = numpy.empty(3 * count, dtype=numpy.float32)
    data.points.foreach_get("position", points)
    radii = numpy.full(count, DEFAULT_RADIUS, dtype=numpy.float32)
    if data.attributes.get("radius") is not None:
        data.attributes["radius"].data.foreach_get("value", radii)
    points, lines, widths = points.reshape(-1, 3), [], []
    for curve in data.curves:
        first, size = curve.first_point_index, curve.points_length
        if size > 1:
            lines.append(points[first:first + size])
            widths.append(numpy.maximum(radii[first:first + size], THINNEST))
    return bezier(lines, widths) if lines else None


DEFAULT_RADIUS = 0.005  # metres, as Cycles has it


def color_of_melanin(node, number):
    """Absorption of a Principled Hair node by melanin (Chiang et al. 2016, with the coefficients of d'Eon et al. 2011
    as Cycles scales them)."""
    amount = -numpy.log(max(1e-4, 1 - number(node.inputs["Melanin"])))
    redness = number(node.inputs["Melanin Redness"])
    brown, red = numpy.array([0.506, 0.841, 1.653]), numpy.array([0.343, 0.733, 1.924])
    return (amount * ((1 - redness) * brown + redness * red)).tolist()
