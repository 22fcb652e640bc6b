# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Volumes of grids: an OpenVDB file, and the smoke of a fluid domain. Compares means with Cycles."""
import math
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bpy
import numpy
import stage

TOLERANCE = 0.03     # of the mean of the picture
OF_BLOCKS = 0.03     # the largest difference of blocks of 16 × 16 pixels, of the mean of the picture
FOLDER = sys.argv[sys.argv.index("--") + 1] if sys.argv[-1] != "--" and "--" in sys.argv else None


def principled_volume(**inputs):
    material = stage.node_material("smoke", "ShaderNodeVolumePrincipled",
                                   **{key.replace("_", " "): value for key, value in inputs.items()})
    nodes, links = material.node_tree.nodes, material.node_tree.links
    output, shader = (next(n for n in nodes if n.type == kind) for kind in ("OUTPUT_MATERIAL", "PRINCIPLED_VOLUME"))
    links.clear()
    links.new(shader.outputs[0], output.inputs["Volume"])
    return material


class VolumeTest(unittest.TestCase):
    def setUp(self):
        scene = stage.empty_scene(64, 64)
        stage.add_camera((0, -4, 1.2), (math.radians(80), 0, 0), lens=50)
        stage.add_plane(size=12, material=stage.diffuse("floor", (0.4, 0.4, 0.4)))
        scene.world.color = (0.3, 0.35, 0.4)
        stage.add_light("AREA", 300, (2, -3, 4), (0.6, 0.35, 0), size=1)

    def compare(self, name, bounces=16, passes=96, of_blocks=OF_BLOCKS):
        cycles = stage.render("CYCLES", samples=128, max_bounces=bounces, volume_bounces=bounces, volume_step_rate=0.3)
        # In fog without end, paths are long: they are cut after as many scatterings as in Cycles.
        depth = bounces + 1 if bounces < 16 else 0
        ours = stage.render("LANTHORN", method="path", noise=0, seconds=0, passes=passes, max_depth=depth)
        if FOLDER:
            stage.save_png(os.path.join(FOLDER, f"{name}.png"), cycles, ours)
        mean = cycles[:, :, :3].mean()
        blocks = [p[:, :, :3].reshape(4, 16, 4, 16, 3).mean(axis=(1, 3)) for p in (cycles, ours)]
        worst = abs(blocks[1] - blocks[0]).max() / mean
        print(f"{name}: lanthorn / cycles {ours[:, :, :3].mean() / mean:.4f}; blocks differ by up to {worst:.4f}", flush=True)
        self.assertAlmostEqual(ours[:, :, :3].mean() / mean, 1, delta=TOLERANCE)
        self.assertLess(worst, of_blocks)
        return ours

    def test_openvdb(self):
        from lanthorn import volumes
        vdb = volumes.openvdb_module()
        if vdb is None:
            self.skipTest("Blender's Python has no module of OpenVDB (python3-openvdb)")
        z, y, x = numpy.mgrid[0:24, 0:16, 0:20].astype(numpy.float32)
        # Denser towards one corner, so that a mirrored or turned grid is noticed.
        density = numpy.maximum(0, 1 - ((x - 10)**2 / 100 + (y - 8)**2 / 64 + (z - 12)**2 / 144)) * (1 + x / 5 + z / 8)
        grid = vdb.FloatGrid()
        grid.copyFromArray(numpy.ascontiguousarray(density.transpose(2, 1, 0)))
        grid.name, grid.transform = "density", vdb.createLinearTransform(voxelSize=0.08)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "cloud.vdb")
            vdb.write(path, grids=[grid])
            volume = bpy.data.volumes.new("cloud")
            volume.filepath = path
            volume.materials.append(principled_volume(Color=(0.8, 0.6, 0.4, 1), Density=2.0))
            empty = self.compare_without(lambda: self.compare("openvdb"), stage.link("cloud", volume, location=(-0.8, -0.5, 0.1)))
            self.assertGreater(empty, 0.05)

    def compare_without(self, compare, object):
        """How much the object changes the picture."""
        seen = compare()
        bpy.data.objects.remove(object)
        without = stage.render("LANTHORN", method="path", noise=0, seconds=0, passes=24)
        return abs(seen - without)[16:48, 16:48, :3].mean() / without[:, :, :3].mean()

    def world_volume(self, kind, **inputs):
        """Fills the world with a volume."""
        world = bpy.context.scene.world
        world.use_nodes = True
        nodes, links = world.node_tree.nodes, world.node_tree.links
        shader = nodes.new(kind)
        for name, value in inputs.items():
            shader.inputs[name].default_value = value
        links.new(shader.outputs[0], next(n for n in nodes if n.type == "OUTPUT_WORLD").inputs["Volume"])

    def test_volume_of_the_world(self):
        """Fog fills everything: also another fog. The sky and suns are dark behind it. Both fogs have the same anisotropy:
        otherwise Cycles 3.4 is too bright where they overlap (by 18 % in blue with 0.03 beside 0)."""
        self.world_volume("ShaderNodeVolumeScatter", Color=(0.9, 0.7, 0.4, 1), Density=0.12, Anisotropy=0.0)
        stage.add_light("SUN", 3, rotation=(0.5, 0.3, 0))
        stage.add_ball(0.5, (0.7, 0, 0.5), principled_volume(Color=(0.3, 0.6, 0.9, 1), Density=1.0))
        self.compare("world-volume", bounces=4, passes=96, of_blocks=2 * OF_BLOCKS)

    def test_hot_volumes(self):
        """The black body of a Principled Volume."""
        stage.add_ball(0.7, (0, 0, 0.7), principled_volume(Color=(0.5, 0.5, 0.5, 1), Density=0.4, Blackbody_Intensity=0.05,
                                                          Temperature=2500.0, Blackbody_Tint=(1, 0.9, 0.8, 1)))
        self.compare("hot")

    def test_smoke_of_a_fluid_domain(self):
        with tempfile.TemporaryDirectory() as folder:
            material = principled_volume(Color=(0.7, 0.7, 0.8, 1), Density=6.0)
            mesh = bpy.data.meshes.new("domain")
            mesh.from_pydata([(i & 1, i >> 1 & 1, i >> 2) for i in range(8)], [],
                             [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)])
            mesh.materials.append(material)
            domain = stage.link("domain", mesh, location=(-0.6, -0.6, 0.05))
            domain.scale = (1.2, 1.2, 1.5)
            source = stage.add_ball(0.25, (-0.15, 0, 0.35), stage.diffuse("source"))
            source.hide_render = True
            fluid = domain.modifiers.new("fluid", "FLUID")
            fluid.fluid_type = "DOMAIN"
            fluid.domain_settings.resolution_max, fluid.domain_settings.cache_directory = 24, folder
            fluid.domain_settings.cache_type, fluid.domain_settings.cache_frame_end = "ALL", 8
            flow = source.modifiers.new("fluid", "FLUID")
            flow.fluid_type = "FLOW"
            flow.flow_settings.flow_type, flow.flow_settings.flow_behavior = "SMOKE", "INFLOW"
            with bpy.context.temp_override(object=domain, active_object=domain):
                bpy.ops.fluid.bake_all()
            bpy.context.scene.frame_set(8)
            changed = self.compare_without(lambda: self.compare("fluid"), domain)
            self.assertGreater(changed, 0.05)


if __name__ == "__main__":
    stage.enable_addon()
    arguments = sys.argv[sys.argv.index("--") + 2:] if "--" in sys.argv else []
    unittest.main(argv=["test_volumes", *arguments])
