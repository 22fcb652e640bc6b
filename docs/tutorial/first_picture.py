# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Renders a scene from plain data until the error is below 2 %, and prints the share of each layer of light.

    python3 first_picture.py          # writes first_picture.png, first_picture.exr
"""

import lanthorn
import numpy as np


def scene(width=320, height=240):
    floor = np.array([[-3, 0, -3], [3, 0, -3], [3, 0, 3], [-3, 0, 3]])
    return lanthorn.load_dict(
        {
            "camera": {"type": "perspective", "fov": 35, "camera_to_world": lanthorn.look_at((0, 2.2, 4.5), (0, 0.4, 0))},
            "film": {"width": width, "height": height},
            "materials": [
                {"type": "diffuse", "reflectance": [0.7, 0.65, 0.6], "name": "floor"},
                {"type": "dielectric", "eta": 1.5, "name": "glass"},
                {"type": "conductor", "roughness": {"u": 0.1, "v": 0.1}, "name": "copper"},
            ],
            "shapes": [
                {"type": "triangles", "positions": floor, "triangles": [[0, 2, 1], [0, 3, 2]], "material": "floor"},
                {"type": "sphere", "radius": 0.5, "material": "glass", "object_to_world": lanthorn.translate((-0.6, 0.5, 0))},
                {"type": "sphere", "radius": 0.5, "material": "copper", "object_to_world": lanthorn.translate((0.6, 0.5, 0))},
            ],
            "lights": [{"type": "spot", "from": [-3, 4, -1], "to": [0, 0.4, 0], "cone_angle": 22, "intensity": {"scale": 60}}],
            "environment": {"source": "studio", "scale": 0.3},
        }
    )


def main(small=False):
    picture = lanthorn.render(scene(64, 48) if small else scene(), noise=0.3 if small else 0.02)
    picture.save("first_picture.png")
    picture.save("first_picture.exr")
    print("error:", picture.error)

    total = picture["color"].sum()
    shares = {layer: float(picture[layer].sum() / total) for layer in ("emission", "direct", "indirect", "caustic")}
    for layer, share in shares.items():
        print(f"{layer:9} {share:6.1%} of the light")
    return shares


if __name__ == "__main__":
    main()
