# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Runs pip install . in an empty environment without network access. Nightly, because it compiles the library."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import venv

SOURCE = pathlib.Path(__file__).resolve().parents[2]


class Wheel(unittest.TestCase):
    def version(self):
        return re.search(r'version = "(.*)";', (SOURCE / "include/lanthorn/version.h").read_text()).group(1)

    def test_pip_install(self):
        with tempfile.TemporaryDirectory() as folder:
            venv.create(folder, system_site_packages=True, with_pip=True)
            python = pathlib.Path(folder) / "bin/python"
            environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
            subprocess.run([python, "-m", "pip", "install", "--no-index", SOURCE], check=True, env=environment)
            scene = SOURCE / "tests/scenes/lamps-with-images.pbrt"  # images need lanthorn-openimageio.so
            # Wheels cannot hold links, so there is one copy of the library, under the name that the module loads.
            libraries = sorted(file.name for file in (pathlib.Path(folder) / "lib").rglob("liblanthorn*"))
            self.assertEqual(libraries, [f"liblanthorn.so.{self.version().rsplit('.', 1)[0]}"])
            script = (
                f"import lanthorn; assert lanthorn.__file__.startswith({folder!r}), lanthorn.__file__\n"
                f"picture = lanthorn.render(lanthorn.load_file({str(scene)!r}), passes=1, resolution=(16, 16))\n"
                "assert picture['color'].shape == (16, 16, 3)"
            )
            subprocess.run([python, "-c", script], check=True, env=environment, cwd=folder)


if __name__ == "__main__":
    unittest.main()
