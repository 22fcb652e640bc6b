# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Lists measured indices of refraction by name."""

D_LINE, F_LINE, C_LINE = 0.5876, 0.4861, 0.6563  # Fraunhofer's lines, in micrometres
B_LINE, G_LINE = 0.6867, 0.4308

# From gemmological tables: index at the D line, and dispersion (index at the G line minus that at the B line).
GEMS = {"DIAMOND": ("Diamond", 2.417, 0.044), "MOISSANITE": ("Moissanite", 2.654, 0.104),
        "ZIRCONIA": ("Cubic zirconia", 2.160, 0.060), "CORUNDUM": ("Sapphire, ruby", 1.768, 0.018),
        "SPINEL": ("Spinel", 1.718, 0.020), "TOPAZ": ("Topaz", 1.619, 0.014), "BERYL": ("Emerald, beryl", 1.578, 0.014),
        "QUARTZ": ("Quartz, amethyst", 1.544, 0.013)}
# Index at the d line and Abbe number, at 20 degrees Celsius.
OTHERS = {"WATER": ("Water", 1.3330, 55.7), "ACRYLIC": ("Acrylic", 1.4917, 57.4),
          "POLYCARBONATE": ("Polycarbonate", 1.5855, 29.9)}
# Named spectra of the program.
GLASSES = {"BK7": ("Crown glass BK7", "glass-BK7"), "BAF10": ("Barium flint BAF10", "glass-BAF10"),
           "FK51A": ("Fluor crown FK51A", "glass-FK51A"), "LASF9": ("Dense flint LASF9", "glass-LASF9"),
           "F5": ("Flint F5", "glass-F5"), "F10": ("Flint F10", "glass-F10"), "F11": ("Dense flint F11", "glass-F11")}
METALS = {"Ag": "Silver", "Al": "Aluminium", "Au": "Gold", "Cu": "Copper", "CuZn": "Brass"}

GLASS_ITEMS = [("NONE", "From the node", "Use the index of the Glass node")] + [
    (key, label, "Measured index and dispersion") for key, (label, *_) in {**GLASSES, **GEMS, **OTHERS}.items()]
METAL_ITEMS = [("NONE", "From the node", "Use the colour of the Glossy or Principled node")] + [
    (key, label, "Measured index and absorption") for key, label in METALS.items()]


def _curve(index, slope):
    """Returns Cauchy's spectrum A + slope / wavelength² (micrometres) that has this index at the d line."""
    constant = index - slope / D_LINE**2
    wavelengths = list(range(360, 831, 10))
    return {"nm": wavelengths, "values": [constant + slope / (1e-3 * nm) ** 2 for nm in wavelengths]}


def of_abbe_number(index, abbe):
    """Returns the index as a spectrum with the Abbe number (n_d - 1) / (n_F - n_C)."""
    return _curve(index, (index - 1) / abbe / (F_LINE**-2 - C_LINE**-2))


def eta(name):
    """Returns the index of a glass, gem or liquid as a spectrum."""
    if name in GLASSES:
        return {"named": GLASSES[name][1]}
    if name in OTHERS:
        return of_abbe_number(*OTHERS[name][1:])
    _, index, dispersion = GEMS[name]
    return _curve(index, dispersion / (G_LINE**-2 - B_LINE**-2))


def metal(name):
    """Returns the index and the absorption of a metal, as members of a conductor."""
    return {"eta": {"named": f"metal-{name}-eta"}, "k": {"named": f"metal-{name}-k"}}
