# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Stores values in a box of cells. For a bake, the layers of the box lie side by side in one image, one texel per cell."""
import numpy

LARGEST_SIDE = 256  # cells along a side


def around(surface, size):
    """Returns the box around a surface, with about as many cells as an image of this size has texels."""
    low, high = (f(surface.positions, axis=0).astype(numpy.float64) for f in (numpy.min, numpy.max))
    extent = numpy.maximum(high - low, 1e-6)
    cell = max((extent.prod() / size**2) ** (1 / 3), extent.max() / LARGEST_SIDE)
    return Grid(low, high, numpy.maximum(1, numpy.round(extent / cell)).astype(int))


class Grid:
    """A box that is divided into `counts` cells along x, y and z."""

    def __init__(self, low, high, counts):
        self.low, self.high, self.counts = numpy.asarray(low), numpy.asarray(high), numpy.asarray(counts)
        nx, ny, nz = self.counts
        self.columns = max(1, int(numpy.ceil((nz * ny / nx) ** 0.5)))
        self.rows = -(-nz // self.columns)
        self.size = int(max(self.columns * nx, self.rows * ny))  # texels along each side of the image

    def arrays(self):
        """Returns the arrays for bake_worker.py: a square for each layer, with its place in the image."""
        (nx, ny, nz), layers = self.counts, numpy.arange(self.counts[2])
        corners = numpy.array([[0, 0], [1, 0], [1, 1], [0, 1]])
        z = self.low[2] + (layers + 0.5) / nz * (self.high[2] - self.low[2])
        points = numpy.empty((nz, 4, 3), dtype=numpy.float32)
        points[:, :, :2] = self.low[:2] + corners * (self.high[:2] - self.low[:2])
        points[:, :, 2] = z[:, None]
        starts = numpy.stack([layers % self.columns * nx, layers // self.columns * ny], axis=1)
        places = (starts[:, None] + corners * numpy.array([nx, ny])) / self.size
        triangles = (4 * layers[:, None, None] + numpy.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3)
        atlas = places.reshape(-1, 2)[triangles.reshape(-1)].astype(numpy.float32)
        return {"vertices": points.reshape(-1, 3), "triangles": triangles, "is_smooth": False, "atlas": atlas}

    def read(self, path):
        """Reads the values (n, 3) of all cells, x varying fastest, from the file of bake_worker.py; None if there is no
        file."""
        try:
            texels = numpy.load(path)["texels"]  # rows from the bottom
        except OSError:
            return None
        nx, ny, nz = self.counts
        tiles = texels[:self.rows * ny, :self.columns * nx].reshape(self.rows, ny, self.columns, nx, 3)
        return tiles.transpose(0, 2, 1, 3, 4).reshape(-1, ny, nx, 3)[:nz].reshape(-1, 3)

    def part(self, values):
        """Returns a grid of Lanthorn. The shape of `values` is (3) or (n, 3)."""
        cells = numpy.broadcast_to(values, (int(self.counts.prod()), 3)).astype(numpy.float32)
        return {"size": self.counts.tolist(), "low": self.low.tolist(), "high": self.high.tolist(), "values": cells}
