# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Node trees that are baked, worlds that are baked, bump and displacement: compares blocks of pictures with Cycles."""
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bpy
import numpy
import stage

TOLERANCE = 0.06  # largest difference of blocks of 8 x 8 pixels, of the mean of the picture
FOLDER = sys.argv[sys.argv.index("--") + 1] if sys.argv[-1] != "--" and "--" in sys.argv else None


class Tree:
    """Short names for making nodes: node("TexNoise", Vector=output, Scale=3)."""

    def __init__(self, tree):
        self.tree = tree

    def node(self, kind, members=None, **inputs):
        made = self.tree.nodes.new(f"ShaderNode{kind}")
        for name, value in (members or {}).items():
            setattr(made, name, value)
        for name, value in inputs.items():
            self.set(made.inputs[name.replace("_", " ")], value)
        return made

    def set(self, socket, value):
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        else:
            socket.default_value = value


def material(make, closure="BsdfDiffuse"):
    """A material whose shader `make` gives inputs, by the tree: {"Color": output}."""
    made = bpy.data.materials.new("test")
    made.use_nodes = True
    made.node_tree.nodes.clear()
    tree = Tree(made.node_tree)
    shader = tree.node(closure)
    for name, value in make(tree).items():
        tree.set(shader.inputs[name], value)
    tree.node("OutputMaterial", Surface=shader.outputs[0])
    return made


def ramp(tree, factor, colors=((0.05, 0.1, 0.6, 1), (0.9, 0.7, 0.1, 1))):
    made = tree.node("ValToRGB", Fac=factor)
    for element, color in zip(made.color_ramp.elements, colors):
        element.color = color
    made.color_ramp.elements[0].position, made.color_ramp.elements[1].position = 0.35, 0.65
    return made.outputs["Color"]


def coordinates(tree, kind):
    return tree.node("TexCoord").outputs[kind]


def noise_ramp(kind):
    return lambda t: {"Color": ramp(t, t.node("TexNoise", Vector=coordinates(t, kind), Scale=3).outputs["Fac"])}


def noise_without_vector(t):
    return {"Color": ramp(t, t.node("TexNoise", Scale=3).outputs["Fac"])}


def voronoi_in_a_group(t):
    group = bpy.data.node_groups.new("inner", "ShaderNodeTree")
    inner = Tree(group)
    group.inputs.new("NodeSocketFloat", "Size")
    group.outputs.new("NodeSocketColor", "Color")
    start, end = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    cells = inner.node("TexVoronoi", Vector=coordinates(inner, "Object"), Scale=start.outputs["Size"])
    group.links.new(cells.outputs["Color"], end.inputs["Color"])
    outer = t.tree.nodes.new("ShaderNodeGroup")
    outer.node_tree = group
    outer.inputs["Size"].default_value = 2.5
    hue = t.node("HueSaturation", Color=outer.outputs["Color"], Hue=0.7, Saturation=0.6)
    return {"Color": hue.outputs["Color"]}


def screen_of_images(t):
    image = bpy.data.images.new("stripes", 32, 32)
    y, x = numpy.mgrid[0:32, 0:32]
    pixels = numpy.ones((32, 32, 4), dtype=numpy.float32)
    pixels[:, :, 0], pixels[:, :, 1], pixels[:, :, 2] = x / 31, (y // 8) % 2 * 0.7, 0.2
    image.pixels.foreach_set(pixels.ravel())
    texture = t.node("TexImage", {"image": image}, Vector=coordinates(t, "UV"))
    mixed = t.node("MixRGB", {"blend_type": "SCREEN"}, Fac=0.5, Color1=texture.outputs["Color"], Color2=(0.1, 0.4, 0.5, 1))
    return {"Color": t.node("Gamma", Color=mixed.outputs["Color"], Gamma=1.5).outputs["Color"]}


def math_of_waves(t):
    wave = t.node("TexWave", Vector=coordinates(t, "Generated"), Scale=2)
    power = t.node("Math", {"operation": "POWER"})
    t.set(power.inputs[0], wave.outputs["Fac"])
    power.inputs[1].default_value = 2.0
    return {"Color": power.outputs[0]}


def rough_noise(t):
    noise = t.node("TexNoise", Vector=coordinates(t, "Object"), Scale=2)
    return {"Roughness": ramp(t, noise.outputs["Fac"], ((0.1, 0.1, 0.1, 1), (0.7, 0.7, 0.7, 1))), "Metallic": 1.0,
            "Base Color": (0.8, 0.6, 0.3, 1)}


def bumps(t):
    wave = t.node("TexWave", Vector=coordinates(t, "UV"), Scale=0.5)
    bump = t.node("Bump", Height=wave.outputs["Fac"], Distance=0.05)
    return {"Color": (0.8, 0.8, 0.8, 1), "Normal": bump.outputs["Normal"]}


def bumps_of_place(t):
    wave = t.node("TexWave", Vector=coordinates(t, "Object"), Scale=0.5)
    bump = t.node("Bump", Height=wave.outputs["Fac"], Distance=0.05)
    return {"Color": (0.8, 0.8, 0.8, 1), "Normal": bump.outputs["Normal"]}


MATERIALS = {
    "ramp-of-noise-uv": (noise_ramp("UV"), "BsdfDiffuse"),
    "ramp-of-noise-object": (noise_ramp("Object"), "BsdfDiffuse"),
    "ramp-of-noise-generated": (noise_without_vector, "BsdfDiffuse"),
    "voronoi-in-a-group": (voronoi_in_a_group, "BsdfDiffuse"),
    "screen-of-images": (screen_of_images, "BsdfDiffuse"),
    "math-of-waves": (math_of_waves, "BsdfDiffuse"),
    "rough-noise": (rough_noise, "BsdfPrincipled"),
    "bump": (bumps, "BsdfDiffuse"),
    "bump-of-place": (bumps_of_place, "BsdfDiffuse"),
}


def blocks(picture, size=8):
    height, width = (extent // size * size for extent in picture.shape[:2])
    return picture[:height, :width, :3].reshape(height // size, size, width // size, size, 3).mean(axis=(1, 3))


class TextureTest(unittest.TestCase):
    def compare(self, name, tolerance=TOLERANCE, **options):
        cycles = stage.render("CYCLES", samples=64, max_bounces=4)
        ours = stage.render("LANTHORN", method="path", noise=0, seconds=0, passes=48, bake_size=512, **options)
        mean = cycles[:, :, :3].mean()
        worst = abs(blocks(ours) - blocks(cycles)).max() / mean
        print(f"{name}: lanthorn / cycles {ours[:, :, :3].mean() / mean:.4f}; largest difference of blocks {worst:.4f}",
              flush=True)
        if FOLDER:
            stage.save_png(os.path.join(FOLDER, f"{name}.png"), cycles, ours)
        self.assertLess(worst, tolerance)

    def ball(self, make, closure):
        stage.empty_scene(64, 64).world.color = (0.9, 0.9, 0.9)
        stage.add_camera((0, -4, 0), (math.radians(90), 0, 0), lens=70)
        ball = stage.add_ball(radius=0.9, location=(0, 0, 0), material=material(make, closure)).data
        layer = ball.uv_layers.new()
        for loop, uv in zip(ball.loops, layer.data):
            p = ball.vertices[loop.vertex_index].co
            uv.uv = (0.5 + p.x, 0.5 + p.z)
        stage.add_light("SUN", 2, rotation=(math.radians(50), 0, math.radians(30)), angle=0)

    def test_materials(self):
        for name, (make, closure) in MATERIALS.items():
            with self.subTest(name):
                self.ball(make, closure)
                self.compare(name)

    def test_places_of_triangles_do_not_overlap(self):
        from lanthorn import atlas
        points = numpy.random.default_rng(1).random((40, 3, 3))
        points[::3] *= 0.3
        uvs, size = atlas.places(points, 64)
        self.assertGreaterEqual(size, 64)
        self.assertTrue((uvs > 0).all() and (uvs < 1).all())
        taken = numpy.zeros((size, size), dtype=int)
        y, x = (numpy.mgrid[0:size, 0:size] + 0.5) / size
        for a, b, c in uvs.astype(numpy.float64):
            sides = [(q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) for p, q in ((a, b), (b, c), (c, a))]
            near = [side > -1.0 / size * numpy.hypot(*(q - p)) for side, (p, q) in zip(sides, ((a, b), (b, c), (c, a)))]
            taken += near[0] & near[1] & near[2]  # with the texel around it that interpolation reads
        self.assertEqual(taken.max(), 1)

    def test_mean_fresnel(self):
        from lanthorn.textures import mean_fresnel
        cosines = (numpy.arange(4000) + 0.5) / 4000
        for eta in (1.33, 1.5, 2.0, 1 / 1.5):
            sine = numpy.minimum(1, numpy.sqrt(1 - cosines**2) / eta)
            inner = numpy.sqrt(1 - sine**2)
            s = ((cosines - eta * inner) / (cosines + eta * inner)) ** 2
            p = ((eta * cosines - inner) / (eta * cosines + inner)) ** 2
            exact = (numpy.where(sine < 1, (s + p) / 2, 1) * 2 * cosines).mean()
            self.assertAlmostEqual(mean_fresnel(eta), exact, delta=0.02)

    def test_a_bake_that_fails_is_told_and_grey(self):
        import lanthorn.bake
        self.ball(*MATERIALS["ramp-of-noise-uv"])
        worker, lanthorn.bake.WORKER = lanthorn.bake.WORKER, os.path.join(stage.ROOT, "there-is-no-worker.py")
        told, note = [], lanthorn.report.Report.note
        lanthorn.report.Report.note = lambda self, owner, text: (told.append(text), note(self, owner, text))
        try:
            picture = stage.render("LANTHORN", method="path", noise=0, seconds=0, passes=4)
        finally:
            lanthorn.bake.WORKER, lanthorn.report.Report.note = worker, note
        self.assertTrue(any("1 of 1 images could not be baked" in text for text in told), told)
        red, green, blue = picture[28:36, 28:36, :3].mean(axis=(0, 1))
        self.assertAlmostEqual(red, green, delta=0.02)
        self.assertAlmostEqual(red, blue, delta=0.02)

    def test_displacement(self):
        for method in ("BUMP", "DISPLACEMENT"):
            with self.subTest(method):
                stage.empty_scene(64, 64).world.color = (0.5, 0.5, 0.5)
                stage.add_camera((0, -3, 2), (math.radians(55), 0, 0), lens=50)
                plane = stage.add_plane(2, material=material(lambda t: {"Color": (0.7, 0.7, 0.7, 1)}))
                made = plane.data.materials[0]
                for polygon in plane.data.polygons:
                    polygon.use_smooth = True
                for corner, uv in zip(((0, 0), (1, 0), (1, 1), (0, 1)), plane.data.uv_layers[0].data):
                    uv.uv = corner
                tree = Tree(made.node_tree)
                height = tree.node("TexNoise", Vector=coordinates(tree, "UV"), Scale=4, Detail=0).outputs["Fac"]
                moved = tree.node("Displacement", Height=height, Scale=0.5, Midlevel=0.5).outputs[0]
                output = next(n for n in made.node_tree.nodes if n.type == "OUTPUT_MATERIAL")
                tree.set(output.inputs["Displacement"], moved)
                made.cycles.displacement_method = method
                subdivision = plane.modifiers.new("grid", "SUBSURF")
                subdivision.subdivision_type, subdivision.levels, subdivision.render_levels = "SIMPLE", 5, 5
                stage.add_light("SUN", 3, rotation=(math.radians(60), 0, math.radians(30)), angle=0)
                self.compare(f"displacement-{method.lower()}", tolerance=0.12)

    def world(self, make):
        scene = stage.empty_scene(64, 64)
        scene.world.use_nodes = True
        scene.world.node_tree.nodes.clear()
        tree = Tree(scene.world.node_tree)
        tree.node("OutputWorld", Surface=tree.node("Background", **make(tree)).outputs[0])
        stage.add_camera((0, -4, 1.5), (math.radians(80), 0, 0), lens=30)
        stage.add_plane(size=8)
        stage.add_ball(radius=0.7, location=(0, 0, 0.7), material=stage.diffuse("white", (0.8, 0.8, 0.8)))

    def test_sky(self):
        def sky(tree):
            made = tree.node("TexSky", {"sky_type": "NISHITA", "sun_elevation": math.radians(35),
                                        "sun_rotation": math.radians(60)})
            return {"Color": made.outputs[0], "Strength": 0.05}
        self.world(sky)
        self.compare("sky", 0.06)

    def test_world_of_noise(self):
        def gradient(tree):
            noise = tree.node("TexNoise", Vector=coordinates(tree, "Generated"), Scale=2)
            return {"Color": ramp(tree, noise.outputs["Fac"]), "Strength": 1.0}
        self.world(gradient)
        self.compare("world-of-noise", 0.06)


if __name__ == "__main__":
    stage.enable_addon()
    arguments = sys.argv[sys.argv.index("--") + 2:] if "--" in sys.argv else []
    unittest.main(argv=["test_textures", *arguments])
