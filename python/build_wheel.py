# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Build backend of `pip install .` (PEP 517): configures and builds by CMake in build/wheel, and packs a wheel."""

import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

SOURCE = pathlib.Path(__file__).resolve().parent.parent


def _version():
    header = (SOURCE / "include/lanthorn/version.h").read_text()
    return re.search(r'version = "([^"]+)"', header).group(1)


def _tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def _metadata():
    return (
        f"Metadata-Version: 2.1\nName: lanthorn\nVersion: {_version()}\n"
        "Summary: A renderer for light that other renderers lose\nLicense: Apache-2.0\n"
        "Requires-Python: >=3.10\nRequires-Dist: numpy\n"
    )


def _wheel():
    return f"Wheel-Version: 1.0\nGenerator: lanthorn\nRoot-Is-Purelib: false\nTag: {_tag()}\n"


def _build(prefix):
    build = SOURCE / "build/wheel"
    configure = ["cmake", "-S", SOURCE, "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DLANTHORN_UNITY=ON"]
    configure += ["-DLANTHORN_BUILD_TESTS=OFF", "-DLANTHORN_BUILD_VIEWER=OFF", "-DLANTHORN_BUILD_MPI=OFF", "-DLANTHORN_BUILD_PYTHON=ON"]
    configure += [f"-DPython3_EXECUTABLE={sys.executable}", "-DLANTHORN_INSTALL_PYTHON_DIR=.", "-DLANTHORN_WHEEL=ON"]
    if shutil.which("ninja"):
        configure += ["-G", "Ninja"]
    if shutil.which("ccache"):
        configure += ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"]
    subprocess.run(configure, check=True)
    subprocess.run(["cmake", "--build", build, "--target", "lanthorn_python", "lanthorn_openimageio",
                    "--parallel", str(os.cpu_count() or 1)], check=True)
    subprocess.run(["cmake", "--install", build, "--component", "python", "--strip", "--prefix", prefix], check=True)


def _record(name, data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Builds the wheel into `wheel_directory` and returns its name."""
    info = f"lanthorn-{_version()}.dist-info"
    name = f"lanthorn-{_version()}-{_tag()}.whl"
    with tempfile.TemporaryDirectory() as prefix:
        _build(prefix)
        files = sorted(path for path in pathlib.Path(prefix, "lanthorn").rglob("*") if path.is_file())
        contents = {path.relative_to(prefix).as_posix(): path.read_bytes() for path in files}
    contents[f"{info}/METADATA"] = _metadata().encode()
    contents[f"{info}/WHEEL"] = _wheel().encode()
    record = "".join(_record(file, data) for file, data in contents.items()) + f"{info}/RECORD,,\n"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for file, data in {**contents, f"{info}/RECORD": record.encode()}.items():
            wheel.writestr(zipfile.ZipInfo(file), data, zipfile.ZIP_DEFLATED)  # no time stamps: same input, same bytes
    return name


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """Writes the wheel's metadata without building it, and returns the folder's name."""
    name = f"lanthorn-{_version()}.dist-info"
    folder = pathlib.Path(metadata_directory) / name
    folder.mkdir()
    (folder / "METADATA").write_text(_metadata())
    (folder / "WHEEL").write_text(_wheel())
    return name


def get_requires_for_build_wheel(config_settings=None):
    """None: the build needs nothing from PyPI."""
    return []


def build_sdist(sdist_directory, config_settings=None):
    """Not supported: Lanthorn is built from a clone of the repository."""
    raise NotImplementedError("lanthorn has no source distribution; install from a clone")
