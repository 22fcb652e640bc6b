#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the meshes of the gallery's scenes: filled glasses, a carafe, a lemon, a lantern, a ring, a book, water.

Usage: scenes/gallery/make_gallery_meshes.py [--check] [FOLDER]

Writes into FOLDER, by default meshes/ beside this script; with --check writes nothing and exits 1 if a file's content
differs (compressed bytes may differ, because they depend on zlib). Lengths are in centimetres, z is up. It needs only
Python 3.
"""
import math
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path[:0] = [str(Path(__file__).resolve().parents[1]), str(Path(__file__).resolve().parents[1] / "lectures")]
from make_meshes import arc, lathe, line, surface, write_or_check  # noqa: E402
from make_models import cut, grid, joined, spline  # noqa: E402


def filled(outer, inside, level, rise, rim, segments=96, mesh=None):
    """A vessel with a liquid up to `level`, as three interfaces that share their edge: glass to air, glass to liquid,
    liquid to air with a meniscus of height `rise`. `outer` are the runs from the middle of the bottom to the outer edge
    of the brim, `rim` the arc over it, `inside` runs from the brim to the middle of the floor. Normals point out of the
    glass, and up out of the liquid."""
    dry, wet = cut(inside, level + rise)
    edge = wet[0][0]
    radii = [edge * (1 - (i / 18) ** 2.5) for i in range(19)]
    top = [(r, level + rise * math.exp(-(edge - r) / 0.14)) for r in radii]
    return lathe([*outer, rim, dry], segments, mesh), lathe([wet], segments), lathe([top], segments)


def wine_glass():
    outside = spline([(3.3, 0.3), (2.0, 0.45), (0.8, 0.9), (0.42, 2.0), (0.38, 5.0), (0.45, 7.6), (1.3, 8.7), (3.0, 10.0),
                      (4.15, 12.2), (4.2, 13.6), (3.8, 16.0), (3.35, 18.2), (3.2, 19.0)], 5)
    inside = spline([(3.08, 19.0), (3.23, 18.2), (3.68, 16.0), (4.08, 13.6), (4.02, 12.2), (2.85, 10.15), (1.2, 9.05),
                     (0, 8.8)], 6)
    return filled([line((0, 0), (3.3, 0)), arc((3.3, 0.15), 0.15, -90, 90, 6), outside], inside, 12.4, 0.1,
                  arc((3.14, 19.0), 0.06, 0, 180, 6))


def carafe():
    foot = arc((4.2, 0.3), 0.3, -90, -10, 6)
    outside = spline([foot[-1], (5.2, 1.5), (5.6, 4.0), (5.0, 7.0), (3.2, 10.0), (1.9, 12.5), (1.6, 15.0), (1.9, 17.3),
                      (2.5, 18.6)], 5)
    inside = spline([(2.2, 18.6), (1.62, 17.3), (1.34, 15.0), (1.62, 12.5), (2.92, 9.9), (4.7, 6.95), (5.3, 4.0),
                     (4.9, 1.9), (3.8, 0.95), (2.0, 0.72), (0, 0.7)], 5)
    return filled([line((0, 0), (4.2, 0)), foot, outside], inside, 7.6, 0.12,
                  arc((2.35, 18.6), 0.15, 0, 180, 8))


def step(x):
    """Smooth, from 0 at 0 to 1 at 1."""
    x = min(1.0, max(0.0, x))
    return x * x * (3 - 2 * x)


def fluted(radius, flutes, depth, window, heights, around):
    """A wall about z with round flutes that fade where `window` (of the height) falls to 0."""
    def position(u, v):
        r = radius(v) - depth * window(v) * abs(math.sin(flutes * u / 2)) ** 1.5
        return (r * math.cos(u), r * math.sin(u), v)

    steps = flutes * around
    return surface(position, [math.tau * i / steps for i in range(steps + 1)], heights)


def tumbler():
    """With flutes up to two thirds of its height, and a drink."""
    flutes, around = 14, 9
    heights = [0.4, 0.5, *(0.6 + 0.1 * i for i in range(10)), *(1.8 + 0.8 * i for i in range(5)),
               *(5.4 + 0.15 * i for i in range(11)), 7.2, 8.2, 9.2]
    wall = fluted(lambda z: 3.95 + 0.03 * (z - 0.4), flutes, 0.34, lambda z: step((z - 0.6) / 0.8) * step((6.8 - z) / 1.4), heights,
                  around)
    inside = spline([(3.85, 9.2), (3.75, 6.0), (3.6, 2.6), (3.0, 1.6), (1.5, 1.4), (0, 1.4)], 8)
    return filled([line((0, 0), (3.55, 0)), arc((3.55, 0.4), 0.4, -90, 0, 6)], inside, 4.2, 0.1,
                  arc((4.032, 9.2), 0.182, 0, 180, 8), flutes * around, wall)


def lemon():
    return lathe([spline([(0, -4.1), (0.5, -3.95), (0.9, -3.5), (2.1, -2.3), (2.7, 0), (2.3, 2.0), (1.1, 3.3), (0.55, 3.75),
                          (0.35, 4.1), (0, 4.2)], 5)], 48)


def chimney():
    """The glass of a lantern: a barrel with flutes outside, smooth inside, open below and above."""
    flutes, around = 18, 8
    low, high, thick = 4.0, 17.0, 0.3

    def radius(z):
        return 3.8 + 0.75 * math.sin(math.pi * (z - low) / (high - low)) ** 1.2 if low < z < high else 3.8

    ends = [0.0, 0.1, 0.25, 0.45, 0.7, 1.0]
    heights = [low + e for e in ends] + [low + 1 + (high - low - 2) * i / 18 for i in range(1, 18)] + [high - e for e in reversed(ends)]
    mesh = fluted(radius, flutes, 0.42, lambda z: step((z - low - 0.1) / 0.9) * step((high - 0.1 - z) / 0.9), heights, around)
    inner = [(radius(z) - thick - 0.36 * step((z - low) / 1.0) * step((high - z) / 1.0), z) for z in reversed(heights)]
    edge = radius(high)
    return lathe([arc((edge - thick / 2, high), thick / 2, 0, 180, 6), inner,
                  arc((edge - thick / 2, low), thick / 2, 180, 360, 6)], flutes * around, mesh)


def lantern_base():
    return lathe([line((0, 0), (5.6, 0)), arc((5.6, 0.25), 0.25, -90, 90, 8), line((5.6, 0.5), (5.2, 0.55)),
                  spline([(5.2, 0.55), (4.9, 1.2), (4.6, 2.2), (4.7, 2.7)], 6), arc((4.7, 2.95), 0.25, -90, 90, 8),
                  line((4.7, 3.2), (4.5, 3.2)), line((4.5, 3.2), (4.5, 3.75)), line((4.5, 3.75), (1.2, 3.75)),
                  spline([(1.2, 3.75), (1.1, 4.6), (0.75, 5.2), (0.7, 6.0)], 6), line((0.7, 6.0), (0, 6.0))], 64)


def lantern_cap():
    return lathe([line((0, 17.25), (4.5, 17.25)), line((4.5, 17.25), (4.5, 17.8)), arc((4.7, 18.05), 0.25, -90, 90, 8),
                  spline([(4.7, 18.3), (4.2, 19.0), (2.6, 20.0), (1.9, 21.0), (1.8, 22.0)], 6),
                  arc((1.8, 22.2), 0.2, -90, 90, 8), spline([(1.8, 22.4), (1.5, 23.0), (0.8, 23.4), (0, 23.5)], 5)], 64)


def ring():
    """A wedding ring about z: flat inside with rounded edges, domed outside."""
    inner, outer, half = 0.9, 1.06, 0.26
    dome = [(outer - 0.09 * (1 - math.cos(math.radians(a))), half * math.sin(math.radians(a)) * 0.92) for a in range(-80, 81, 10)]
    return lathe([dome, arc((inner + 0.04, half - 0.04), 0.04, 60, 180, 6),
                  [(inner, (half - 0.04) * (1 - i / 2)) for i in range(5)],
                  arc((inner + 0.04, 0.04 - half), 0.04, 180, 300, 6)], 144)


def page_height(x, thickness):
    """Of an open book, at a distance from its gutter: steep there, then falling to the fore-edge."""
    return thickness * (1.12 * (1 - math.exp(-x / 1.6)) - 0.012 * x + 0.05 * math.sin(x / 4.2))


def page(side):
    """One of both upper pages, 14 by 21, about y; its gutter at x = 0."""
    xs = [14 * (i / 48) ** 1.6 for i in range(49)]

    def position(u, v):
        x = abs(u)
        return (u, v, page_height(x, 1.5))

    us = [side * x for x in xs]
    return surface(position, us if side > 0 else us[::-1], [-10.5, 0, 10.5])


def pool_water(cells=84, size=200.0):
    """A square of `size`, periodic, so that copies side by side have no seam: waves with whole numbers of periods."""
    waves = ((1, 2, 1.5, 0.4), (2, -1, 1.3, 1.9), (-3, 2, 0.85, 0.8), (3, 3, 0.6, 2.6), (1, -5, 0.55, 4.0), (5, 2, 0.45, 5.1),
             (-4, 6, 0.3, 0.3), (7, -3, 0.25, 3.3), (8, 5, 0.14, 1.1), (-6, 9, 0.11, 2.2))

    def height(i, j):
        x, y = i / cells, j / cells
        return sum(a * math.sin(math.tau * (kx * x + ky * y) + phase) for kx, ky, a, phase in waves)

    return grid(height, cells, cells, (0, size), (0, size))


def files():
    """Name and content of every file, before compression."""
    meshes = {"lemon": lemon(), "chimney": chimney(), "lantern-base": lantern_base(), "lantern-cap": lantern_cap(),
              "ring": ring(), "page-left": page(-1), "page-right": page(1), "pool-water": pool_water()}
    for name, parts in (("wine", wine_glass()), ("carafe", carafe()), ("tumbler", tumbler())):
        meshes |= {f"{name}-{part}": mesh for part, mesh in zip(("glass", "liquid-in-glass", "liquid-top"), parts)}
    # Multiples of 2^-12: short mantissas pack well.
    return {f"{name}.ply.gz": mesh.bytes(rounded=lambda x: round(4096 * x) / 4096) for name, mesh in meshes.items()}


if __name__ == "__main__":
    sys.exit(write_or_check(files(), __file__, sys.argv[1:]))
