// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "spectrum/curve.h"

namespace lanthorn {

/// Sets the RGB-mode values of a metal's index of refraction and absorption so that its reflectance in each channel
/// equals the reflectance of its spectrum under D65, at normal incidence and at 82 degrees (the two angles of Hoffman
/// 2019, "Fresnel equations considered harmful"). For each channel, Fresnel's equations have one solution: the
/// reflectance at normal incidence gives k as a function of n (Gulbrandsen 2014, "Artist friendly metallic Fresnel",
/// eq. 4), and the other angle decides n.
void fit_metal_rgb(SpectrumCurve& eta, SpectrumCurve& k);

}  // namespace lanthorn
