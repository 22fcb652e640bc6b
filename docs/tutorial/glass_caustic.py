# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""The caustic of a glass ball: path tracing cannot find it, because no path hits a spot light, but photons can.

    python3 glass_caustic.py          # writes caustic_path.png, caustic_probppm.png
"""

import lanthorn
from first_picture import scene


def main(small=False):
    glass = scene(64, 48) if small else scene()
    passes = 8 if small else 256
    reference = lanthorn.render(glass, integrator="probppm", passes=4 * passes, seed=1)
    errors = {}
    for method in ("path", "probppm"):
        session = lanthorn.Session(glass, integrator=method)
        picture = session.render(passes=passes)
        caustic = lanthorn.Picture(picture["caustic"].copy())
        caustic.save(f"caustic_{method}.png")
        errors[method] = lanthorn.compare(caustic, lanthorn.Picture(reference["caustic"].copy()))["rel_mse"]
        print(f"{method:8} relMSE of the caustic {errors[method]:.4f}, light {caustic['color'].mean():.4f}")
    return errors


if __name__ == "__main__":
    main()
