# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""The overhead of Python: PYTHONPATH=build/release/lib/python python3 bench/python_cost.py build/release/bin/lanthorn [METHOD...]

Prints the seconds from the start of `import lanthorn` to the array of a picture of 64 x 64 pixels, each in a separate
process. Then prints the processor milliseconds of a pass of 256 x 256 pixels by the program, by Session.render, and by
Session.passes, which makes a picture after each pass: from the difference between 80 and 16 passes, so that start-up and
files cancel; the least of several alternating runs.
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
LOOPS = {"render": "session.render(passes=COUNT)", "passes": "for picture in session.passes(COUNT): pass"}


def processor_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def commands(program, method, count, folder):
    """{name: command} for this many passes."""
    render = [program, "render", SCENE, "-r", "256x256", "-p", str(count), "-i", method, "-q", "--checkpoint", "none"]
    all_ways = {"program": [*render, "-o", f"{folder}/a.exr"]}
    for name, loop in LOOPS.items():
        script = PASSES.replace("LOOP", loop).replace("COUNT", str(count))
        script = script.replace("METHOD", repr(method)).replace("FILE", repr(f"{folder}/b.exr"))
        all_ways[name] = [sys.executable, "-c", script]
    return all_ways


def print_start(method, runs):
    command = [sys.executable, "-c", START.replace("METHOD", repr(method))]
    lines = [subprocess.run(command, check=True, capture_output=True, text=True).stdout for _ in range(runs)]
    wall, cpu = zip(*(map(float, line.split()) for line in lines))
    print(f"{method}: import to array {statistics.median(wall):.3f} s (processor {statistics.median(cpu):.3f} s)", flush=True)


def print_passes(program, method, runs):
    few, many = 16, 80
    with tempfile.TemporaryDirectory() as folder:
        least = {}
        for _ in range(runs):
            for count in (few, many):
                for name, command in commands(program, method, count, folder).items():
                    least[name, count] = min(least.get((name, count), 1e9), processor_seconds(command))
        for name in ("program", *LOOPS):
            print(f"{method}, {name}: {1000 * (least[name, many] - least[name, few]) / (many - few):.1f} ms a pass", flush=True)


def main(program, *methods):
    for method in methods or ("path", "probppm"):
        print_start(method, runs=5)
        print_passes(program, method, runs=3)


if __name__ == "__main__":
    main(*sys.argv[1:])
