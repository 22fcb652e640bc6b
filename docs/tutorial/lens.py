# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Optimises a lens for its caustic: scipy finds the radius of curvature that focuses sunlight on a point of the floor.

The paraxial answer is the lensmaker's: f = R / (n - 1). A thick lens with a wide aperture needs a larger radius: light
starts to bend above the flat face, and the rim bends it too much.

    python3 lens.py                   # writes lens.png: the floor under the best lens
"""

import lanthorn
import numpy as np
from scipy.optimize import minimize_scalar

ETA, HEIGHT, APERTURE = 1.5, 1.0, 0.25


def lens_mesh(radius, rings=24, sectors=48):
    """A spherical cap over a flat disk, both of radius APERTURE: positions, normals, triangles. Up is y."""
    r = np.linspace(0, APERTURE, rings + 1)[1:, None]
    phi = 2 * np.pi * np.arange(sectors) / sectors
    rim = np.sqrt(radius**2 - APERTURE**2)
    y = np.sqrt(radius**2 - r**2) - rim
    ring = np.stack([r * np.cos(phi), y + 0 * phi, r * np.sin(phi)], -1).reshape(-1, 3)
    cap = np.vstack([[[0, radius - rim, 0]], ring])
    cap_normals = (cap + [0, rim, 0]) / radius
    disk = cap * [1, 0, 1]

    i = np.arange(sectors)
    j = (i + 1) % sectors
    fan = np.stack([0 * i, 1 + j, 1 + i], -1)
    bands = [np.stack([a + i, a + j, a + sectors + j], -1) for a in 1 + sectors * np.arange(rings - 1)]
    bands += [np.stack([a + i, a + sectors + j, a + sectors + i], -1) for a in 1 + sectors * np.arange(rings - 1)]
    top = np.vstack([fan, *bands])
    triangles = np.vstack([top, top[:, ::-1] + len(cap)])
    return np.vstack([cap, disk]), np.vstack([cap_normals, 0 * disk - [0, 1, 0]]), triangles


def scene(radius, width=200, height=200):
    positions, normals, triangles = lens_mesh(radius)
    s = 0.4
    return lanthorn.load_dict(
        {
            "camera": {"fov": 30, "camera_to_world": lanthorn.look_at((0.9, 0.8, 0.9), (0, 0.1, 0))},
            "film": {"width": width, "height": height},
            "materials": [{"type": "diffuse", "reflectance": 0.8}, {"type": "dielectric", "eta": ETA, "name": "glass"}],
            "shapes": [
                {"type": "triangles", "positions": [[-s, 0, -s], [s, 0, -s], [s, 0, s], [-s, 0, s]], "triangles": [[0, 2, 1], [0, 3, 2]]},
                {
                    "type": "triangles",
                    "positions": positions + [0, HEIGHT, 0],
                    "normals": normals,
                    "triangles": triangles,
                    "material": "glass",
                },
            ],
            "lights": [{"type": "distant", "from": [0, 1, 0], "to": [0, 0, 0], "radiance": {"scale": 3}}],
        }
    )


def spot_radius(radius, photons):
    """Root mean square distance (m) of the caustic's power on the floor from the axis."""
    p = lanthorn.trace_photons(scene(radius), integrator="probppm", photons=photons)
    caustic = (p.classes == p.CAUSTIC) & (np.abs(p.positions[:, 1]) < 1e-3)
    distance, power = np.linalg.norm(p.positions[caustic][:, [0, 2]], axis=1), p.powers[caustic].sum(1)
    return np.sqrt((distance**2 * power).sum() / power.sum())


def main(small=False):
    photons = 20_000 if small else 300_000
    best = minimize_scalar(
        lambda radius: spot_radius(radius, photons), bounds=(0.3, 1.2), method="bounded", options={"xatol": 0.01 if small else 1e-3}
    )
    print(f"best radius {best.x:.3f} m, spot {1000 * best.fun:.1f} mm; thin lens {HEIGHT * (ETA - 1):.3f} m")
    size = (48, 48) if small else (200, 200)
    lanthorn.render(scene(best.x, *size), integrator="probppm", passes=4 if small else 64).save("lens.png", curve="filmic")
    return best.x, best.fun


if __name__ == "__main__":
    main()
