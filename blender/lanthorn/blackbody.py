# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Computes the colour of a black body as Blender's Blackbody node does."""
import numpy

LEAST, MOST = 800.0, 12000.0  # kelvin; beyond them, Cycles' colour is constant
WAVELENGTHS = numpy.arange(360.0, 831.0, 5.0)  # nm
SECOND_RADIATION_CONSTANT = 1.438777e7  # nm K
# Lobes of the CIE 1931 colour matching functions: amplitude, centre, width below the centre, width above it (Wyman,
# Sloan, Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions").
LOBES = (((1.056, 599.8, 37.9, 31.0), (0.362, 442.0, 16.0, 26.7), (-0.065, 501.1, 20.4, 26.2)),
         ((0.821, 568.8, 46.9, 40.5), (0.286, 530.9, 16.3, 31.1)),
         ((1.217, 437.0, 11.8, 36.0), (0.681, 459.0, 26.0, 13.8)))
XYZ_TO_RGB = numpy.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560],
                          [0.0556434, -0.2040259, 1.0572252]])


def _matching(lobes):
    values = numpy.zeros_like(WAVELENGTHS)
    for amplitude, centre, below, above in lobes:
        width = numpy.where(WAVELENGTHS < centre, below, above)
        values += amplitude * numpy.exp(-0.5 * ((WAVELENGTHS - centre) / width) ** 2)
    return values


MATCHING = numpy.array([_matching(lobes) for lobes in LOBES])


def color(kelvin):
    """Returns linear Rec. 709 of luminance 1. Negative components, of colours outside the gamut, become 0."""
    kelvin = min(MOST, max(LEAST, kelvin))
    planck = WAVELENGTHS**-5 / numpy.expm1(SECOND_RADIATION_CONSTANT / (WAVELENGTHS * kelvin))
    xyz = MATCHING @ planck
    return [max(0.0, float(c)) for c in XYZ_TO_RGB @ (xyz / xyz[1])]


TABLE = numpy.linspace(LEAST, MOST, 225)


def colors(kelvin):
    """Returns `color` for an array of temperatures of shape (n, 1), or for one temperature."""
    table = numpy.array([color(t) for t in TABLE])
    return numpy.stack([numpy.interp(numpy.squeeze(kelvin), TABLE, table[:, c]) for c in range(3)], axis=-1)
