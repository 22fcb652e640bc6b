// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace lanthorn {

/// A visible normal of the microsurface, in the space in which the microsurface is a hemisphere (Dupuy & Benyoub 2023):
/// uniform in azimuth and in the height above the lower end of the visible cap.
struct CapSample {
  float cos_phi, height;
};
/// The samples of each texel of `brdf_table`.
std::vector<CapSample> cap_samples();

}  // namespace lanthorn
