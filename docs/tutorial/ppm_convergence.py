# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Convergence of progressive photon mapping, as in the lecture: noise and bias fall at different rates.

Knaus & Zwicker 2011: with alpha = 2/3 the variance of the mean of n passes falls as n^(-2/3), the bias as
n^(-1/3). The variance of path tracing falls as 1/n. What it calls bias here is the caustic of the spot light, which no
path finds, however many there are.

    python3 ppm_convergence.py        # prints the table
"""

import lanthorn
from first_picture import scene


def main(small=False):
    ball = scene(24, 18) if small else scene(80, 60)
    runs, passes = (4, 16) if small else (32, 256)
    reference = lanthorn.render(ball, integrator="vcm", passes=16 if small else 4096, seed=1)
    slopes = {}
    for method in ("path", "probppm"):
        curve = lanthorn.converge(ball, runs=runs, passes=passes, integrator=method, reference=reference)
        print(f"{method}\n  passes  deviation       bias      error")
        for row in zip(curve["passes"], curve["deviation"], curve["bias"], curve["error"]):
            print("  {:6.0f} {:10.5f} {:10.5f} {:10.5f}".format(*row))
        slopes[method] = curve["variance_slope"]
        print("  variance falls as n^", slopes[method])
    return slopes


if __name__ == "__main__":
    main()
