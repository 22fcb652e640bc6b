# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""A Blender that is killed leaves no process: neither the program during a render nor the second Blender during a bake."""
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import uuid

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bpy
import stage

MARK = "LANTHORN_TEST_OF_KILLS"  # in the environment of all that the victim starts
VICTIM = "victim"
PATIENCE = 120   # seconds until a process runs, on a busy machine
END = 20         # seconds in which all must end
BUSY = 2.0       # processor seconds after which a process is at its work


def render_for_long(is_baked):
    """What the victim does: a render without an end, after a bake that takes long."""
    scene = stage.empty_scene()
    stage.camera_from_above()
    stage.add_light("SUN", 3)
    material = stage.diffuse()
    if is_baked:
        tree = material.node_tree
        noise = tree.nodes.new("ShaderNodeTexNoise")
        noise.inputs["Detail"].default_value = 15
        shader = next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE")
        tree.links.new(noise.outputs["Color"], shader.inputs["Color"])
    stage.add_plane(material=material)
    scene.render.engine = "LANTHORN"
    scene.lanthorn.noise, scene.lanthorn.seconds, scene.lanthorn.bake_size = 0, 0, 8192
    bpy.ops.render.render()


def processes(mark):
    """Processor seconds and command line by number of each process with this mark."""
    found = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/environ", "rb") as environ, open(f"/proc/{name}/cmdline", "rb") as command, \
                    open(f"/proc/{name}/stat", encoding="ascii", errors="replace") as stat:
                if f"{MARK}={mark}".encode() not in environ.read().split(b"\0"):
                    continue
                fields = stat.read().rsplit(")", 1)[1].split()
                seconds = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
                found[int(name)] = seconds, command.read().decode(errors="replace").replace("\0", " ")
        except OSError:
            continue
    return found


def wait_for(condition, seconds):
    end = time.monotonic() + seconds
    while not (value := condition()) and time.monotonic() < end:
        time.sleep(0.1)
    return value


class KillTest(unittest.TestCase):
    def check(self, argument, wanted):
        """Kills the victim when a process whose command line has `wanted` works. No process stays."""
        mark = uuid.uuid4().hex
        with tempfile.TemporaryDirectory() as folder:  # the victim cannot delete its files
            victim = subprocess.Popen([bpy.app.binary_path, "-b", "--factory-startup", "--python", __file__, "--", VICTIM,
                                       argument], env={**os.environ, MARK: mark, "TMPDIR": folder},
                                      stdout=subprocess.DEVNULL)
            try:
                works = wait_for(lambda: [pid for pid, (seconds, command) in processes(mark).items()
                                          if wanted in command and seconds > BUSY], PATIENCE)
                self.assertTrue(works, f"{wanted} runs: {processes(mark)}")
                victim.send_signal(signal.SIGKILL)
                victim.wait()
                start = time.monotonic()
                wait_for(lambda: not processes(mark), END)
                print(f"{argument}: all ended {time.monotonic() - start:.1f} s after the kill", flush=True)
                self.assertEqual(processes(mark), {})
            finally:
                for pid in processes(mark):
                    os.kill(pid, signal.SIGKILL)

    def test_during_a_render(self):
        self.check("plain", "lanthorn link")

    def test_during_a_bake(self):
        self.check("baked", "bake_worker.py")


if __name__ == "__main__":
    stage.enable_addon()
    arguments = sys.argv[sys.argv.index("--") + 1:]
    if arguments[:1] == [VICTIM]:
        render_for_long(arguments[1] == "baked")
    else:
        unittest.main(argv=["test_killed", *arguments[1:]])
