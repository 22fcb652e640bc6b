# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""What Python costs: PYTHONPATH=build/release/lib/python python3 bench/python_cost.py build/release/bin/lanthorn

Prints the seconds from the start of `import lanthorn` to the array of a picture of 64 x 64 pixels, each in a process of its
own, and the processor seconds of 32 passes by the program and through Session.passes, in turns.
"""

import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

SCENE = str(pathlib.Path(__file__).resolve().parent.parent / "scenes/cornell-caustics.pbrt")
START = f"""
import time
begin = time.perf_counter(), time.process_time()
import lanthorn
scene = lanthorn.load_file({SCENE!r})
lanthorn.render(scene, resolution=(64, 64), passes=1, integrator=METHOD)["color"].copy()
print(time.perf_counter() - begin[0], time.process_time() - begin[1])
"""
PASSES = f"""
import lanthorn
session = lanthorn.Session(lanthorn.load_file({SCENE!r}), resolution=(256, 256), integrator=METHOD)
LOOP
session.picture().save(FILE)
"""
LOOPS = {"render": "session.render(passes=32)", "passes": "for picture in session.passes(32): pass"}


def processor_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main(program, runs=5):
    for method in ("path", "probppm"):
        lines = [
            subprocess.run([sys.executable, "-c", START.replace("METHOD", repr(method))], check=True, capture_output=True, text=True)
            for _ in range(runs)
        ]
        wall, cpu = zip(*(map(float, line.stdout.split()) for line in lines))
        print(f"{method}: import to array {statistics.median(wall):.3f} s (processor {statistics.median(cpu):.3f} s)")
    with tempfile.TemporaryDirectory() as folder:
        for method in ("path", "probppm"):
            commands = {"program": [program, "render", SCENE, "-r", "256x256", "-p", "32", "-i", method, "-q", "--checkpoint", "none",
                                    "-o", f"{folder}/a.exr"]}
            for name, loop in LOOPS.items():
                script = PASSES.replace("METHOD", repr(method)).replace("LOOP", loop).replace("FILE", repr(f"{folder}/b.exr"))
                commands[name] = [sys.executable, "-c", script]
            seconds = {name: [] for name in commands}
            for _ in range(runs):
                for name, command in commands.items():
                    seconds[name].append(processor_seconds(command))
            for name, values in seconds.items():
                print(f"{method}, 32 passes, {name}: processor seconds {statistics.median(values):.2f} (least {min(values):.2f})")


if __name__ == "__main__":
    main(sys.argv[1])
