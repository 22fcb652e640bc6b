#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the meshes of the lectures' scenes: glass with liquid, water, fractals, rooms and halls.

Usage: scenes/lectures/make_models.py [--check] [FOLDER]

Writes into FOLDER, by default meshes/ beside this script; with --check writes nothing and exits 1 if a file's content
differs (compressed bytes may differ, because they depend on zlib). Lengths are in metres unless noted; z is up.
"""
import math
import random
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from make_meshes import Mesh, add, arc, lathe, line, mul, polar, scene_text, smooth, sub, surface, unit, write_or_check  # noqa: E402


def spline(points, steps):
    """A Catmull-Rom spline through points (r, z), `steps` pieces between two of them."""
    ends = [sub(mul(points[0], 2), points[1]), *points, sub(mul(points[-1], 2), points[-2])]
    curve = [points[0]]
    for a, b, c, d in zip(ends, ends[1:], ends[2:], ends[3:]):
        for i in range(1, steps + 1):
            t = i / steps
            weights = ((-t + 2 * t * t - t**3) / 2, (2 - 5 * t * t + 3 * t**3) / 2,
                       (t + 4 * t * t - 3 * t**3) / 2, (t**3 - t * t) / 2)
            curve.append(tuple(sum(w * p[k] for w, p in zip(weights, (a, b, c, d))) for k in range(2)))
    return curve


def cut(profile, z):
    """A falling profile in two at height z."""
    i = next(i for i, p in enumerate(profile) if p[1] < z)
    a, b = profile[i - 1], profile[i]
    at = add(a, mul(sub(b, a), (z - a[1]) / (b[1] - a[1])))
    at = (at[0], z)
    return profile[:i] + [at], [at] + profile[i:]


def cognac(segments=128):
    """A balloon glass and what is in it, in centimetres, as three interfaces that share their edge: glass to air, glass
    to liquid, liquid to air with a meniscus. Normals point out of the glass, and up out of the liquid."""
    outside = spline([(3.25, 0.3), (2.2, 0.42), (0.75, 0.72), (0.46, 1.4), (0.46, 2.2), (1.1, 2.85), (2.8, 3.75), (4.0, 5.4),
                      (4.22, 7.0), (3.85, 9.0), (3.2, 11.0), (2.85, 12.5)], 10)
    inside = spline([(2.71, 12.5), (3.06, 11.0), (3.71, 9.0), (4.08, 7.0), (3.85, 5.45), (2.7, 3.98), (1.2, 3.2),
                     (0, 3.0)], 14)
    level, rise = 5.5, 0.12
    dry, wet = cut(inside, level + rise)
    rim = wet[0][0]
    radii = [rim * (1 - (i / 40) ** 2.5) for i in range(41)]
    top = [(r, level + rise * math.exp(-(rim - r) / 0.14)) for r in radii]
    glass = lathe([line((0, 0), (3.2, 0)), arc((3.25, 0.15), 0.15, -90, 90, 10), outside,
                   arc((2.78, 12.5), 0.07, 0, 180, 10), dry], segments)
    return glass, lathe([wet], segments), lathe([top], segments)


def egg(segments=128, steps=96):
    """Of length 2 about z, its blunt end down."""
    turns = [math.pi * i / steps for i in range(steps + 1)]
    return lathe([[(0.74 * math.sin(t) * (1 + 0.14 * math.cos(t)), -math.cos(t)) for t in turns]], segments)


def grid(height, columns, rows, xs, ys):
    """A height field z(column, row), with normals by differences."""
    mesh = Mesh()
    dx, dy = (xs[1] - xs[0]) / columns, (ys[1] - ys[0]) / rows
    lines = []
    for j in range(rows + 1):
        row = []
        for i in range(columns + 1):
            slope_x = (height(i + 1, j) - height(i - 1, j)) / (2 * dx)
            slope_y = (height(i, j + 1) - height(i, j - 1)) / (2 * dy)
            row.append(mesh.vertex((xs[0] + i * dx, ys[0] + j * dy, height(i, j)), unit((-slope_x, -slope_y, 1))))
        lines.append(row)
    for lower, upper in zip(lines, lines[1:]):
        mesh.strip(lower, upper)
    return mesh


def water(cells=120):
    """A body of water for a box of side 2 about z on z = 0, closed, two millimetres larger than the box to all sides
    but its front, y = -1: there it ends a centimetre before the edge. Waves on top."""
    low, high, front, level = -1.002, 1.002, -0.99, 0.62
    waves = ((5.1, 2.3, 0.016, 0.4), (-3.2, 6.4, 0.011, 1.9), (9.5, -4.4, 0.006, 0.8), (7.3, 11.9, 0.0045, 2.6),
             (-16.1, 8.2, 0.0022, 4.0))

    def height(i, j):
        x, y = low + (high - low) * i / cells, front + (high - front) * j / cells
        return level + sum(a * math.sin(kx * x + ky * y + phase) for kx, ky, a, phase in waves)

    mesh = grid(height, cells, cells, (low, high), (front, high))
    corner = mesh.vertices
    size = cells + 1
    edges = (([i for i in range(size)], (0, -1, 0)), ([i * size + cells for i in range(size)], (1, 0, 0)),
             ([size * size - 1 - i for i in range(size)], (0, 1, 0)), ([(cells - i) * size for i in range(size)], (-1, 0, 0)))
    for edge, normal in edges:
        upper = [mesh.vertex(corner[k][0], normal) for k in edge]
        lower = [mesh.vertex(corner[k][0][:2] + (-0.002,), normal) for k in edge]
        mesh.strip(lower, upper)
    mesh.polygon([(low, front, -0.002), (low, high, -0.002), (high, high, -0.002), (high, front, -0.002)], (0, 0, -1))
    return mesh


def midpoints(levels, roughness, seed, pinned):
    """Heights of 2^levels squares to a side by midpoint displacement (diamond-square; Fournier, Fussell & Carpenter
    1982). `pinned`: 0 along the edges, else periodic. The first displacement has deviation 1."""
    chance = random.Random(seed)
    size = 2**levels
    heights = {(0, 0): 0.0}
    step, scale = size, 1.0

    def at(x, y):
        return 0.0 if pinned and (x <= 0 or y <= 0 or x >= size or y >= size) else heights[x % size, y % size]

    while step > 1:
        half = step // 2
        for offsets, corners in ((((half, half),), ((-1, -1), (1, -1), (-1, 1), (1, 1))),
                                 (((half, 0), (0, half)), ((-1, 0), (1, 0), (0, -1), (0, 1)))):
            for y in range(0, size, step):
                for x in range(0, size, step):
                    for dx, dy in offsets:
                        mean = sum(at(x + dx + half * a, y + dy + half * b) for a, b in corners) / 4
                        heights[x + dx, y + dy] = mean + scale * chance.uniform(-1.73, 1.73)
            scale *= 2 ** (-roughness / 2)
        step = half
    return at, size


def terrain(levels, amplitude, roughness, seed, pinned):
    """A fractal square of side 2 about z."""
    at, size = midpoints(levels, roughness, seed, pinned)
    return grid(lambda i, j: round(amplitude * at(i, j), 5), size, size, (-1, 1), (-1, 1))


def highest(mesh, radius):
    """The top of a terrain within a distance of its middle."""
    return max(p[2] for p, _ in mesh.vertices if math.hypot(p[0], p[1]) <= radius)


# Rooms and halls

def joined(mesh, other, turn=0.0, scale=1.0, offset=(0, 0, 0)):
    """Adds another mesh, turned about z by degrees, scaled, moved."""
    first = len(mesh.vertices)
    c, s = polar(1, turn)

    def turned(v):
        return (v[0] * c - v[1] * s, v[0] * s + v[1] * c, v[2])

    mesh.vertices += [(add(mul(turned(p), scale), offset), turned(n)) for p, n in other.vertices]
    mesh.triangles += [tuple(first + k for k in t) for t in other.triangles]
    return mesh


def boxes(*corners, mesh=None):
    """Boxes (x0, y0, z0, x1, y1, z1) with flat faces."""
    mesh = mesh or Mesh()
    for box in corners:
        for axis in range(3):
            a, b = (axis + 1) % 3, (axis + 2) % 3
            for side in (0, 1):
                face = []
                for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))[::1 if side else -1]:
                    p = [0, 0, 0]
                    p[axis], p[a], p[b] = box[axis + 3 * side], box[a + 3 * i], box[b + 3 * j]
                    face.append(tuple(p))
                mesh.polygon(face, tuple((2 * side - 1) * (k == axis) for k in range(3)))
    return mesh


def pierced(low, high, holes):
    """A wall from corner `low` to corner `high`, thin in y, with rectangular holes (x0, z0, x1, z1): boxes on a common
    grid, so that there are no cracks."""
    xs = sorted({low[0], high[0], *(h[k] for h in holes for k in (0, 2))})
    zs = sorted({low[2], high[2], *(h[k] for h in holes for k in (1, 3))})
    cells = [(x0, low[1], z0, x1, high[1], z1) for x0, x1 in zip(xs, xs[1:]) for z0, z1 in zip(zs, zs[1:])
             if not any(h[0] <= x0 and x1 <= h[2] and h[1] <= z0 and z1 <= h[3] for h in holes)]
    return boxes(*cells)


def arch(width, height, radius, depth, steps=48):
    """Masonry over a round arch: from x = -width/2 to width/2, z = 0 to `height` above the springing, y = -depth/2 to
    depth/2; with a roll moulding along both edges."""
    mesh = Mesh()
    turns = [180 - 180 * i / steps for i in range(steps + 1)]
    for side in (-1, 1):
        rows = [[mesh.vertex((x, side * depth / 2, z), (0, side, 0)) for x, z in row] for row in (
            [(-width / 2, 0), *(polar(radius, t) for t in turns), (width / 2, 0)],
            [(-width / 2, height), *((radius * math.cos(math.radians(t)), height) for t in turns), (width / 2, height)])]
        mesh.strip(*(row[::-side] for row in rows))
    intrados = [[mesh.vertex((radius * c, y, radius * s), (-c, 0, -s)) for c, s in (polar(1, t) for t in turns)]
                for y in (-depth / 2, depth / 2)]
    mesh.strip(*intrados)
    for y in (-depth / 2, depth / 2):
        joined(mesh, roll(radius + 0.05, 0.05, y, steps))
    mesh.polygon([(-width / 2, -depth / 2, 0), (-width / 2, depth / 2, 0), (-radius, depth / 2, 0), (-radius, -depth / 2, 0)],
                 (0, 0, -1))
    mesh.polygon([(radius, -depth / 2, 0), (radius, depth / 2, 0), (width / 2, depth / 2, 0), (width / 2, -depth / 2, 0)],
                 (0, 0, -1))
    mesh.polygon([(-width / 2, -depth / 2, height), (width / 2, -depth / 2, height), (width / 2, depth / 2, height),
                  (-width / 2, depth / 2, height)], (0, 0, 1))
    return mesh


def roll(radius, thickness, y, steps, sides=10):
    """Half a ring about the axis y."""
    def position(u, v):
        r = radius + thickness * math.cos(v)
        return (r * math.cos(u), y + thickness * math.sin(v), r * math.sin(u))

    return surface(lambda u, v: position(math.pi - u, v), [math.pi * i / steps for i in range(steps + 1)],
                   [math.tau * i / sides for i in range(sides + 1)])


def column(height, radius, flutes=20):
    """On a plinth, with a base, a fluted shaft and a capital of an echinus and an abacus."""
    foot, neck = 3 * 0.22 * radius + 0.3 * radius, height - 1.1 * radius
    mesh = boxes((-1.35 * radius, -1.35 * radius, 0, 1.35 * radius, 1.35 * radius, 0.3 * radius),
                 (-1.35 * radius, -1.35 * radius, height - 0.35 * radius, 1.35 * radius, 1.35 * radius, height))
    lathe([arc((1.1 * radius, 0.52 * radius), 0.22 * radius, -90, 90, 10), line((1.1 * radius, 0.74 * radius),
           (1.02 * radius, 0.74 * radius)), line((1.02 * radius, 0.74 * radius), (1.02 * radius, foot))], 64, mesh)
    lathe([arc((0.88 * radius, neck), 0.09 * radius, -90, 90, 8),
           spline([(0.86 * radius, neck + 0.05 * radius), (0.95 * radius, neck + 0.4 * radius),
                   (1.3 * radius, height - 0.35 * radius)], 8)], 64, mesh)

    def position(u, v):
        t = min(1, max(0, (v - foot) / (neck - foot)))
        fade = min(1, 8 * t, 8 * (1 - t))
        r = radius * (1 - 0.14 * t**1.8) * (1 - 0.03 * fade * (1 - math.cos(flutes * u)))
        return (r * math.cos(u), r * math.sin(u), v)

    shaft = surface(position, [math.tau * i / (8 * flutes) for i in range(8 * flutes + 1)],
                    [foot + (neck - foot) * i / 24 for i in range(25)])
    return joined(mesh, shaft)


def vault(radius, length, ribs, steps=64):
    """A barrel vault along y from 0, seen from below, with round ribs."""
    mesh = Mesh()
    turns = [180 * i / steps for i in range(steps + 1)]
    rows = [[mesh.vertex((radius * c, y, radius * s), (-c, 0, -s)) for c, s in (polar(1, t) for t in turns)]
            for y in (0, length)]
    mesh.strip(*rows[::-1])
    for y in ribs:
        joined(mesh, roll(radius, 0.16, y, steps, 16))
    return mesh


def drape(width, height, folds, seed):
    """A hanging cloth across y = 0 from z = 0 down."""
    chance = random.Random(seed)
    phases = [chance.uniform(0, math.tau) for _ in range(3)]

    def position(u, v):
        deep = 0.03 + 0.09 * v
        wave = math.sin(folds * u * math.tau + phases[0] + 0.7 * math.sin(3 * v + phases[1]))
        return (width * (u - 0.5), deep * wave + 0.03 * math.sin(5 * u + 4 * v + phases[2]), -height * v)

    return surface(position, [i / 96 for i in range(97)], [i / 32 for i in range(33)])


def chair():
    legs = [(x, y, 0, x + 0.035, y + 0.035, 0.44) for x in (-0.22, 0.185) for y in (-0.22, 0.185)]
    return boxes(*legs, (-0.24, -0.24, 0.44, 0.24, 0.24, 0.475), (-0.23, 0.2, 0.475, -0.195, 0.235, 0.92),
                 (0.195, 0.2, 0.475, 0.23, 0.235, 0.92), (-0.24, 0.195, 0.66, 0.24, 0.24, 0.9))


def desk(width=1.6, depth=0.8):
    x, y = width / 2, depth / 2
    return boxes((-x, -y, 0.71, x, y, 0.745), (-x + 0.02, -y + 0.05, 0, -x + 0.06, y - 0.05, 0.71),
                 (x - 0.45, -y + 0.05, 0.08, x - 0.02, y - 0.05, 0.71), (-x + 0.06, y - 0.09, 0.3, x - 0.45, y - 0.06, 0.71))


def shelf(width, height, boards):
    """A bookcase with its back at y = 0."""
    z = [0.05 + (height - 0.08) * i / boards for i in range(boards + 1)]
    return boxes((-width / 2, -0.02, 0, width / 2, 0, height), (-width / 2, -0.32, 0, -width / 2 + 0.03, -0.02, height),
                 (width / 2 - 0.03, -0.32, 0, width / 2, -0.02, height),
                 *((-width / 2 + 0.03, -0.31, b, width / 2 - 0.03, -0.02, b + 0.03) for b in z))


def books(width, height, boards, seed, share):
    """Books for such a case, one in three of them, so that three meshes may have three colours."""
    chance = random.Random(seed)
    found = []
    for i in range(boards):
        z, x, k = 0.08 + (height - 0.08) * i / boards, -width / 2 + 0.04, 0
        while x < width / 2 - 0.1:
            thick, tall, deep = chance.uniform(0.02, 0.06), chance.uniform(0.2, 0.29), chance.uniform(0.17, 0.24)
            if chance.random() < 0.88 and k % 3 == share:
                found.append((x, -0.03 - deep, z, x + thick - 0.002, -0.03, z + tall))
            x, k = x + thick, k + chance.randrange(1, 3)
    return boxes(*found)


def frame(width, height):
    """Of a picture, about y = 0, in front of the wall at y = 0 towards -y; the picture is at y = -0.02."""
    x, z, w = width / 2, height / 2, 0.06
    return boxes((-x - w, -0.05, -z - w, x + w, 0, -z), (-x - w, -0.05, z, x + w, 0, z + w), (-x - w, -0.05, -z, -x, 0, z),
                 (x, -0.05, -z, x + w, 0, z))


def figure():
    """A turned figure, 1.5 high."""
    return lathe([line((0, 0), (0.2, 0)), spline([(0.2, 0), (0.21, 0.05), (0.13, 0.14), (0.1, 0.35), (0.17, 0.6), (0.24, 0.8),
                  (0.19, 0.98), (0.09, 1.08), (0.075, 1.14), (0.14, 1.24), (0.16, 1.34), (0.11, 1.45), (0, 1.5)], 8)], 64)


def museum_walls():
    """Hall 12 by 10 about the origin, two rooms behind its far wall and one to the right; doors of 2 by 3."""
    mesh = pierced((-6.2, 5, 0), (6.2, 5.4, 5), [(-4.2, 0, -2.2, 3.1), (2.2, 0, 4.2, 3.1)])
    side = pierced((-5, -6.4, 0), (5, -6, 5), [(-1.2, 0, 1.2, 3.1)])
    joined(mesh, side, 90)
    return boxes((-6.4, -5.2, 0, -6, 5, 5), (-6.2, -5.4, 0, 12.4, -5, 5), (-6.4, 12, 0, 12.4, 12.4, 5), (-6.4, 5, 0, -6, 12, 5),
                 (-0.2, 5.4, 0, 0.2, 12, 5), (12, -5, 0, 12.4, 12, 5), (6, 5.4, 0, 6.4, 12, 5), (6.2, 5, 0, 12, 5.4, 5), mesh=mesh)


def nave_walls(length, width):
    """Side walls of the aisles and of the clerestory with windows, and the ends."""
    mesh = Mesh()
    bays = [2.25 + 4.5 * i for i in range(int(length / 4.5))]
    for x, z0, z1, half, sill, head in ((width / 2 + 3.5, 0, 5.6, 0.6, 1.8, 4.4), (width / 2, 7.2, 10.2, 0.7, 7.8, 9.7)):
        wall = pierced((0, 0, z0), (length, 0.5, z1), [(b - half, sill, b + half, head) for b in bays])
        joined(mesh, wall, 90, 1, (x + 0.5, 0, 0))
        joined(mesh, wall, 90, 1, (-x, 0, 0))
    x = width / 2 + 4
    ends = ((-x, -0.6, 0, x, 0, 10.2 + width / 2 + 0.5),)
    joined(mesh, pierced((-x, length, 0), (x, length + 0.6, 10.2 + width / 2 + 0.5),
                         [(-1, 2.5, 1, 8), (-2.9, 3, -1.7, 7), (1.7, 3, 2.9, 7), (-0.9, 9.6, 0.9, 11.4)]))
    return boxes(*ends, (width / 2, 0, 5.6, width / 2 + 4, length, 5.9), (-width / 2 - 4, 0, 5.6, -width / 2, length, 5.9),
                 mesh=mesh)


def nave_placements(length, width):
    lines = []
    for i in range(int(length / 4.5)):
        for side in (-1, 1):
            x, y = side * width / 2 + side * 0.25, 4.5 * i
            lines += [f'AttributeBegin Translate {x:g} {y:g} 0 ObjectInstance "column" AttributeEnd',
                      f'AttributeBegin Translate {x:g} {y + 2.25:g} 4.6 Rotate 90 0 0 1 ObjectInstance "arch" AttributeEnd']
    for side in (-1, 1):
        lines.append(f'AttributeBegin Translate {side * (width / 2 + 0.25):g} {length:g} 0 ObjectInstance "column" AttributeEnd')
    return scene_text(lines, "make_models.py")


def atrium_placements(bays, pitch, width):
    """Two storeys of arcades along both sides, and galleries behind them."""
    lines = []
    for z, kind in ((0, "lower"), (5.1, "upper")):
        for side in (-1, 1):
            x = side * width / 2
            lines += [f'AttributeBegin Translate {x:g} {pitch * i:g} {z:g} ObjectInstance "{kind}-column" AttributeEnd'
                      for i in range(bays + 1)]
            spring = z + (3.3 if kind == "lower" else 2.7)
            lines += [f'AttributeBegin Translate {x:g} {pitch * (i + 0.5):g} {spring:g} Rotate 90 0 0 1 ObjectInstance "arch" '
                      "AttributeEnd" for i in range(bays)]
    return scene_text(lines, "make_models.py")


def atrium_walls(length, width):
    """The galleries' back walls with doors, their floors and roofs, and the ends."""
    mesh, back = Mesh(), width / 2 + 3.2
    doors = [(y - 0.6, z, y + 0.6, z + 2.4) for y in (4.5, 10.5, 16.5, 22.5) for z in (0, 5.1)]
    wall = pierced((-0.6, 0, 0), (length + 0.6, 0.4, 9.8), doors)
    joined(mesh, wall, 90, 1, (back + 0.4, 0, 0))
    joined(mesh, wall, 90, 1, (-back, 0, 0))
    slabs = []
    for side in (-1, 1):
        x = sorted((side * (width / 2 - 0.35), side * (back + 0.4)))
        slabs += [(x[0], 0, 4.8, x[1], length, 5.1), (x[0], 0, 9.3, x[1], length, 9.6)]
        blind = sorted((side * (back + 0.4), side * (back + 0.6)))
        slabs.append((blind[0], 0, 0, blind[1], length, 9.8))
    return boxes(*slabs, (-back - 0.4, -0.6, 0, back + 0.4, 0, 9.8), (-back - 0.4, length, 0, back + 0.4, length + 0.6, 9.8),
                 mesh=mesh)


def files():
    """Name and content of every file, before compression."""
    glass, wet, top = cognac()
    meshes = {
        "cognac-glass": glass,
        "cognac-liquid-in-glass": wet,
        "cognac-liquid-top": top,
        "arch": arch(3, 1.5, 1.1, 0.6),
        "atrium-walls": atrium_walls(27, 8),
        "books-0": books(1.6, 2.2, 6, 3, 0),
        "books-1": books(1.6, 2.2, 6, 3, 1),
        "books-2": books(1.6, 2.2, 6, 3, 2),
        "chair": chair(),
        "column-lower": column(3.3, 0.3),
        "column-nave": column(4.6, 0.42, 24),
        "column-upper": column(2.7, 0.22),
        "cube": boxes((-0.5, -0.5, -0.5, 0.5, 0.5, 0.5)),
        "desk": desk(),
        "drape": drape(2.1, 2.6, 5, 7),
        "egg": egg(),
        "figure": figure(),
        "frame": frame(1.6, 1.1),
        "museum-walls": museum_walls(),
        "nave-arch": arch(4.5, 2.6, 1.75, 0.7, 72),
        "nave-vault": vault(4.5, 36, [4.5 * i for i in range(9)]),
        "nave-walls": nave_walls(36, 9),
        "shelf": shelf(1.6, 2.2, 6),
        "water": water(),
    }
    fractals = {"fractal-ground": terrain(8, 0.09, 0.9, 5, False), "fractal-wall": terrain(8, 0.055, 0.85, 11, True)}
    scenes = {"atrium": atrium_placements(9, 3, 8), "nave": nave_placements(36, 9)}
    return ({f"{name}.pbrt": text for name, text in scenes.items()} | {f"{name}.ply.gz": mesh.bytes() for name, mesh in meshes.items()}
            | {f"{name}.ply.gz": mesh.bytes(flat=True) for name, mesh in fractals.items()})


if __name__ == "__main__":
    sys.exit(write_or_check(files(), __file__, sys.argv[1:]))
