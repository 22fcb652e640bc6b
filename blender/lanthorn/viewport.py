# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""The rendered viewport: a thread talks to the program, the interface draws the picture that it has."""
import queue
import threading

import gpu
import numpy
from gpu_extras.presets import draw_texture_2d

from . import camera, passes
from .link import LinkError
from .scene_export import SceneExport

PATIENCE = 0.1  # seconds that the thread waits for a picture before it looks for edits


class Viewport:
    """`edit` and `draw` are called by Blender, the rest belongs to the thread."""

    def __init__(self, link, redraw, options, denoises):
        self._link, self._redraw = link, redraw
        self._options, self._denoises = options, denoises
        self._edits = queue.Queue()
        self._lock = threading.Lock()
        self._answer, self._texture = None, None
        self.problem = ""
        self.status = "Loading"
        self._export = SceneExport()
        self._view = None
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._is_started = False

    # Blender's side.

    def update_scene(self, context, depsgraph):
        self._export.forget(depsgraph)
        changed, gone = self._export.changes(self._export.parts(depsgraph, context.space_data))
        self.update_view(context, changed, gone)

    def update_view(self, context, changed=None, gone=None):
        """Sends what has changed, if anything has."""
        region = context.region
        size = max(1, region.width), max(1, region.height)
        view = {"camera": camera.view_part(context.region_data), "film": camera.film_part(size),
                "filter": camera.filter_part(context.scene.render.filter_size)}
        is_moved = view != self._view
        if not (changed or gone or is_moved):
            return
        self._view = view
        self._edits.put({"set": {**(changed or {}), **view}, "remove": gone or {}, "is_moving": not (changed or gone)})
        if not self._is_started:
            self._is_started = True
            self._thread.start()

    def notes(self):
        return self._export.report.lines()

    def draw(self, width, height):
        with self._lock:
            answer, self._answer = self._answer, None
        if answer is not None:
            self._texture = texture_of(answer)
        if self._texture is not None:
            draw_texture_2d(self._texture, (0, 0), width, height)

    def close(self):
        self._edits.put(None)
        if self._is_started:
            self._thread.join(timeout=5)
        self._link.close()
        self._export.close()

    # The thread's side.

    def _run(self):
        try:
            self._serve()
        except LinkError as error:
            self.problem = str(error)
        self._redraw()

    def _serve(self):
        number, is_running = 0, False
        while (edit := self._next_edit(is_running)) is not None:
            if edit:
                self._link.request("update", **edit)
            if not is_running:
                self._link.request("start", options=self._options, is_interactive=True, denoise=self._denoises)
                is_running = True
            answer = self._link.request("wait", after=number, patience=PATIENCE, layers=["color"])
            number = answer["number"]
            self.status = describe(answer)
            if "pixels" in answer:
                with self._lock:
                    self._answer = answer
                self._redraw()

    def _next_edit(self, is_running):
        """All edits that have come, as one; an empty one if there is none; None at the end."""
        merged = {}
        try:
            while True:
                edit = self._edits.get(block=not is_running and not merged, timeout=60)
                if edit is None:
                    return None
                merged = merged_edits(merged, edit)
        except queue.Empty:
            return merged


def merged_edits(first, second):
    """The effect of two updates, one after the other. (A part that the second one removes may never have been sent.)"""
    if not first:
        return second
    if first["remove"] or second["remove"]:
        return {**second, "set": _without(_joined(first["set"], second["set"]), second["remove"]),
                "remove": _joined_names(first, second)}
    return {**second, "set": _joined(first["set"], second["set"]),
            "is_moving": first["is_moving"] and second["is_moving"]}


def _joined(first, second):
    from .scene_export import TABLES
    joined = {**first, **second}
    for table in TABLES:
        if table in first and table in second:
            joined[table] = {**first[table], **second[table]}
    return joined


def _without(parts, removed):
    return {table: {name: part for name, part in entries.items() if name not in removed[table]}
            if table in removed else entries for table, entries in parts.items()}


def _joined_names(first, second):
    tables = {*first["remove"], *second["remove"]}
    added = {table: set(first["set"].get(table, {})) for table in tables}
    return {table: list(first["remove"].get(table, [])) +
            [name for name in second["remove"].get(table, []) if name not in added[table]] for table in tables}


def describe(answer):
    if answer["phase"] == "failed":
        return answer["problem"]
    return f"{answer['passes']} passes" if "passes" in answer else answer["phase"].capitalize()


def texture_of(answer):
    pixels = numpy.ascontiguousarray(passes.Picture(answer).combined(False)[::-1])
    height, width = pixels.shape[:2]
    buffer = gpu.types.Buffer("FLOAT", width * height * 4, pixels.ravel())
    return gpu.types.GPUTexture((width, height), format="RGBA16F", data=buffer)
