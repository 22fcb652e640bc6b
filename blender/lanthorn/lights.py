# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Translates Blender's lights. The factors give the same light as Cycles: tests/blender/test_lights.py measures them."""
import math

from .textures import Textures

# Smaller point and spot lights become lights without a size.
SMALLEST_RADIUS = 1e-4
POINTS_OF_SPOT = 32  # lights without a size that approximate a spot light with a radius
SMALLEST_SUN = math.radians(0.01)  # a smaller sun becomes parallel light
GOLDEN_ANGLE = math.pi * (3 - 5**0.5)
SMALLEST_SPREAD = 1  # degrees, as in Cycles
WIDE_SPOT = 0.85  # cosine of half the cone; wider spots get a warning


def _color(light):
    return list(light.color)


def _strength(light, power, report):
    """Returns the power, multiplied by the colours and strengths of the light and of its Emission node."""
    color = _color(light)
    if light.use_nodes and light.node_tree:
        output = light.node_tree.get_output_node("CYCLES") or light.node_tree.get_output_node("ALL")
        values = Textures({"float_textures": {}, "spectrum_textures": {}}, report, None, None)
        source = values.source(output.inputs["Surface"]) if output is not None else None
        if source is None:
            return [0.0, 0.0, 0.0]
        if source.node.type != "EMISSION":
            report.note(light.name, f"the node {source.node.bl_label} of a light is not supported: the light's own colour and power are used")
            return [power * c for c in color]
        emitted = values.constant_color(source.node.inputs["Color"], light.name, "the colour of a light")
        factor = values.constant(source.node.inputs["Strength"], light.name, "the strength of a light")
        color = [c * e * factor for c, e in zip(color, emitted)]
    return [power * c for c in color]


def _disk(count):
    """Returns points that cover the unit disk evenly (Vogel's spiral)."""
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
    # Cycles 3.4 multiplies the intensity P / 4 pi by the cosine to the axis. The mean cosine of the cone replaces it.
    power = _strength(light, light.energy, report)
    outer = math.degrees(light.spot_size) / 2
    # Cycles: smoothstep of (cos(angle) - cos(outer)) / ((1 - cos(outer)) blend).
    cosine = math.cos(light.spot_size / 2)
    mean_cosine = (1 + cosine) / 2
    if cosine < WIDE_SPOT:
        report.note(light.name, "wide spot lights are brighter towards the edge than in Cycles")
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


def sun(direction, irradiance, angle):
    """Returns a sun. `direction`: to its centre. `irradiance`: on a plane that faces it, W/m². `angle`: of its
    diameter, radians."""
    return {"type": "distant", "from": list(direction), "to": [0, 0, 0], "radiance": {"spectrum": list(irradiance)},
            "angle": math.degrees(angle) if angle >= SMALLEST_SUN else 0.0}


def _sun(light, matrix, report):
    # Cycles draws points of a disk at distance 1, each of which gives P to a plane that faces it. So a plane that faces
    # the disk's centre receives P times the mean cosine over the disk, 2 c / (1 + c) with c at the edge.
    angle = min(light.angle, math.radians(179))
    cosine = math.cos(angle / 2)
    irradiance = [2 * cosine / (1 + cosine) * e for e in _strength(light, light.energy, report)]
    towards = matrix.to_3x3().normalized().col[2]
    return {"lights": [sun(towards, irradiance, angle)]}


def _rectangle(width, height):
    x, y = width / 2, height / 2
    return {"type": "triangles", "positions": [[-x, -y, 0], [-x, y, 0], [x, y, 0], [x, -y, 0]],
            "triangles": [[0, 1, 2], [0, 2, 3]]}


def _area(light, matrix, report):
    # The radiance in Cycles is P / 4 A, on the side of -z. (A diffuse emitter of P watts would have P / pi A.)
    width = light.size
    height = light.size_y if light.shape in {"RECTANGLE", "ELLIPSE"} else light.size
    scale = matrix.to_scale()
    is_round = light.shape in {"DISK", "ELLIPSE"}
    area = width * scale.x * height * scale.y * (math.pi / 4 if is_round else 1)
    power = _strength(light, light.energy, report)
    shape = _rectangle(width, height)
    to_world = [list(row) for row in matrix]
    if is_round:
        shape = {"type": "disk", "radius": 0.5, "reverse_orientation": True}
        to_world = [[row[0] * width, row[1] * height, row[2], row[3]] for row in to_world]
    spread = max(math.degrees(light.spread), SMALLEST_SPREAD)
    return {"shape": {**shape, "object_to_world": to_world}, "spread": min(spread, 180.0),
            "radiance": [p / (4 * max(area, 1e-12)) for p in power]}


NAMES = {"POINT": "point lights", "SPOT": "spot lights"}
KINDS = {"POINT": _point, "SPOT": _spot, "SUN": _sun, "AREA": _area}


def add_light(parts, name, object, matrix, report):
    """Adds an object's light to the parts of a scene: as lights without a surface, or as an emitting shape."""
    light = object.data
    made = KINDS[light.type](light, matrix, report)
    if "lights" in made:
        if light.type == "SUN":
            made["lights"][0]["visible_to_camera"] = object.visible_camera
        elif object.visible_camera and light.shadow_soft_size > 0:
            report.note(object.name, f"{NAMES[light.type]} are never visible to the camera")
        for number, part in enumerate(made["lights"]):
            parts["lights"][f"{name}/{number}" if number else name] = part
        return
    parts["area_lights"][name] = {"radiance": made["radiance"], "spread": made.get("spread", 180.0)}
    # Lights do not cast shadows, so the surface lets all light pass.
    parts["materials"].setdefault("lamp", {"type": "thindielectric", "eta": 1.0})
    parts["shapes"][name] = {**made["shape"], "material": "lamp", "area_light": name,
                             "visible_to_camera": object.visible_camera}
