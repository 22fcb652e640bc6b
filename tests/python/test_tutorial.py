# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the scripts of docs/tutorial at a small size and checks what each of them shows."""

import importlib
import os
import pathlib
import sys
import tempfile
import unittest

import numpy as np

import lanthorn

TUTORIAL = pathlib.Path(__file__).resolve().parents[2] / "docs/tutorial"


class Tutorial(unittest.TestCase):
    def setUp(self):
        sys.path.insert(0, str(TUTORIAL))
        self.before = os.getcwd()
        self.folder = tempfile.TemporaryDirectory()
        os.chdir(self.folder.name)

    def tearDown(self):
        os.chdir(self.before)
        self.folder.cleanup()
        sys.path.remove(str(TUTORIAL))

    def run_script(self, name):
        return importlib.import_module(name).main(small=True)

    def test_all_scripts_are_tested(self):
        tested = {name.removeprefix("test_") for name in dir(self) if name.startswith("test_")}
        self.assertLessEqual({path.stem for path in TUTORIAL.glob("*.py")}, tested)

    def test_first_picture(self):
        shares = self.run_script("first_picture")
        self.assertAlmostEqual(sum(shares.values()), 1, places=3)
        self.assertGreater(shares["caustic"], 0.005)
        self.assertTrue(pathlib.Path("first_picture.png").exists())

    def test_glass_caustic(self):
        errors = self.run_script("glass_caustic")
        self.assertLess(errors["probppm"], errors["path"])

    def test_photons(self):
        irradiance, power = self.run_script("photons")
        # Little light falls outside the grid.
        landed = irradiance.sum((0, 1)) * (3 / 40) ** 2
        self.assertTrue((landed <= power * 1.001).all() and (landed > 0.5 * power).all())

    def test_ppm_convergence(self):
        slopes = self.run_script("ppm_convergence")
        # (alpha - 1) / 2, which determines the rates of noise and bias.
        self.assertAlmostEqual(slopes["radius"], -1 / 6, delta=0.005)
        # With so few passes, slopes vary with the seed: path (-1 in the limit) gave -0.85, -0.99 and -1.03, and probppm
        # (-2/3 in the limit) -0.74, -0.89 and -1.05.
        self.assertAlmostEqual(slopes["path"], -1, delta=0.5)
        self.assertLess(slopes["probppm"], -0.2)

    def test_lens(self):
        radius, spot = self.run_script("lens")
        self.assertGreater(radius, 0.45)  # the lensmaker's 0.5 m, and more for the rim
        self.assertLess(radius, 0.65)
        self.assertLess(spot, 0.03)

    def test_environment(self):
        environment, maps = self.run_script("environment")
        # Energy is conserved: the mean of irradiance/pi equals the mean of the environment over the sphere.
        height = environment.height
        weight = np.sin(np.pi * (np.arange(height) + 0.5) / height)[:, None, None]
        mean = (environment["color"] * weight).sum((0, 1)) / (weight.sum() * environment.width)
        np.testing.assert_allclose(maps["mean"], mean, rtol=0.02)
        np.testing.assert_allclose(maps["sh"][0] * 0.282095, mean, rtol=0.02)


if __name__ == "__main__":
    unittest.main()
