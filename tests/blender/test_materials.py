# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Each shader on a ball on a floor, under a uniform sky and an area lamp: compares means with Cycles."""
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bpy
import numpy
import stage

TOLERANCE = 0.03  # of the mean of the picture
LARGEST_OF_BALL = 0.12  # of a colour of the ball: Glossy is a metal here, whose edge is white; rough glass is darker
FOLDER = sys.argv[sys.argv.index("--") + 1] if sys.argv[-1] != "--" and "--" in sys.argv else None


def shader(kind, **inputs):
    return lambda: stage.node_material("test", kind, **inputs)


def mixed(first, second, amount=0.3, kind="ShaderNodeMixShader"):
    """Two shaders in one material."""
    def make():
        material = stage.node_material("test", first[0], **first[1])
        nodes, links = material.node_tree.nodes, material.node_tree.links
        output = next(n for n in nodes if n.type == "OUTPUT_MATERIAL")
        one = output.inputs["Surface"].links[0].from_node
        two, mix = nodes.new(second[0]), nodes.new(kind)
        for key, value in second[1].items():
            two.inputs[key].default_value = value
        if kind == "ShaderNodeMixShader":
            mix.inputs[0].default_value = amount
        links.new(one.outputs[0], mix.inputs[-2])
        links.new(two.outputs[0], mix.inputs[-1])
        links.new(mix.outputs[0], output.inputs["Surface"])
        return material
    return make


def textured(colorspace="sRGB", scale=(2, 1, 1), rotation=0.3):
    def make():
        material = stage.diffuse("test")
        nodes, links = material.node_tree.nodes, material.node_tree.links
        image = bpy.data.images.new("checks", 16, 16)
        image.colorspace_settings.name = colorspace
        y, x = numpy.mgrid[0:16, 0:16]
        pixels = numpy.ones((16, 16, 4), dtype=numpy.float32)
        pixels[:, :, 0], pixels[:, :, 1], pixels[:, :, 2] = x / 15, y / 15, ((x // 4 + y // 4) % 2) * 0.8
        image.pixels.foreach_set(pixels.ravel())
        texture, mapping, place = (nodes.new(f"ShaderNode{n}") for n in ("TexImage", "Mapping", "TexCoord"))
        texture.image = image
        mapping.inputs["Scale"].default_value = scale
        mapping.inputs["Rotation"].default_value = (0, 0, rotation)
        mapping.inputs["Location"].default_value = (0.1, 0.2, 0)
        links.new(place.outputs["UV"], mapping.inputs["Vector"])
        links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
        links.new(texture.outputs["Color"], next(n for n in nodes if n.type == "BSDF_DIFFUSE").inputs["Color"])
        return material
    return make


def volume(kind, surface=None, **inputs):
    """A medium in the ball, with or without a surface."""
    def make():
        material = stage.node_material("test", surface or "ShaderNodeBsdfDiffuse", **({"IOR": 1.3} if surface else {}))
        nodes, links = material.node_tree.nodes, material.node_tree.links
        output = next(n for n in nodes if n.type == "OUTPUT_MATERIAL")
        if surface is None:
            nodes.remove(output.inputs["Surface"].links[0].from_node)
        medium = nodes.new(kind)
        for key, value in inputs.items():
            medium.inputs[key.replace("_", " ")].default_value = value
        links.new(medium.outputs[0], output.inputs["Volume"])
        return material
    return make


def clouds(kind="ShaderNodeVolumePrincipled", coordinates="Object", with_color=False):
    """A medium whose density, and perhaps colour, comes from a noise."""
    def make():
        material = volume(kind, Anisotropy=0.0)()
        nodes, links = material.node_tree.nodes, material.node_tree.links
        medium = next(n for n in nodes if n.bl_idname == kind)
        place, noise, ramp = (nodes.new(f"ShaderNode{n}") for n in ("TexCoord", "TexNoise", "ValToRGB"))
        noise.inputs["Scale"].default_value = 1.5
        ramp.color_ramp.elements[0].position, ramp.color_ramp.elements[1].position = 0.4, 0.6
        ramp.color_ramp.elements[1].color = (4, 4, 4, 1)
        links.new(place.outputs[coordinates], noise.inputs["Vector"])
        links.new(noise.outputs["Fac"], ramp.inputs["Fac"])
        links.new(ramp.outputs["Color"], medium.inputs["Density"])
        if with_color:
            links.new(noise.outputs["Color"], medium.inputs["Color"])
        return material
    return make


def coat_of_fresnel():
    """The idiom of a diffuse shader under a glossy one."""
    material = mixed((DIFFUSE, {"Color": RED}), (GLOSSY, {"Roughness": 0.2}))()
    nodes, links = material.node_tree.nodes, material.node_tree.links
    fresnel = nodes.new("ShaderNodeFresnel")
    fresnel.inputs["IOR"].default_value = 1.5
    links.new(fresnel.outputs[0], next(n for n in nodes if n.type == "MIX_SHADER").inputs[0])
    return material


RED = (0.8, 0.2, 0.1, 1)
DIFFUSE, GLOSSY, EMISSION = "ShaderNodeBsdfDiffuse", "ShaderNodeBsdfGlossy", "ShaderNodeEmission"
PRINCIPLED, GLASS, HOLE = "ShaderNodeBsdfPrincipled", "ShaderNodeBsdfGlass", "ShaderNodeBsdfTransparent"
BASE = {"Base Color": RED}
MATERIALS = {
    "diffuse": (shader(DIFFUSE, Color=RED), TOLERANCE),
    "translucent": (shader("ShaderNodeBsdfTranslucent", Color=RED), TOLERANCE),
    "glossy": (shader(GLOSSY, Color=RED, Roughness=0.3), TOLERANCE),
    "mirror": (shader(GLOSSY, Color=RED, Roughness=0.0), TOLERANCE),
    "glass": (shader(GLASS, Color=(0.8, 0.9, 1, 1), IOR=1.5, Roughness=0.0), TOLERANCE),
    "rough-glass": (shader(GLASS, IOR=1.5, Roughness=0.4), 0.06),
    "hole": (mixed((DIFFUSE, {"Color": RED}), (HOLE, {})), TOLERANCE),
    "veil": (mixed((DIFFUSE, {"Color": (0.5, 0.15, 0.1, 1)}), (HOLE, {"Color": (0.4, 0.4, 0.4, 1)}),
                   kind="ShaderNodeAddShader"), TOLERANCE),
    "mix": (mixed((DIFFUSE, {"Color": RED}), (GLOSSY, {"Roughness": 0.2})), TOLERANCE),
    "emission": (shader(EMISSION, Color=RED, Strength=3.0), TOLERANCE),
    "diffuse-emission": (mixed((DIFFUSE, {"Color": RED}), (EMISSION, {"Strength": 0.5}), kind="ShaderNodeAddShader"),
                         TOLERANCE),
    "principled": (shader(PRINCIPLED, **BASE, Roughness=0.4, Specular=0.5), 0.05),
    "principled-metal": (shader(PRINCIPLED, **BASE, Roughness=0.3, Metallic=1.0), 0.05),
    "principled-glass": (shader(PRINCIPLED, **BASE, Roughness=0.0, Transmission=1.0, IOR=1.45), 0.05),
    "clearcoat": (shader(PRINCIPLED, **BASE, Roughness=0.5, Clearcoat=1.0, **{"Clearcoat Roughness": 0.1}), 0.05),
    "sheen": (shader(PRINCIPLED, **BASE, Roughness=0.6, Sheen=0.5, **{"Sheen Tint": 0.0}), 0.05),
    "velvet": (shader("ShaderNodeBsdfVelvet", Color=RED, Sigma=0.8), TOLERANCE),
    "coat-of-fresnel": (coat_of_fresnel, 0.05),
    "absorption": (volume("ShaderNodeVolumeAbsorption", GLASS, Color=(0.2, 0.6, 0.9, 1), Density=1.0), TOLERANCE),
    "scatter": (volume("ShaderNodeVolumeScatter", Color=(0.9, 0.6, 0.3, 1), Density=1.5, Anisotropy=0.3), TOLERANCE),
    "smoke": (volume("ShaderNodeVolumePrincipled", Color=(0.3, 0.6, 0.9, 1), Density=1.5, Anisotropy=0.0,
                     Absorption_Color=(0.2, 0.2, 0.2, 1)), TOLERANCE),
    "glow": (volume("ShaderNodeVolumePrincipled", Color=(0.5, 0.5, 0.5, 1), Density=0.5, Emission_Strength=0.4,
                    Emission_Color=(1, 0.5, 0.2, 1)), TOLERANCE),
    "clouds": (clouds(), TOLERANCE),
    "clouds-generated": (clouds("ShaderNodeVolumeScatter", "Generated", with_color=True), TOLERANCE),
    "anisotropic": (shader("ShaderNodeBsdfAnisotropic", Color=RED, Roughness=0.4, Anisotropy=0.7), TOLERANCE),
    "brushed": (shader(PRINCIPLED, **BASE, Roughness=0.4, Metallic=1.0, Anisotropic=0.9,
                       **{"Anisotropic Rotation": 0.25}), TOLERANCE),
    "under-surface": (shader(PRINCIPLED, **BASE, Roughness=0.4, Subsurface=0.5,
                             **{"Subsurface Color": (0.1, 0.7, 0.3, 1), "Subsurface Radius": (0.02, 0.02, 0.02)}), 0.05),
    "texture": (textured(), TOLERANCE),
    "texture-linear": (textured(colorspace="Non-Color"), TOLERANCE),
}


ONLY = sys.argv[sys.argv.index("--") + 2:] if "--" in sys.argv else []  # names of materials; none: all


class MaterialTest(unittest.TestCase):
    def build(self, make):
        scene = stage.empty_scene(64, 64)
        stage.add_camera((0, -4, 1.2), (math.radians(80), 0, 0), lens=50)
        stage.add_plane(size=12, material=stage.diffuse("floor", (0.4, 0.4, 0.4)))
        scene.world.color = (0.6, 0.7, 0.8)
        stage.add_light("AREA", 300, (2, -3, 4), (0.6, 0.35, 0), size=1)
        stage.add_ball(radius=0.8, location=(0, 0, 0.8), material=make())
        # Texture coordinates.
        ball = bpy.data.objects["ball"].data
        layer = ball.uv_layers.new()
        for loop, uv in zip(ball.loops, layer.data):
            p = ball.vertices[loop.vertex_index].co
            uv.uv = (0.5 + p.x, 0.5 + p.z)

    def test_each(self):

        rows = []
        for name in ONLY or MATERIALS:
            make, tolerance = MATERIALS[name]
            with self.subTest(name):
                self.build(make)
                cycles = stage.render("CYCLES", samples=192, max_bounces=24, transmission_bounces=24, volume_bounces=24,
                                      blur_glossy=0, sample_clamp_indirect=0)
                ours = stage.render("LANTHORN", method="vcm", noise=0, seconds=0, passes=48)
                rows.append(numpy.concatenate([cycles, ours], axis=1))
                ratio = ours[:, :, :3].mean() / cycles[:, :, :3].mean()
                middle = [p[24:52, 20:44, :3].mean(axis=(0, 1)) for p in (cycles, ours)]
                print(f"{name}: lanthorn / cycles {ratio:.4f}; of the ball {numpy.round(middle[1] / middle[0], 3)}")
                self.assertAlmostEqual(ratio, 1, delta=tolerance)
                self.assertLess(abs(middle[1] / middle[0] - 1).max(), LARGEST_OF_BALL)
        if FOLDER:
            half = (len(rows) + 1) // 2
            columns = [numpy.concatenate(part) for part in (rows[:half], rows[half:] or [0 * rows[0]])]
            columns[1] = numpy.pad(columns[1], ((0, columns[0].shape[0] - columns[1].shape[0]), (0, 0), (0, 0)))
            stage.save_png(os.path.join(FOLDER, "materials.png"), *columns, exposure=0.8)

    def test_measured_glass_and_metal(self):
        """Presets give the index at the d line; the program takes them, and a film, in a spectral render."""
        from lanthorn import presets
        for name, (_, index, *_) in {**presets.GEMS, **presets.OTHERS}.items():
            curve = presets.eta(name)
            self.assertAlmostEqual(numpy.interp(587.6, curve["nm"], curve["values"]), index, places=3, msg=name)
        curve = presets.of_abbe_number(1.6, 30)
        d, f, c = (numpy.interp(nm, curve["nm"], curve["values"]) for nm in (587.6, 486.1, 656.3))
        self.assertAlmostEqual((d - 1) / (f - c), 30, delta=0.2)
        means = {}
        for name, kind, members in (("glass", GLASS, {}), ("diamond", GLASS, {"glass": "DIAMOND"}),
                                    ("flint", GLASS, {"glass": "LASF9", "film_thickness": 500}),
                                    ("copper", GLOSSY, {"metal": "Cu"})):
            def make():
                material = stage.node_material("test", kind, Roughness=0.0)
                for member, value in members.items():
                    setattr(material.lanthorn, member, value)
                return material
            self.build(make)
            picture = stage.render("LANTHORN", method="path", noise=0, seconds=0, passes=6, spectral=True)
            means[name] = picture[24:52, 20:44, :3].mean(axis=(0, 1))
        self.assertGreater(abs(means["diamond"] - means["glass"]).max(), 0.02)
        self.assertGreater(abs(means["flint"] - means["glass"]).max(), 0.02)
        self.assertGreater(means["copper"][0], 1.2 * means["copper"][2])


if __name__ == "__main__":
    stage.enable_addon()
    unittest.main(argv=["test_materials", *(["MaterialTest.test_each"] if ONLY else [])])
