# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""A session in Blender's window, under Xvfb: the rendered viewport refines, follows changes of a lamp and of a colour, and
ends.

Usage: xvfb-run -a blender --factory-startup --python viewport_session.py -- FOLDER
Leaves screenshots in the folder, and the times of first pictures on standard output. The ball has 10^5 triangles; a cube
beside it has a texture that is baked meanwhile.
"""
import os
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bpy
import stage

FOLDER = sys.argv[sys.argv.index("--") + 1]


def scene():
    bpy.context.scene.render.engine = "LANTHORN"
    for name in [o.name for o in bpy.data.objects]:
        bpy.data.objects.remove(bpy.data.objects[name])
    stage.add_camera((0, -5, 3), (1.05, 0, 0), lens=40)
    stage.add_plane(size=8)
    stage.add_ball(radius=0.7, location=(0, 0, 0.9),
                   material=stage.node_material("glass", "ShaderNodeBsdfGlass", IOR=1.5, Roughness=0.0))
    smooth = bpy.data.objects["ball"].modifiers.new("many triangles", "SUBSURF")
    smooth.levels = smooth.render_levels = 2
    smooth.subdivision_type = "SIMPLE"
    cube = stage.add_ball(radius=0.4, location=(1.5, 0.6, 0.4), material=stage.diffuse("noise"), is_smooth=False)
    tree = cube.data.materials[0].node_tree
    noise = tree.nodes.new("ShaderNodeTexNoise")
    tree.links.new(noise.outputs["Color"], next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE").inputs["Color"])
    stage.add_light("POINT", 400, (-2, 1, 3.5), shadow_soft_size=0.05)
    time_first_pictures()


def time_first_pictures():
    """Tells how long it takes from an export of the scene to the next picture that is drawn."""
    from lanthorn.viewport import Viewport
    draw, update = Viewport.draw, Viewport.update_scene

    def timed_update(self, context, depsgraph):
        self.exported_at = time.monotonic()
        update(self, context, depsgraph)
        print(f"  export: {time.monotonic() - self.exported_at:.2f} s", flush=True)

    def timed_draw(self, width, height):
        is_new = self._answer is not None
        draw(self, width, height)
        if is_new and self.exported_at is not None:
            print(f"  first picture after {time.monotonic() - self.exported_at:.2f} s", flush=True)
            self.exported_at = None
    Viewport.draw, Viewport.update_scene, Viewport.exported_at = timed_draw, timed_update, None


def view():
    area = next(a for a in bpy.context.window_manager.windows[0].screen.areas if a.type == "VIEW_3D")
    return area, area.spaces.active


def show():
    area, space = view()
    space.region_3d.view_perspective = "CAMERA"
    space.shading.type = "RENDERED"


def screenshot(name):
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen):
        bpy.ops.screen.screenshot(filepath=os.path.join(FOLDER, f"{name}.png"))
    print(f"{name}: {time.monotonic() - START:.1f} s", flush=True)


def move_lamp():
    bpy.data.objects["point"].location.x = 2.5


def color_floor():
    shader = next(n for n in bpy.data.materials["grey"].node_tree.nodes if n.type == "BSDF_DIFFUSE")
    shader.inputs["Color"].default_value = (0.8, 0.3, 0.1, 1)


def turn():
    view()[1].region_3d.view_perspective = "PERSP"
    view()[1].region_3d.view_distance = 9


def leave():
    view()[1].shading.type = "SOLID"


def press_f12():
    bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = 320, 240
    bpy.context.scene.lanthorn.noise = 0
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen):
        bpy.ops.render.render("INVOKE_DEFAULT")


def count_pictures():
    """Counts the pictures of final renders."""
    from lanthorn.engine import FinalRender
    show = FinalRender._show

    def counted(self, result, answer):
        show(self, result, answer)
        PICTURES.append(answer["passes"])
    FinalRender._show = counted


def wait_for_picture():
    """The step is repeated until there is one."""
    return None if PICTURES else "again"


def press_escape():
    subprocess.run(["xdotool", "mousemove", "640", "400", "key", "Escape"], check=True)


def check_render():
    print("render runs after Escape:", bpy.app.is_job_running("RENDER"), flush=True)
    if bpy.app.is_job_running("RENDER"):
        raise RuntimeError("Escape did not end the render")
    bpy.data.images["Render Result"].save_render(os.path.join(FOLDER, "cancelled.png"))


STEPS = [(scene, 1), (show, 2), (lambda: screenshot("first"), 14), (lambda: screenshot("refined"), 0.1), (move_lamp, 6),
         (lambda: screenshot("lamp-moved"), 0.1), (color_floor, 6), (lambda: screenshot("floor-coloured"), 0.1),
         (turn, 5), (lambda: screenshot("turned"), 0.1), (leave, 2), (lambda: screenshot("solid"), 0.1),
         (press_f12, 2), (wait_for_picture, 1), (lambda: screenshot("f12"), 0.1),
         (press_escape, 8), (lambda: screenshot("after-escape"), 0.1), (check_render, 0.1),
         (lambda: bpy.ops.wm.quit_blender(), 1)]
START = time.monotonic()
PICTURES = []


def step():
    action, pause = STEPS.pop(0)
    if action() == "again":
        STEPS.insert(0, (action, pause))
    return pause if STEPS else None


stage.enable_addon()
count_pictures()
bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(step, first_interval=2)
