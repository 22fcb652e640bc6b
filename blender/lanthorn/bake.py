# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Bakes node trees that Lanthorn does not support to images. Cycles evaluates them in a second, headless Blender
(bake_worker.py), because the running one is rendering: it can neither bake nor change its data."""
import hashlib
import json
import os
import subprocess
import threading
import time

import bpy
import numpy

TIMEOUT = 600   # seconds
PATIENCE = 0.1  # seconds between checks whether the user cancels
WORKER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bake_worker.py")
LARGEST_FROM_IMAGES = 4096  # texels; larger images lose detail
UNTOLD = {"name", "label", "location", "width", "width_hidden", "height", "select", "show_options", "show_preview",
          "hide", "show_texture", "use_custom_color", "color", "dimensions", "bl_idname", "bl_label", "bl_description",
          "bl_icon", "bl_width_default", "bl_width_min", "bl_width_max", "bl_height_default", "bl_height_min",
          "bl_height_max", "bl_static_type", "type", "rna_type", "parent", "internal_links", "inputs", "outputs"}


def _plain(value):
    """Returns a property's value as text; equal texts mean equal values."""
    if isinstance(value, (bool, int, float, str)) or value is None:
        return str(value)
    if isinstance(value, bpy.types.Image):
        return f"{value.name_full} {value.filepath} {value.colorspace_settings.name} {value.is_dirty} {tuple(value.size)}"
    if isinstance(value, bpy.types.ID):
        return value.name_full
    if isinstance(value, bpy.types.ColorRamp):
        elements = [(e.position, *e.color) for e in value.elements]
        return f"{value.interpolation} {value.color_mode} {value.hue_interpolation} {elements}"
    if isinstance(value, bpy.types.CurveMapping):
        return str([[(*p.location, p.handle_type) for p in curve.points] for curve in value.curves])
    try:
        return str(list(value))
    except TypeError:
        return ""


def signature_of(output, source, done=None):
    """Returns a text that changes if the values of this socket do. `source` is Textures.source."""
    done = {} if done is None else done
    node = output.node
    key = (node.id_data.name, node.name)
    if key in done:
        return f"{done[key]}.{output.identifier}"
    done[key] = str(len(done))
    parts = [node.type, output.identifier]
    parts += [f"{p.identifier}={_plain(getattr(node, p.identifier))}" for p in node.bl_rna.properties
              if p.identifier not in UNTOLD]
    for socket in node.inputs:
        fed = source(socket)
        if fed is not None:
            parts.append(f"{socket.identifier}<{signature_of(fed, source, done)}>")
        elif hasattr(socket, "default_value"):
            parts.append(f"{socket.identifier}={_plain(socket.default_value)}")
    return "(" + " ".join(parts) + ")"


def images_behind(output, source, done=None):
    """Returns the images that the nodes behind a socket read."""
    done = set() if done is None else done
    node, images = output.node, []
    if (node.id_data.name, node.name) in done:
        return images
    done.add((node.id_data.name, node.name))
    if node.type in {"TEX_IMAGE", "TEX_ENVIRONMENT"} and node.image is not None:
        images.append(node.image)
    for socket in node.inputs:
        fed = source(socket)
        if fed is not None:
            images += images_behind(fed, source, done)
    return images


class Bakes:
    """Manages the baked images of a scene. Their file names are hashes of their content, so that none is baked
    twice."""

    def __init__(self, folder):
        self.folder = folder
        self.size, self.frame = 1024, 1  # texels along each side
        self._jobs = {}   # images that are still to be baked, by path
        self._failed = set()
        self._thread, self._is_closed = None, False
        self._log = os.path.join(folder, "bake.log")
        self.problem = ""

    def image(self, tree_owner, output, path_of_groups, textures, domain):
        """Returns the path of an image of this socket's values, and adds a job if the image does not exist. `domain` has
        the members `key` and `job` (see bake_worker.py), and optionally `size` and `extension`. An npz file contains an
        array `texels`, rows from the bottom."""
        images = images_behind(output, textures.source)
        largest = max([0, *(side for image in images for side in image.size)])
        size = domain.get("size") or max(self.size, min(LARGEST_FROM_IMAGES, largest))
        text = f"{tree_owner.name_full} {signature_of(output, textures.source)} {domain['key']} {size}"
        path = self._path(text, domain.get("extension", "exr"))
        if not os.path.exists(path) and path not in self._failed:
            self._jobs[path] = {"kind": "surface", "material": tree_owner.original, "groups": path_of_groups, "size": size,
                                "node": output.node.name, "output": output.identifier, "path": path,
                                "images": self._unsaved(images, textures), **domain["job"]()}
        return path

    @staticmethod
    def _unsaved(images, textures):
        """Writes images that are not stored in the .blend file to files, and returns their paths by name."""
        return {image.name: textures.images.path_of(image) for image in images
                if image.packed_file is None and (image.is_dirty or image.source == "GENERATED")}

    def world(self, world, signature):
        """Returns the path of an .npz file with the world's `texels` and `sun` (its direction, irradiance and angle, or
        nothing)."""
        path = self._path(f"{world.name_full} {signature} {self.size} sun with angle", "npz")
        if not os.path.exists(path) and path not in self._failed:
            self._jobs[path] = {"kind": "world", "world": world.original, "size": self.size, "path": path}
        return path

    def _path(self, text, extension):
        return os.path.join(self.folder, f"bake-{hashlib.md5(text.encode()).hexdigest()}.{extension}")

    def store(self, arrays):
        """Writes the arrays of a mesh to a file, unless the same arrays were written before. Returns the path."""
        digest = hashlib.md5()
        for name, values in sorted(arrays.items()):
            digest.update(name.encode())
            digest.update(numpy.ascontiguousarray(values).tobytes())
        path = os.path.join(self.folder, f"mesh-{digest.hexdigest()}.npz")
        if not os.path.exists(path):
            numpy.savez(path, **arrays)
        return path

    def is_missing(self, path):
        return path in self._jobs

    @property
    def are_missing(self):
        return bool(self._jobs)

    @property
    def are_running(self):
        return self._thread is not None

    def run(self, is_cancelled=lambda: False):
        """Bakes the missing images and waits for them. `problem` says why an image is still missing."""
        process, paths = self._start()
        self._finish(process, paths, is_cancelled)

    def run_beside(self, tell):
        """Bakes the missing images in a second process without waiting. A thread calls `tell` when it ends."""
        if self._thread is not None:
            return
        process, paths = self._start()

        def wait():
            self._finish(process, paths, lambda: self._is_closed)
            if self.problem:
                print(f"Lanthorn: {self.problem}", flush=True)
            self._thread = None
            if not self._is_closed:
                tell()
        self._thread = threading.Thread(target=wait, daemon=True)
        self._thread.start()

    def close(self):
        """Stops a running bake."""
        self._is_closed = True
        thread = self._thread
        if thread is not None:
            thread.join()

    def _start(self):
        jobs = list(self._jobs.values())
        library, names = os.path.join(self.folder, "nodes.blend"), []
        blocks = {job.get("material") or job["world"] for job in jobs}
        bpy.data.libraries.write(library, blocks, path_remap="ABSOLUTE", compress=False)
        for job in jobs:
            plain = {k: v for k, v in job.items() if k not in {"material", "world"}}
            names.append({**plain, "owner": (job.get("material") or job["world"]).name})
        list_file = os.path.join(self.folder, "jobs.json")
        with open(list_file, "w", encoding="utf-8") as file:
            json.dump({"library": library, "jobs": names, "frame": self.frame}, file)
        command = [bpy.app.binary_path, "-b", "--factory-startup", "--python-exit-code", "1", "-noaudio", "--python",
                   WORKER, "--", list_file]
        with open(self._log, "w", encoding="utf-8") as log:
            # The worker ends when its standard input is closed.
            process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=log, stderr=subprocess.STDOUT)
        return process, [job["path"] for job in jobs]

    def _finish(self, process, paths, is_cancelled=lambda: False):
        end, is_late = time.monotonic() + TIMEOUT, False
        while True:
            try:
                process.wait(PATIENCE)
                break
            except subprocess.TimeoutExpired:
                is_late = time.monotonic() > end
                if is_late or is_cancelled():
                    process.kill()
        process.stdin.close()
        self.problem = ""
        for path in paths:  # including images that failed, which are not tried again
            self._jobs.pop(path, None)
        missing = [path for path in paths if not os.path.exists(path)]
        if missing and not is_cancelled():
            self._failed.update(missing)
            with open(self._log, encoding="utf-8", errors="replace") as log:
                text = log.read()
            print(text)
            lines = [f"it took longer than {TIMEOUT} s"] if is_late else \
                [line for line in text.splitlines() if "Error" in line] or ["no reason was given"]
            self.problem = f"{len(missing)} of {len(paths)} images could not be baked: {lines[-1]}"

    def replace_missing(self, parts):
        """Replaces missing images by a constant grey."""
        for table, grey in (("float_textures", 0.5), ("spectrum_textures", [0.5] * 3)):
            for name, texture in parts[table].items():
                if self._is_absent(texture.get("filename")):
                    parts[table][name] = {"type": "constant", "value": grey}
        for name, material in parts["materials"].items():
            if self._is_absent(material.get("normal_map", {}).get("image", {}).get("filename")):
                parts["materials"][name] = {k: v for k, v in material.items() if k != "normal_map"}

    def _is_absent(self, filename):
        return filename is not None and os.path.dirname(filename) == self.folder and not os.path.exists(filename)
