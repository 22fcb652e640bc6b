# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""The sixteen .blend files of scenes/blender/make_blends.py, opened and rendered by both engines. The means of
pictures and of blocks must agree, except for the scenes with caustics, which Cycles does not find."""
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bpy
import numpy
import stage

sys.path.insert(0, os.path.join(stage.ROOT, "scenes", "blender"))
import make_blends

OF_MEAN = 0.03     # of the mean of the picture
OF_MEDIAN = 0.03   # the median difference of blocks, of the mean of the picture
OF_WORST = 0.2     # nine blocks of ten differ by less
CAUSTICS = {"glass-of-water", "ring", "pool", "lamp", "beams"}
BRIGHTER = {"glass-of-water": 0.75, "ring": 0.9, "pool": 1.1, "lamp": 5.0}  # largest block, at least so many times Cycles'
BRIGHTER_MEAN = {"beams": 1.8}  # the brightest block is lit through the open hole
FOLDER = sys.argv[sys.argv.index("--") + 1] if sys.argv[-1] != "--" and "--" in sys.argv else None
ONLY = sys.argv[sys.argv.index("--") + 2:] if "--" in sys.argv else []


def blocks(picture, size=8):
    height, width = picture.shape[0] // size, picture.shape[1] // size
    return picture[:height * size, :width * size, :3].reshape(height, size, width, size, 3).mean(axis=(1, 3))


class BlendTest(unittest.TestCase):
    def render_both(self, path):
        bpy.ops.wm.open_mainfile(filepath=path)
        render = bpy.context.scene.render
        render.resolution_x, render.resolution_y = 80, 64
        cycles = stage.render("CYCLES", samples=64, max_bounces=16, transmission_bounces=16, volume_bounces=16)
        ours = stage.render("LANTHORN", noise=0, seconds=0, passes=24, bake_size=256)
        return cycles, ours

    def test_each(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ONLY or make_blends.SCENES:
                with self.subTest(name):
                    make_blends.SCENES[name]()
                    path = os.path.join(folder, f"{name}.blend")
                    bpy.ops.wm.save_as_mainfile(filepath=path, compress=True)
                    self.check(name, *self.render_both(path))

    def check(self, name, cycles, ours):
        mean = cycles[:, :, :3].mean()
        ratio = ours[:, :, :3].mean() / mean
        differences = abs(blocks(ours) - blocks(cycles)).max(axis=2) / mean
        median, worst = numpy.median(differences), numpy.quantile(differences, 0.9)
        brightest = blocks(ours).max() / blocks(cycles).max()
        print(f"{name}: lanthorn / cycles {ratio:.4f}; blocks differ by {median:.4f} (median), {worst:.4f} (nine of ten); "
              f"the brightest {brightest:.2f}", flush=True)
        if FOLDER:
            stage.save_png(os.path.join(FOLDER, f"blend-{name}.png"), cycles, ours)
        self.assertTrue(numpy.isfinite(ours).all())
        if name in CAUSTICS:
            self.assertGreater(brightest, BRIGHTER.get(name, 0))
            self.assertGreater(ratio, BRIGHTER_MEAN.get(name, 0))
            return
        self.assertAlmostEqual(ratio, 1, delta=OF_MEAN)
        self.assertLess(median, OF_MEDIAN)
        self.assertLess(worst, OF_WORST)


if __name__ == "__main__":
    stage.enable_addon()
    unittest.main(argv=["test_blends"])
