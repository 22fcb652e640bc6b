// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "lanthorn/measured_data.h"

namespace lanthorn {

/// Parses a measurement of EPFL's material database (".bsdf", with spectra or RGB): a tensor file with the fields
/// phi_i, theta_i, ndf, sigma, vndf, luminance, jacobian, and either spectra with wavelengths, or rgb. Throws Error at
/// `name` if a field is missing, inconsistent with another field, or not plausible for a measurement.
MeasuredData parse_measured_brdf(std::string_view bytes, const std::string& name);

}  // namespace lanthorn
