# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the Python module through its public interface: python3 test_lanthorn.py, with the module on PYTHONPATH."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

import lanthorn

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("LANTHORN_PROGRAM", SOURCE / "build/release/bin/lanthorn")
CORNELL = SOURCE / "scenes/cornell-caustics.pbrt"
SMALL = {"resolution": (32, 32), "passes": 2, "integrator": "path"}


def furnace(albedo=0.5, light=0.5):
    """The inside of a sphere that emits and reflects: L = light / (1 - albedo) everywhere, in all directions."""
    return {
        "camera": {"type": "perspective", "fov": 60},
        "film": {"width": 16, "height": 16},
        "materials": [{"type": "diffuse", "reflectance": 0.5}, {"type": "diffuse", "reflectance": albedo, "name": "wall"}],
        "area_lights": [{"radiance": [light, light, light]}],
        "shapes": [{"type": "sphere", "radius": 2, "material": "wall", "area_light": 0, "reverse_orientation": True}],
    }


def floor_and_lamp():
    return {
        "camera": {"camera_to_world": lanthorn.look_at((0, 3, 4), (0, 0, 0)), "fov": 40},
        "film": {"width": 24, "height": 16},
        "materials": [{"type": "diffuse", "reflectance": [0.2, 0.4, 0.8], "name": "floor"}],
        "shapes": [
            {
                "type": "triangles",
                "positions": np.array([[-2, 0, -2], [2, 0, -2], [2, 0, 2], [-2, 0, 2]], dtype=float),
                "triangles": [[0, 2, 1], [0, 3, 2]],
            }
        ],
        "lights": [{"type": "point", "intensity": {"spectrum": [1, 1, 1], "scale": 10}, "from": [0, 2, 0]}],
    }


class Loading(unittest.TestCase):
    def test_same_bytes_as_the_program(self):
        picture = lanthorn.render(lanthorn.load_file(CORNELL), seed=3, **SMALL)
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/a.exr"
            subprocess.run(
                [PROGRAM, "render", CORNELL, "-o", path, "-r", "32x32", "-p", "2", "-i", "path", "--seed", "3", "-q"],
                check=True,
            )
            program = lanthorn.load_image(path)
        # The program's files have noise layers as well.
        columns = [program.channels.index(channel) for channel in picture.channels]
        np.testing.assert_array_equal(picture.array, program.array[..., columns])

    def test_errors_have_a_place(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "bad.pbrt"
            path.write_text('Camera "perspective"\nWorldBegin\n  Shape "sphere" "float radius" [ wide ]\n')
            with self.assertRaises(lanthorn.Error) as caught:
                lanthorn.load_file(path)
        self.assertTrue(caught.exception.file.endswith("bad.pbrt"))
        self.assertEqual(caught.exception.line, 3)
        self.assertGreater(caught.exception.column, 1)
        self.assertIn("bad.pbrt:3:", str(caught.exception))

    def test_dict_is_a_furnace(self):
        picture = lanthorn.render(lanthorn.load_dict(furnace()), passes=64, integrator="path")
        np.testing.assert_allclose(picture["color"].mean(), 1, atol=0.03)

    def test_errors_of_dicts_have_a_path(self):
        def message_of(change):
            data = floor_and_lamp()
            change(data)
            with self.assertRaises(lanthorn.Error) as caught:
                lanthorn.load_dict(data)
            return str(caught.exception)

        self.assertIn(
            "shapes[0].triangles: expected whole numbers of shape (n, 3)",
            message_of(lambda d: d["shapes"][0].update(triangles=[[0.5, 1, 2]])),
        )
        self.assertIn("did you mean reflectance", message_of(lambda d: d["materials"][0].update(reflectence=1)))
        self.assertIn(
            "materials[0].type: expected one of 'diffuse'", message_of(lambda d: d["materials"][0].update(type="difuse"))
        )
        self.assertIn('no entry named "flor"', message_of(lambda d: d["shapes"][0].update(material="flor")))
        self.assertIn("lights[0].from: expected 3 numbers", message_of(lambda d: d["lights"][0].update({"from": [1, 2]})))
        self.assertIn("film.width: expected a whole number", message_of(lambda d: d["film"].update(width="wide")))
        self.assertIn(
            'shapes[0].area_light: expected an entry of "area_lights", by its index or name, got {',
            message_of(lambda d: d["shapes"][0].update(area_light={"radiance": [1, 1, 1]})),
        )

    def test_description_goes_round(self):
        data = floor_and_lamp()
        scene = lanthorn.load_dict(data)
        again = scene.description
        again["shapes"] = data["shapes"]  # built scenes have no meshes
        np.testing.assert_array_equal(
            lanthorn.render(scene, **SMALL)["color"], lanthorn.render(lanthorn.load_dict(again), **SMALL)["color"]
        )

    def test_files_of_every_kind_of_entry_go_round(self):
        """All members of all materials, lights, textures ... of a scene survive being written and read."""
        for name in ("materials", "lights", "textures", "media", "shapes", "emitters", "realistic-camera"):
            with self.subTest(name):
                data = lanthorn.load_file(SOURCE / f"tests/scenes/{name}.pbrt").description
                data["shapes"], data["objects"], data["instances"] = [], [], []
                if any(m["type"] == "measured" for m in data["materials"]):
                    continue
                again = lanthorn.load_dict(data).description
                self.assertEqual(repr(data), repr(again))

    def test_environment_by_name(self):
        scene = lanthorn.load_dict({**floor_and_lamp(), "environment": {"source": "studio", "rotation": 20}})
        bare = lanthorn.load_dict(floor_and_lamp())
        self.assertGreater(np.asarray(lanthorn.render(scene, **SMALL)).mean(), np.asarray(lanthorn.render(bare, **SMALL)).mean())
        with self.assertRaises(lanthorn.Error):
            lanthorn.load_dict({**floor_and_lamp(), "environment": "nowhere"})
        with self.assertRaisesRegex(lanthorn.Error, "environment.up: expected one of 'y', 'z', got 'x'"):
            lanthorn.load_dict({**floor_and_lamp(), "environment": {"source": "studio", "up": "x"}})


class Pictures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.picture = lanthorn.render(lanthorn.load_file(CORNELL), **SMALL)

    def test_arrays_share_memory(self):
        color = self.picture["color"]
        self.assertEqual(color.shape, (32, 32, 3))
        self.assertEqual(color.dtype, np.float32)
        self.assertTrue(np.shares_memory(color, self.picture.array))
        self.assertTrue(np.shares_memory(color, np.asarray(self.picture)))
        self.assertFalse(color.flags.writeable)
        self.assertEqual(self.picture["depth"].shape, (32, 32))
        self.assertEqual(self.picture["normal"].shape, (32, 32, 3))

    def test_arrays_outlive_the_picture(self):
        color = lanthorn.render(lanthorn.load_file(CORNELL), **SMALL)["color"]
        np.testing.assert_array_equal(color, self.picture["color"])

    def test_layers_are_those_of_their_channels(self):
        channels = self.picture.channels
        self.assertIn("caustic", self.picture)
        for i, c in enumerate("RGB"):
            np.testing.assert_array_equal(
                self.picture["caustic"][..., i], self.picture.array[..., channels.index(f"caustic.{c}")]
            )
        light = sum(self.picture[name] for name in ("emission", "direct", "indirect", "caustic"))
        np.testing.assert_allclose(light, self.picture["color"], rtol=1e-4, atol=1e-5)
        with self.assertRaisesRegex(lanthorn.Error, "did you mean caustic"):
            self.picture["caustics"]

    def test_notebooks_show_them(self):
        html = lanthorn.load_file(CORNELL)._repr_html_()
        self.assertIn("triangles", html)
        self.assertTrue(html.startswith("<table>") and html.endswith("</table>"))
        self.assertEqual(self.picture._repr_png_()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(self.picture._repr_png_(), self.picture.png())
        self.assertNotEqual(self.picture.png(exposure=1), self.picture.png())
        methods = lanthorn.methods()
        self.assertEqual(methods._repr_html_().count("<tr>"), len(methods))
        vcm = next(m for m in methods if m["name"] == "vcm")
        self.assertEqual(vcm._repr_html_().count("<tr>"), len(vcm["parameters"]))
        self.assertNotIn("<b>", lanthorn.Method(vcm, summary="<b>")._repr_html_().replace("<b>vcm</b>", ""))

    def test_objects_say_what_they_are(self):
        scene = lanthorn.load_file(CORNELL)
        width, height = scene.resolution
        self.assertRegex(repr(scene), rf"^<lanthorn.Scene {width} x {height}, \d+ triangles, .*lights: 1 area, materials: \d")
        session = lanthorn.Session(scene, integrator="path", passes=3, resolution=(8, 8))
        session.render(passes=1)
        self.assertEqual(repr(session), "<lanthorn.Session path, 1 of 3 passes>")
        self.assertIn("<lanthorn.Session auto, 0 of", repr(lanthorn.Session(scene, resolution=(8, 8))))
        vcm = next(m for m in lanthorn.methods() if m["name"] == "vcm")
        self.assertEqual(repr(vcm), f"<lanthorn.Method vcm: {vcm['summary']}>")

    def test_arrays_become_pictures(self):
        array = np.linspace(0, 1, 60, dtype=np.float64).reshape(4, 5, 3)
        picture = lanthorn.Picture(array)
        self.assertEqual((picture.width, picture.height, picture.layers), (5, 4, ["color"]))
        np.testing.assert_array_equal(picture["color"], array.astype(np.float32))
        with self.assertRaisesRegex(lanthorn.Error, "names"):
            lanthorn.Picture(np.zeros((2, 2, 4)))

    def test_compare(self):
        zero = lanthorn.compare(self.picture, self.picture)
        self.assertEqual((zero["mse"], zero["flip"]), (0, 0))
        twice = lanthorn.compare(lanthorn.Picture(2 * self.picture["color"]), self.picture)
        np.testing.assert_allclose(twice["mse"], (self.picture["color"].astype(float) ** 2).mean(), rtol=1e-5)
        np.testing.assert_allclose(twice["mean_ratio"], 2, rtol=1e-6)


class Sessions(unittest.TestCase):
    def setUp(self):
        self.scene = lanthorn.load_file(CORNELL)

    def test_passes_are_those_of_one_render(self):
        session = lanthorn.Session(self.scene, **SMALL)
        counts = [session.pass_count for _ in session.passes(2)]
        self.assertEqual(counts, [1, 2])
        np.testing.assert_array_equal(session.picture().array, lanthorn.render(self.scene, **SMALL).array)

    def test_threads_change_nothing(self):
        # In a process of its own, because the limit holds for the whole process; it must end without an error.
        script = (
            "import lanthorn, sys\nlanthorn.set_threads(1)\n"
            f"picture = lanthorn.render(lanthorn.load_file({str(CORNELL)!r}), resolution=(32, 32), passes=2, integrator='path')\n"
            "sys.stdout.buffer.write(picture['color'].tobytes())"
        )
        alone = subprocess.run([sys.executable, "-c", script], stdout=subprocess.PIPE, check=True).stdout
        self.assertEqual(alone, lanthorn.render(self.scene, **SMALL)["color"].tobytes())

    def test_limits(self):
        session = lanthorn.Session(self.scene, **SMALL)
        session.render(passes=3)
        self.assertEqual(session.pass_count, 3)
        session.render(noise=0.9)
        self.assertLess(session.picture().error.bound, 0.9)
        with self.assertRaisesRegex(lanthorn.Error, "passes: expected a whole number"):
            lanthorn.Session(self.scene, passes="many")

    def test_wrong_options(self):
        scene = lanthorn.load_file(CORNELL)
        for options, message in (
            ({"width": 3}, "width: there is no such option, .*the options are .*resolution"),
            ({"integrator": "path", "sedd": 3}, "sedd: .*did you mean seed"),
            ({"integrator": "probppm", "raduis": 0.1}, "raduis: .*did you mean radius"),
            ({"radius": 0.1}, "'auto' has no parameters"),
            ({"passes": 0}, "expected 1 or more"),
            ({"noise": 5}, "expected a share"),
        ):
            with self.assertRaisesRegex(lanthorn.Error, message):
                lanthorn.Session(scene, **options)

    def test_save_resume_merge(self):
        whole = lanthorn.render(self.scene, **{**SMALL, "passes": 4}).array
        with tempfile.TemporaryDirectory() as folder:
            first = lanthorn.Session(self.scene, **{**SMALL, "passes": 4})
            first.render(passes=2)
            first.save(f"{folder}/a.state")
            second = lanthorn.Session(self.scene, **{**SMALL, "passes": 4})
            second.resume(f"{folder}/a.state")
            self.assertEqual(second.pass_count, 2)
            np.testing.assert_array_equal(second.render().array, whole)

            options = {k: v for k, v in SMALL.items() if k != "passes"}
            shard = lanthorn.Session(self.scene, **options, pass_range=(2, 4))
            shard.render()
            shard.save(f"{folder}/b.state")
            merged = lanthorn.merge([f"{folder}/b.state", f"{folder}/a.state"])
            self.assertEqual((merged.pass_count, merged.passes), (4, [(0, 4)]))
            np.testing.assert_array_equal(merged.picture().array, whole)
            with self.assertRaises(lanthorn.Error):
                lanthorn.merge([f"{folder}/a.state", f"{folder}/a.state"])

    def test_states_of_dicts_can_be_resumed(self):
        with tempfile.TemporaryDirectory() as folder:
            session = lanthorn.Session(lanthorn.load_dict(floor_and_lamp()), **SMALL)
            session.render()
            session.save(f"{folder}/a.state")
            lanthorn.Session(lanthorn.load_dict(floor_and_lamp()), **SMALL).resume(f"{folder}/a.state")
            other = floor_and_lamp()
            other["lights"][0]["from"] = [0, 2, 1]
            with self.assertRaises(lanthorn.Error):
                lanthorn.Session(lanthorn.load_dict(other), **SMALL).resume(f"{folder}/a.state")

    def test_edits(self):
        scene = lanthorn.load_dict(floor_and_lamp())
        session = lanthorn.Session(scene, **SMALL)
        before = session.render()["color"]

        session.scene = scene.edit(lights={"light1": {"intensity": {"scale": 20}}})
        self.assertEqual(session.pass_count, 0)
        np.testing.assert_allclose(session.render()["color"], 2 * before, rtol=1e-3)

        session.scene = scene.edit(materials={"floor": {"reflectance": [0.4, 0.4, 0.8]}})
        ratio = session.render()["color"].mean((0, 1)) / before.mean((0, 1))
        np.testing.assert_allclose(ratio, [2, 1, 1], rtol=1e-3)

        session.scene = scene.look_at((0, 3, 40), (0, 0, 0))
        self.assertLess(session.render()["color"].mean(), 0.2 * before.mean())

        session.scene = scene  # as it was
        np.testing.assert_array_equal(session.render()["color"], before)
        with self.assertRaisesRegex(lanthorn.Error, "index below 1, got 7"):
            scene.edit(materials={7: {}})
        with self.assertRaisesRegex(lanthorn.Error, "unknown key .lamps."):
            scene.edit(lamps={})

    def test_numbers_must_be_finite(self):
        for change, message in (
            (lambda d: d["shapes"][0]["positions"].__setitem__((2, 1), np.nan), "positions.*finite.*entry 2"),
            (lambda d: d["materials"][0].update(reflectance=[0.2, np.inf, 0]), "reflectance.*finite.*entry 1"),
            (lambda d: d["camera"].update(fov=np.nan), "fov: expected a number"),
        ):
            data = floor_and_lamp()
            change(data)
            with self.assertRaisesRegex(lanthorn.Error, message):
                lanthorn.load_dict(data)

    def test_pictures_are_not_mirrored(self):
        data = floor_and_lamp()
        data["camera"] = {"camera_to_world": lanthorn.look_at((0, 5, 0), (0, 0, 0), up=(0, 0, -1)), "fov": 40}
        data["lights"][0].update({"from": [1, 0.5, 0.5]})
        for scene in (lanthorn.load_dict(data), lanthorn.load_dict(data).look_at((0, 6, 0), (0, 0, 0), up=(0, 0, -1))):
            light = lanthorn.render(scene, **SMALL)["color"].sum(-1)
            y, x = np.unravel_index(light.argmax(), light.shape)
            self.assertGreater(x, 16)  # +x is to the right, -z upwards
            self.assertGreater(y, 16)
        with self.assertRaisesRegex(lanthorn.Error, "on one line"):
            lanthorn.look_at((0, 5, 0), (0, 0, 0), up=(0, 2, 0))

    def test_instances_move(self):
        data = floor_and_lamp()
        data["objects"] = [{"name": "ball", "shapes": [{"type": "sphere", "radius": 0.5}]}]
        data["instances"] = [{"object": "ball", "object_to_world": lanthorn.translate((0, 0.5, 0))}]
        scene = lanthorn.load_dict(data)
        ray = ([[-1, 0.5, 5]], [[0, 0, -1]])
        self.assertEqual(lanthorn.intersect(scene, *ray)["distance"][0], np.inf)
        moved = scene.edit(instances={0: lanthorn.translate((-1, 0.5, 0))})
        np.testing.assert_allclose(lanthorn.intersect(moved, *ray)["distance"], [4.5], rtol=1e-5)

    def test_denoised(self):
        scene = lanthorn.load_file(CORNELL)
        options = {"resolution": (48, 48), "integrator": "probppm", "photons": 20000}
        truth = lanthorn.render(scene, passes=64, seed=9, **options)
        session = lanthorn.Session(scene, passes=4, **options)
        noisy = session.render()
        clean = session.denoised()
        error = lambda picture: lanthorn.compare(picture, truth)["rel_mse"]
        self.assertLess(error(clean), error(noisy))
        np.testing.assert_array_equal(lanthorn.denoise(session.picture(noise=True))["color"], clean["color"])
        with self.assertRaises(lanthorn.Error):
            lanthorn.denoise(lanthorn.Picture(noisy["color"]))

    def test_the_interpreter_is_free_meanwhile(self):
        session = lanthorn.Session(self.scene, integrator="path", resolution=(64, 64))
        worker = threading.Thread(target=lambda: session.render(seconds=60))
        worker.start()
        while session.pass_count < 2:  # counts while the other thread renders
            time.sleep(0.001)
        with self.assertRaisesRegex(lanthorn.Error, "another thread"):
            session.picture()
        session.stop()
        worker.join(30)
        self.assertFalse(worker.is_alive())
        self.assertGreaterEqual(session.pass_count, 2)

    def test_ctrl_c_keeps_what_there_is(self):
        session = lanthorn.Session(self.scene, integrator="path", resolution=(64, 64))
        threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            session.render(seconds=60)
        self.assertLess(time.monotonic() - begin, 30)
        done = session.pass_count
        self.assertGreater(done, 0)
        self.assertEqual(session.picture()["color"].shape, (64, 64, 3))
        session.render(passes=1)  # and goes on
        self.assertEqual(session.pass_count, done + 1)

        threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt) as caught:
            lanthorn.render(self.scene, integrator="path", resolution=(64, 64), seconds=60)
        self.assertEqual(caught.exception.picture["color"].shape, (64, 64, 3))


class Light(unittest.TestCase):
    def test_photons(self):
        scene = lanthorn.load_file(CORNELL)
        photons = lanthorn.trace_photons(scene, integrator="probppm", photons=5000)
        n = len(photons)
        self.assertGreater(n, 1000)
        for name, shape in (("positions", (n, 3)), ("directions", (n, 3)), ("powers", (n, 3)), ("depths", (n,)), ("classes", (n,))):
            self.assertEqual(getattr(photons, name).shape, shape)
            self.assertTrue(np.shares_memory(getattr(photons, name), getattr(photons, name)))
        np.testing.assert_allclose(np.linalg.norm(photons.directions, axis=1), 1, atol=1e-2)
        np.testing.assert_array_equal(photons.classes == photons.DIRECT, photons.depths == 1)
        self.assertTrue((photons.classes == photons.CAUSTIC).any())
        again = lanthorn.trace_photons(scene, integrator="probppm", photons=5000, direct=False)
        self.assertEqual(len(again), (photons.depths > 1).sum())

    def test_photons_from_starts_of_ones_own(self):
        scene = lanthorn.load_dict(floor_and_lamp())  # a diffuse floor at y = 0
        generator = np.random.default_rng(3)
        origins = np.column_stack([generator.uniform(-0.5, 0.5, 5000), np.full(5000, 0.5), generator.uniform(-0.5, 0.5, 5000)])
        photons = lanthorn.trace_photons(scene, origins=origins, directions=[0.3, -1, 0], powers=[1, 2, 3], max_depth=2)
        first = photons.depths == 1
        self.assertEqual(photons.light_paths, 5000)
        np.testing.assert_array_equal(photons.starts[first], np.arange(5000))
        np.testing.assert_allclose(photons.positions[first], origins + [0.15, -0.5, 0], atol=1e-5)
        np.testing.assert_allclose(photons.powers[first], np.tile([1, 2, 3], (5000, 1)), rtol=1e-6)
        np.testing.assert_allclose(photons.directions[first], np.tile([-0.3, 1, 0] / np.sqrt(1.09), (5000, 1)), atol=1e-6)
        np.testing.assert_array_equal(photons.classes == photons.DIRECT, first)
        self.assertEqual(len(lanthorn.trace_photons(scene, origins=origins, directions=[0, 1, 0])), 0)

    def test_photons_through_a_lens_of_ones_own(self):
        # A ball of glass bends rays near its axis to the focus at n R / (2 (n - 1)) from its centre.
        scene = lanthorn.load_dict({
            "materials": [{"type": "dielectric", "eta": 1.5}, {"type": "diffuse"}],
            "shapes": [{"type": "sphere", "radius": 1, "material": 0},
                       {"type": "disk", "radius": 3, "material": 1, "object_to_world": lanthorn.translate((0, 0, -1.5))}],
        })
        offsets = np.random.default_rng(4).uniform(-0.05, 0.05, (2000, 2))
        photons = lanthorn.trace_photons(
            scene, origins=np.column_stack([offsets, np.full(2000, 2)]), directions=[0, 0, -1], powers=[0.001] * 3, max_depth=3
        )
        self.assertGreater(len(photons), 1000)
        self.assertTrue((photons.classes == photons.CAUSTIC).all())
        self.assertLess(np.linalg.norm(photons.positions[photons.depths == 3][:, :2], axis=1).max(), 1e-3)
        # Of the power, what is not reflected at both surfaces comes straight through: (1 - .04)^2, drawn by chance.
        self.assertAlmostEqual(photons.powers[photons.depths == 3][:, 0].sum() / 2, 0.96**2, delta=5 * 0.006)

    def test_wrong_starts_of_photons(self):
        scene = lanthorn.load_dict(floor_and_lamp())
        for wrong, message in (
            ({"origins": [0, 1, 0]}, "expected both"),
            ({"powers": [1, 1, 1]}, "expected both"),
            ({"origins": [0, 1, 0], "directions": [0, 0, 0]}, "ray 0: expected"),
            ({"origins": np.zeros((3, 3)), "directions": np.ones((2, 3))}, "equal numbers of rows"),
            ({"origins": [0, 1, 0], "directions": [0, -1, 0], "powers": [1, -1, 1]}, "light path 0: expected a power"),
            ({"origins": [0, 1, 0], "directions": [0, -1, 0], "powers": np.ones((2, 3))}, "powers: expected"),
        ):
            with self.assertRaisesRegex(lanthorn.Error, message):
                lanthorn.trace_photons(scene, **wrong)

    def test_radiance_in_a_furnace(self):
        scene = lanthorn.load_dict(furnace(albedo=0.5, light=0.5))
        generator = np.random.default_rng(1)
        directions = generator.normal(size=(256, 3))
        radiance = lanthorn.radiance_along(scene, [[0.3, -0.2, 0.1]], directions, samples=64)
        self.assertEqual(radiance.shape, (256, 3))
        np.testing.assert_allclose(radiance.mean(), 1, atol=0.03)
        # Without any reflection, radiance along a ray is the emitted radiance.
        dark = lanthorn.load_dict(furnace(albedo=0, light=0.25))
        np.testing.assert_allclose(lanthorn.radiance_along(dark, [[0, 0, 0]], [[0, 3, 0]], samples=1), [[0.25] * 3], rtol=1e-5)
        with self.assertRaisesRegex(lanthorn.Error, "ray 1"):
            lanthorn.radiance_along(scene, [[0, 0, 0], [0, 0, 0]], [[0, 0, 1], [0, 0, 0]])
        with self.assertRaisesRegex(lanthorn.Error, "equal numbers of rows"):
            lanthorn.radiance_along(scene, np.zeros((3, 3)), np.ones((2, 3)))

    def test_rays_meet_a_sphere(self):
        scene = lanthorn.load_dict(furnace())
        hits = lanthorn.intersect(scene, [[0, 0, 0.5]], [[0, 0, 2], [0, 0, -1]])
        np.testing.assert_allclose(hits["distance"], [1.5, 2.5], rtol=1e-5)
        np.testing.assert_allclose(hits["position"], [[0, 0, 2], [0, 0, -2]], atol=1e-5)
        np.testing.assert_allclose(np.abs(hits["normal"][:, 2]), 1, atol=1e-5)
        self.assertTrue(hits["emits"].all())

    def test_bsdf(self):
        diffuse = lanthorn.Bsdf({"type": "diffuse", "reflectance": [0.2, 0.4, 0.8]})
        up = np.array([[0, 0.6, 0.8]])
        np.testing.assert_allclose(diffuse.eval(up, [[0, 0, 1]]), [np.array([0.2, 0.4, 0.8]) / np.pi], rtol=1e-4)
        np.testing.assert_allclose(diffuse.pdf(up, [[0.6, 0, 0.8]]), [0.8 / np.pi], rtol=1e-4)

        metal = lanthorn.Bsdf({"type": "conductor", "roughness": {"u": 0.4, "v": 0.4, "remap": False}})
        generator = np.random.default_rng(2)
        samples = metal.sample(up, generator.random((20000, 3)))
        scattered = np.linalg.norm(samples["wo"], axis=1) > 0
        albedo = samples["weight"][scattered].sum(0) / len(scattered)
        # The same integral, by uniform sampling of the hemisphere.
        z, phi = generator.random(200000), 2 * np.pi * generator.random(200000)
        r = np.sqrt(1 - z * z)
        wo = np.stack([r * np.cos(phi), r * np.sin(phi), z], 1)
        np.testing.assert_allclose((metal.eval(up, wo) * z[:, None]).mean(0) * 2 * np.pi, albedo, rtol=0.03)
        np.testing.assert_allclose(metal.pdf(up, wo).mean() * 2 * np.pi, scattered.mean(), rtol=0.05)
        self.assertTrue(lanthorn.Bsdf({"type": "dielectric"}).sample(up, [[0.5, 0.5, 0.5]])["is_delta"].all())

    def test_bsdf_at_a_point(self):
        scene = lanthorn.load_dict(floor_and_lamp())
        bsdf = lanthorn.bsdf_at(scene, [0, 1, 0], [0, -1, 0])
        np.testing.assert_allclose(bsdf.eval([[0, 0, 1]], [[0, 0, 1]]), [np.array([0.2, 0.4, 0.8]) / np.pi], rtol=1e-4)
        self.assertIsNone(lanthorn.bsdf_at(scene, [0, 1, 0], [0, 1, 0]))

    def test_ibl_of_a_white_sky(self):
        maps = lanthorn.ibl(lanthorn.Picture(np.ones((16, 32, 3))), irradiance_size=8, specular_size=16, samples=64)
        np.testing.assert_allclose(maps["irradiance"]["color"], 1, rtol=1e-2)
        np.testing.assert_allclose(maps["specular"][0][1]["color"], 1, rtol=1e-2)
        self.assertEqual(maps["sh"].shape, (9, 3))
        np.testing.assert_allclose(maps["sh"][1:], 0, atol=1e-2)

    def test_an_integrator_in_python(self):
        class Direct(lanthorn.Integrator):
            """light of the lamp at (0, 2, 0) on a floor of reflectance (.2, .4, .8)"""

            def radiance(self, rays, scene, sampler):
                hits = lanthorn.intersect(scene, rays.origins, rays.directions)
                way = [0, 2, 0] - hits["position"]
                squared = (way**2).sum(1, keepdims=True)
                cosine = np.abs((hits["normal"] * way).sum(1, keepdims=True)) / np.sqrt(squared)
                light = 10 * cosine / squared * np.array([0.2, 0.4, 0.8]) / np.pi
                return np.where(np.isfinite(hits["distance"])[:, None], light, 0)

        class Noise(lanthorn.Integrator):
            def radiance(self, rays, scene, sampler):
                return sampler.random((len(rays), 3))

        class Wrong(lanthorn.Integrator):
            def radiance(self, rays, scene, sampler):
                return np.zeros((3, 3))

        scene = lanthorn.load_dict(floor_and_lamp())
        lanthorn.add_integrator("direct", Direct())
        options = {"resolution": (40, 40), "passes": 3}
        own = lanthorn.render(scene, integrator="direct", **options)
        path = lanthorn.render(scene, integrator="path", **options)
        # A light's RGB becomes a spectrum of the same colour, within 1 %.
        np.testing.assert_allclose(own["color"].mean((0, 1)), path["color"].mean((0, 1)), rtol=0.02)

        lanthorn.add_integrator("noise", Noise())
        first = lanthorn.render(scene, integrator="noise", **options)
        np.testing.assert_array_equal(first.array, lanthorn.render(scene, integrator="noise", **options).array)
        self.assertFalse((first.array == lanthorn.render(scene, integrator="noise", seed=1, **options).array).all())
        np.testing.assert_allclose(first["color"].mean(), 0.5, atol=0.02)

        lanthorn.add_integrator("noise", Wrong())
        with self.assertRaisesRegex(lanthorn.Error, r"noise.radiance: expected numbers of shape \(1280, 3\)"):
            lanthorn.render(scene, integrator="noise", **options)
        lanthorn.add_integrator("noise", lanthorn.Integrator())
        with self.assertRaises(NotImplementedError):
            lanthorn.render(scene, integrator="noise", **options)
        with self.assertRaisesRegex(lanthorn.Error, "exists already"):
            lanthorn.add_integrator("path", Noise())

    def test_converge(self):
        scene = lanthorn.load_dict(furnace())
        result = lanthorn.converge(scene, runs=4, passes=8, integrator="path")
        np.testing.assert_array_equal(result["passes"], [1, 2, 4, 8])
        self.assertTrue((np.diff(result["deviation"]) < 0).all())
        self.assertTrue(np.isnan(result["bias"]).all())
        truth = lanthorn.Picture(np.ones((16, 16, 3)))
        self.assertLess(lanthorn.converge(scene, runs=4, passes=8, integrator="path", reference=truth)["bias"][-1], 0.05)


if __name__ == "__main__":
    unittest.main()
