// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "lanthorn/measured_data.h"

namespace lanthorn {

/// Parses a measurement of EPFL's material database (".bsdf", with spectra or RGB): a tensor file with the fields
/// phi_i, theta_i, ndf, sigma, vndf, luminance, jacobian, and spectra with wavelengths, or rgb. Throws Error with the
/// place `name` if something is missing, does not fit together, or cannot be a measurement.
MeasuredData parse_measured_brdf(std::string_view bytes, const std::string& name);

}  // namespace lanthorn
