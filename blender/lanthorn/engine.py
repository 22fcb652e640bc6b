# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Defines the render engine, with final renders and the viewport."""
import weakref

import bpy
import gpu

from . import camera, motion, passes, settings, viewport
from .link import Link, LinkError
from .scene_export import SceneExport

PATIENCE = 0.2  # seconds between checks whether the user cancels
ENDS = {"finished", "out_of_time"}


def start_program():
    program = settings.program_path()
    if program is None:
        raise LinkError(settings.MISSING)
    return Link(program)


class FinalRender:
    """Renders one picture of one view layer."""

    def __init__(self, engine, depsgraph):
        self.engine, self.depsgraph = engine, depsgraph
        self.scene, self.view_layer = depsgraph.scene, depsgraph.view_layer
        render = self.scene.render
        self.size = camera.picture_size(render)
        self.crop = camera.border_pixels(render, self.size)
        self.passes = passes.wanted_passes(self.view_layer)
        self.is_transparent = render.film_transparent
        self.camera = None

    def view_parts(self, report):
        render = self.scene.render
        object = self.engine.camera_override or self.scene.camera
        if object is None:
            raise LinkError("the scene has no camera")
        self.camera = camera.camera_part(object.evaluated_get(self.depsgraph), self.depsgraph, self.size,
                                         (render.pixel_aspect_x, render.pixel_aspect_y), report)
        return {"camera": self.camera, "film": camera.film_part(self.size),
                "filter": camera.filter_part(render.filter_size)}

    def run(self, link):
        export = SceneExport()
        try:
            self.engine.update_stats("", "Exporting the scene")
            export.bakes.size, export.bakes.frame = self.scene.lanthorn.bake_size, self.scene.frame_current
            parts = export.parts(self.depsgraph)
            if export.bakes.are_missing:
                self.engine.update_stats("", "Baking unsupported nodes")
            export.bake(parts, self.engine.test_break)
            if self.engine.test_break():
                return
            if export.is_unfinished:
                parts = export.parts(self.depsgraph)
                export.bake(parts, self.engine.test_break)
            view = self.view_parts(export.report)
            view["camera"].update(export.camera_medium(parts))
            motion.add_motion(self.engine, self.depsgraph, self.scene.camera, parts, view["camera"])
            changed, _ = export.changes(parts)
            link.request("update", set={**changed, **view})
            self._say(export.report.lines())
            self.engine.update_stats("", "Building the scene")
            options = {**self.scene.lanthorn.options(), "crop": self.crop}
            self._say(link.request("start", options=options, denoise=self.scene.lanthorn.denoise)["warnings"])
            self._follow(link)
        finally:
            export.close()

    def _say(self, lines):
        for line in lines:
            self.engine.report({"WARNING"}, line)

    def _follow(self, link):
        width, height = self.crop[2] - self.crop[0], self.crop[3] - self.crop[1]
        result = self.engine.begin_result(0, 0, width, height, layer=self.view_layer.name)
        number, is_cancelled, problem = 0, False, None
        layers = passes.layers_of(self.passes, self.is_transparent)
        try:
            while not is_cancelled:
                answer = link.request("wait", after=number, patience=PATIENCE, layers=layers)
                number = answer["number"]
                if "pixels" in answer:
                    self._show(result, answer)
                problem = answer.get("problem")
                is_done = answer["phase"] in ENDS and (answer.get("is_denoised") or not self.scene.lanthorn.denoise)
                if is_done or answer["phase"] == "failed":
                    break
                is_cancelled = self.engine.test_break()
        finally:
            self.engine.end_result(result, cancel=False)
        if problem:
            raise LinkError(problem)

    def _show(self, result, answer):
        picture = passes.Picture(answer)
        values = {"Combined": picture.combined(self.is_transparent)}
        for wanted in self.passes:
            values[wanted.name] = self._axial(picture.of_pass(wanted)) if wanted.name == "Depth" else picture.of_pass(wanted)
        passes.fill(result.layers[0], values, picture.pixels.shape[:2])
        self._tell_metadata(result, answer)
        self.engine.update_result(result)
        self._tell_progress(answer)

    def _axial(self, depth):
        if depth is None or self.camera["type"] != "perspective":
            return depth
        window = camera.window_of_border(self.camera["screen_window"], self.size, self.crop)
        return camera.axial_depth(depth[:, :, 0], window)[:, :, None].clip(max=passes.FAR)

    def _tell_metadata(self, result, answer):
        result.stamp_data_add_field("Lanthorn", f"{answer['integrator']}, {passes.count_text(answer['passes'])}")

    def _tell_progress(self, answer):
        seconds, left = answer["seconds"], answer.get("seconds_left")
        text = passes.count_text(answer["passes"])
        error = answer.get("error")
        if error and not error.get("doubt"):
            text += f", error below {100 * error['bound']:.1f} %"
        if left is not None:
            text += f", {left:.0f} s left"
            self.engine.update_progress(min(1, seconds / max(seconds + left, 1e-6)))
        self.engine.update_stats("", text)


def redraw_of(engine):
    """Returns a function that redraws the engine's viewport and holds only a weak reference to the engine."""
    reference = weakref.ref(engine)

    def redraw():
        found = reference()
        try:
            if found is not None:
                found.tag_redraw()
        except ReferenceError:  # Blender has freed the engine
            pass
    return redraw


class LanthornEngine(bpy.types.RenderEngine):
    bl_idname = "LANTHORN"
    bl_label = "Lanthorn"
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False
    bl_use_gpu_context = False

    def update_render_passes(self, scene, view_layer):
        self.register_pass(scene, view_layer, "Combined", 4, "RGBA", "COLOR")
        for wanted in passes.wanted_passes(view_layer):
            self.register_pass(scene, view_layer, wanted.name, len(wanted.channels), wanted.channels, wanted.kind)

    def render(self, depsgraph):
        try:
            with start_program() as link:
                FinalRender(self, depsgraph).run(link)
        except LinkError as error:
            self.report({"ERROR"}, f"Lanthorn: {error}")
            self.error_set(f"Lanthorn: {error}")

    # Blender creates an engine for each viewport, but does not always call __init__.
    _viewport = None

    def view_update(self, context, depsgraph):
        settings_of_scene = context.scene.lanthorn
        try:
            if self._viewport is None:
                self._viewport = viewport.Viewport(start_program(), redraw_of(self), settings_of_scene.viewport_options(),
                                                   settings_of_scene.denoise)
                # Blender frees the engine's members before __del__ runs.
                weakref.finalize(self, self._viewport.close)
            self._viewport.update_scene(context, depsgraph)
        except LinkError as error:
            self.update_stats("Lanthorn", str(error))

    def view_draw(self, context, depsgraph):
        if self._viewport is None:
            return
        if self._viewport.is_baked:
            self._viewport.update_scene(context, depsgraph)
        else:
            self._viewport.update_view(context)
        gpu.state.blend_set("ALPHA_PREMULT")
        self.bind_display_space_shader(depsgraph.scene)
        self._viewport.draw(context.region.width, context.region.height)
        self.unbind_display_space_shader()
        gpu.state.blend_set("NONE")
        self.update_stats("Lanthorn", self._viewport.problem or self._viewport.status)


def register():
    bpy.utils.register_class(LanthornEngine)


def unregister():
    bpy.utils.unregister_class(LanthornEngine)
