#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the meshes and the fur of the scenes, byte for byte as they are in the repository.

Usage: scenes/make_meshes.py [--check] [FOLDER]

Writes into FOLDER, by default meshes/ beside this script; with --check writes nothing and exits 1 if a file differs.
Positions are rounded to a micrometre, so that the last bit of a sine does not show in the files.
"""
import gzip
import math
import random
import struct
import sys
from pathlib import Path


# Vectors, as tuples

def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def mul(a, s):
    return tuple(x * s for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return mul(a, 1 / length)


def polar(r, degrees):
    return (r * math.cos(math.radians(degrees)), r * math.sin(math.radians(degrees)))


class Mesh:
    """Triangles, counter-clockwise seen from outside, with a normal at each vertex."""

    def __init__(self):
        self.vertices = []
        self.triangles = []

    def vertex(self, position, normal):
        self.vertices.append((position, normal))
        return len(self.vertices) - 1

    def polygon(self, points, normal):
        """A flat convex facet."""
        corners = [self.vertex(p, normal) for p in points]
        self.triangles += [(corners[0], b, c) for b, c in zip(corners[1:], corners[2:])]

    def strip(self, lower, upper):
        """Triangles between two rows of vertices that run to the right seen from outside; none where both ends are
        one point."""
        at = [v[0] for v in self.vertices]
        for a, b, c, d in zip(lower, lower[1:], upper[1:], upper):
            if at[a] != at[b]:
                self.triangles.append((a, b, c))
            if at[c] != at[d]:
                self.triangles.append((a, c, d))

    def bytes(self, flat=False, rounded=lambda x: round(x, 6)):
        """The PLY file. `flat` leaves the normals out."""
        index, face = ("ushort", "<B3H") if len(self.vertices) <= 65536 else ("uint", "<B3I")
        names = ("x", "y", "z") if flat else ("x", "y", "z", "nx", "ny", "nz")
        header = ("ply", "format binary_little_endian 1.0", f"element vertex {len(self.vertices)}",
                  *(f"property float {name}" for name in names),
                  f"element face {len(self.triangles)}", f"property list uchar {index} vertex_indices", "end_header\n")
        return b"".join(("\n".join(header).encode(),
                         *(struct.pack(f"<{len(names)}f", *(rounded(x) + 0.0 for x in (p + n)[:len(names)]))
                           for p, n in self.vertices),
                         *(struct.pack(face, 3, *t) for t in self.triangles)))


# Surfaces of revolution about z

def line(*points):
    return list(points)


def arc(centre, radius, start, end, steps):
    """Points on an arc of a circle; angles in degrees."""
    return [add(centre, polar(radius, start + (end - start) * i / steps)) for i in range(steps + 1)]


def smooth(points):
    """Runs of (r, z): a polyline without creases. Normals are to the right of its direction."""
    for i, point in enumerate(points):
        dr, dz = sub(points[min(i + 1, len(points) - 1)], points[max(i - 1, 0)])
        yield point, unit((dz, -dr))


def lathe(runs, segments=64, mesh=None):
    """Turns a profile of smooth runs of (r, z), which has the outside on its right, about z."""
    mesh = mesh or Mesh()
    for run in runs:
        rows = []
        for (r, z), (nr, nz) in smooth(run):
            turns = [polar(1, 360 * (i % segments) / segments) for i in range(segments + 1)]
            rows.append([mesh.vertex((r * x, r * y, z), (nr * x, nr * y, nz)) for x, y in turns])
        for lower, upper in zip(rows, rows[1:]):
            mesh.strip(lower, upper)
    return mesh


def surface(position, us, vs):
    """A parametric surface on a grid, closed or not; u × v points out. Normals by differences."""
    mesh = Mesh()
    step = 1e-4

    def normal(u, v):
        along_u = sub(position(u + step, v), position(u - step, v))
        along_v = sub(position(u, v + step), position(u, v - step))
        return unit(cross(along_u, along_v))

    rows = [[mesh.vertex(position(u, v), normal(u, v)) for u in us] for v in vs]
    for lower, upper in zip(rows, rows[1:]):
        mesh.strip(lower, upper)
    return mesh


def angles(count, degrees=360.0):
    return [math.radians(degrees) * i / count for i in range(count + 1)]


def torus(major, minor):
    def position(u, v):
        r = major + minor * math.cos(v)
        return (r * math.cos(u), r * math.sin(u), minor * math.sin(v))

    return surface(position, angles(80), angles(40))


def tube(path, radius, sides=20):
    """A round tube along a path of (y, z) in the plane x = 0, open at its ends."""
    mesh = Mesh()
    rows = []
    for (y, z), (ny, nz) in smooth(path):
        spokes = [(x, ny * s, nz * s) for x, s in (polar(1, 360 * (i % sides) / sides) for i in range(sides + 1))]
        rows.append([mesh.vertex(add((0, y, z), mul(spoke, radius)), spoke) for spoke in spokes])
    for lower, upper in zip(rows, rows[1:]):
        mesh.strip(lower, upper)
    return mesh


# Plates: an outline in the plane, given thickness

def inset(loop, distance):
    """Moves every edge of a counter-clockwise loop inwards; corners stay sharp."""
    moved = []
    for a, b, c in zip(loop[-1:] + loop[:-1], loop, loop[1:] + loop[:1]):
        (ux, uy), (vx, vy) = unit(sub(b, a)), unit(sub(c, b))
        scale = distance / max(0.3, 1 + ux * vx + uy * vy)
        moved.append((b[0] - (uy + vy) * scale, b[1] + (ux + vx) * scale))
    return moved


def walls(mesh, loop, levels):
    """The sides of a plate through (inset, z) levels; smooth where the outline turns by less than 30 degrees."""
    loops = [[p + (z,) for p in inset(loop, distance)] for distance, z in levels]
    count = len(loop)
    for lower, upper in zip(loops, loops[1:]):
        facets = [unit(cross(sub(lower[(i + 1) % count], lower[i]), sub(upper[i], lower[i]))) for i in range(count)]

        def normal(edge, neighbour):
            near = dot(facets[edge], facets[neighbour]) > math.cos(math.radians(30))
            return unit(add(facets[edge], facets[neighbour])) if near else facets[edge]

        for i in range(count):
            j = (i + 1) % count
            normals = (normal(i, i - 1), normal(i, j))
            ends = [[mesh.vertex(row[k], n) for k, n in zip((i, j), normals)] for row in (lower, upper)]
            mesh.strip(*ends)


def ears(loop):
    """Triangles of a simple counter-clockwise polygon, by clipping ears."""
    def left_of(a, b, p):
        return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])

    def is_ear(a, b, c):
        others = [loop[k] for k in rest if k not in (a, b, c)]
        a, b, c = loop[a], loop[b], loop[c]
        return left_of(a, b, c) > 1e-12 and not any(
            min(left_of(a, b, p), left_of(b, c, p), left_of(c, a, p)) >= 0 for p in others)

    rest = list(range(len(loop)))
    while len(rest) > 2:
        i = next(i for i in range(len(rest)) if is_ear(rest[i - 1], rest[i], rest[(i + 1) % len(rest)]))
        yield rest[i - 1], rest[i], rest[(i + 1) % len(rest)]
        del rest[i]


def plate(outline, thickness, chamfer, hole=None):
    """A counter-clockwise outline from z = 0 to `thickness`; a hole has as many points as the outline, each near its
    own."""
    mesh = Mesh()
    levels = ((chamfer, 0), (0, chamfer), (0, thickness - chamfer), (chamfer, thickness))
    walls(mesh, outline, levels)
    if hole:
        walls(mesh, hole[::-1], levels)
    for z, side in ((thickness, 1), (0, -1)):
        outer = [mesh.vertex(p + (z,), (0, 0, side)) for p in inset(outline, chamfer)]
        if hole:
            inner = [mesh.vertex(p + (z,), (0, 0, side)) for p in inset(hole[::-1], chamfer)[::-1]]
            rows = (outer + outer[:1], inner + inner[:1])
            mesh.strip(*rows[::side])
        else:
            mesh.triangles += [tuple(outer[k] for k in ear[::side]) for ear in ears(inset(outline, chamfer))]
    return mesh


def gear(teeth, radius, bore):
    """Outline and hole of a spur gear with straight flanks."""
    depth = 2.6 * radius / teeth
    flanks = ((-0.30, -depth), (-0.14, 0), (0.14, 0), (0.30, -depth))
    outline = [polar(radius + dr, 360 * (i + turn) / teeth) for i in range(teeth) for turn, dr in flanks]
    hole = [polar(bore, 360 * (i + turn) / teeth) for i in range(teeth) for turn, _ in flanks]
    return outline, hole


def hexagon(width, points_per_side=8):
    """Outline of a nut of this width across flats, and the directions of its points."""
    outline = []
    for k in range(6):
        a, b = polar(width / math.sqrt(3), 60 * k), polar(width / math.sqrt(3), 60 * k + 60)
        outline += [add(a, mul(sub(b, a), i / points_per_side)) for i in range(points_per_side)]
    return outline


def nut(width, bore, thickness):
    outline = hexagon(width)
    return plate(outline, thickness, 0.04 * width, [mul(unit(p), bore) for p in outline])


def bolt(width, radius, length):
    """A hexagonal head below z = 0 and a threaded shaft above it."""
    mesh = plate(hexagon(width, 1), 0.4 * width, 0.05 * width)
    mesh.vertices = [((x, y, z - 0.4 * width), n) for (x, y, z), n in mesh.vertices]
    pitch = 0.4 * radius

    def thread(u, v):
        phase = v / pitch - u / math.tau
        fade = min(1, (length - v) / pitch)
        r = radius * (0.9 + 0.08 * math.cos(math.tau * phase) * fade)
        return (r * math.cos(u), r * math.sin(u), v)

    rows = int(length / pitch * 6)
    shaft = surface(thread, angles(24), [length * i / rows for i in range(rows + 1)])
    first = len(mesh.vertices)
    mesh.vertices += shaft.vertices
    mesh.triangles += [tuple(first + k for k in t) for t in shaft.triangles]
    return lathe([line((0.9 * radius, length), (0, length + 0.2 * radius))], 24, mesh)


def spanner(length, small, large):
    """Outline of a double open-ended spanner for nuts of two widths across flats; jaws are turned by 15 degrees."""
    def head(width):
        radius, jaw = 1.05 * width, 0.5 * width
        tip = math.degrees(math.asin(jaw / radius))
        neck = 180 - math.degrees(math.asin(0.36 * small / radius))
        upper = [polar(radius, tip + (neck - 15 - tip) * i / 14) for i in range(15)]
        lower = [polar(radius, -neck - 15 + (neck + 15 - tip) * i / 14) for i in range(15)]
        seat = [(-0.3 * width, -jaw), (-0.3 * width, jaw)]
        turned = lower + seat + upper
        cosine, sine = polar(1, 15)
        return [(x * cosine - y * sine, x * sine + y * cosine) for x, y in turned]

    right = [(x + length / 2, y) for x, y in head(large)]
    left = [(-x - length / 2, -y) for x, y in head(small)]
    return right + left


# Convex solids

def convex(planes, size=10.0):
    """The solid where dot(normal, p) <= offset for every (normal, offset): each facet is a large square, clipped by
    all other planes."""
    mesh = Mesh()
    for normal, offset in planes:
        helper = (1, 0, 0) if abs(normal[0]) < 0.7 else (0, 1, 0)
        s = unit(cross(helper, normal))
        t = cross(normal, s)
        facet = [add(mul(normal, offset), add(mul(s, a * size), mul(t, b * size)))
                 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        for other, limit in planes:
            if other is not normal:
                facet = clip(facet, other, limit)
        if len(facet) > 2:
            mesh.polygon(facet, normal)
    return mesh


def clip(polygon, normal, offset):
    """The part of a convex polygon behind a plane (Sutherland & Hodgman 1974)."""
    kept = []
    for a, b in zip(polygon[-1:] + polygon[:-1], polygon):
        above_a, above_b = dot(normal, a) - offset, dot(normal, b) - offset
        if (above_a > 1e-9) != (above_b > 1e-9):
            kept.append(add(a, mul(sub(b, a), above_a / (above_a - above_b))))
        if above_b <= 1e-9:
            kept.append(b)
    return [b for a, b in zip(kept[-1:] + kept[:-1], kept) if dot(sub(a, b), sub(a, b)) > 1e-12]


def slanted(azimuth, slope, through):
    """The plane that falls by `slope` degrees away from the axis towards `azimuth` and holds a point."""
    normal = polar(math.sin(math.radians(slope)), azimuth) + (math.cos(math.radians(slope)),)
    return normal, dot(normal, through)


def brilliant(table=0.57, crown=34.5, pavilion=41.0, girdle=0.02):
    """Round brilliant of girdle radius 1 with 57 facets and the girdle's 16: Tolkowsky's crown, the pavilion that is
    common now."""
    def kite(slope, r, side):
        """A point of a main facet where its neighbours meet it, 22.5 degrees from its middle."""
        return polar(r, 22.5) + (side * (girdle + (1 - r * math.cos(math.pi / 8)) * math.tan(math.radians(slope))),)

    def half_slope(point):
        """Slope of the facet through a point of the main facet and the girdle beside it."""
        r = math.hypot(point[0], point[1])
        return math.degrees(math.atan2(abs(point[2]) - girdle, (1 - r) * math.cos(math.pi / 16)))

    side_tip, lower_tip = kite(crown, (1 + table * math.cos(math.pi / 8)) / 2, 1), kite(pavilion, 0.23, -1)
    top = girdle + (1 - table) * math.tan(math.radians(crown))
    star = math.degrees(math.atan2(top - side_tip[2], math.hypot(*side_tip[:2]) - table * math.cos(math.pi / 8)))
    planes = [((0, 0, 1), top)]
    for k in range(8):
        rim = polar(1, 45 * k)
        planes += [slanted(45 * k, crown, rim + (girdle,)), slanted(45 * k, 180 - pavilion, rim + (-girdle,)),
                   slanted(45 * k + 22.5, star, polar(table, 45 * k) + (top,))]
    for k in range(16):
        rim, azimuth = polar(1, 22.5 * k), 22.5 * k + 11.25
        planes += [slanted(azimuth, half_slope(side_tip), rim + (girdle,)), slanted(azimuth, 90, rim + (0,)),
                   slanted(azimuth, 180 - half_slope(lower_tip), rim + (-girdle,))]
    return convex(planes)


def emerald():
    """Step cut on an octagon of 1.4 by 1: three steps above the girdle, three below."""
    planes = [((0, 0, 1), 0.3)]
    for azimuth, reach in ((0, 1.4), (90, 1), (45, 1.42), (180, 1.4), (270, 1), (135, 1.42), (225, 1.42), (315, 1.42)):
        planes.append(slanted(azimuth, 90, polar(reach, azimuth) + (0,)))
        for slope, inwards, z in ((50, 0, 0.03), (38, 0.1, 0.15), (28, 0.22, 0.245),
                                  (180 - 56, 0, -0.03), (180 - 48, 0.2, -0.33), (180 - 40, 0.45, -0.61)):
            planes.append(slanted(azimuth, slope, polar(reach - inwards, azimuth) + (z,)))
    return convex(planes)


def rounded_cube(half, radius, steps=6):
    """A cube with round edges and corners: grids on its faces, pulled onto the surface at `radius` from an inner
    cube."""
    core = half - radius
    ramp = [core + radius * math.tan(math.radians(45 * i / steps)) for i in range(steps + 1)]
    knots = [-x for x in reversed(ramp)] + ramp
    mesh = Mesh()
    for axis in range(3):
        for side in (-1, 1):
            rows = []
            for b in knots:
                row = []
                for a in knots[::side]:
                    p = (a, b, side * half)
                    p = p[-axis:] + p[:-axis]
                    inner = tuple(max(-core, min(core, x)) for x in p)
                    normal = unit(sub(p, inner))
                    row.append(mesh.vertex(add(inner, mul(normal, radius)), normal))
                rows.append(row)
            for lower, upper in zip(rows, rows[1:]):
                mesh.strip(lower, upper)
    return mesh


# Fur

def fur(count, radius, length):
    """Curves of a tuft of fur on a sphere: evenly spread roots (a Fibonacci spiral), each hair bent by a smooth
    field and by chance."""
    chance = random.Random(1)
    lines = []
    for i in range(count):
        y = 1 - (2 * i + 1) / count
        ring = math.sqrt(1 - y * y)
        turn = i * math.pi * (3 - math.sqrt(5))
        out = (ring * math.cos(turn), y, ring * math.sin(turn))
        swirl = cross(out, (math.sin(3 * out[1]), 1, math.cos(3 * out[0])))
        bend = add(mul(swirl, 0.35), tuple(chance.uniform(-0.25, 0.25) for _ in range(3)))
        bend = add(bend, (0, -0.25, 0))
        reach = length * chance.uniform(0.75, 1.15)
        points = [add(mul(out, radius + reach * t), mul(bend, reach * t * t)) for t in (0, 1 / 3, 2 / 3, 1)]
        text = "  ".join(" ".join(f"{x + 0.0:.3f}" for x in p) for p in points)
        lines.append(f'Shape "curve" "point3 P" [{text}] "float width0" [0.014] "float width1" [0.003]')
    return scene_text(lines)


# The things of the scenes

def flashlight():
    """Its body about z, shining along +z: the rim at z = 0.6, the reflector's apex at 0."""
    grip = []
    for i in range(9):
        z = -2.1 + 0.17 * i
        grip += [(0.30, z), (0.33, z + 0.02), (0.33, z + 0.1), (0.30, z + 0.12)]
    straight = [line(a, b) for a, b in zip(grip, grip[1:])]
    return lathe([line((0, -2.5), (0.28, -2.5)), arc((0.28, -2.42), 0.08, -90, 0, 6),
                  line((0.36, -2.42), (0.36, -2.2)), line((0.36, -2.2), (0.30, -2.2)),
                  line((0.30, -2.2), grip[0]), *straight, line(grip[-1], (0.30, -0.5)),
                  [(0.30, -0.5), (0.32, -0.42), (0.38, -0.3), (0.47, -0.12), (0.53, -0.02), (0.55, 0.05)],
                  line((0.55, 0.05), (0.55, 0.3)), line((0.55, 0.3), (0.6, 0.33)), line((0.6, 0.33), (0.6, 0.56)),
                  arc((0.56, 0.56), 0.04, 0, 90, 5), line((0.56, 0.6), (0.5, 0.6)), line((0.5, 0.6), (0.5, 0.5))], 48)


def reflector(focal=0.125, rim=0.5, steps=20):
    """A paraboloid about z with its focus at z = `focal`; its outside is the side of the focus."""
    rs = [rim - (rim - 0.06) * i / steps for i in range(steps + 1)]
    return lathe([[(r, r * r / (4 * focal)) for r in rs]], 48)


def cylinder(radius, low, high, segments=48):
    """A solid one."""
    return lathe([line((0, low), (radius, low)), line((radius, low), (radius, high)), line((radius, high), (0, high))],
                 segments)


def watch_case():
    """A pocket watch's, of radius 1, open above: a round back, a bezel, a floor at z = 0 for the dial."""
    back = [(0.97 * math.sin(math.radians(a)), -0.26 * math.cos(math.radians(a))) for a in range(0, 91, 6)]
    return lathe([back, line((0.97, 0), (0.96, 0.03)), arc((0.96, 0.09), 0.06, -90, 90, 10),
                  [(0.96, 0.15), (0.93, 0.148), (0.9, 0.13), (0.88, 0.1)], line((0.88, 0.1), (0.87, 0)),
                  line((0.87, 0), (0, 0))], 80)


def watch_glass(base=0.875, rise=0.2, thickness=0.03, low=0.07):
    """A shell between two spherical caps, its rim at z = `low`."""
    def cap(radius, height, steps=14):
        curvature = (radius * radius + height * height) / (2 * height)
        half = math.degrees(math.asin(radius / curvature))
        return arc((0, low + height - curvature), curvature, 90, 90 - half, steps)

    inner, outer = cap(base - thickness, rise - thickness), cap(base, rise)
    inner[0], outer[0] = (0, inner[0][1]), (0, outer[0][1])
    return lathe([inner, line(inner[-1], outer[-1]), outer[::-1]], 64)


def watch_hand():
    """A hand of length 1 along +x with a leaf at its end."""
    upper = [(-0.2, 0.035), (-0.04, 0.02), (0, 0.055), (0.04, 0.02), (0.5, 0.016), (0.62, 0.05), (0.72, 0.055),
             (0.8, 0.035), (1, 0.003)]
    return plate([(x, -y) for x, y in upper] + upper[::-1], 0.016, 0.003)


def basin():
    """A wash basin about z: rim at z = 0 with radius 0.5, bowl 0.3 deep, outside visible too."""
    outer = [(0.12 + 0.36 * math.sin(math.radians(a)), -0.36 * math.cos(math.radians(a)) - 0.02)
             for a in range(0, 91, 6)]
    inner = [(0.44 * math.sin(math.radians(a)), -0.3 * math.cos(math.radians(a)) - 0.02) for a in range(90, 3, -6)]
    return lathe([line((0, outer[0][1]), outer[0]), outer, arc((0.46, -0.02), 0.02, 0, 180, 8), inner,
                  line(inner[-1], (0, inner[-1][1]))], 72)


def tap():
    """A spout that rises along +z and bends over to +y."""
    return tube([(0, 0), (0, 0.28), *arc((0.12, 0.3), 0.12, 180, 20, 16), (0.242, 0.3)], 0.022)


def tumbler():
    """A drinking glass about z on z = 0: radius 1 at the brim, 2.6 high, with a thick floor."""
    return lathe([line((0, 0), (0.74, 0)), arc((0.74, 0.08), 0.08, -90, 0, 5), line((0.82, 0.08), (1, 2.56)),
                  arc((0.96, 2.56), 0.04, 0, 180, 8),
                  line((0.92, 2.56), (0.76, 0.42)), arc((0.66, 0.42), 0.1, 0, -90, 5),
                  line((0.66, 0.32), (0, 0.32))], 64)


def vase():
    """A vase of thick glass about z on z = 0, 2 high."""
    def radius(z):
        return 0.46 + 0.2 * math.sin(2.6 * z + 0.1) + 0.03 * z * z * z

    outside = [(radius(2 * i / 40), 2 * i / 40) for i in range(41)]
    inside = [(radius(0.25 + 1.75 * i / 36) - 0.08, 0.25 + 1.75 * i / 36) for i in range(36, -1, -1)]
    return lathe([line((0, 0), outside[0]), outside, line(outside[-1], inside[0]), inside,
                  line(inside[-1], (0, 0.25))], 56)


def fluted_globe(flutes=16, depth=0.03):
    """The outside of a glass globe of radius 1 with flutes along its meridians."""
    def position(u, v):
        r = 1 + depth * math.cos(flutes * u) * math.cos(v) ** 2
        return (r * math.cos(u) * math.cos(v), r * math.sin(u) * math.cos(v), r * math.sin(v))

    return surface(position, angles(8 * flutes), [math.radians(89.99 * (i / 12 - 1)) for i in range(25)])


def placed(transform, shape):
    return f"AttributeBegin {transform} Shape {shape} AttributeEnd"


def ply(name):
    return f'"plymesh" "string filename" "meshes/{name}.ply"'


def pips():
    """White drops just below the faces of a die of side 1: opposite faces sum to seven."""
    a = 0.26
    places = {1: [(0, 0)], 2: [(a, a), (-a, -a)], 3: [(a, -a), (0, 0), (-a, a)]}
    places[4] = places[2] + [(a, -a), (-a, a)]
    places[5] = places[4] + places[1]
    places[6] = places[4] + [(a, 0), (-a, 0)]
    faces = ((1, "0 1 0 0"), (6, "180 1 0 0"), (2, "90 1 0 0"), (5, "-90 1 0 0"), (3, "90 0 1 0"), (4, "-90 0 1 0"))
    lines = ['Material "diffuse" "rgb reflectance" [0.9 0.9 0.9]']
    lines += [placed(f"Rotate {turn} Translate {x} {y} 0.435 Scale 1 1 0.5", '"sphere" "float radius" [0.085]')
              for count, turn in faces for x, y in places[count]]
    return scene_text(lines)


def watch():
    """A watch about z of radius 1; its case, crown and bow are of the material that is in force."""
    lines = [f'Shape {ply("watch-case")}',
             placed("Translate 0 1.02 0.02 Rotate -90 1 0 0 Scale 0.12 0.12 1.4", ply("gear-small")),
             placed("Translate 0 1.42 0.02 Scale 0.3 0.3 0.15", ply("torus")),
             'Material "diffuse" "rgb reflectance" [0.85 0.83 0.78]',
             placed("Translate 0 0 0.004", '"disk" "float radius" [0.868]'),
             'Material "diffuse" "rgb reflectance" [0.02 0.02 0.03]']
    for minute in range(60):
        x, y = (0.022, 0.7) if minute % 5 == 0 else (0.006, 0.78)
        corners = f"{-x} {y} 0.006  {x} {y} 0.006  {-x} 0.83 0.006  {x} 0.83 0.006"
        lines.append(placed(f"Rotate {6 * minute} 0 0 1", f'"bilinearmesh" "point3 P" [{corners}]'))
    lines.append('Material "conductor" "rgb reflectance" [0.06 0.1 0.35] "float roughness" [0.05]')
    for z, turn, x, y in ((0.02, 150, 0.5, 1.3), (0.045, 32, 0.75, 1)):
        lines.append(placed(f"Translate 0 0 {z} Rotate {turn} 0 0 1 Scale {x} {y} 1", ply("watch-hand")))
    lines += ['Material "dielectric" "float eta" [1.5]', f'Shape {ply("watch-glass")}']
    return scene_text(lines)


def scene_text(lines, maker="make_meshes.py"):
    header = ("# SPDX-FileCopyrightText: 2026 The Lanthorn authors", "# SPDX-License-Identifier: Apache-2.0",
              f"# Made by {maker}.")
    return ("\n".join((*header, *lines)) + "\n").encode()


def files():
    """Name and content of every file."""
    (large, large_bore), (small, small_bore) = gear(36, 1, 0.3), gear(14, 0.42, 0.1)
    meshes = {
        "basin": basin(),
        "bolt": bolt(1, 0.3, 2),
        "brilliant": brilliant(),
        "die": rounded_cube(0.5, 0.09),
        "emerald": emerald(),
        "flashlight": flashlight(),
        "flashlight-pane": cylinder(0.5, 0.53, 0.56),
        "fluted-globe": fluted_globe(),
        "gear-large": plate(large, 0.12, 0.01, large_bore),
        "gear-small": plate(small, 0.16, 0.01, small_bore),
        "glass-cube": rounded_cube(0.5, 0.015, 4),
        "nut": nut(1, 0.3, 0.4),
        "reflector": reflector(),
        "spanner": plate(spanner(3.6, 0.5, 0.6), 0.16, 0.025),
        "tap": tap(),
        "torus": torus(0.5, 0.2),
        "tumbler": tumbler(),
        "vase": vase(),
        "watch-case": watch_case(),
        "watch-glass": watch_glass(),
        "watch-hand": watch_hand(),
    }
    scenes = {"fur": fur(1200, 0.5, 0.3), "pips": pips(), "watch": watch()}
    return ({f"{name}.ply": mesh.bytes() for name, mesh in meshes.items()}
            | {f"{name}.pbrt": text for name, text in scenes.items()})


def write_or_check(contents, maker, arguments):
    """Writes the files of a generator, or with --check compares them; those named .gz are packed. The exit code."""
    check = "--check" in arguments
    folders = [a for a in arguments if a != "--check"]
    folder = Path(folders[0]) if folders else Path(maker).resolve().parent / "meshes"
    differing = 0
    for name, content in contents.items():
        path = folder / name
        packed = path.suffix == ".gz"
        if not check:
            path.write_bytes(gzip.compress(content, mtime=0) if packed else content)
        # Of packed files the content: how it is packed depends on zlib.
        elif not path.is_file() or (gzip.decompress(path.read_bytes()) if packed else path.read_bytes()) != content:
            print(f"{path}: differs from what {maker} makes", file=sys.stderr)
            differing += 1
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(write_or_check(files(), __file__, sys.argv[1:]))
