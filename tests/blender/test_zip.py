# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""The add-on's zip depends on names and contents alone. Needs no Blender."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zipfile

MAKE_ZIP = pathlib.Path(__file__).resolve().parents[2] / "blender/make_zip.py"
CONTENTS = {"addon/b.py": "two\n" * 99, "addon/a.py": "one\n"}


def packed(seconds, mode, names):
    """Returns the bytes of a zip. Its files have this time as their times of change and access, and this mode."""
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            path = pathlib.Path(folder) / name
            path.parent.mkdir(exist_ok=True)
            path.write_text(CONTENTS[name])
            path.chmod(mode)
            os.utime(path, (seconds, seconds))
        subprocess.run([sys.executable, MAKE_ZIP, "addon.zip", *names], check=True, cwd=folder)
        archive = pathlib.Path(folder) / "addon.zip"
        with zipfile.ZipFile(archive) as files:
            for name in names:
                assert files.read(name).decode() == CONTENTS[name]
        return archive.read_bytes()


class Zip(unittest.TestCase):
    def test_equal_files_give_equal_bytes(self):
        self.assertEqual(packed(1e9, 0o644, CONTENTS), packed(1.5e9, 0o600, sorted(CONTENTS)))


if __name__ == "__main__":
    unittest.main()
