# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Runs a test of the Python module: run.py TEST.py. Exit code 77 if a package that it needs is missing."""

import importlib.util
import pathlib
import sys
import unittest

for package in ("numpy", "scipy"):
    if importlib.util.find_spec(package) is None:
        print(f"*** SKIPPED: {sys.executable} has no {package} (scripts/install-packages test) ***")
        sys.exit(77)
folder = pathlib.Path(__file__).parent
sys.path.insert(0, str(folder))
suite = unittest.defaultTestLoader.loadTestsFromName(pathlib.Path(sys.argv[1]).stem)
sys.exit(not unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful())
