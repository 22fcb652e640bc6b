#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the meshes of six more scenes of the gallery: a glass of water, a whisky on ice, a diamond ring, a church, a torch
with a stencil and a lens, an aquarium.

Usage: scenes/gallery/make_gallery_models.py [--check] [FOLDER]

Writes into FOLDER, by default meshes/ beside this script; with --check writes nothing and exits 1 if a file's content
differs (compressed bytes may differ, because they depend on zlib). z is up. It needs Python 3 alone.
"""
import math
import random
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path[:0] = [str(Path(__file__).resolve().parents[1]), str(Path(__file__).resolve().parents[1] / "lectures"),
                str(Path(__file__).resolve().parent)]
from make_gallery_meshes import filled, step  # noqa: E402
from make_meshes import (Mesh, add, arc, cross, dot, lathe, line, mul, placed, plate, rounded_cube, scene_text, sub, surface,  # noqa: E402
                         unit, write_or_check)
from make_models import boxes, grid, joined, spline  # noqa: E402


# A glass of water, in centimetres

def highball():
    """A tall glass with a heavy floor, filled with water."""
    foot = arc((2.55, 0.35), 0.35, -90, -5, 8)
    outside = spline([foot[-1], (3.05, 3), (3.3, 7.5), (3.5, 13.4)], 8)
    inside = spline([(3.34, 13.4), (3.14, 7.5), (2.87, 3.2), (2.7, 2.3), (2.2, 1.75), (1.2, 1.6), (0, 1.55)], 8)
    return filled([line((0, 0), (2.55, 0)), foot, outside], inside, 9.6, 0.12, arc((3.42, 13.4), 0.08, 0, 180, 8), 112)


def cloth(columns=90, rows=75):
    """A table cloth of 150 by 125 with the creases of its folds and some unrest."""
    width, depth = 150.0, 125.0

    def crease(t, at):
        return 0.16 * math.exp(-abs(t - at) / 1.6)

    def height(i, j):
        x, y = width * (i / columns - 0.5), depth * (j / rows - 0.5)
        unrest = math.sin(0.061 * x + 0.02 * y + 1) * math.sin(0.047 * y - 0.013 * x) + 0.5 * math.sin(0.13 * x - 0.09 * y + 2)
        return 0.12 * unrest - 0.2 + crease(x, -13.3) + crease(x, 36.7) + crease(y, 20.8) - crease(y, -24.2)

    return grid(height, columns, rows, (-width / 2, width / 2), (-depth / 2, depth / 2))


def leaves(count, seed, middle, size, length):
    """Leaves in a box: diamonds that point anywhere."""
    chance = random.Random(seed)
    mesh = Mesh()
    for _ in range(count):
        at = tuple(m + s * chance.uniform(-0.5, 0.5) for m, s in zip(middle, size))
        along = unit(tuple(chance.gauss(0, 1) for _ in range(3)))
        across = unit(cross(along, tuple(chance.gauss(0, 1) for _ in range(3))))
        reach = length * chance.uniform(0.6, 1.2)
        mesh.polygon([add(at, mul(along, -reach)), add(at, mul(across, -0.4 * reach)), add(at, mul(along, reach)),
                      add(at, mul(across, 0.4 * reach))], cross(along, across))
    return mesh


def bowl():
    """A bowl of china."""
    outer = spline([(4.2, 0.9), (7.2, 2.6), (9.6, 5.4), (10.4, 7.6)], 6)
    inner = spline([(10.1, 7.6), (9.2, 5.5), (6.8, 2.9), (3.5, 1.5), (0, 1.3)], 6)
    return lathe([line((0, 0), (3.9, 0)), arc((3.9, 0.3), 0.3, -90, 0, 5), line((4.2, 0.3), (4.2, 0.9)), outer,
                  arc((10.25, 7.6), 0.15, 0, 180, 6), inner], 72)


# A whisky on ice, in centimetres

LEVEL = 4.55  # of the whisky
# Middle, turn about z, axis and angle of the tilt
ICE = (((-1.56, 0.35, 3.42), 24, (1, 0.3, 0), 5), ((1.58, -0.25, 3.42), -13, (0.2, 1, 0), 6),
       ((1.2, 1.2, 6.4), 48, (1, 0.4, 0), 13), ((-1.45, -1.05, 6.3), 8, (0.3, 1, 0), 9))


def flat_sided(facets, apothem, window, heights, around, sharpness=110):
    """A wall about z with flat sides whose edges are rounded; it is round where `window` (of the height) is 0."""
    def position(u, v):
        distances = (math.cos(u - math.tau * k / facets) for k in range(facets))
        flat = sum((c / apothem(v)) ** sharpness for c in distances if c > 0.5) ** (-1 / sharpness)
        r = flat + (1 - window(v)) * (apothem(v) * 1.05 - flat)
        return (r * math.cos(u), r * math.sin(u), v)

    steps = facets * around
    return surface(position, [math.tau * i / steps for i in range(steps + 1)], heights)


def thick_tumbler():
    """With a heavy floor and nine flat sides that end below the brim."""
    facets, around = 9, 16
    heights = [0.35, 0.5, 0.7, 0.9, 1.1, 1.4, 2, 3.5, 5, *(5.6 + 0.2 * i for i in range(10)), 8, 8.8]

    def apothem(z):
        return 3.95 + 0.045 * z

    wall = flat_sided(facets, apothem, lambda z: step((z - 0.45) / 0.7) * step((7.5 - z) / 1.6), heights, around)
    r = apothem(0.35) * 1.05
    inside = spline([(apothem(8.8) * 1.05 - 0.4, 8.8), (3.98, 6), (3.8, 3.2), (3.55, 2.45), (2.9, 2.1), (1.5, 2), (0, 2)], 8)
    return filled([line((0, 0), (r - 0.35, 0)), arc((r - 0.35, 0.35), 0.35, -90, 0, 8)], inside, LEVEL, 0.1,
                  arc((apothem(8.8) * 1.05 - 0.2, 8.8), 0.2, 0, 180, 8), facets * around, wall)


def turned(v, axis, degrees):
    """A vector about an axis (Rodrigues 1840)."""
    axis = unit(axis)
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return add(add(mul(v, c), mul(cross(axis, v), s)), mul(axis, dot(axis, v) * (1 - c)))


def melted_cube(half, power=6.5, cells=14):
    """A superellipsoid: a cube whose edges have melted."""
    mesh = rounded_cube(1, 0.5, cells // 2)
    vertices = []
    for p, _ in mesh.vertices:
        q = mul(p, half / sum(abs(x) ** power for x in p) ** (1 / power))
        vertices.append((q, unit(tuple(math.copysign(abs(x) ** (power - 1), x) for x in q))))
    mesh.vertices = vertices
    return mesh


def ice_cube(middle, turn, axis, tilt):
    mesh = melted_cube(1.32)
    mesh.vertices = [tuple(turned(turned(v, (0, 0, 1), turn), axis, tilt) for v in pair) for pair in mesh.vertices]
    mesh.vertices = [(add(p, middle), n) for p, n in mesh.vertices]
    return mesh


def cut_at(mesh, level):
    """A mesh in two at height z = level, below and above, and the convex outline of the cut, counter-clockwise."""
    parts, outline = (Mesh(), Mesh()), []

    def cross_point(a, b):
        t = (level - a[0][2]) / (b[0][2] - a[0][2])
        p, n = (add(x, mul(sub(y, x), t)) for x, y in zip(a, b))
        outline.append(p[:2])
        return (p[:2] + (level,), unit(n))

    for triangle in mesh.triangles:
        corners = [mesh.vertices[k] for k in triangle]
        for part, side in zip(parts, (-1, 1)):
            kept = []
            for a, b in zip(corners[-1:] + corners[:-1], corners):
                if (side * (a[0][2] - level) > 0) != (side * (b[0][2] - level) > 0):
                    kept.append(cross_point(a, b))
                if side * (b[0][2] - level) > 0:
                    kept.append(b)
            if len(kept) > 2:
                corner = [part.vertex(*v) for v in kept]
                part.triangles += [(corner[0], b, c) for b, c in zip(corner[1:], corner[2:])]
    return (*parts, hull(outline))


def left_of(a, b, p):
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def hull(points):
    """The convex hull in the plane (Andrew 1979)."""
    chains = []
    for ordered in (sorted(set(points)), sorted(set(points), reverse=True)):
        chain = []
        for p in ordered:
            while len(chain) > 1 and left_of(chain[-2], chain[-1], p) <= 1e-9:
                chain.pop()
            chain.append(p)
        chains += chain[:-1]
    return chains


def without(piece, hole):
    """What is left of a convex polygon outside a convex, counter-clockwise hole: convex polygons."""
    left, whole = [], piece
    for a, b in zip(hole, hole[1:] + hole[:1]):
        outside, inside = [], []
        for p, q in zip(piece[-1:] + piece[:-1], piece):
            side_p, side_q = left_of(a, b, p), left_of(a, b, q)
            if (side_p > 0) != (side_q > 0):
                at = add(p, mul(sub(q, p), side_p / (side_p - side_q)))
                outside.append(at)
                inside.append(at)
            (inside if side_q > 0 else outside).append(q)
        if len(outside) > 2:
            left.append(outside)
        piece = inside
        if len(piece) < 3:
            return [whole]
    return left


def pierced_surface(mesh, holes):
    """A liquid's surface, open where the ice stands in it."""
    result = Mesh()
    result.vertices = list(mesh.vertices)
    for triangle in mesh.triangles:
        corner = [mesh.vertices[k][0] for k in triangle]
        pieces = [corner]
        for hole in holes:
            pieces = [rest for piece in pieces for rest in without(piece, [p + (LEVEL,) for p in hole])]
        if pieces == [corner]:
            result.triangles.append(triangle)
        else:
            for piece in pieces:
                result.polygon(piece, (0, 0, 1))
    return result


def whisky():
    """Glass, whisky and ice; the ice in the whisky and above it."""
    glass, wet, top = thick_tumbler()
    below, above, holes = Mesh(), Mesh(), []
    for place in ICE:
        low, high, outline = cut_at(ice_cube(*place), LEVEL)
        joined(below, low)
        joined(above, high)
        holes += [outline] if outline else []
    return {"whisky-glass": glass, "whisky-liquid-in-glass": wet, "whisky-liquid-top": pierced_surface(top, holes),
            "whisky-ice-below": below, "whisky-ice-above": above}


def bubbles():
    """Balls of air in the ice, most of them near its middle."""
    chance = random.Random(8)
    lines = []
    for middle, turn, axis, tilt in ICE:
        for _ in range(26):
            at = turned(tuple(chance.gauss(0, 0.33) for _ in range(3)), (0, 0, 1), turn)
            if max(map(abs, at)) < 0.95:
                x, y, z = add(middle, turned(at, axis, tilt))
                radius = 0.02 + 0.07 * chance.random() ** 3
                lines.append(placed(f"Translate {x:.3f} {y:.3f} {z:.3f}", f'"sphere" "float radius" [{radius:.3f}]'))
    return scene_text(lines, "make_gallery_models.py")


# A church, in metres

def sweep(path, radius, sides=10, normal=(0, 0, 1)):
    """A round tube along a path in space; `radius` is a number or a function of the point's index."""
    mesh = Mesh()
    rows = []
    for i, p in enumerate(path):
        along = unit(sub(path[min(i + 1, len(path) - 1)], path[max(i - 1, 0)]))
        normal = unit(sub(normal, mul(along, dot(normal, along))))
        other = cross(along, normal)
        r = radius(i) if callable(radius) else radius
        turns = (math.tau * (k % sides) / sides for k in range(sides + 1))
        spokes = [add(mul(normal, math.cos(a)), mul(other, math.sin(a))) for a in turns]
        rows.append([mesh.vertex(add(p, mul(s, r)), s) for s in spokes])
    for lower, upper in zip(rows, rows[1:]):
        mesh.strip(lower, upper)
    return mesh


def pointed(half, steps=16):
    """A pointed arch of two arcs over a span of 2 half, from the left springing (x, z) = (-half, 0) over the apex."""
    turns = [60 * i / steps for i in range(steps + 1)]
    left = [(half - 2 * half * math.cos(math.radians(a)), 2 * half * math.sin(math.radians(a))) for a in turns]
    return left + [(-x, z) for x, z in left[-2::-1]]


def faces(mesh, inner, outer, depth):
    """Both faces of a wall, y = -depth/2 and depth/2, between two rows of points (x, z) that run clockwise as seen from
    y < 0."""
    for side in (-1, 1):
        rows = [[mesh.vertex((x, side * depth / 2, z), (0, side, 0)) for x, z in row] for row in (inner, outer)]
        mesh.strip(*(row[::-side] for row in rows))


def reveal(mesh, loop, depth):
    """The inside of an opening, along points (x, z) that run clockwise as seen from y < 0."""
    for (ax, az), (bx, bz) in zip(loop, loop[1:]):
        dx, dz = unit((bx - ax, bz - az))
        mesh.polygon([(ax, depth / 2, az), (bx, depth / 2, bz), (bx, -depth / 2, bz), (ax, -depth / 2, az)], (dz, 0, -dx))


def roll_along(mesh, loop, depth, offset, radius):
    """A moulding on both faces of a wall, beside an opening: each point moves outwards by `offset`."""
    moved = []
    for i, (x, z) in enumerate(loop):
        a, b = loop[max(i - 1, 0)], loop[min(i + 1, len(loop) - 1)]
        dx, dz = unit((b[0] - a[0], b[1] - a[1]))
        moved.append((x - dz * offset, z + dx * offset))
    for y in (-depth / 2, depth / 2):
        joined(mesh, sweep([(x, y, z) for x, z in moved], radius, 10, (0, 1, 0)))


def arcade_panel(width, height, half, depth):
    """Masonry over a pointed arch, from its springing z = 0 up."""
    mesh, arch = Mesh(), pointed(half)
    outer = [(-width / 2, height), *((x, height) for x, _ in arch[1:-1]), (width / 2, height)]
    faces(mesh, [(-width / 2, 0), *arch, (width / 2, 0)], [outer[0], *outer, outer[-1]], depth)
    reveal(mesh, arch, depth)
    for offset, radius in ((0.02, 0.09), (0.24, 0.07), (0.42, 0.05)):
        roll_along(mesh, arch, depth, offset, radius)
    return mesh


def window_panel(width, height, half, sill, springing, depth):
    """A wall with a pointed window."""
    mesh = Mesh()
    loop = [(-half, sill), *((-half, sill + (springing - sill) * i / 8) for i in range(1, 8)),
            *((x, z + springing) for x, z in pointed(half)),
            *((half, springing - (springing - sill) * i / 8) for i in range(1, 9)), *((half - half * i / 4, sill) for i in range(1, 9))]
    middle = (0, (sill + springing) / 2)
    outer = []
    for x, z in loop:
        dx, dz = x - middle[0], z - middle[1]
        reach = min(s for s in ((width / 2 / abs(dx)) if dx else 1e9, ((height - middle[1]) / dz) if dz > 0 else 1e9,
                                (middle[1] / -dz) if dz < 0 else 1e9))
        outer.append((dx * reach, middle[1] + dz * reach))
    for corner in ((-width / 2, 0), (-width / 2, height), (width / 2, height), (width / 2, 0)):
        nearest = min(range(len(outer) - 1), key=lambda k: math.dist(outer[k], corner))
        outer[nearest] = corner
        if nearest == 0:
            outer[-1] = corner
    faces(mesh, loop, outer, depth)
    reveal(mesh, loop, depth)
    roll_along(mesh, loop[:-9], depth, 0.06, 0.07)
    # A mullion and the tracery of two lancets and a ring
    arch = pointed(half / 2)
    z = springing - 0.25 * half
    joined(mesh, sweep([(0, 0, sill), (0, 0, z)], 0.07, 10, (0, 1, 0)))
    for x in (-half / 2, half / 2):
        joined(mesh, sweep([(x + px, 0, z + pz) for px, pz in arch], 0.055, 10, (0, 1, 0)))
    ring = [(0.36 * half * math.sin(a), 0, springing + 0.93 * half + 0.36 * half * math.cos(a)) for a in (math.tau * i / 32 for i in range(33))]
    return joined(mesh, sweep(ring, 0.055, 10, (0, 1, 0)))


def pier(height, radius):
    """A pier of eight shafts, with base and capital."""
    def position(u, v):
        t = v / height
        lobes = 1 + 0.16 * abs(math.cos(4 * u)) ** 0.8
        swell = 0.45 * step((0.09 - t) / 0.03) + 0.18 * step((0.14 - t) / 0.02) + 0.5 * step((t - 0.9) / 0.09) + 0.12 * math.exp(-((t - 0.89) / 0.008) ** 2)
        r = radius * (lobes + swell)
        return (r * math.cos(u), r * math.sin(u), v)

    heights = [0, 0.06, 0.065, 0.075, 0.085, 0.095, 0.115, 0.125, 0.135, 0.15, 0.5, 0.86, 0.875, 0.882, 0.888, 0.894, 0.9, 0.91,
               0.93, 0.95, 0.97, 0.99]
    mesh = surface(position, [math.tau * i / 64 for i in range(65)], [height * t for t in heights])
    r = 1.62 * radius
    return lathe([line((0, 0), (r + 0.1, 0)), line((r + 0.1, 0), (r + 0.1, 0.18)), line((r + 0.1, 0.18), (0, 0.2)),
                  line((0, 0.985 * height), (r, 0.985 * height)), line((r, 0.985 * height), (r + 0.04, height - 0.02)),
                  line((r + 0.04, height), (0, height))], 8, mesh)


def rise(t):
    """The height of a pointed arch at a share of its half span; 1 in its middle."""
    return math.sqrt(max(0.0, 4 - (1 + abs(t)) ** 2) / 3)


def rib_vault(width, length, height, rib, steps=14):
    """A bay of a quadripartite vault about z, seen from below: four webs, ribs below their edges."""
    mesh = Mesh()
    for axis in (0, 1):
        for side in (-1, 1):
            rows = []
            for i in range(steps + 1):
                t = i / steps
                row = []
                for j in range(-steps, steps + 1):
                    # A web reaches from the middle to one side; across it the arch of the other direction.
                    s = t * j / steps
                    x, y = ((side * t, s), (s, side * t))[axis]
                    z = height * rise(s)
                    slope = -height * (1 + abs(s)) / (3 * max(0.15, rise(s))) * math.copysign(1, s) if s else 0
                    n = (0, slope / (length / 2), -1) if axis == 0 else (slope / (width / 2), 0, -1)
                    row.append(mesh.vertex((x * width / 2, y * length / 2, z), unit(n)))
                rows.append(row)
            for lower, upper in zip(rows, rows[1:]):
                mesh.strip(*((lower, upper) if (side > 0) == (axis == 0) else (upper, lower)))
    ts = [i / 20 - 1 for i in range(41)]
    for k in (-1, 1):
        joined(mesh, sweep([(t * width / 2, k * t * length / 2, height * rise(t) - 0.02) for t in ts], rib))
        joined(mesh, sweep([(k * width / 2, t * length / 2, height * rise(t) - 0.02) for t in ts], 0.8 * rib))
    joined(mesh, sweep([(t * width / 2, -length / 2, height * rise(t) - 0.04) for t in ts], 1.5 * rib))
    return lathe([[(0.28 * math.sin(math.radians(a)), height - 0.1 - 0.14 * math.cos(math.radians(a))) for a in range(0, 91, 15)]], 24, mesh)


def wall_shaft(height):
    """Three shafts on a wall, at x = 0, with a capital: from z = 0 up."""
    mesh = Mesh()
    for y, x, r in ((0, -0.16, 0.12), (-0.19, -0.05, 0.09), (0.19, -0.05, 0.09)):
        joined(mesh, sweep([(x, y, 0), (x, y, height)], r, 16, (1, 0, 0)))
    return lathe([spline([(0.24, height - 0.5), (0.27, height - 0.3), (0.42, height - 0.06)], 5), line((0.42, height - 0.06), (0.42, height)),
                  line((0.42, height), (0, height))], 24, mesh)


def pew(length):
    """A bench along x about the origin, its back towards -y, with carved ends."""
    outline = [(-0.36, 0), (0.32, 0), (0.32, 0.08), (0.26, 0.13), (0.24, 0.3), (0.27, 0.42), (0.24, 0.5), (0.14, 0.53), (-0.1, 0.56), (-0.2, 0.62),
               (-0.24, 0.75), (-0.25, 0.92), (-0.22, 1.0), (-0.25, 1.08), (-0.31, 1.1), (-0.37, 1.07), (-0.39, 1.0), (-0.36, 0.9), (-0.32, 0.5), (-0.32, 0.13),
               (-0.36, 0.08)]
    end = plate(outline, 0.07, 0.012)
    mesh = Mesh()
    for x in (-length / 2, length / 2 - 0.07):
        first = len(mesh.vertices)
        mesh.vertices += [((p[2] + x, p[0], p[1]), (n[2], n[0], n[1])) for p, n in end.vertices]
        mesh.triangles += [tuple(first + k for k in t) for t in end.triangles]
    x = length / 2 - 0.07
    return boxes((-x, -0.27, 0.43, x, 0.22, 0.47), (-x, -0.31, 0.1, x, -0.28, 0.98), (-x, -0.33, 0.96, x, -0.25, 1.02),
                 (-x, 0.05, 0.1, x, 0.08, 0.43), (-x, -0.5, 0.78, x, -0.3, 0.8), mesh=mesh)


BAY, WIDTH, AISLE, BAYS = 5.0, 9.0, 4.2, 7


def church_placements():
    lines = []

    def put(name, x, y, z, turn=0):
        at = f"Translate {x:g} {y:g} {z:g}" + (f" Rotate {turn} 0 0 1" if turn else "")
        lines.append(f'AttributeBegin {at} ObjectInstance "{name}" AttributeEnd')

    for i in range(BAYS):
        y = BAY * (i + 0.5)
        put("vault", 0, y, 11)
        for side in (-1, 1):
            x = side * WIDTH / 2
            put("pier", x, BAY * i, 0)
            put("arcade", x, y, 5, 90)
            put("clerestory", x, y, 9.4, 90)
            put("shaft", x - side * 0.42, BAY * i, 5, 180 if side < 0 else 0)
            put("aisle vault", x + side * AISLE / 2, y, 4.8)
            put("aisle wall", x + side * AISLE, y, 0, 90)
    for i in range(11):
        for side in (-1, 1):
            put("pew", side * 2.35, 5.2 + 1.35 * i, 0)
    return scene_text(lines, "make_gallery_models.py")


def church():
    return {"church-vault": rib_vault(WIDTH, BAY, 5.4, 0.13), "church-aisle-vault": rib_vault(AISLE, BAY, 3.4, 0.1, 10),
            "church-pier": pier(5, 0.52), "church-arcade": arcade_panel(BAY, 4.42, 1.8, 0.9),
            "church-clerestory": window_panel(BAY, 7.4, 1.0, 0.9, 3.4, 0.5), "church-aisle-wall": window_panel(BAY, 8.6, 0.85, 1.9, 4.6, 0.7),
            "church-shaft": wall_shaft(6), "church-pew": pew(3.5), "church-east": window_panel(3.0, 17, 0.95, 4.2, 8.6, 0.8),
            "church-east-middle": window_panel(3.0, 17, 1.05, 4.2, 10.4, 0.8)}


# A diamond ring, in millimetres: the ring about z; the stone about z, its girdle of radius 3.6 at z = 0

def closed_ring(radius, thickness, z, mesh=None):
    return lathe([arc((radius, z), thickness, -180, 180, 14)], 72, mesh)


def band(inner=8.6, outer=10.2, half=1.15):
    """Domed outside, slightly domed inside, with round edges."""
    outside = [(outer - 0.55 * (1 - math.cos(math.radians(a))), half * math.sin(math.radians(a))) for a in range(-80, 81, 8)]
    inside = [(inner + 0.12 * (z / 0.85) ** 2, z) for z in (0.85 - 0.17 * i for i in range(11))]
    edge = spline([outside[-1], (9.2, 1.17), (8.85, 1.05), inside[0]], 5)
    return lathe([outside, edge, inside, [(r, -z) for r, z in reversed(edge)]], 160)


def head(prongs=6):
    """The setting: six prongs that clasp the stone, two rings that hold them."""
    mesh = closed_ring(2.72, 0.26, -1.75)
    closed_ring(1.75, 0.34, -3.35, mesh)
    path = spline([(1.65, -3.75), (2.05, -2.9), (2.75, -1.75), (3.5, -0.5), (3.78, 0.1), (3.68, 0.55), (3.28, 0.8)], 6)
    path += [add(path[-1], mul(unit(sub(path[-1], path[-2])), d)) for d in (0.12, 0.2, 0.26, 0.29, 0.3)]
    radii = [0.33] * (len(path) - 5) + [0.31, 0.25, 0.165, 0.08, 0.0]
    prong = sweep([(r, 0, z) for r, z in path], lambda i: radii[i], 16, (0, 1, 0))
    for k in range(prongs):
        joined(mesh, prong, 360 * (k + 0.5) / prongs)
    return mesh


def small_stones():
    """Stones along the shoulders of the ring, whose head is towards -y, and the beads that hold them."""
    stones, beads = [], []
    for side in (-1, 1):
        for i in range(8):
            turn = 270 + side * (24.5 + 9.2 * i)
            stones.append(placed(f"Rotate {turn:g} 0 0 1 Translate 10.13 0 0 Rotate 90 0 1 0 Scale 0.76 0.76 0.76",
                                 '"plymesh" "string filename" "../meshes/brilliant.ply"'))
            for z in (-0.62, 0.62):
                beads.append(placed(f"Rotate {turn + side * 4.6:g} 0 0 1 Translate 10.07 0 {z}", '"sphere" "float radius" [0.2]'))
    return {"small-stones.pbrt": scene_text(stones, "make_gallery_models.py"),
            "beads.pbrt": scene_text(beads, "make_gallery_models.py")}


# An aquarium, in centimetres: 60 by 30 inside, its water 32 deep

HALF_X, HALF_Y, WATER, BRIM, PANE = 30.0, 15.0, 32.0, 36.0, 0.6


def tank():
    """The panes to the air, and to the water; there is no floor under the sand."""
    outside, wet = Mesh(), Mesh()
    x, y = HALF_X + PANE, HALF_Y + PANE
    outer = [(-x, -y), (x, -y), (x, y), (-x, y)]
    inner = [(-HALF_X, -HALF_Y), (HALF_X, -HALF_Y), (HALF_X, HALF_Y), (-HALF_X, HALF_Y)]
    for k in range(4):
        (ax, ay), (bx, by) = outer[k], outer[(k + 1) % 4]
        n = unit((by - ay, ax - bx, 0))
        outside.polygon([(ax, ay, 0), (bx, by, 0), (bx, by, BRIM), (ax, ay, BRIM)], n)
        (cx, cy), (dx, dy) = inner[k], inner[(k + 1) % 4]
        outside.polygon([(ax, ay, BRIM), (bx, by, BRIM), (dx, dy, BRIM), (cx, cy, BRIM)], (0, 0, 1))
        outside.polygon([(dx, dy, WATER), (cx, cy, WATER), (cx, cy, BRIM), (dx, dy, BRIM)], mul(n, -1))
        wet.polygon([(dx, dy, 0), (cx, cy, 0), (cx, cy, WATER), (dx, dy, WATER)], mul(n, -1))
    return outside, wet


def frame_of_tank():
    """Bars along the upper and the lower edges."""
    x, y, t = HALF_X + PANE, HALF_Y + PANE, 0.35
    bars = []
    for low, high in ((0, 1.6), (BRIM - 1.6, BRIM + 0.4)):
        bars += [(-x - t, -y - t, low, x + t, -y - 0.001, high), (-x - t, y + 0.001, low, x + t, y + t, high),
                 (-x - t, -y - t, low, -x - 0.001, y + t, high), (x + 0.001, -y - t, low, x + t, y + t, high)]
    return boxes(*bars)


def ripples(columns=120, rows=60):
    waves = ((0.62, 0.21, 0.11, 0.4), (-0.35, 0.7, 0.1, 1.9), (0.9, -0.55, 0.055, 0.8), (0.25, 1.25, 0.04, 2.6),
             (-1.3, 0.6, 0.03, 4.0), (1.6, 1.2, 0.017, 5.1), (-0.7, -0.24, 0.07, 3.3))

    def height(i, j):
        x, y = HALF_X * (2 * i / columns - 1), HALF_Y * (2 * j / rows - 1)
        still = step((HALF_X - abs(x)) / 0.8) * step((HALF_Y - abs(y)) / 0.8)
        return WATER + still * sum(a * math.sin(kx * x + ky * y + phase) for kx, ky, a, phase in waves)

    return grid(height, columns, rows, (-HALF_X, HALF_X), (-HALF_Y, HALF_Y))


def sand(columns=110, rows=60):
    x, y = HALF_X + 0.2, HALF_Y + 0.2

    def height(i, j):
        u, v = x * (2 * i / columns - 1), y * (2 * j / rows - 1)
        ridges = 0.22 * math.sin(0.95 * v + 0.35 * u + 1.4 * math.sin(0.17 * u) + 0.5 * math.sin(0.4 * v))
        dunes = 0.7 * math.sin(0.11 * u + 0.6) * math.sin(0.1 * v + 0.3)
        return 3.4 + 0.085 * (v + y) + dunes + ridges * (0.4 + 0.6 * math.sin(0.09 * u + 1) ** 2)

    mesh = grid(height, columns, rows, (-x, x), (-y, y))
    # What the panes show of it from the side
    size = columns + 1
    edges = (([i for i in range(size)], (0, -1, 0)), ([columns + size * j for j in range(rows + 1)], (1, 0, 0)),
             ([size * j for j in range(rows, -1, -1)], (-1, 0, 0)))
    for edge, normal in edges:
        upper = [mesh.vertex(mesh.vertices[k][0], normal) for k in edge]
        lower = [mesh.vertex(mesh.vertices[k][0][:2] + (0.0,), normal) for k in edge]
        mesh.strip(lower, upper)
    return mesh


def stone(seed, flat=0.7):
    """A stone of radius 1: a ball with dents and planes."""
    chance = random.Random(seed)

    def direction():
        return unit(tuple(chance.gauss(0, 1) for _ in range(3)))

    bumps = [(direction(), chance.uniform(1.5, 5), chance.uniform(-0.13, 0.1)) for _ in range(26)]
    planes = [(direction(), chance.uniform(0.72, 0.95)) for _ in range(9)]

    def position(u, v):
        d = (math.cos(u) * math.cos(v), math.sin(u) * math.cos(v), math.sin(v))
        r = 1 + sum(a * math.exp(k * 2 * (dot(d, b) - 1)) for b, k, a in bumps)
        r = sum(max(0.05, c / max(0.05, dot(d, n)) if dot(d, n) > 0 else 9) ** -14 for n, c in planes) + r ** -14
        rough = 0.012 * math.sin(9 * d[0] + 3 * d[1]) * math.sin(8 * d[1] - 5 * d[2])
        r = r ** (-1 / 14) + rough + 0.006 * math.sin(23 * d[2] + 11 * d[0])
        return (r * d[0], r * d[1], flat * r * d[2])

    return surface(position, [math.tau * i / 44 for i in range(45)], [math.radians(89.9 * (i / 15 - 1)) for i in range(31)])


def blade(height, width, lean, turn, twist, steps=14):
    """A leaf of a water plant that grows from the origin, waving."""
    def position(s, t):
        sway = lean * t ** 1.6 + 0.05 * height * math.sin(3.2 * t + turn)
        z = height * t - 0.12 * lean * t ** 3
        w = width * (1 - t ** 3) * (0.55 + 0.45 * math.sin(math.pi * min(1, 0.25 + t)))
        a = turn + twist * t
        return (sway * math.cos(turn) - s * w * math.sin(a), sway * math.sin(turn) + s * w * math.cos(a), z - 0.25 * w * s * s)

    return surface(position, [-1, -0.5, 0, 0.5, 1], [0.001 + 0.984 * i / steps for i in range(steps + 1)])


def grass(count, seed, height, width, spread):
    chance, mesh = random.Random(seed), Mesh()
    for _ in range(count):
        tall = height * chance.uniform(0.6, 1.1)
        at = (spread * chance.gauss(0, 0.5), spread * chance.gauss(0, 0.5), 0)
        leaf = blade(tall, width * chance.uniform(0.7, 1.2), tall * chance.uniform(0.08, 0.4), chance.uniform(0, math.tau),
                     chance.uniform(-1.5, 1.5))
        joined(mesh, leaf, 0, 1, at)
    return mesh


def bush(stems, seed, height, leaf):
    """Stems with crossed pairs of leaves."""
    chance, mesh = random.Random(seed), Mesh()
    for _ in range(stems):
        tall, direction = height * chance.uniform(0.65, 1.1), chance.uniform(0, math.tau)
        lean = tall * chance.uniform(0.05, 0.3)
        at = (chance.gauss(0, 1.3), chance.gauss(0, 1.0), 0)

        def along(t):
            return (at[0] + lean * t * t * math.cos(direction), at[1] + lean * t * t * math.sin(direction), tall * t)

        joined(mesh, sweep([along(i / 10) for i in range(11)], 0.1, 6, (1, 0, 0)))
        pairs = int(tall / (0.55 * leaf))
        for i in range(1, pairs + 1):
            t = i / pairs
            for k in range(2):
                turn = direction + 90 * i + 180 * k + chance.uniform(-25, 25)
                size = leaf * (0.55 + 0.45 * math.sin(math.pi * min(0.93, t + 0.15))) * chance.uniform(0.85, 1.15)
                droop = chance.uniform(0.1, 0.5) - 0.5 * t

                def position(s, r):
                    w = 0.3 * size * math.sin(math.pi * r ** 0.8) * s
                    return (size * r, w, size * (0.35 * r - droop * r * r) + 0.35 * abs(w))

                joined(mesh, surface(position, [-1, -0.5, 0, 0.5, 1], [0.02 + 0.16 * j for j in range(7)]), turn, 1, along(t))
    return mesh


def fish(length, tall, wide, seed=1):
    """A fish along x, its head towards +x: the back, the belly, the fins, the eyes."""
    outline = spline([(0, 0.02), (0.04, 0.2), (0.12, 0.42), (0.28, 0.78), (0.45, 1.0), (0.6, 0.92), (0.78, 0.52),
                      (0.9, 0.24), (1.0, 0.2)], 4)

    def section(t):
        x = min(0.999, max(0, t))
        i = next(k for k in range(len(outline) - 1) if outline[k + 1][0] >= x)
        (a, ra), (b, rb) = outline[i], outline[i + 1]
        return ra + (rb - ra) * (x - a) / (b - a)

    def bend(x):
        return 0.05 * length * math.sin(2.2 * (0.5 - x / length) + 0.4 * seed) - 0.02 * length

    def side(first, last):
        def position(a, t):
            r = section(t)
            x = length * (0.5 - t)
            y = 0.5 * wide * math.cos(a) * (r ** 0.85) * (1 - 0.75 * step((t - 0.45) / 0.55))
            z = 0.5 * tall * r * math.sin(a) * (0.95 if math.sin(a) > 0 else 1.05)
            return (x, y + bend(x), z)

        turns = [math.radians(last + (first - last) * i / 14) for i in range(15)]
        return surface(position, turns, [0.001 + 0.998 * i / 36 for i in range(37)])

    def fin(x0, x1, reach, sweep_back, z_sign, base):
        def position(s, t):
            x = x0 + (x1 - x0) * s
            crest = reach * math.sin(math.pi * min(0.99, 0.12 + 0.86 * s)) ** 0.6 * (1 - 0.4 * s)
            z = z_sign * (0.5 * tall * section(0.5 - x / length) * base + t * crest)
            return (x - sweep_back * t * (0.4 + 0.6 * s), bend(x) + 0.03 * reach * math.sin(14 * s) * t, z)

        return surface(position, [0.001 + 0.998 * i / 14 for i in range(15)], [0.001 + i / 6 for i in range(7)])

    def tail(sign):
        def position(s, t):
            spread = 0.16 * tall * (1 - t) + t * tall * 0.55 * (0.12 + 0.95 * s)
            x = -0.46 * length - t * length * 0.36 * (0.55 + 0.55 * s)
            return (x, bend(x) + 0.035 * length * t * math.sin(7 * s + 1.5 * t), sign * spread)

        return surface(position, [0.001 + i / 10 for i in range(11)], [0.001 + i / 8 for i in range(9)])

    def pectoral(sign):
        def position(s, t):
            return (length * (0.2 - 0.15 * t - 0.03 * s), sign * (0.42 * wide + 0.2 * wide * t) + bend(0.2 * length),
                    tall * (-0.16 - 0.2 * t * (s - 0.3)))

        return surface(position, [i / 8 for i in range(9)], [i / 6 for i in range(7)])

    fins = fin(0.16 * length, -0.36 * length, 0.3 * tall, 0.1 * length, 1, 0.9)
    joined(fins, fin(-0.05 * length, -0.38 * length, 0.24 * tall, 0.1 * length, -1, 0.9))
    for sign in (-1, 1):
        joined(fins, tail(sign))
        joined(fins, pectoral(sign))
    eyes = Mesh()
    for sign in (-1, 1):
        x = 0.395 * length
        at = (x, bend(x) + sign * 0.5 * wide * section(0.105) ** 0.85 * 0.86, 0.06 * tall)
        joined(eyes, lathe([arc((0, 0), 0.055 * tall + 0.03, -90, 90, 10)], 16), 0, 1, at)
    return side(-8, 188), side(188, 352), fins, eyes


def aquarium():
    panes, wet = tank()
    meshes = {"tank-panes": panes, "tank-wet": wet, "tank-frame": frame_of_tank(), "tank-water": ripples(), "tank-sand": sand(),
              "grass-tall": grass(16, 3, 27, 0.55, 2.2), "grass-short": grass(34, 5, 6, 0.28, 2.6),
              "bush-red": bush(6, 2, 14, 2.6), "bush-green": bush(7, 9, 11, 3.2)}
    meshes |= {f"stone-{i}": stone(seed, flat) for i, (seed, flat) in enumerate(((2, 0.75), (7, 0.6), (12, 0.9)))}
    for name, parts in (("goldfish", fish(8.5, 4.0, 2.6)), ("tetra", fish(3.4, 1.1, 0.6, 2))):
        meshes |= {f"{name}-{part}": mesh for part, mesh in zip(("back", "belly", "fins", "eyes"), parts)}
    return meshes


def air_bubbles():
    """From a stone to the surface."""
    chance, lines = random.Random(4), []
    for i in range(46):
        t = i / 46
        z = 6.5 + (WATER - 7.3) * t + chance.uniform(-0.2, 0.2)
        x, y = (0.35 + 0.75 * t) * chance.gauss(0, 1), (0.35 + 0.75 * t) * chance.gauss(0, 1)
        radius = chance.uniform(0.08, 0.2 + 0.12 * t)
        lines.append(placed(f"Translate {x:.2f} {y:.2f} {z:.2f}", f'"sphere" "float radius" [{radius:.3f}]'))
    return scene_text(lines, "make_gallery_models.py")


# A lens on a stand, a book, a stencil; in centimetres

def lens(radius=4.4, curvature=9.4, edge=0.25):
    """Biconvex, about z."""
    half = math.degrees(math.asin(radius / curvature))
    z = curvature * math.cos(math.radians(half)) - edge / 2
    lower = [(r, -h) for r, h in reversed(arc((0, -z), curvature, 90 - half, 90, 20))]
    upper = [(r, h) for r, h in arc((0, -z), curvature, 90 - half, 90, 20)]
    lower[0], upper[-1] = (0, lower[0][1]), (0, upper[-1][1])
    return lathe([lower, line(lower[-1], upper[0]), upper], 96)


def lens_stand():
    """A ring about x at the height of 9.5, on a pillar with a round foot."""
    ring = lathe([spline([(4.3, -0.42), (4.75, -0.5), (5.0, 0), (4.75, 0.5), (4.3, 0.42)], 6), line((4.3, 0.42), (4.3, -0.42))], 96)
    mesh = Mesh()
    mesh.vertices = [((z, -y, x + 9.5), (nz, -ny, nx)) for (x, y, z), (nx, ny, nz) in ring.vertices]
    mesh.triangles = list(ring.triangles)
    return lathe([line((0, 0), (3.4, 0)), arc((3.4, 0.2), 0.2, -90, 90, 6),
                  spline([(3.4, 0.4), (2.6, 0.55), (1.2, 0.75), (0.6, 1.2), (0.42, 1.9), (0.55, 2.3), (0.75, 2.6),
                          (0.5, 2.9), (0.34, 3.3), (0.34, 4.4), (0.5, 4.7)], 6)], 48, mesh)


def book(width, depth, thick):
    """A closed book on z = 0, its back towards -y: the cover, the pages."""
    cover = boxes((-width / 2, -depth / 2 + 0.3, 0, width / 2, depth / 2, 0.25),
                  (-width / 2, -depth / 2 + 0.3, thick - 0.25, width / 2, depth / 2, thick))
    turns = [(math.cos(math.radians(a)), math.sin(math.radians(a))) for a in range(0, 181, 15)]
    back = [(-depth / 2 + 0.3 - 0.35 * s, thick / 2 - 0.5 * thick * c) for c, s in turns]
    rows = [[cover.vertex((x, y, z), (0, -s, -c)) for (y, z), (c, s) in zip(back, turns)] for x in (-width / 2, width / 2)]
    cover.strip(*rows[::-1])
    for x, side in ((-width / 2, -1), (width / 2, 1)):
        cover.polygon([(x, y, z) for y, z in back[::side]], (side, 0, 0))
    return cover, boxes((-width / 2 + 0.35, -depth / 2 + 0.3, 0.25, width / 2 - 0.35, depth / 2 - 0.35, thick - 0.25))


def star(x, y, radius, turn=0.0):
    """Convex pieces of a star with five points, counter-clockwise."""
    def point(r, k):
        a = math.radians(90 + turn + 36 * k)
        return (x + r * math.cos(a), y + r * math.sin(a))

    return [[(x, y), point(0.45 * radius, k - 1), point(radius, k), point(0.45 * radius, k + 1)] for k in range(0, 10, 2)]


def crescent(x, y, radius, steps=24):
    """Convex pieces of a waning moon, counter-clockwise."""
    outer = [(x + radius * math.cos(a), y + radius * math.sin(a)) for a in (math.radians(50 + 260 * i / steps) for i in range(steps + 1))]
    hollow = 1.05 * radius * math.sin(math.radians(50))
    middle = x + radius * math.cos(math.radians(50)) + math.sqrt(hollow ** 2 - (outer[0][1] - y) ** 2)
    half = math.degrees(math.asin((outer[0][1] - y) / hollow))
    inner = [(middle + hollow * math.cos(a), y + hollow * math.sin(a))
             for a in (math.radians(180 - half + 2 * half * i / steps) for i in range(steps + 1))]
    inner[0], inner[-1] = outer[0], outer[-1]
    return [[outer[i], outer[i + 1], *([inner[i + 1]] if i < steps - 1 else []), *([inner[i]] if i else [])] for i in range(steps)]


def stencil(radius=2.68):
    """A disc about x with a moon and stars cut out, upside down as a lens turns them."""
    pieces = [[(radius * math.cos(math.tau * i / 64), radius * math.sin(math.tau * i / 64)) for i in range(64)]]
    holes = crescent(0.3, 0.1, 1.25)
    for place in ((0.98, 0.12, 0.46, 8), (1.75, 0.7, 0.36, -12), (1.55, -0.75, 0.42, 20), (0.8, 1.95, 0.4, 4), (-0.75, 1.85, 0.3, 15),
                  (-1.75, 0.95, 0.36, -8), (-1.9, -0.55, 0.28, 10), (-1.05, -1.75, 0.38, -15), (0.35, -1.85, 0.33, 5), (1.62, 1.5, 0.2, 0),
                  (2.2, -0.15, 0.2, 10), (-1.5, 1.75, 0.18, 0), (-0.3, -2.3, 0.17, 0), (1.2, -1.75, 0.2, 12), (-1.9, 0.2, 0.17, 20)):
        holes += star(*place)
    for hole in holes:
        pieces = [rest for piece in pieces for rest in without(piece, hole)]
    mesh = Mesh()
    for piece in pieces:
        mesh.polygon([(0, x, -y) for x, y in piece], (1, 0, 0))
    return mesh


def files():
    """Name and content of every file, before compression."""
    meshes = {"cloth": cloth(), "bowl": bowl(),
              "leaves": leaves(700, 4, (0, 420, 60), (800, 120, 200), 11),
              "leaves-far": leaves(900, 5, (0, 520, 60), (1100, 120, 320), 16)}
    meshes |= whisky() | church() | aquarium() | {"diamond-band": band(), "diamond-head": head()}
    meshes |= {"lens": lens(), "lens-stand": lens_stand(), "stencil": stencil()}
    for name, parts in (("book-a", book(21, 15, 3)), ("book-b", book(18, 13, 2.4))):
        meshes |= {f"{name}-{part}": mesh for part, mesh in zip(("cover", "pages"), parts)}
    for name, parts in (("highball", highball()),):
        meshes |= {f"{name}-{part}": mesh for part, mesh in zip(("glass", "liquid-in-glass", "liquid-top"), parts)}
    # Multiples of 2^-12: short mantissas pack well.
    packed = {f"{name}.ply.gz": mesh.bytes(rounded=lambda x: round(4096 * x) / 4096) for name, mesh in meshes.items()}
    return packed | {"bubbles.pbrt": bubbles(), "church.pbrt": church_placements()} | {"air-bubbles.pbrt": air_bubbles()} | small_stones()


if __name__ == "__main__":
    sys.exit(write_or_check(files(), __file__, sys.argv[1:]))
