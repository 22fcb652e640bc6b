# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Final renders: a caustic of glass, passes, border, cameras, instances, animation, errors."""
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
        # The caustic of the ball is several times as bright as the floor around it.
        self.assertGreater(numpy.quantile(ours[:, :, 1], 0.998), 3 * numpy.median(ours[:, :, 1]))


    def compare_blocks(self, name, tolerance=0.03, blocks=6, **settings):
        """Compares the means of blocks between the pictures of both engines."""
        cycles = stage.render("CYCLES", samples=64, max_bounces=0)
        ours = stage.render("LANTHORN", method="path", max_depth=1, noise=0, seconds=0, passes=64, **settings)
        self.assertEqual(cycles.shape, ours.shape)
        means = [p[:p.shape[0] // blocks * blocks, :p.shape[1] // blocks * blocks, :3]
                 .reshape(blocks, p.shape[0] // blocks, blocks, p.shape[1] // blocks, 3).mean(axis=(1, 3))
                 for p in (cycles, ours)]
        worst = abs(means[1] - means[0]).max() / cycles[:, :, :3].mean()
        print(f"{name}: largest difference of blocks {worst:.4f} of the mean")
        if FOLDER:
            stage.save_png(os.path.join(FOLDER, f"{name}.png"), cycles, ours)
        self.assertLess(worst, tolerance)
        return cycles, ours

    def blocks_in_the_sky(self):
        """Cubes of several colours, so that a rotated, mirrored or shifted picture is noticed."""
        scene = stage.empty_scene(96, 60)
        scene.world.color = (0.8, 0.8, 0.8)
        stage.add_plane(size=6)
        for i, color in enumerate([(0.8, 0.1, 0.1), (0.1, 0.8, 0.1), (0.1, 0.1, 0.8)]):
            cube = stage.add_ball(0.4, (i - 1, 0.3 * i, 0.4), stage.diffuse(f"c{i}", color), is_smooth=False)
            cube.scale = (1, 1 + 0.3 * i, 1)
        return scene

    def test_cameras(self):
        cameras = {"perspective": {"lens": 35}, "shift": {"lens": 35, "shift_x": 0.2, "shift_y": -0.1},
                   "vertical": {"lens": 35, "sensor_fit": "VERTICAL", "sensor_height": 20},
                   "orthographic": {"type": "ORTHO", "ortho_scale": 4}}
        for name, members in cameras.items():
            with self.subTest(name):
                self.blocks_in_the_sky()
                stage.add_camera((0.5, -4, 2), (math.radians(65), 0.1, 0.1), **members)
                self.compare_blocks(f"camera-{name}")

    def test_depth_of_field(self):
        self.blocks_in_the_sky()
        camera = stage.add_camera((0, -3, 1), (math.radians(75), 0, 0), lens=50).data
        camera.dof.use_dof, camera.dof.aperture_fstop, camera.dof.focus_distance = True, 0.1, 3
        self.compare_blocks("depth-of-field")

    def test_border_percentage_and_aspect(self):
        render = self.blocks_in_the_sky().render
        stage.add_camera((0.5, -4, 2), (math.radians(65), 0, 0), lens=35)
        render.use_border, render.use_crop_to_border = True, True
        render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.8, 0.1, 0.7
        render.resolution_percentage = 150
        render.pixel_aspect_x = 1.5
        self.compare_blocks("border")
        render.use_crop_to_border = False
        self.compare_blocks("border-in-whole")

    def test_instances_and_modifiers(self):
        self.blocks_in_the_sky()
        stage.add_camera((0.5, -4, 2), (math.radians(65), 0, 0), lens=30)
        collection = bpy.data.collections.new("pair")
        for name in ("c0", "c2"):
            ball = stage.add_ball(0.15, ({"c0": 0, "c2": 0.4}[name], 0, 0.2), stage.diffuse(f"i{name}", (0.9, 0.9, 0.1)))
            bpy.context.scene.collection.objects.unlink(ball)
            collection.objects.link(ball)
        for i in range(2):
            empty = stage.link(f"instance{i}", None, location=(i - 1, -1.2, 0))
            empty.instance_type, empty.instance_collection = "COLLECTION", collection
            empty.scale = (1 + i, 1, 1)
        bevel = bpy.data.objects["plane"].modifiers.new("array", "ARRAY")
        bevel.count, bevel.relative_offset_displace = 2, (0, 1.1, 0.3)
        self.compare_blocks("instances")

    def test_instances_of_several_meshes_of_one_object(self):
        """As geometry nodes make them: cubes and balls in turn."""
        self.blocks_in_the_sky()
        stage.add_camera((0.5, -4, 2), (math.radians(65), 0, 0), lens=30)
        tree = bpy.data.node_groups.new("row", "GeometryNodeTree")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
        line, place, to_instance, cube, ball, end = (tree.nodes.new(kind) for kind in (
            "GeometryNodeMeshLine", "GeometryNodeInstanceOnPoints", "GeometryNodeGeometryToInstance", "GeometryNodeMeshCube",
            "GeometryNodeMeshUVSphere", "NodeGroupOutput"))
        line.inputs["Count"].default_value = 5
        line.inputs["Start Location"].default_value, line.inputs["Offset"].default_value = (-1.4, -0.8, 0.3), (0.7, 0, 0)
        cube.inputs["Size"].default_value, ball.inputs["Radius"].default_value = (0.4, 0.4, 0.4), 0.3
        for shape in (ball, cube):
            tree.links.new(shape.outputs["Mesh"], to_instance.inputs[0])
        tree.links.new(line.outputs["Mesh"], place.inputs["Points"])
        tree.links.new(to_instance.outputs[0], place.inputs["Instance"])
        place.inputs["Pick Instance"].default_value = True
        tree.links.new(place.outputs[0], end.inputs[0])
        row = stage.link("row", bpy.data.meshes.new("row"))
        row.modifiers.new("nodes", "NODES").node_group = tree
        self.compare_blocks("geometry-nodes")

    def hairy_ball(self, parametrization):
        stage.empty_scene(64, 64).world.color = (0.7, 0.7, 0.7)
        stage.add_camera((0, -4, 0.3), (math.radians(88), 0, 0), lens=50)
        stage.add_light("SUN", 3, rotation=(0.7, 0.3, 0.2), angle=0)
        ball = stage.add_ball(0.6, (0, 0, 0), stage.diffuse("skin", (0.5, 0.3, 0.2)))
        material = stage.node_material("hair", "ShaderNodeBsdfHairPrincipled")
        next(n for n in material.node_tree.nodes if n.type == "BSDF_HAIR_PRINCIPLED").parametrization = parametrization
        ball.data.materials.append(material)
        ball.modifiers.new("hair", "PARTICLE_SYSTEM")
        settings = ball.particle_systems[0].settings
        settings.type, settings.count, settings.hair_length, settings.hair_step = "HAIR", 800, 0.5, 4
        settings.material, settings.render_step = 2, 3
        settings.root_radius, settings.tip_radius, settings.radius_scale = 1.0, 0.5, 0.03

    def test_hair(self):
        for parametrization, tolerance in (("COLOR", 0.05), ("MELANIN", 0.05)):
            self.hairy_ball(parametrization)
            cycles = stage.render("CYCLES", samples=48)
            ours = stage.render("LANTHORN", method="path", noise=0, seconds=0, passes=48)
            if FOLDER:
                stage.save_png(os.path.join(FOLDER, f"hair-{parametrization.lower()}.png"), cycles, ours)
            ratio = ours[:, :, :3].mean() / cycles[:, :, :3].mean()
            middle = [p[16:48, 16:48, :3].mean(axis=(0, 1)) for p in (cycles, ours)]
            print(f"hair {parametrization}: lanthorn / cycles {ratio:.4f}; of the middle {middle[1] / middle[0]}")
            self.assertAlmostEqual(ratio, 1, delta=tolerance)

    def test_hair_has_the_colours_of_its_roots(self):
        self.hairy_ball("COLOR")
        mesh, image = bpy.data.objects["ball"].data, bpy.data.images.new("halves", 8, 8)
        layer = mesh.uv_layers.new()
        for loop, uv in zip(mesh.loops, layer.data):
            uv.uv = (0.5 + 0.6 * mesh.vertices[loop.vertex_index].co.x, 0.5)
        pixels = numpy.ones((8, 8, 4), dtype=numpy.float32)
        pixels[:, :4, :3], pixels[:, 4:, :3] = (0.9, 0.2, 0.1), (0.1, 0.3, 0.9)
        image.pixels.foreach_set(pixels.ravel())
        for material in mesh.materials[0], mesh.materials[1]:
            nodes, links = material.node_tree.nodes, material.node_tree.links
            texture = nodes.new("ShaderNodeTexImage")
            texture.image = image
            shader = next(n for n in nodes if n.type in {"BSDF_DIFFUSE", "BSDF_HAIR_PRINCIPLED"})
            links.new(texture.outputs["Color"], shader.inputs["Color"])
        cycles = stage.render("CYCLES", samples=48)
        ours = stage.render("LANTHORN", method="path", noise=0, seconds=0, passes=48)
        if FOLDER:
            stage.save_png(os.path.join(FOLDER, "hair-roots.png"), cycles, ours)
        for name, columns in (("left", slice(12, 28)), ("right", slice(36, 52))):
            means = [p[16:48, columns, :3].mean(axis=(0, 1)) for p in (cycles, ours)]
            print(f"hair, {name}: lanthorn / cycles {means[1] / means[0]}", flush=True)
            self.assertLess(abs(means[1] / means[0] - 1).max(), 0.1)

    def render_pass(self, engine, name):
        """Makes the compositor show a pass as the picture."""
        scene = bpy.context.scene
        scene.render.engine, scene.use_nodes = engine, True
        nodes, links = scene.node_tree.nodes, scene.node_tree.links
        nodes.clear()
        layers, output = nodes.new("CompositorNodeRLayers"), nodes.new("CompositorNodeComposite")
        links.new(layers.outputs[name], output.inputs["Image"])
        return stage.render(engine, **({"samples": 16} if engine == "CYCLES" else
                                       {"method": "path", "passes": 16, "noise": 0, "seconds": 0}))

    def test_passes_are_those_of_cycles(self):
        self.blocks_in_the_sky()
        stage.add_camera((0.5, -4, 2), (math.radians(65), 0, 0), lens=30)
        layer = bpy.context.view_layer
        layer.use_pass_z = layer.use_pass_normal = layer.use_pass_position = True
        for name in ("Depth", "Normal", "Position"):
            with self.subTest(name):
                cycles, ours = (self.render_pass(e, name)[40:56, 4:92, :3] for e in ("CYCLES", "LANTHORN"))  # the floor
                print(f"pass {name}: cycles {cycles.mean(axis=(0, 1))}, lanthorn {ours.mean(axis=(0, 1))}")
                self.assertLess(abs(cycles - ours).mean(), 0.03)
        caustic = self.render_pass("LANTHORN", "Caustic")
        self.assertEqual(abs(caustic[:, :, :3]).max(), 0)  # there is no glass

    def test_animation_and_view_layers(self):
        scene = self.blocks_in_the_sky()
        stage.add_camera((0, -4, 2), (math.radians(65), 0, 0), lens=30)
        plane = bpy.data.objects["plane"]
        for frame, z in ((1, 0), (2, -3)):
            plane.location.z = z
            plane.keyframe_insert("location", frame=frame)
        scene.frame_start, scene.frame_end = 1, 2
        scene.view_layers.new("second")
        scene.render.engine = "LANTHORN"
        scene.lanthorn.passes, scene.lanthorn.noise, scene.lanthorn.method = 4, 0, "path"
        scene.render.image_settings.file_format = "OPEN_EXR"
        import tempfile
        with tempfile.TemporaryDirectory() as folder:
            scene.render.filepath = os.path.join(folder, "f")
            bpy.ops.render.render(animation=True)
            names = sorted(os.listdir(folder))
            self.assertEqual(names, ["f0001.exr", "f0002.exr"])
            first, second = (stage.read_picture(os.path.join(folder, n)) for n in names)
        self.assertGreater(abs(first - second).mean(), 0.02)

    def test_motion_blur(self):
        scene = self.blocks_in_the_sky()
        camera = stage.add_camera((0, -4, 2), (math.radians(65), 0, 0), lens=30)
        for thing, axis, places in ((bpy.data.objects["ball"], 2, (0.2, 1.4)), (camera, 0, (-0.3, 0.5))):
            for frame, place in zip((1, 3), places):
                thing.location[axis] = place
                thing.keyframe_insert("location", frame=frame)
            for curve in thing.animation_data.action.fcurves:
                for key in curve.keyframe_points:
                    key.interpolation = "LINEAR"
        scene.frame_set(2)
        scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.8
        self.compare_blocks("motion-blur")

    def test_objects_that_the_camera_does_not_see(self):
        """They cast shadows and are seen in mirrors, as in Cycles."""
        self.blocks_in_the_sky()
        stage.add_camera((0, -4, 2), (math.radians(65), 0, 0), lens=30)
        stage.add_light("SUN", 2, rotation=(0.5, 0.3, 0), angle=0)
        bpy.data.objects["ball"].visible_camera = False
        hidden = self.compare_blocks("hidden")[1]
        bpy.data.objects["ball"].visible_camera = True
        self.assertGreater(abs(hidden - self.compare_blocks("visible")[1]).mean(), 0.008)

    def exported(self):
        """Returns the parts of the scene, and what is noted about them."""
        from lanthorn.scene_export import SceneExport
        export = SceneExport()
        self.addCleanup(export.close)
        return export.parts(bpy.context.evaluated_depsgraph_get()), export.report.lines()

    def test_curves_texts_and_metaballs_are_exported_once(self):
        """The depsgraph shows their meshes, too. Particles instance curves without a mesh, which Cycles does not draw."""
        stage.empty_scene(16, 16)
        text = bpy.data.curves.new("text", "FONT")
        text.body, text.extrude = "A", 0.1
        source = stage.link("text", text)
        bpy.ops.object.metaball_add()
        plane = stage.add_plane()
        plane.modifiers.new("crowd", "PARTICLE_SYSTEM")
        settings = plane.particle_systems[0].settings
        settings.type, settings.count, settings.render_type, settings.instance_object = "HAIR", 5, "OBJECT", source
        parts, _ = self.exported()
        self.assertEqual(len(parts["instances"]), 3, parts["instances"].keys())

    def test_uv_maps_survive_geometry_nodes(self):
        """Blender 3.4 turns UV maps into attributes when nodes realize instances."""
        stage.empty_scene(16, 16)
        source, target = stage.add_plane(), stage.add_plane()
        source.hide_render = True
        tree = bpy.data.node_groups.new("realized", "GeometryNodeTree")
        info, realize, end = (tree.nodes.new(kind) for kind in ("GeometryNodeObjectInfo", "GeometryNodeRealizeInstances",
                                                              "NodeGroupOutput"))
        tree.outputs.new("NodeSocketGeometry", "Geometry")
        info.inputs["Object"].default_value, info.inputs["As Instance"].default_value = source, True
        tree.links.new(info.outputs["Geometry"], realize.inputs[0])
        tree.links.new(realize.outputs[0], end.inputs[0])
        target.modifiers.new("nodes", "NODES").node_group = tree
        self.assertFalse(len(target.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.uv_layers))
        shapes = [shape for made in self.exported()[0]["objects"].values() for shape in made["shapes"]]
        self.assertTrue(all(numpy.ptp(shape["uvs"]) == 1 for shape in shapes), shapes)

    def test_what_is_not_supported_is_named(self):
        self.blocks_in_the_sky()
        ball = bpy.data.objects["ball"]
        ball.visible_glossy, ball.is_shadow_catcher = False, True
        stage.add_light("SPOT", 10, (0, 0, 3), shadow_soft_size=0.1).visible_camera = True
        ball.lightgroup = "key"
        notes = "\n".join(self.exported()[1])
        for text in ("of Ray Visibility, only Camera", "shadow catchers", "spot lights are never visible", "light groups"):
            self.assertIn(text, notes)

    def test_errors_name_what_to_do(self):
        scene = self.blocks_in_the_sky()
        scene.render.engine = "LANTHORN"
        stage.add_camera((0, -4, 2), (math.radians(65), 0, 0), lens=30)
        path = os.environ["PATH"]
        try:
            os.environ["PATH"] = "/nowhere"
            with self.assertRaisesRegex(RuntimeError, "lanthorn was not found on the PATH"):
                bpy.ops.render.render()
        finally:
            os.environ["PATH"] = path
        scene.camera = None
        with self.assertRaisesRegex(RuntimeError, "[Nn]o camera"):
            bpy.ops.render.render()

    def test_the_program_killed_leaves_blender_alive(self):
        import signal
        import threading
        scene = self.blocks_in_the_sky()
        stage.add_camera((0, -4, 2), (math.radians(65), 0, 0), lens=30)
        scene.render.engine = "LANTHORN"
        scene.lanthorn.passes, scene.lanthorn.noise, scene.lanthorn.seconds = 0, 0, 60

        def kill_child():
            for name in os.listdir("/proc"):
                try:
                    with open(f"/proc/{name}/stat") as stat:
                        fields = stat.read().rsplit(")", 1)
                except (OSError, NotADirectoryError):
                    continue
                if name.isdigit() and int(fields[1].split()[1]) == os.getpid() and "lanthorn" in fields[0]:
                    os.kill(int(name), signal.SIGKILL)

        timer = threading.Timer(4, kill_child)
        timer.start()
        with self.assertRaisesRegex(RuntimeError, "the program has ended: killed by signal 9"):
            bpy.ops.render.render()
        timer.join()


if __name__ == "__main__":
    stage.enable_addon()
    arguments = sys.argv[sys.argv.index("--") + 2:] if "--" in sys.argv else []
    unittest.main(argv=["test_render", *arguments])
