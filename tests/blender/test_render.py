# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Final renders: a glass that throws a caustic, passes, border, cameras, instances, animation, errors."""
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bpy
import numpy
import stage

FOLDER = sys.argv[sys.argv.index("--") + 1] if sys.argv[-1] != "--" and "--" in sys.argv else None


def glass_ball():
    stage.empty_scene(width=96, height=72)
    stage.add_camera((0, -5, 3), (math.radians(60), 0, 0), lens=40)
    stage.add_plane(size=8)
    stage.add_ball(radius=0.7, location=(0, 0, 0.9),
                   material=stage.node_material("glass", "ShaderNodeBsdfGlass", IOR=1.5, Roughness=0.0))
    stage.add_light("POINT", 400, (-2, 1, 3.5), shadow_soft_size=0.05)


class RenderTest(unittest.TestCase):
    def test_a_glass_ball_throws_a_caustic(self):
        glass_ball()
        bpy.context.scene.render.film_transparent = False
        layer = bpy.context.view_layer
        layer.use_pass_z = layer.use_pass_normal = True
        ours = stage.render("LANTHORN", noise=0, seconds=0, passes=24)
        cycles = stage.render("CYCLES", samples=128)
        if FOLDER:
            stage.save_png(os.path.join(FOLDER, "glass-ball.png"), cycles, ours, exposure=1)
        print("means: cycles", cycles[:, :, :3].mean(), "lanthorn", ours[:, :, :3].mean())
        self.assertTrue(numpy.isfinite(ours).all())
        # The light that the ball gathers on the floor is several times as bright as the floor around it.
        self.assertGreater(numpy.quantile(ours[:, :, 1], 0.998), 3 * numpy.median(ours[:, :, 1]))


if __name__ == "__main__":
    stage.enable_addon()
    arguments = sys.argv[sys.argv.index("--") + 2:] if "--" in sys.argv else []
    unittest.main(argv=["test_render", *arguments])
