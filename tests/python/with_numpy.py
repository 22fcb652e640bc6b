# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Runs tests of the Python module with one version of numpy: with_numpy.py FOLDER VERSION TEST.py...

pip installs numpy into a virtual environment in FOLDER, once. Exit code 77 if it cannot.
"""

import pathlib
import subprocess
import sys
import venv


def has_numpy(python, version):
    check = f"import numpy; assert numpy.__version__ == {version!r}"
    return python.exists() and subprocess.run([python, "-c", check], stderr=subprocess.DEVNULL).returncode == 0


def main(folder, version, *tests):
    python = pathlib.Path(folder) / "bin/python"
    if not has_numpy(python, version):
        venv.create(folder, clear=True, with_pip=True)
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary=:all:", f"numpy=={version}"]
        if subprocess.run(pip).returncode:
            print(f"*** SKIPPED: pip cannot install numpy {version}; THE MODULE IS NOT TESTED WITH IT ***")
            return 77
    here = pathlib.Path(__file__).resolve().parent
    codes = [subprocess.run([python, here / test, "--verbose"]).returncode for test in tests]  # negative after a crash
    return int(any(codes))


sys.exit(main(*sys.argv[1:]))
