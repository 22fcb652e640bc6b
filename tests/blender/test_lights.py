# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Each kind of lamp on a diffuse plane: the means of Lanthorn's and Cycles' pictures differ by less than
2 %, and the means of lit blocks by less than 4 %."""
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bpy
import numpy
import stage

TOLERANCE = 0.02
FOLDER = sys.argv[sys.argv.index("--") + 1] if sys.argv[-1] != "--" and "--" in sys.argv else None


def block_means(picture, blocks=4):
    height, width = picture.shape[:2]
    cut = picture[:height // blocks * blocks, :width // blocks * blocks, :3]
    return cut.reshape(blocks, height // blocks, blocks, width // blocks, 3).mean(axis=(1, 3))


class LightTest(unittest.TestCase):
    def setUp(self):
        stage.empty_scene()
        stage.camera_from_above(height=3)
        stage.add_plane(size=8)

    def compare(self, name, tolerance=TOLERANCE, samples=256, blocks=4):
        # Single scattering only, so that the engines differ in nothing but the light.
        cycles = stage.render("CYCLES", samples=samples, max_bounces=0)
        ours = stage.render("LANTHORN", method="path", max_depth=1, noise=0, seconds=0, passes=256)
        ratio = ours[:, :, :3].mean() / cycles[:, :, :3].mean()
        self.ratios = ours[:, :, :3].mean(axis=(0, 1)) / cycles[:, :, :3].mean(axis=(0, 1))  # of the colours
        theirs, means = block_means(cycles, blocks), block_means(ours, blocks)
        lit = theirs > 0.05 * cycles[:, :, :3].max()
        ratios = means[lit] / theirs[lit]
        print(f"{name}: lanthorn / cycles {ratio:.4f}; blocks {ratios.min():.4f} to {ratios.max():.4f}; "
              f"mean of cycles {cycles[:, :, :3].mean():.5f}")
        if FOLDER:
            stage.save_png(os.path.join(FOLDER, f"light-{name}.png"), cycles, ours,
                           exposure=0.5 / cycles[:, :, :3].max())
        self.assertAlmostEqual(ratio, 1, delta=tolerance)
        if blocks == 4:
            self.assertLess(abs(ratios - 1).max(), 2 * tolerance)
        else:  # of shadows: in parts of the brightest block
            self.assertLess(abs(means - theirs).max() / theirs.max(), 2 * tolerance)

    def test_point_of_no_size(self):
        stage.add_light("POINT", 100, (0.5, 0, 2), shadow_soft_size=0)
        self.compare("point-0")

    def test_point(self):
        stage.add_light("POINT", 100, (2.5, 0.4, 1), shadow_soft_size=0.25, color=(1, 0.5, 0.2))
        self.compare("point")

    def test_sun(self):
        stage.add_light("SUN", 3, rotation=(0.5, 0.3, 0), angle=0)
        self.compare("sun")

    def test_sun_in_a_mirror(self):
        stage.add_light("SUN", 3, rotation=(0.4, 0.2, 0), angle=math.radians(20))
        stage.add_ball(material=stage.node_material("mirror", "ShaderNodeBsdfGlossy", Roughness=0.0))
        cycles = stage.render("CYCLES", samples=256)
        ours = stage.render("LANTHORN", method="auto", noise=0, seconds=0, passes=128)
        theirs, means = block_means(cycles, 12), block_means(ours, 12)
        print(f"sun in a mirror: brightest block {means.max() / theirs.max():.4f}")
        self.assertGreater(theirs.max(), 5 * cycles[:, :, :3].mean())
        self.assertLess(abs(means - theirs).max() / theirs.max(), 2 * TOLERANCE)

    def test_sun_in_the_picture(self):
        stage.add_camera((0, 0, 1), (math.pi, 0, 0), angle=math.radians(40))
        sun = stage.add_light("SUN", 3, rotation=(0.1, 0, 0), angle=math.radians(12))
        for is_seen in (False, True):
            with self.subTest(is_seen):
                sun.visible_camera = is_seen
                cycles, ours = (stage.render(engine, **settings) for engine, settings in (
                    ("CYCLES", {"samples": 64}),
                    ("LANTHORN", {"method": "path", "noise": 0, "seconds": 0, "passes": 64})))
                self.assertEqual(cycles[:, :, :3].max() > 1, is_seen)
                difference = abs(block_means(ours, 12) - block_means(cycles, 12)).max()
                self.assertLess(difference, 0.02 * max(1, cycles[:, :, :3].max()))

    def test_spot(self):
        stage.add_light("SPOT", 100, (0.3, 0, 2), (0.2, 0, 0), shadow_soft_size=0, spot_size=math.radians(40),
                        spot_blend=0.3)
        self.compare("spot")

    def test_soft_shadows(self):
        """The half-shadow of a ball: blocks are smaller than it."""
        stage.add_ball(radius=0.3, location=(0, 0, 0.8), material=stage.diffuse("ball"))
        for name, lamp in (("sun-soft", ("SUN", 3, (0, 0, 0), (0.5, 0.3, 0), {"angle": math.radians(12)})),
                           ("spot-soft", ("SPOT", 100, (0.3, 0, 2.4), (0.12, 0.1, 0), {"shadow_soft_size": 0.3,
                                                                 "spot_size": math.radians(50), "spot_blend": 0.3}))):
            with self.subTest(name):
                kind, energy, place, turn, members = lamp
                made = stage.add_light(kind, energy, place, turn, **members)
                self.compare(name, blocks=12, samples=128)
                bpy.data.objects.remove(made)

    def test_area(self):
        for shape in ("SQUARE", "RECTANGLE", "DISK", "ELLIPSE"):
            with self.subTest(shape):
                self.setUp()
                stage.add_light("AREA", 100, (2.2, 0.2, 1), (0.4, 0.9, 0), shape=shape, size=0.6, size_y=0.3)
                self.compare(f"area-{shape.lower()}")

    def test_area_that_is_scaled(self):
        light = stage.add_light("AREA", 100, (2.4, 0, 1), (0, 0.8, 0), shape="RECTANGLE", size=0.6, size_y=0.3)
        light.scale = (2, 0.5, 1)
        self.compare("area-scaled")

    def test_lights_in_the_picture(self):
        """The camera sees a light only if its Ray Visibility says so."""
        for is_seen in (False, True):
            with self.subTest(is_seen):
                self.setUp()
                stage.add_light("POINT", 20, (0.2, 0.2, 1), shadow_soft_size=0.1).visible_camera = is_seen
                self.compare(f"in-picture-{is_seen}", blocks=6)

    def test_spread_of_area_lights(self):
        for degrees in (120, 60, 15):
            with self.subTest(degrees):
                self.setUp()
                stage.add_light("AREA", 100, (0.4, 0.2, 1.5), (0.2, 0.3, 0), shape="RECTANGLE", size=0.6, size_y=0.3,
                                spread=math.radians(degrees))
                self.compare(f"spread-{degrees}", blocks=6)

    def test_black_bodies(self):
        """Of a light's nodes, and of a mesh."""
        light = stage.add_light("SPOT", 100, (0.3, 0, 2), (0.2, 0, 0), shadow_soft_size=0, spot_size=math.radians(40))
        light.data.use_nodes = True
        lamp = stage.node_material("lamp", "ShaderNodeEmission", Strength=20)
        stage.add_ball(radius=0.2, location=(3, 0, 1.5), material=lamp)
        for tree, kelvin in ((light.data.node_tree, 2500), (lamp.node_tree, 9000)):
            black_body = tree.nodes.new("ShaderNodeBlackbody")
            black_body.inputs["Temperature"].default_value = kelvin
            tree.links.new(black_body.outputs[0], next(n for n in tree.nodes if n.type == "EMISSION").inputs["Color"])
        self.compare("black-bodies")
        self.assertLess(abs(self.ratios - 1).max(), TOLERANCE)

    def test_mesh(self):
        lamp = stage.node_material("lamp", "ShaderNodeEmission", Color=(1, 0.8, 0.6, 1), Strength=20)
        stage.add_ball(radius=0.2, location=(3, 0, 1.5), material=lamp)
        self.compare("mesh")

    def test_world_color(self):
        bpy.context.scene.world.color = (0.5, 0.7, 1)
        self.compare("world-color")

    def test_world_texture(self):
        image = bpy.data.images.new("sky", 64, 32, float_buffer=True)
        y, x = numpy.mgrid[0:32, 0:64]
        pixels = numpy.ones((32, 64, 4), dtype=numpy.float32)
        # Bright in one direction, so that a rotated or mirrored picture is noticed.
        pixels[:, :, 0] = numpy.exp(-((x - 14) ** 2 + (y - 22) ** 2) / 30) * 20
        pixels[:, :, 1] = numpy.where(x > 40, 1.0, 0.1)
        pixels[:, :, 2] = 0.2
        image.pixels.foreach_set(pixels.ravel())
        world = bpy.context.scene.world
        world.use_nodes = True
        nodes, links = world.node_tree.nodes, world.node_tree.links
        texture = nodes.new("ShaderNodeTexEnvironment")
        texture.image = image
        background = next(n for n in nodes if n.type == "BACKGROUND")
        background.inputs["Strength"].default_value = 0.7
        links.new(texture.outputs[0], background.inputs["Color"])
        # A faceted object, whose sides face different directions.
        stage.add_ball(radius=0.6, location=(0, 0, 0.3), material=stage.diffuse(), is_smooth=False)
        self.compare("world-texture")


if __name__ == "__main__":
    stage.enable_addon()
    arguments = sys.argv[sys.argv.index("--") + 2:] if "--" in sys.argv else []
    unittest.main(argv=["test_lights", *arguments])
