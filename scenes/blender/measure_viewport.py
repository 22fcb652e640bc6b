# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Measures how long the first picture of the viewport takes, by phases, for meshes of several sizes.

Usage: blender -b --factory-startup --python measure_viewport.py -- [TRIANGLES...]
Prints a line for each phase: seconds on the clock, and processor seconds of Blender and of the program. It works like
viewport.py, but without a window.
"""
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tests", "blender"))
import bpy
import numpy
import stage

SIZE = 960, 640
CLOCK_TICK = os.sysconf("SC_CLK_TCK")


def terrain(count):
    """A smooth mesh of about `count` triangles with texture coordinates."""
    side = max(2, int(round((count / 2) ** 0.5)))
    y, x = numpy.mgrid[0:side + 1, 0:side + 1].astype(numpy.float32) / side
    z = 0.1 * numpy.sin(19 * x) * numpy.cos(23 * y)
    points = numpy.stack([4 * x - 2, 4 * y - 2, z], axis=2).reshape(-1, 3)
    first = (numpy.arange(side)[:, None] * (side + 1) + numpy.arange(side)).reshape(-1, 1)
    corners = (first + numpy.array([0, 1, side + 2, side + 1])).astype(numpy.int32).reshape(-1)
    mesh = bpy.data.meshes.new("terrain")
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", points.ravel())
    mesh.loops.add(len(corners))
    mesh.loops.foreach_set("vertex_index", corners)
    mesh.polygons.add(side * side)
    mesh.polygons.foreach_set("loop_start", numpy.arange(0, len(corners), 4, dtype=numpy.int32))
    mesh.polygons.foreach_set("loop_total", numpy.full(side * side, 4, dtype=numpy.int32))
    mesh.polygons.foreach_set("use_smooth", numpy.ones(side * side, dtype=bool))
    mesh.update(calc_edges=True)
    uvs = mesh.uv_layers.new()
    uvs.data.foreach_set("uv", (points[:, :2] / 4 + 0.5)[corners].ravel())
    mesh.materials.append(stage.diffuse())
    return stage.link("terrain", mesh)


def build(count):
    stage.empty_scene(*SIZE)
    stage.add_camera((0, -4, 3), (0.9, 0, 0), lens=40)
    terrain(count)
    stage.add_ball(radius=0.5, location=(0, 0, 0.9),
                   material=stage.node_material("glass", "ShaderNodeBsdfGlass", IOR=1.5, Roughness=0.0))
    stage.add_light("POINT", 400, (-2, 1, 3.5), shadow_soft_size=0.05)


def processor_seconds(pid):
    with open(f"/proc/{pid}/stat", encoding="ascii") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / CLOCK_TICK


class Phases:
    def __init__(self, pid):
        self.pids, self.last = (os.getpid(), pid), None
        self.first = self.now()

    def now(self):
        return numpy.array([time.monotonic(), *(processor_seconds(pid) for pid in self.pids)])

    def begin(self):
        self.first = self.last = self.now()

    def end(self, name):
        now = self.now()
        self.tell(name, now - self.last)
        self.last = now

    @staticmethod
    def tell(name, seconds):
        print(f"  {name:32} {seconds[0]:7.2f} s   Blender {seconds[1]:6.2f}   program {seconds[2]:6.2f}", flush=True)


def wait_for_picture(link, number=0):
    while True:
        answer = link.request("wait", after=number, patience=10, layers=["color"])
        number = answer["number"]
        if "pixels" in answer or answer["phase"] == "failed":
            return answer


def measure(count):
    from lanthorn import camera, engine, report
    from lanthorn.scene_export import SceneExport
    build(count)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    triangles = sum(len(o.data.polygons) * 2 for o in bpy.data.objects if o.type == "MESH")
    print(f"{triangles} triangles", flush=True)
    with engine.start_program() as link:
        phases, export = Phases(link.process.pid), SceneExport()
        phases.begin()
        parts = export.parts(depsgraph)
        phases.end("export")
        changed, _ = export.changes(parts)
        phases.end("comparison")
        lens = camera.camera_part(bpy.context.scene.camera, depsgraph, SIZE, (1, 1), report.Report())
        link.request("update", set={**changed, "camera": lens, "film": camera.film_part(SIZE)})
        phases.end("transfer")
        link.request("start", options=bpy.context.scene.lanthorn.viewport_options(), is_interactive=True)
        phases.end("preparation")
        answer = wait_for_picture(link)
        phases.end(f"first picture (coarse {answer['is_coarse']})")
        phases.tell("sum", phases.last - phases.first)
        wait_for_picture(link, answer["number"])
        phases.end("second picture")
        again, _ = export.changes(export.parts(depsgraph))
        phases.end(f"export again ({sum(map(len, again.values()))} parts)")
        export.close()


if __name__ == "__main__":
    stage.enable_addon()
    bpy.context.preferences.edit.use_global_undo = False
    for text in sys.argv[sys.argv.index("--") + 1:] or ["10000", "100000", "1000000"]:
        measure(int(text))
