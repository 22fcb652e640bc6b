# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Gives each triangle of a mesh its own place in an image, in proportion to its size."""
import numpy

LARGEST_RATIO = 6     # log2 of the largest square over the smallest one
SMALLEST_SQUARE = 8   # texels along each side
LARGEST_IMAGE = 4096  # texels along each side; beyond it, the smallest squares shrink
MARGIN = 1.0          # texels between a triangle and the edge of its square, for bilinear interpolation


def _even_bits(codes):
    """Packs the bits 0, 2, 4 … of each number: one coordinate of a position along a Z-order curve."""
    values = numpy.zeros_like(codes)
    for bit in range(31):
        values |= ((codes >> (2 * bit)) & 1) << bit
    return values


def _levels(points):
    """Returns log2 of the side of each triangle's square, from the triangle's longest edge."""
    edges = numpy.linalg.norm(points - numpy.roll(points, 1, axis=1), axis=2).max(axis=1)
    largest = max(float(edges.max()), 1e-30)
    below = numpy.round(numpy.log2(largest / numpy.maximum(edges, largest * 2.0**-LARGEST_RATIO))).astype(numpy.int64)
    return below.max() - below


def places(points, size):
    """Returns texture coordinates (n, 3, 2) for triangles (n, 3, 3), and the size of the image, which is at least
    `size`. Two triangles of equal size share a square. The squares, sorted by size, follow a Z-order curve, along which
    squares with sides of powers of two leave no gaps."""
    levels = _levels(numpy.asarray(points, dtype=numpy.float64))
    order = numpy.argsort(-levels, kind="stable")
    sorted_levels = levels[order]
    starts = numpy.r_[True, sorted_levels[1:] != sorted_levels[:-1]]
    first = numpy.maximum.accumulate(numpy.where(starts, numpy.arange(len(order)), 0))
    is_second = (numpy.arange(len(order)) - first) % 2 == 1
    ends = numpy.cumsum(numpy.where(is_second, 0, 4**sorted_levels))
    begins = ends - 4**sorted_levels
    side = 1
    while side * side < ends[-1]:
        side *= 2
    size = min(max(size, SMALLEST_SQUARE * side), max(size, LARGEST_IMAGE))
    squares = (2.0**sorted_levels)[:, None, None]
    near = numpy.minimum(MARGIN * side / size / squares, 0.2)
    far, gap = 1 - near, 2 * near
    signs = numpy.array([[0, 0], [1, 0], [0, 1]])
    lower = near + signs * (far - gap - near)
    upper = far + signs * (near + gap - far)
    inside = numpy.where(is_second[:, None, None], upper, lower)
    corner = numpy.stack([_even_bits(begins), _even_bits(begins >> 1)], axis=1)[:, None, :]
    result = numpy.empty((len(order), 3, 2), dtype=numpy.float32)
    result[order] = (corner + inside * squares) / side
    return result, int(size)
