# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Adds motion blur: the places of objects and the camera when the shutter opens and closes."""
from . import camera
from .scene_export import SceneExport


def shutter_times(scene):
    """Returns when the shutter opens and closes, in frames relative to the current one."""
    shutter = scene.render.motion_blur_shutter
    position = getattr(getattr(scene, "cycles", None), "motion_blur_position", "CENTER")
    start = {"START": 0.0, "CENTER": -shutter / 2, "END": -shutter}[position]
    return start, start + shutter


def _places(depsgraph, camera_object):
    """Returns the matrices of all instances by name, and the camera's matrix."""
    places = {SceneExport.name_of(i): camera.rows(i.matrix_world) for i in depsgraph.object_instances if i.show_self}
    seen = camera_object.evaluated_get(depsgraph)
    return places, camera.times_flip_z(camera.without_scale(seen.matrix_world))


def add_motion(engine, depsgraph, camera_object, parts, camera_part):
    """Gives moving instances and the camera two places. Lights and deforming meshes do not blur."""
    scene = depsgraph.scene
    if not scene.render.use_motion_blur:
        return
    frame, times = scene.frame_current_final, shutter_times(scene)
    ends = []
    for time in times:
        whole = int(frame + time // 1)
        engine.frame_set(whole, subframe=frame + time - whole)
        ends.append(_places(depsgraph, camera_object))
    engine.frame_set(int(frame), subframe=frame - int(frame))
    for name, part in parts["instances"].items():
        start, end = (places.get(name) for places, _ in ends)
        if start is not None and end is not None and start != end:
            part["object_to_world"] = {"start": start, "end": end}
    start, end = (seen for _, seen in ends)
    if start != end:
        camera_part["camera_to_world"] = {"start": start, "end": end}
