# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Arrays of numpy, into the module and out of it; runs with numpy 1 and with numpy 2."""

import unittest
import warnings

import numpy as np

import lanthorn

NUMBERS = ("i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", "f2", "f4", "f8", np.longdouble)


def box_of_points(dtype):
    """A triangle with the corners (0, 0, 0), (1, 2, 3) and (4, 0, 5), as a scene."""
    points = np.array([[0, 0, 0], [1, 2, 3], [4, 0, 5]], dtype)
    return lanthorn.load_dict({"shapes": [{"type": "triangles", "positions": points, "triangles": np.array([[0, 1, 2]], "i8")}]})


class IntoTheModule(unittest.TestCase):
    def test_every_type_of_numbers(self):
        for name in NUMBERS:
            for dtype in (np.dtype(name), np.dtype(name).newbyteorder()):
                with self.subTest(dtype=dtype):
                    low, high = box_of_points(dtype).summary["bounds"]
                    np.testing.assert_allclose([low, high], [[0, 0, 0], [4, 2, 5]], atol=1e-6)
                    picture = lanthorn.Picture(np.arange(12).reshape(2, 2, 3).astype(dtype))
                    np.testing.assert_array_equal(picture["color"], np.arange(12, dtype="f4").reshape(2, 2, 3))

    def test_arrays_in_any_order_of_memory(self):
        whole = np.arange(4 * 6 * 3, dtype="f4").reshape(4, 6, 3)
        for array in (whole, np.asfortranarray(whole), whole[::2, ::-1], whole.transpose(1, 0, 2), whole[:0], whole[:, :, 0]):
            picture = lanthorn.Picture(array)
            expected = array if array.ndim == 3 else array[..., None]
            np.testing.assert_array_equal(picture.array, expected)
            self.assertEqual(picture.array.shape, expected.shape)

    def test_other_objects_that_hold_numbers(self):
        import array

        for data in (array.array("f", [0.5, 0.25, 1]), memoryview(array.array("d", [0.5, 0.25, 1])), np.float32([0.5, 0.25, 1]),
                     [np.float32(0.5), np.float64(0.25), np.int64(1)], (0.5, 0.25, np.uint8(1))):
            bsdf = lanthorn.Bsdf({"type": "diffuse", "reflectance": data})
            np.testing.assert_allclose(bsdf.eval([[0, 0, 1]], [[0, 0, 1]]) * np.pi, [[0.5, 0.25, 1]], rtol=1e-4)
        np.testing.assert_array_equal(lanthorn.Picture(lanthorn.Picture(np.ones((2, 3, 3)))).array, np.ones((2, 3, 3)))

    def test_what_is_not_a_number_is_refused(self):
        for data in (np.array([["a"]]), np.array([[None]]), np.array([[1j]]), np.zeros((2, 2), "V4"), np.zeros((2, 2), "M8[s]")):
            with self.assertRaisesRegex(lanthorn.Error, "expected numbers"):
                lanthorn.Picture(data)


class OutOfTheModule(unittest.TestCase):
    def test_pictures(self):
        numbers = np.arange(2 * 3 * 3, dtype="f4").reshape(2, 3, 3)
        picture = lanthorn.Picture(numbers)
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # numpy 2 warns if __array__ does not know `copy`
            for array in (np.array(picture), np.asarray(picture), np.asarray(picture, "f4"), np.array(picture, copy=True)):
                self.assertEqual((array.dtype, array.shape), (np.float32, (2, 3, 3)))
                np.testing.assert_array_equal(array, numbers)
            self.assertEqual(np.asarray(picture, "f8").dtype, np.float64)
            self.assertTrue(np.shares_memory(np.asarray(picture), picture.array))
            changed = np.array(picture)
            changed[:] = 0
        np.testing.assert_array_equal(picture.array, numbers)
        self.assertFalse(picture.array.flags.writeable)
        self.assertIs(picture.__array__(copy=False).dtype, np.dtype("f4"))
        self.assertFalse(np.shares_memory(picture.__array__(copy=True), picture.array))
        with self.assertRaisesRegex(ValueError, "must be a copy"):
            picture.__array__("f8", copy=False)

    def test_arrays_outlive_their_owners(self):
        arrays = [lanthorn.Picture(np.full((64, 64, 3), float(i)))["color"] for i in range(50)]
        for i, array in enumerate(arrays):
            np.testing.assert_array_equal(array, float(i))

    def test_rays(self):
        scene = box_of_points("f8")
        hits = lanthorn.intersect(scene, [[2, 0.5, 9], [9, 9, 9]], [0, 0, -1])
        self.assertEqual({name: array.dtype for name, array in hits.items()},
                         {"distance": "f4", "position": "f4", "normal": "f4", "shading_normal": "f4", "uv": "f4", "emits": "bool"})
        self.assertEqual(hits["uv"].shape, (2, 2))
        self.assertEqual(hits["distance"][1], np.inf)
        self.assertEqual(hits["emits"].tolist(), [False, False])
        none = lanthorn.intersect(scene, np.zeros((0, 3)), np.zeros((0, 3)))
        self.assertEqual((none["position"].shape, none["distance"].shape), ((0, 3), (0,)))
        hits["position"][:] = 0  # the caller's own memory

    def test_bsdfs(self):
        bsdf = lanthorn.Bsdf({"type": "diffuse", "reflectance": [0.2, 0.4, 0.8]})
        up = np.array([0, 0, 1], "f4")
        np.testing.assert_allclose(bsdf.eval(up, up), [np.array([0.2, 0.4, 0.8]) / np.pi], rtol=1e-4)
        sample = bsdf.sample(np.tile(up, (5, 1)), np.full((5, 3), 0.5))
        self.assertEqual((sample["is_delta"].dtype, sample["pdf"].shape, sample["wo"].shape), (bool, (5,), (5, 3)))

    def test_photons(self):
        scene = box_of_points("f8")
        photons = lanthorn.trace_photons(scene, origins=np.float32([2, 0.5, 9]), directions=[0, 0, -1], max_depth=1)
        self.assertEqual((photons.depths.dtype, photons.classes.dtype, photons.starts.dtype), (np.int32, np.uint8, np.uint32))
        self.assertEqual(photons.depths.tolist(), [1])
        np.testing.assert_allclose(photons.positions[:, :2], [[2, 0.5]], atol=1e-5)
        empty = lanthorn.trace_photons(scene, origins=[9, 9, 9], directions=[0, 0, 1])
        self.assertEqual(empty.positions.shape, (0, 3))

    def test_matrices_and_descriptions(self):
        np.testing.assert_array_equal(lanthorn.translate((1, 2, 3)), [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])
        self.assertEqual(lanthorn.scale(np.float32([1, 2, 3])).dtype, np.float64)
        scene = lanthorn.load_dict({"lights": [{"type": "point", "from": np.float32([1, 2, 3])}]})
        np.testing.assert_array_equal(scene.description["lights"][0]["from"], [1, 2, 3])
        self.assertEqual(np.asarray(lanthorn.ibl(lanthorn.Picture(np.ones((4, 8, 3))), irradiance_size=4, specular_size=4,
                                                 samples=4)["sh"]).shape, (9, 3))


if __name__ == "__main__":
    unittest.main()
