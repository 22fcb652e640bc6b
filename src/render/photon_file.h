// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "path/render_job.h"

namespace lanthorn {

/// Photons for other tools.
struct PhotonFile {
  std::string ply;  ///< binary, little-endian: see the header that it begins with
  std::uint64_t light_paths = 0;
  std::size_t photons = 0;
};

/// Traces the photons of a pass, the same for any number of threads. `direct`: with those that come straight from a
/// light. Powers are display-linear RGB, watts, negative where a wavelength's colour is.
PhotonFile trace_photon_file(const RenderJob& job, std::uint32_t pass, bool direct);

}  // namespace lanthorn
