#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Usage: bench/link_update.py PROGRAM [TRIANGLES]

Time of updates by `lanthorn link` to a scene of 8 million triangles: the first update, a moved camera, a new lamp, and a
painted material. An update without a render converts what it is sent; the next frame builds the scene.
"""
import importlib.util
import os
import sys
import time

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
spec = importlib.util.spec_from_file_location("link", os.path.join(ROOT, "blender", "lanthorn", "link.py"))
link = importlib.util.module_from_spec(spec)
sys.dont_write_bytecode = True
spec.loader.exec_module(link)


def grid(side):
    y, x = np.divmod(np.arange((side + 1) ** 2), side + 1)
    positions = np.stack([x / side, y / side, 0 * x], axis=1).astype(np.float32)
    i = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    triangles = np.concatenate([np.stack([i, i + 1, i + side + 2], axis=1), np.stack([i, i + side + 2, i + side + 1], axis=1)])
    return positions, triangles.astype(np.uint32)


def camera(z):
    return {"type": "perspective", "fov": 60, "camera_to_world": [[1, 0, 0, 0.5], [0, 1, 0, 0.5], [0, 0, -1, z], [0, 0, 0, 1]]}


def main():
    side = round((int(sys.argv[2] if len(sys.argv) > 2 else 8_000_000) / 2) ** 0.5)
    positions, triangles = grid(side)
    client = link.Link(sys.argv[1])

    def timed(name, repeats=1, **members):
        times = []
        for i in range(repeats):
            begin = time.perf_counter()
            client.request("update", **(members["make"](i) if "make" in members else members))
            times.append(time.perf_counter() - begin)
        print(f"{name:16} {1e3 * sorted(times)[len(times) // 2]:10.3f} ms")

    mesh = {"type": "triangles", "positions": positions, "triangles": triangles, "material": "white"}
    print(f"{len(triangles)} triangles")
    timed("first", set={"camera": camera(2), "film": {"width": 16, "height": 12},
                        "materials": {"white": {"type": "diffuse", "reflectance": 0.5}},
                        "shapes": {"grid": mesh}, "lights": {"sky": {"type": "infinite"}}})
    client.request("start", options={"integrator": "path", "passes": 1})
    timed("camera", 101, make=lambda i: {"set": {"camera": camera(2 + i / 100)}})
    timed("lamp", 101, make=lambda i: {"set": {"lights": {"lamp": {"type": "point", "from": [i / 100, 0, 1]}}}})
    timed("material", 101, make=lambda i: {"set": {"materials": {"white": {"type": "diffuse", "reflectance": i / 101}}}})
    client.close()


main()
