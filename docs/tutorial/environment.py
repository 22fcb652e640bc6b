# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Bakes an environment for a real-time engine: irradiance, prefiltered reflections, spherical harmonics.

    python3 environment.py            # writes sky.exr, irradiance.png and specular_N.png
"""

import lanthorn
import numpy as np


def sky(height=128):
    """Equirectangular: blue above, brown below, and a small sun."""
    theta = np.pi * (np.arange(height) + 0.5) / height
    phi = 2 * np.pi * (np.arange(2 * height) + 0.5) / (2 * height)
    y = np.cos(theta)[:, None, None] + 0 * phi[None, :, None]
    image = np.where(y > 0, [0.3, 0.5, 1.0] + 0 * y, [0.2, 0.15, 0.1] + 0 * y)
    image[height // 5 : height // 5 + 2, height // 2 : height // 2 + 2] = 500
    return lanthorn.Picture(image)


def main(small=False):
    environment = sky(32 if small else 128)
    environment.save("sky.exr")
    maps = lanthorn.ibl(
        environment,
        irradiance_size=8 if small else 32,
        specular_size=16 if small else 256,
        samples=64 if small else 4096,
    )
    maps["irradiance"].save("irradiance.png")
    for number, (roughness, faces) in enumerate(maps["specular"]):
        faces.save(f"specular_{number}.png")
        print(f"level {number}: roughness {roughness:.2f}, {faces.height} x {faces.height} texels a face")
    print("mean radiance", maps["mean"])

    # Irradiance over pi of a surface that faces up, by the first two bands of spherical harmonics.
    up = maps["sh"][0] * 0.282095 + maps["sh"][1] * 0.488603
    print("up:", up.round(3))
    return environment, maps


if __name__ == "__main__":
    main()
