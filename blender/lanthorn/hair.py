# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Translates hair of particle systems and curves objects to curves of Lanthorn."""
import numpy

THINNEST = 1e-7  # metres


def bezier(lines, radii):
    """Returns Bézier curves through points. `lines` and `radii` have the points (n, 3), n > 1, and the radii (n) of each
    hair. Tangents follow Catmull-Rom splines; inner control points lie a third of the tangent away."""
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
        used[1:] &= numpy.abs(line[1:]).max(axis=1) > 0  # shorter hairs have no points at the last steps
        if used.sum() > 1:
            yield number, line[used]


def _particle_radii(settings, count):
    """Returns radii from root to tip. Blender calls its values radii, but they are diameters."""
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


class Strands:
    """Holds the hairs of a particle system, in world space."""

    def __init__(self, object, modifier, is_viewport):
        self._object, self._modifier, self.system = object, modifier, modifier.particle_system
        made = list(_particle_lines(object, self.system, is_viewport))
        self.numbers, self.lines = [number for number, _ in made], [line for _, line in made]
        self.slot = self.system.settings.material - 1

    def shape(self, chosen=None):
        """Returns curves of all hairs, or of the chosen ones."""
        lines = self.lines if chosen is None else [self.lines[i] for i in chosen]
        return bezier(lines, [_particle_radii(self.system.settings, len(line)) for line in lines])

    def roots(self):
        """Returns the texture coordinates (n, 2) of the surface at the roots; None if it has none."""
        particles = self.system.particles
        if not len(self._object.data.uv_layers) or not len(particles):
            return None
        return numpy.array([self.system.uv_on_emitter(self._modifier, particle=particles[min(i, len(particles) - 1)],
                                                      particle_no=i, uv_no=0) for i in self.numbers])


def strands(object, is_viewport):
    """Yields the hair of an object's particle systems."""
    for modifier in object.modifiers:
        if modifier.type == "PARTICLE_SYSTEM" and _is_hair(modifier.particle_system):
            made = Strands(object, modifier, is_viewport)
            if made.lines:
                yield made


LEVELS = 8  # levels per colour channel that distinguish hairs


def groups_of_color(image, roots):
    """Groups hairs whose roots have about the same colour in an image. Yields the colour and the hairs' indices."""
    width, height = image.size
    pixels = numpy.empty(width * height * 4, dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    x, y = (numpy.floor((roots[:, i] % 1) * size).astype(int) % size for i, size in enumerate((width, height)))
    colors = pixels.reshape(height, width, 4)[y, x, :3]
    if image.colorspace_settings.name == "sRGB" and not image.is_float:
        colors = numpy.where(colors <= 0.04045, colors / 12.92, ((colors + 0.055) / 1.055) ** 2.4)
    steps = numpy.round(numpy.sqrt(colors.clip(0, 1)) * (LEVELS - 1)).astype(int)
    _, group = numpy.unique(steps, axis=0, return_inverse=True)
    for number in range(group.max() + 1):
        chosen = numpy.flatnonzero(group.reshape(-1) == number)
        yield colors[chosen].mean(axis=0).tolist(), chosen.tolist()


def curves_shape(object):
    """Returns the curves of a curves object in object space; None if it has none."""
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


DEFAULT_RADIUS = 0.005  # metres, as in Cycles


def color_of_melanin(node, number):
    """Returns the absorption coefficient of a Principled Hair node by melanin (Chiang et al. 2016, with the coefficients
    of d'Eon et al. 2011, scaled as in Cycles)."""
    amount = -numpy.log(max(1e-4, 1 - number(node.inputs["Melanin"])))
    redness = number(node.inputs["Melanin Redness"])
    brown, red = numpy.array([0.506, 0.841, 1.653]), numpy.array([0.343, 0.733, 1.924])
    return (amount * ((1 - redness) * brown + redness * red)).tolist()
