# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Blender's lamps. The factors make the same light as Cycles does: tests/blender/test_lights.py measures them."""
import math

from bpy_extras.object_utils import world_to_camera_view

# What stands in for a lamp without a size, whose light Cycles takes from a point.
SMALLEST_RADIUS = 1e-4
POINTS_OF_SPOT = 32  # lights without a size that stand for a spot light with one
SMALLEST_SUN = math.radians(0.1)  # angle below which one direction stands for the sun
WIDE_SUN, SUNS, WIDE_SUNS = math.radians(2), 16, 64  # directions that stand for a sun, and for one of a larger angle
GOLDEN_ANGLE = math.pi * (3 - 5**0.5)
WIDE_SPOT = 0.85  # cosine of half the cone from which the approximation of its profile is told


def _color(light):
    return list(light.color)


def _strength(light, power, report):
    """Power times the strength of an Emission node, if the lamp has nodes."""
    color = _color(light)
    if light.use_nodes and light.node_tree:
        node = next((n for n in light.node_tree.nodes if n.type == "EMISSION"), None)
        others = [n for n in light.node_tree.nodes if n.type not in {"EMISSION", "OUTPUT_LIGHT"}]
        if others:
            report.note(light.name, "of the nodes of lamps, the Emission node's color and strength alone are used")
        if node:
            factor = node.inputs["Strength"].default_value
            color = [c * e * factor for c, e in zip(color, node.inputs["Color"].default_value)]
    return [power * c for c in color]


def _disk(count):
    """Points spread evenly over the unit disk (Vogel's spiral)."""
    radii = [math.sqrt((i + 0.5) / count) for i in range(count)]
    return [(r * math.cos(i * GOLDEN_ANGLE), r * math.sin(i * GOLDEN_ANGLE)) for i, r in enumerate(radii)]


def _point(light, matrix, report):
    # A sphere of radius r whose radiance is P / (4 pi^2 r^2) has the intensity P / 4 pi.
    power = _strength(light, light.energy, report)
    radius = light.shadow_soft_size
    place = list(matrix.translation)
    if radius < SMALLEST_RADIUS:
        intensity = [p / (4 * math.pi) for p in power]
        return {"lights": [{"type": "point", "from": place, "intensity": {"spectrum": intensity}}]}
    radiance = [p / (4 * math.pi**2 * radius**2) for p in power]
    return {"shape": {"type": "sphere", "radius": radius,
                      "object_to_world": [[1, 0, 0, place[0]], [0, 1, 0, place[1]], [0, 0, 1, place[2]], [0, 0, 0, 1]]},
            "radiance": radiance}


def _spot(light, matrix, report):
    # Cycles multiplies the intensity P / 4 pi by the cosine to the axis; here, its mean over the cone stands for it.
    power = _strength(light, light.energy, report)
    outer = math.degrees(light.spot_size) / 2
    # Cycles: smoothstep of (cos(angle) - cos(outer)) / ((1 - cos(outer)) blend).
    cosine = math.cos(light.spot_size / 2)
    mean_cosine = (1 + cosine) / 2
    if cosine < WIDE_SPOT:
        report.note(light.name, "a wide spot light is evenly bright: Cycles' are darker to the edge")
    inner = math.degrees(math.acos(min(1, cosine + (1 - cosine) * light.spot_blend)))
    axes, radius = matrix.to_3x3().normalized(), light.shadow_soft_size
    places = [(0, 0)] if radius < SMALLEST_RADIUS else _disk(POINTS_OF_SPOT)
    intensity = [mean_cosine * p / (4 * math.pi) / len(places) for p in power]
    made = []
    for x, y in places:
        place = matrix.translation + radius * (x * axes.col[0] + y * axes.col[1])
        made.append({"type": "spot", "from": list(place), "to": list(place - axes.col[2]), "cone_angle": outer,
                     "cone_delta_angle": outer - inner, "intensity": {"spectrum": intensity}})
    return {"lights": made}


def _sun(light, matrix, report):
    # Cycles samples a disk at distance 1 uniformly by area; away from its centre, the solid angle falls by cos^3.
    axes, irradiance = matrix.to_3x3().normalized(), _strength(light, light.energy, report)
    directions = [(0, 0)] if light.angle < SMALLEST_SUN else _disk(SUNS if light.angle < WIDE_SUN else WIDE_SUNS)
    radius, made = math.tan(min(light.angle, math.radians(179)) / 2), []
    for x, y in directions:
        direction = axes.col[2] + radius * (x * axes.col[0] + y * axes.col[1])
        share = direction.length**-3 / len(directions)
        made.append({"type": "distant", "from": list(direction.normalized()), "to": [0, 0, 0],
                     "radiance": {"spectrum": [share * e for e in irradiance]}})
    return {"lights": made}


def _rectangle(width, height):
    x, y = width / 2, height / 2
    return {"type": "triangles", "positions": [[-x, -y, 0], [-x, y, 0], [x, y, 0], [x, -y, 0]],
            "triangles": [[0, 1, 2], [0, 2, 3]]}


def _area(light, matrix, report):
    # Cycles: radiance P / 4 A, on the side of -z. (A Lambertian emitter of P watts would have P / pi A.)
    width = light.size
    height = light.size_y if light.shape in {"RECTANGLE", "ELLIPSE"} else light.size
    scale = matrix.to_scale()
    is_round = light.shape in {"DISK", "ELLIPSE"}
    area = width * scale.x * height * scale.y * (math.pi / 4 if is_round else 1)
    power = _strength(light, light.energy, report)
    if light.spread < math.radians(179):
        report.note(light.name, "the spread of an area light has no counterpart: it emits to all sides")
    shape = _rectangle(width, height)
    to_world = [list(row) for row in matrix]
    if is_round:
        shape = {"type": "disk", "radius": 0.5, "reverse_orientation": True}
        to_world = [[row[0] * width, row[1] * height, row[2], row[3]] for row in to_world]
    return {"shape": {**shape, "object_to_world": to_world},
            "radiance": [p / (4 * max(area, 1e-12)) for p in power]}


KINDS = {"POINT": _point, "SPOT": _spot, "SUN": _sun, "AREA": _area}


def add_light(parts, name, light, matrix, report):
    """Adds the lamp to the parts of a scene: lights, or a shape that emits."""
    made = KINDS[light.type](light, matrix, report)
    if "lights" in made:
        for number, part in enumerate(made["lights"]):
            parts["lights"][f"{name}/{number}" if number else name] = part
        return
    parts["area_lights"][name] = {"radiance": made["radiance"]}
    # A lamp does not stop the light of others: its surface lets all of it pass.
    parts["materials"].setdefault("lamp", {"type": "thindielectric", "eta": 1.0})
    parts["shapes"][name] = {**made["shape"], "material": "lamp", "area_light": name}


def seen_lamps(scene, camera, depsgraph):
    """Names of lamps that the camera probably sees: those whose centre or an extreme point is in the picture."""
    for instance in depsgraph.object_instances:
        object, light = instance.object, instance.object.data
        if object.type != "LIGHT" or not instance.show_self or light.type not in {"POINT", "AREA"}:
            continue
        radius = light.shadow_soft_size if light.type == "POINT" else light.size / 2
        middle = instance.matrix_world.translation
        ends = [middle + sign * radius * camera.matrix_world.to_3x3().col[axis] for axis in (0, 1) for sign in (1, -1)]
        views = [world_to_camera_view(scene, camera, point) for point in (middle, *ends)]
        if radius >= SMALLEST_RADIUS and any(0 < v.x < 1 and 0 < v.y < 1 and v.z > 0 for v in views):
            yield object.name
