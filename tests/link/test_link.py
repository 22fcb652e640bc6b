#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Usage: test_link.py PROGRAM [unittest's arguments]

Tests `lanthorn link` from the view of another program: scenes sent in parts, pictures, errors, and the end of either process.
"""
import array
import importlib.util
import os
import signal
import struct
import subprocess
import sys
import time
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROGRAM = sys.argv[1]
spec = importlib.util.spec_from_file_location("link", os.path.join(ROOT, "blender", "lanthorn", "link.py"))
link = importlib.util.module_from_spec(spec)
sys.dont_write_bytecode = True
spec.loader.exec_module(link)

IDENTITY = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
# The camera looks down from z = 2 at a white square of 4 m in z = 0, which fills the picture.
DOWN = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 2], [0, 0, 0, 1]]


def square(**members):
    return {"type": "triangles", "positions": [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]],
            "triangles": [[0, 1, 2], [0, 2, 3]], "material": "white", **members}


def scene(sky=1.0, reflectance=0.5):
    """Under a sky of radiance 1, the square's radiance equals its reflectance everywhere."""
    return {"camera": {"type": "perspective", "fov": 60, "camera_to_world": DOWN}, "film": {"width": 16, "height": 12},
            "materials": {"white": {"type": "diffuse", "reflectance": reflectance}},
            "objects": {"square": {"shapes": [square()]}},
            "instances": {"first": {"object": "square", "object_to_world": IDENTITY}},
            "lights": {"sky": {"type": "infinite", "radiance": {"spectrum": sky}}}}


def mean(answer, channel="R"):
    pixels = answer["pixels"]
    values = array.array("f", bytes(pixels.bytes))
    values = values[answer["channels"].index(channel)::pixels.shape[2]]
    return sum(values) / len(values)


def raised(z):
    return [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, z], [0, 0, 0, 1]]


def values_of(answer):
    return array.array("f", bytes(answer["pixels"].bytes))


def last_picture(client, after=0, revision=0, layers=("color",)):
    """Waits for the finished picture of this revision or of a later one."""
    picture = None
    end = time.monotonic() + 60
    while time.monotonic() < end:
        answer = client.request("wait", after=after, patience=1, layers=list(layers))
        after = answer["number"]
        picture = answer if "pixels" in answer else picture
        if answer["phase"] == "failed":
            raise link.LinkError(answer["problem"])
        if answer["phase"] == "finished" and picture["revision"] >= revision:
            return picture
    raise TimeoutError(f"no picture: {answer}")


def is_gone(pid):
    """Waits until a process with another parent has ended or is a zombie."""
    for _ in range(100):
        try:
            with open(f"/proc/{pid}/stat") as stat:
                if stat.read().rsplit(")", 1)[1].split()[0] == "Z":
                    return True
        except (FileNotFoundError, ProcessLookupError):
            return True
        time.sleep(0.1)
    return False


class LinkTest(unittest.TestCase):
    def setUp(self):
        self.client = link.Link(PROGRAM, ("--threads", "1"))
        self.addCleanup(self.client.close)

    def start(self, scene, **options):
        self.client.request("update", set=scene)
        self.client.request("start", options={"integrator": "path", "passes": 4, **options})

    def assert_refused(self, message, name, **members):
        with self.assertRaises(link.LinkError) as caught:
            self.client.request(name, **members)
        self.assertIn(message, str(caught.exception))

    def test_says_who_it_is(self):
        self.assertEqual(self.client.about["protocol"], 1)
        self.assertIn("auto", self.client.about["methods"])
        self.assert_refused("speaks version 1", "hello", protocol=7)

    def test_renders_a_scene_to_the_end(self):
        self.start(scene())
        picture = last_picture(self.client, layers=("color", "depth"))
        self.assertEqual(picture["pixels"].shape, (12, 16, 4))
        self.assertEqual(picture["channels"], ["R", "G", "B", "depth.Z"])
        self.assertEqual(picture["passes"], 4)
        self.assertAlmostEqual(mean(picture), 0.5, delta=0.03)
        self.assertEqual(picture["seconds_left"], 0)

    def test_arrays_are_binary(self):
        flat = scene()
        shape = flat["objects"]["square"]["shapes"][0]
        shape["positions"] = array.array("f", sum(shape["positions"], []))
        # Arrays of the standard library have one dimension, so this message is made by hand.
        packer = link._Packer()
        packed = packer.pack(flat)
        packed["objects"]["square"]["shapes"][0]["positions"]["shape"] = [4, 3]
        self.send({"request": "update", "set": packed}, b"".join(packer.parts))
        self.assertEqual(self.receive()["answer"], "update")
        self.client.request("start", options={"integrator": "path", "passes": 4})
        self.assertAlmostEqual(mean(last_picture(self.client)), 0.5, delta=0.03)

    def test_updates_parts_of_a_running_render(self):
        self.start(scene())
        last_picture(self.client)
        changes = ({"materials": {"white": {"type": "diffuse", "reflectance": 0.25}}},
                   {"lights": {"sky": {"type": "infinite", "radiance": {"spectrum": 2}}}},
                   {"film": {"width": 8, "height": 8}},
                   {"lights": {"sky": {"type": "infinite", "radiance": {"spectrum": 1}}},
                    "materials": {"black": {"type": "diffuse", "reflectance": 0}},
                    "objects": {"square": {"shapes": [square(material="black")]}}})
        for change, expected in zip(changes, (0.25, 0.5, 0.5, 0)):
            revision = self.client.request("update", set=change)["revision"]
            picture = last_picture(self.client, revision=revision)
            self.assertAlmostEqual(mean(picture), expected, delta=0.03)
        self.assertEqual(picture["pixels"].shape[:2], (8, 8))
        # A removed part is no longer rendered: the camera sees the sky.
        revision = self.client.request("update", remove={"instances": ["first"]})["revision"]
        self.assertAlmostEqual(mean(last_picture(self.client, revision=revision)), 1, delta=0.01)

    def assert_as_from_the_start(self, revision, scene):
        edited = last_picture(self.client, revision=revision)
        with link.Link(PROGRAM) as other:
            other.request("update", set=scene)
            other.request("start", options={"integrator": "path", "passes": 4})
            direct = last_picture(other)
        self.assertEqual(bytes(edited["pixels"].bytes), bytes(direct["pixels"].bytes))

    def test_pictures_do_not_depend_on_the_way_to_the_scene(self):
        self.start(scene(sky=1, reflectance=0.3))
        revision = self.client.request("update", set=scene(sky=2, reflectance=0.6))["revision"]
        self.assert_as_from_the_start(revision, scene(sky=2, reflectance=0.6))

    def test_parts_that_did_not_change_are_those_of_the_last_scene(self):
        self.start(scene())
        now = scene()
        now["camera"]["fov"] = 40
        now["lights"]["lamp"] = {"type": "point", "from": [0.3, 0.2, 0.7]}
        now["instances"]["first"]["object_to_world"] = raised(0.1)
        now["materials"]["white"]["reflectance"] = 0.8
        for table in ("camera", "lights", "instances", "materials"):
            revision = self.client.request("update", set={table: now[table]})["revision"]
            last_picture(self.client, revision=revision)
        self.assert_as_from_the_start(revision, now)
        # A new material changes the numbers of others: all is read again.
        now["materials"]["black"] = {"type": "diffuse", "reflectance": 0}
        now["objects"]["square"]["shapes"].append({"type": "sphere", "radius": 0.2, "material": "black"})
        revision = self.client.request("update", set={"materials": now["materials"], "objects": now["objects"]})["revision"]
        self.assert_as_from_the_start(revision, now)

    def test_textures_come_in_any_order(self):
        textured = scene()
        textured["spectrum_textures"] = {
            "a": {"type": "mix", "tex1": {"texture": "z"}, "tex2": [0, 0, 0], "amount": 0.5},
            "z": {"type": "constant", "value": [0.8, 0.8, 0.8]}}
        textured["materials"]["white"]["reflectance"] = {"texture": "a"}
        self.start(textured)
        self.assertAlmostEqual(mean(last_picture(self.client)), 0.4, delta=0.03)
        textured["spectrum_textures"]["z"] = textured["spectrum_textures"]["a"] | {"tex1": {"texture": "a"}}
        self.assert_refused("refers to itself", "update", set={"spectrum_textures": textured["spectrum_textures"]})

    def test_mixes_come_in_any_order(self):
        mixed = scene()
        mixed["materials"] |= {"a": {"type": "mix", "materials": ["white", "black"], "amount": 0.5},
                               "black": {"type": "diffuse", "reflectance": 0}}
        mixed["objects"]["square"]["shapes"][0]["material"] = "a"
        self.start(mixed)
        self.assertAlmostEqual(mean(last_picture(self.client)), 0.25, delta=0.03)
        # A different mix changes the order of the materials.
        change = {"materials": {"a": {"type": "mix", "materials": ["black", "white"], "amount": 0.8}}}
        revision = self.client.request("update", set=change)["revision"]
        self.assertAlmostEqual(mean(last_picture(self.client, revision=revision)), 0.4, delta=0.03)
        self.assert_refused("refers to itself", "update",
                            set={"materials": {"a": {"type": "mix", "materials": ["a", "white"]}}})

    def picture_of_ball(self, method, **members):
        """Renders a ball that emits, above a mirror on the square."""
        ball = {"type": "sphere", "radius": 0.3, "object_to_world": raised(0.8), "material": "clear", "area_light": "lamp"}
        mirror = {"type": "disk", "radius": 0.5, "object_to_world": raised(0.01), "material": "mirror"}
        made = scene()
        made["lights"].clear()
        made["materials"].update(clear={"type": "thindielectric", "eta": 1.0},
                                 mirror={"type": "conductor", "reflectance": 0.9})
        self.client.request("update", set={**made, "area_lights": {"lamp": {"radiance": 2.0}},
                                           "shapes": {"ball": {**ball, **members}, "mirror": mirror}})
        self.client.request("start", options={"integrator": method, "passes": 200 if method == "path" else 40,
                                              "photons": 10000, "color": "rgb"})
        return last_picture(self.client, layers=("color", "emission"))

    def test_shapes_are_hidden_from_the_camera_alone(self):
        seen = self.picture_of_ball("path")
        reference = self.picture_of_ball("path", visible_to_camera=False)
        middle = seen["pixels"].shape[2] * (16 * 6 + 8)
        self.assertGreater(values_of(seen)[middle], 2)
        # The mirror shows the ball.
        self.assertGreater(mean(reference, "emission.R"), 0.005)
        self.assertLess(values_of(reference)[middle], 2)
        invisible = self.picture_of_ball("path", alpha=0.0)
        self.assertEqual(mean(invisible, "emission.R"), 0)
        for method in ("bdpt", "vcm", "probppm", "mlt"):
            with self.subTest(method):
                hidden = self.picture_of_ball(method, visible_to_camera=False)
                self.assertAlmostEqual(mean(hidden) / mean(reference), 1, delta=0.05)

    def test_light_reaches_the_camera_through_a_hidden_wall(self):
        """The wall is between the camera and the square. A point light shines on both."""
        means = {}
        for method, passes in (("path", 200), ("light", 20), ("bdpt", 40)):
            made = scene()
            made["lights"] = {"lamp": {"type": "point", "from": [0.3, 0.2, 0.7]}}
            made["shapes"] = {"wall": {**square(), "object_to_world": raised(1.2), "visible_to_camera": False}}
            self.start(made, integrator=method, passes=passes, photons=10000, max_depth=2, color="rgb")
            means[method] = mean(last_picture(self.client))
        self.assertAlmostEqual(means["light"] / means["path"], 1, delta=0.04)
        self.assertAlmostEqual(means["bdpt"] / means["path"], 1, delta=0.04)

    def test_a_shape_that_bounds_a_medium_is_visible(self):
        made = scene()
        made["media"] = {"fog": {"sigma_a": 1.0}}
        made["shapes"] = {"ball": {"type": "sphere", "radius": 0.3, "material": "white", "inside_medium": "fog",
                                   "visible_to_camera": False}}
        self.client.request("update", set=made)
        warnings = self.client.request("start", options={"integrator": "path", "passes": 1})["warnings"]
        self.assertTrue(any("cannot be hidden from the camera" in line for line in warnings), warnings)

    def test_spread_narrows_an_area_light(self):
        """The square gets the same power from above, on a smaller spot."""
        made = scene(reflectance=1.0)
        made["lights"].clear()
        made["area_lights"] = {"lamp": {"radiance": 10.0}}
        made["materials"]["clear"] = {"type": "thindielectric", "eta": 1.0}
        made["shapes"] = {"lamp": {"type": "disk", "radius": 0.05, "object_to_world": raised(0.4), "material": "clear",
                                   "area_light": "lamp", "reverse_orientation": True, "visible_to_camera": False}}
        means, largest = {}, {}
        for method, passes in (("path", 500), ("light", 40)):
            for spread in (180, 60):
                made["area_lights"]["lamp"]["spread"] = spread
                self.start(made, integrator=method, passes=passes, photons=10000, max_depth=1, color="rgb")
                picture = last_picture(self.client)
                means[method, spread], largest[method, spread] = mean(picture), max(values_of(picture))
        self.assertAlmostEqual(means["light", 60] / means["path", 60], 1, delta=0.03)
        # Nearly all light is in the picture. Straight below the lamp, it is 1 / (1 - (pi / 6) / tan 30°) = 10.7 times as bright.
        self.assertAlmostEqual(means["path", 60] / means["path", 180], 1.07, delta=0.07)
        self.assertGreater(largest["path", 60], 3 * largest["path", 180])
        self.assert_bad_spread(made, 0)
        self.assert_bad_spread(made, 200)

    def assert_bad_spread(self, made, spread):
        made["area_lights"]["lamp"]["spread"] = spread
        self.client.request("stop")
        self.client.request("update", set=made)
        self.assert_refused(f"expected a spread of more than 0 and at most 180 degrees, got {spread}", "start",
                            options={"integrator": "path", "passes": 1})

    def test_a_layer_that_is_named_often_is_sent_once(self):
        self.start(scene())
        last_picture(self.client)
        answer = self.client.request("wait", layers=["color"] * 200000 + ["depth", "color"] + [str(i) for i in range(1000)])
        self.assertEqual(answer["channels"], ["R", "G", "B", "depth.Z"])

    def test_requests_are_answered_although_no_more_will_come(self):
        self.start(scene(), passes=1000000000)
        self.send({"request": "wait", "after": 10**9, "patience": 1})
        self.send({"request": "stop"})
        self.client.process.stdin.close()
        self.assertEqual([self.receive()["answer"], self.receive()["answer"]], ["wait", "stop"])
        self.assertEqual(self.client.process.wait(timeout=20), 0)

    def test_goes_on_until_it_is_told_to_end(self):
        self.client.request("update", set=scene())
        self.client.request("start", options={"integrator": "path"})
        answer = {"passes": 0}
        number, end = 0, time.monotonic() + 60
        while answer.get("passes", 0) <= 100 and time.monotonic() < end:  # lanthorn render would stop after 64
            answer = self.client.request("wait", after=number, patience=1, layers=["color"])
            number = answer["number"]
        self.assertEqual(answer["phase"], "refining")

    def test_a_pass_can_be_the_last_one(self):
        self.start(scene(), passes=1000000)
        number = 0
        while "pixels" not in (answer := self.client.request("wait", after=number, patience=10)):
            number = answer["number"]
        self.client.request("finish_pass")
        number = answer["number"]
        while (answer := self.client.request("wait", after=number, patience=1))["phase"] != "paused":
            number = answer["number"]
        self.client.request("stop")
        self.assert_refused("nothing is being rendered", "wait")

    def test_names_what_is_wrong_and_changes_nothing(self):
        self.start(scene())
        bad = (("objects.square.shapes[0].material: there is no entry named \"wite\"",
                {"set": {"objects": {"square": {"shapes": [square(material="wite")]}}}}),
               ("materials.white.reflectance: expected a number, got 'high'",
                {"set": {"materials": {"white": {"type": "diffuse", "reflectance": "high"}}}}),
               ("unknown part \"material\"; did you mean materials?", {"set": {"material": {}}}),
               ("set.lights: expected an object of parts by name, got []", {"set": {"lights": []}}),
               ("there is no part \"second\"", {"remove": {"instances": ["second"]}}),
               ("film.width: expected a whole number", {"set": {"film": {"width": "wide"}}}),
               ("unknown key \"sett\"", {"sett": {}}))
        for message, members in bad:
            with self.subTest(message):
                self.assert_refused(message, "update", **members)
        self.assert_refused("expected 0 to 10 seconds", "wait", patience=11)
        self.assert_refused("did you mean start?", "strat")
        self.assert_refused("passes: expected a whole number", "start", options={"passes": "all"})
        self.assertAlmostEqual(mean(last_picture(self.client)), 0.5, delta=0.03)
        # Refused changes leave no trace.
        revision = self.client.request("update", set={"film": {"width": 10, "height": 10}})["revision"]
        self.assertAlmostEqual(mean(last_picture(self.client, revision=revision)), 0.5, delta=0.03)

    def test_a_scene_that_cannot_be_built_leaves_the_picture(self):
        self.start(scene())
        last_picture(self.client)
        far = {"objects": {"square": {"shapes": [square(triangles=[[0, 1, 7]])]}}}
        revision = self.client.request("update", set=far)["revision"]
        with self.assertRaises(link.LinkError):
            last_picture(self.client, revision=revision)
        revision = self.client.request("update", set=scene())["revision"]
        self.assertAlmostEqual(mean(last_picture(self.client, revision=revision)), 0.5, delta=0.03)

    def send(self, body, data=b"", magic=b"LNTH", data_size=None):
        import json
        text = body if isinstance(body, bytes) else json.dumps(body).encode()
        self.client.process.stdin.write(
            struct.pack("<4sIQ", magic, len(text), len(data) if data_size is None else data_size) + text + data)

    def receive(self):
        import json
        _, json_size, data_size = struct.unpack("<4sIQ", bytes(self.client._read(16)))
        body = json.loads(bytes(self.client._read(json_size)))
        self.client._read(data_size)
        return body

    def test_malformed_json_is_answered(self):
        array_of = {"$array": "float32", "shape": [4], "offset": 0}
        bad = ((b"", "expected a JSON object"), (b"[1]", "expected a JSON object"), (b"{\"request\": ", "expected a JSON"),
               (b"[" * 100000, "levels of lists"), (b"{}", "the name of a request"),
               ({"request": 3}, "the name of a request"), ({"request": "update", "set": array_of}, "beyond the end"),
               ({"request": "update", "set": array_of | {"shape": [2**40, 2**40, 0, 2**40]}}, "beyond the end"),
               ({"request": "update", "set": array_of | {"shape": [-1]}}, "beyond the end"),
               ({"request": "update", "set": array_of | {"offset": 2**64 - 1}}, "beyond the end"),
               ({"request": "update", "set": {"$array": "float16", "shape": [], "offset": 0}}, "type of an array"),
               (b"{\"request\": \"\xff\xfe\"}", "expected a JSON"))
        for body, message in bad:
            with self.subTest(str(body)[:40]):
                self.send(body)
                answer = self.receive()
                self.assertEqual(answer["answer"], "error")
                self.assertIn(message, answer["message"])
        self.assertEqual(self.client.request("hello", protocol=1)["answer"], "hello")

    def assert_ends(self, said):
        self.client.process.stdin.close()
        self.assertEqual(self.client.process.wait(timeout=20), 2)
        self.client._messages.seek(0)
        self.assertIn(said, self.client._messages.read().decode())

    def test_bytes_that_are_no_message_end_the_program(self):
        self.client.process.stdin.write(b"GET / HTTP/1.1\r\n\r\n")
        self.assert_ends("begins with the bytes LNTH")

    def test_a_client_that_no_longer_reads_ends_the_program(self):
        self.client.process.stdout.close()
        self.assertEqual(self.client.process.wait(timeout=20), 0)

    def test_a_message_that_is_cut_short_ends_the_program(self):
        self.send({"request": "hello"}, b"1234", data_size=2**30)  # takes no gigabyte
        self.assert_ends("is truncated")

    def test_a_message_that_is_too_large_ends_the_program(self):
        self.send({"request": "hello"}, data_size=2**60)
        self.assert_ends("at most")

    def test_the_end_of_the_client_ends_the_program(self):
        script = ("import importlib.util, sys, time\n"
                  f"spec = importlib.util.spec_from_file_location('link', {link.__file__!r})\n"
                  "link = importlib.util.module_from_spec(spec); spec.loader.exec_module(link)\n"
                  f"client = link.Link({PROGRAM!r}, ('--threads', '1'))\n"
                  f"client.request('update', set={scene()!r})\n"
                  "client.request('start', options={'passes': 1000000000})\n"
                  "print(client.process.pid, flush=True)\n"
                  "client.request('wait', after=10**9, patience=10)\n"
                  "time.sleep(60)\n")
        owner = subprocess.Popen([sys.executable, "-B", "-c", script], stdout=subprocess.PIPE)
        pid = int(owner.stdout.readline())
        os.kill(pid, 0)  # it lives
        owner.kill()
        owner.wait()
        owner.stdout.close()
        self.assertTrue(is_gone(pid))

    def test_the_end_of_the_program_is_an_error_of_the_client(self):
        self.start(scene(), passes=1000000000)
        os.kill(self.client.process.pid, signal.SIGKILL)
        with self.assertRaisesRegex(link.LinkError, "the program has ended: killed by signal 9"):
            for _ in range(100):
                self.client.request("wait", patience=1)

    def test_a_program_that_is_not_there_is_an_error(self):
        with self.assertRaisesRegex(link.LinkError, "cannot be started: No such file"):
            link.Link("/no/such/lanthorn")
        with self.assertRaisesRegex(link.LinkError, "the program has ended|does not speak"):
            link.Link("/bin/false")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
