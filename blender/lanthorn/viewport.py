# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Implements the rendered viewport: a thread talks to the program, and Blender's thread draws the latest picture."""
import collections
import threading

import gpu
import numpy
from gpu_extras.presets import draw_texture_2d

from . import camera, passes
from .link import LinkError
from .scene_export import SceneExport

PATIENCE = 0.1  # seconds to wait for a picture before looking for edits

orphans = []  # textures, which only Blender's thread may free


class Viewport:
    """Blender's thread calls the public functions; the private ones below `The thread's side` run in the thread."""

    def __init__(self, link, redraw, options, denoises):
        self._link, self._redraw = link, redraw
        self._options, self._denoises = options, denoises
        self._edits = collections.deque()  # None asks the thread to end
        self._lock = threading.Condition()
        self._answer, self._texture = None, None
        self.problem = ""
        self.status = "Loading"
        self._export, self._said = SceneExport(), set()
        self.is_baked = False  # True if images have been baked since the scene was sent
        self._view, self._medium = None, {}  # members of the camera
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._is_started = False

    # Blender's side.

    def update_scene(self, context, depsgraph):
        self.is_baked = False
        self._export.forget(depsgraph)
        bakes = self._export.bakes
        bakes.size, bakes.frame = context.scene.lanthorn.bake_size, context.scene.frame_current
        parts = self._export.parts(depsgraph, context.space_data)
        if bakes.are_missing:  # until then, they are grey
            bakes.run_beside(self._tell_of_bakes)
        self._export.settle(parts)
        self._say(self._export.report.lines())
        self._medium = self._export.camera_medium(parts)
        changed, gone = self._export.changes(parts)
        self.update_view(context, changed, gone)

    def update_view(self, context, changed=None, gone=None):
        """Sends the view and the parts that have changed, if any."""
        region = context.region
        size = max(1, region.width), max(1, region.height)
        view = {"camera": {**camera.view_part(context.region_data), **self._medium}, "film": camera.film_part(size),
                "filter": camera.filter_part(context.scene.render.filter_size)}
        is_moved = view != self._view
        if not (changed or gone or is_moved):
            return
        self._view = view
        self._put({"set": {**(changed or {}), **view}, "remove": gone or {}, "is_moving": not (changed or gone)})
        if not self._is_started:
            self._is_started = True
            self._thread.start()

    def _say(self, lines):
        """Prints each line once on the terminal, because a viewport cannot show reports."""
        for line in lines:
            if line not in self._said:
                self._said.add(line)
                print(f"Lanthorn: {line}", flush=True)

    def _tell_of_bakes(self):
        """Requests another export. The thread of the bake calls this function."""
        self.is_baked = True
        self._redraw()

    def draw(self, width, height):
        with self._lock:
            answer, self._answer = self._answer, None
        if answer is not None:
            self._texture = texture_of(answer)
        orphans.clear()
        if self._texture is not None:
            draw_texture_2d(self._texture, (0, 0), width, height)

    def _put(self, edit):
        with self._lock:
            self._edits.append(edit)
            self._lock.notify_all()

    def close(self):
        """Asks the thread to end the program, without waiting for it."""
        orphans.append(self._texture)
        self._texture = None
        self._put(None)
        if not self._is_started:
            self._clean_up()

    def _clean_up(self):
        self._link.close()
        self._export.close()

    # The thread's side.

    def _run(self):
        try:
            self._serve()
        except LinkError as error:
            self.problem = str(error)
            self._redraw()
            self._wait_for_end()
        self._clean_up()

    def _wait_for_end(self):
        with self._lock:
            self._lock.wait_for(lambda: None in self._edits)

    def _serve(self):
        number, is_running = 0, False
        while True:
            edit = self._next_edit(is_running)
            if edit is None:
                return
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
        """Returns the next edit, an empty one if there is none, or None at the end. Skips all but the last of several views."""
        with self._lock:
            while not self._edits and not is_running:
                self._lock.wait()
            edit = self._edits.popleft() if self._edits else {}
            while edit and edit["is_moving"] and self._edits and self._edits[0] and self._edits[0]["is_moving"]:
                edit = self._edits.popleft()
            return edit


def describe(answer):
    if answer["phase"] == "failed":
        return answer["problem"]
    return passes.count_text(answer["passes"]) if "passes" in answer else answer["phase"].capitalize()


def texture_of(answer):
    pixels = numpy.ascontiguousarray(passes.Picture(answer).combined(False)[::-1])
    height, width = pixels.shape[:2]
    buffer = gpu.types.Buffer("FLOAT", width * height * 4, pixels.ravel())
    return gpu.types.GPUTexture((width, height), format="RGBA16F", data=buffer)
