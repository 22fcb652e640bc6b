# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Looks at photons: where they land, what they carry, and a density estimate in ten lines.

    python3 photons.py                # writes photons.png: irradiance of the caustic seen from above
"""

import lanthorn
import numpy as np
from first_picture import scene


def main(small=False):
    photons = lanthorn.trace_photons(scene(64, 48), integrator="probppm", photons=50_000 if small else 2_000_000)
    for name in ("DIRECT", "CAUSTIC", "INDIRECT"):
        those = photons.classes == getattr(photons, name)
        print(f"{name:8} {those.sum():8} photons, {photons.powers[those].sum(0).round(3)} W")

    # Irradiance on the floor (W/m²): the power that lands in each cell of a grid, over the cell's area.
    on_floor = (np.abs(photons.positions[:, 1]) < 1e-3) & (photons.classes == photons.CAUSTIC)
    x, z = photons.positions[on_floor][:, 0], photons.positions[on_floor][:, 2]
    cells, half = 40 if small else 256, 1.5
    edges = np.linspace(-half, half, cells + 1)
    power = [np.histogram2d(z, x, (edges, edges), weights=w)[0] for w in photons.powers[on_floor].T]
    irradiance = np.stack(power, axis=-1) / (2 * half / cells) ** 2
    lanthorn.Picture(irradiance / np.percentile(irradiance, 99.9)).save("photons.png")
    return irradiance, photons.powers[on_floor].sum(0)


if __name__ == "__main__":
    main()
