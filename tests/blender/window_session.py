# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""A session in Blender's window, driven by script: the add-on's zip is installed and enabled, the rendered viewport
refines and follows edits, F12 renders, Escape cancels, the picture is saved, and the program is killed during F12.

Runs by run_in_window. Leaves screenshots in FOLDER and prints "session passed" at its end. The ball has 64,000
triangles; another one beside it has a texture that is baked meanwhile.
"""
import os
import signal
import subprocess
import sys
import time
import traceback

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bpy
import numpy
import stage

ZIP, FOLDER = sys.argv[sys.argv.index("--") + 1:]
PATIENCE = 240  # seconds for each step, on a busy machine
MIDDLE = (500, 350)


# What the session waits for, and what it looks at.

class Seen:
    """What the viewport has drawn, and how many pictures F12 has shown."""
    revision, passes, is_coarse, pictures = 0, 0, True, 0
    exported_at, problem = None, None


def watch():
    from lanthorn import viewport
    from lanthorn.engine import FinalRender
    from lanthorn.link import LinkError
    texture, update, show, run = viewport.texture_of, viewport.Viewport.update_scene, FinalRender._show, FinalRender.run

    def timed_update(self, context, depsgraph):
        Seen.exported_at = time.monotonic()
        update(self, context, depsgraph)

    def watched_texture(answer):
        Seen.revision, Seen.passes, Seen.is_coarse = answer["revision"], answer["passes"], answer["is_coarse"]
        if Seen.exported_at is not None:
            print(f"  first picture after {time.monotonic() - Seen.exported_at:.2f} s", flush=True)
            Seen.exported_at = None
        return texture(answer)

    def watched_show(self, result, answer):
        show(self, result, answer)
        Seen.pictures += 1

    def watched_run(self, link):
        try:
            run(self, link)
        except LinkError as problem:
            Seen.problem = str(problem)
            raise
    viewport.texture_of, viewport.Viewport.update_scene = watched_texture, timed_update
    FinalRender._show, FinalRender.run = watched_show, watched_run


def programs():
    """The processes of lanthorn that this Blender has started."""
    found = []
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", encoding="ascii", errors="replace") as stat:
                command, rest = stat.read().rsplit(")", 1)
        except OSError:
            continue
        if int(rest.split()[1]) == os.getpid() and command.endswith("(lanthorn") and rest.split()[0] != "Z":
            found.append(int(name))
    return found


def is_shown(after):
    return lambda: Seen.revision > after and not Seen.is_coarse


def is_rendering():
    return bpy.app.is_job_running("RENDER")


def pause(seconds):
    end = time.monotonic() + seconds
    return lambda: time.monotonic() > end


def window():
    return bpy.context.window_manager.windows[0]


def largest_area():
    return max(window().screen.areas, key=lambda area: area.width * area.height)


def screenshot(name):
    """Saves the window. Returns the pixels of the largest area."""
    path = os.path.join(FOLDER, f"{name}.png")
    with bpy.context.temp_override(window=window(), screen=window().screen):
        bpy.ops.screen.screenshot(filepath=path)
    print(f"{name}: {time.monotonic() - START:.1f} s", flush=True)
    area = largest_area()
    pixels = stage.read_picture(path)[::-1]
    return pixels[area.y + area.height // 4:area.y + area.height * 3 // 4,
                  area.x + area.width // 4:area.x + area.width * 3 // 4, :3]


def press(key):
    subprocess.run(["xdotool", "mousemove", *map(str, MIDDLE), "key", key], check=True)


def expect(condition, what):
    if not condition:
        raise AssertionError(what)


# The session: each `yield` waits until what it yields is true.

def enable():
    bpy.ops.preferences.addon_install(filepath=ZIP)
    bpy.ops.preferences.addon_enable(module="lanthorn")
    import lanthorn
    expect(not lanthorn.__file__.startswith(stage.ROOT), "the add-on comes from the zip")
    preferences = bpy.context.preferences
    preferences.active_section = "ADDONS"
    bpy.context.window_manager.addon_search = "Lanthorn"
    bpy.ops.preferences.addon_expand(module="lanthorn")
    area = largest_area()
    area.type = "PREFERENCES"
    yield pause(0.5)
    screenshot("enabled")
    area.type = "VIEW_3D"
    watch()


def build():
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
    ball = stage.add_ball(radius=0.4, location=(1.5, 0.6, 0.4), material=stage.diffuse("noise"), is_smooth=False)
    tree = ball.data.materials[0].node_tree
    noise = tree.nodes.new("ShaderNodeTexNoise")
    tree.links.new(noise.outputs["Color"], shader_of(ball.data.materials[0]).inputs["Color"])
    stage.add_light("POINT", 400, (-2, 1, 3.5), shadow_soft_size=0.05)


def shader_of(material):
    return next(n for n in material.node_tree.nodes if n.type == "BSDF_DIFFUSE")


def viewport():
    space = largest_area().spaces.active
    space.region_3d.view_perspective = "CAMERA"
    space.shading.type = "RENDERED"
    yield lambda: Seen.revision > 0
    screenshot("first")
    yield lambda: Seen.revision > 1 and not Seen.is_coarse  # the baked texture has come
    grey = screenshot("refined")
    bpy.data.objects["point"].location.x = 2.5
    yield is_shown(Seen.revision)
    moved = screenshot("lamp-moved")
    expect(abs(moved - grey).mean() > 0.02, "the picture changes when a lamp moves")
    shader_of(bpy.data.materials["grey"]).inputs["Color"].default_value = (0.8, 0.3, 0.1, 1)
    yield is_shown(Seen.revision)
    colored = screenshot("floor-coloured").mean(axis=(0, 1))
    expect(colored[0] > 1.5 * colored[2], f"the floor is orange: {colored}")
    space.region_3d.view_perspective, space.region_3d.view_distance = "PERSP", 9
    yield is_shown(Seen.revision)
    screenshot("turned")
    expect(len(programs()) == 1, "the viewport has one program")
    space.shading.type = "SOLID"
    yield lambda: not programs()
    screenshot("solid")


def final_render():
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 320, 240
    scene.lanthorn.noise = scene.lanthorn.seconds = 0
    bpy.context.preferences.view.render_display_type = "AREA"
    press("F12")
    yield lambda: Seen.pictures > 1
    yield pause(0.5)
    expect(is_rendering(), "F12 renders until it is cancelled")
    shown = screenshot("f12")
    expect(shown.std() > 0.02, "the picture is shown while it refines")
    press("Escape")
    yield lambda: not is_rendering() and not programs()
    yield pause(0.5)
    screenshot("after-escape")
    path = os.path.join(FOLDER, "saved.png")
    with bpy.context.temp_override(window=window(), screen=window().screen, area=largest_area()):
        bpy.ops.image.save_as(filepath=path)
    saved = stage.read_picture(path)
    expect(saved.shape[:2] == (240, 320) and saved[:, :, :3].std() > 0.05, "the cancelled picture is saved")


def kill():
    """The program is killed during F12: Blender lives and says so."""
    Seen.pictures = 0
    press("F12")
    yield lambda: Seen.pictures > 0
    for process in programs():
        os.kill(process, signal.SIGKILL)
    yield lambda: not is_rendering()
    yield pause(0.5)
    screenshot("killed")
    expect(Seen.problem == "the program has ended: killed by signal 9", f"Blender knows why the render ended: {Seen.problem}")


def session():
    yield pause(1)
    yield from enable()
    build()
    yield from viewport()
    yield from final_render()
    yield from kill()
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(FOLDER, "saved.blend"))


STEPS, START = session(), time.monotonic()
waiting, since = (lambda: True), START


def advance():
    """A timer of Blender's."""
    global waiting, since
    try:
        if not waiting():
            if time.monotonic() - since > PATIENCE:
                raise AssertionError(f"nothing came of it for {PATIENCE} seconds")
            return 0.05
        waiting, since = next(STEPS), time.monotonic()
        return 0.05
    except StopIteration:
        print("session passed", flush=True)
    except Exception:
        traceback.print_exc()
        print("session failed", flush=True)
        screenshot("failed")
    bpy.ops.wm.quit_blender()
    return None


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(advance, first_interval=1)
