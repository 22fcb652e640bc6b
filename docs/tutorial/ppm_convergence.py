# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Convergence of progressive photon mapping, as in the lecture: noise and bias fall at different rates.

Knaus & Zwicker 2011: the radius of pass n falls as n^((alpha - 1) / 2). With alpha = 2/3 the variance of the mean of
n passes falls as n^(-2/3), and the bias as n^(-1/3), like the square of the radius. The variance of path tracing falls
as 1/n. The table's "bias" of path tracing is the caustic of the spot light, which no number of paths finds.

    python3 ppm_convergence.py        # prints the table
"""

import math

import lanthorn
from first_picture import scene


def radius_slope(ball, first=16, last=64):
    """The exponent by which the radius falls between two passes."""
    session = lanthorn.Session(ball, integrator="probppm", photons=2000)
    session.render(passes=first)
    before = session.statistics["radius"]
    session.render(passes=last - first)
    return math.log(session.statistics["radius"] / before) / math.log(last / first)


def main(small=False):
    ball = scene(24, 18) if small else scene(80, 60)
    runs, passes = (8, 32) if small else (32, 256)
    reference = lanthorn.render(ball, integrator="vcm", passes=16 if small else 4096, seed=1)
    slopes = {"radius": radius_slope(ball)}
    print(f"radius falls as n^{slopes['radius']:.3f}")
    for method in ("path", "probppm"):
        few = {"photons": 2000} if small and method == "probppm" else {}
        curve = lanthorn.converge(ball, runs=runs, passes=passes, integrator=method, reference=reference, **few)
        print(f"{method}\n  passes  deviation       bias      error")
        for row in zip(curve["passes"], curve["deviation"], curve["bias"], curve["error"]):
            print("  {:6.0f} {:10.5f} {:10.5f} {:10.5f}".format(*row))
        slopes[method] = curve["variance_slope"]
        print("  variance falls as n^", slopes[method])
    return slopes


if __name__ == "__main__":
    main()
