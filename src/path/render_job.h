// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "camera/view.h"
#include "scene/scene.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Settings of every method, besides scene and view. All but `memory` affect the picture; `photon_block` does so by
/// rounding alone.
struct RenderSettings {
  std::uint64_t seed = 0;
  ColorMode color = ColorMode::rgb;
  int max_depth = 64;  ///< scattering events of a whole path, from light to eye
  /// Parts of a pass, which the method renders one after the other. Each part has its own wavelengths, its share of the
  /// light paths, and an eye path in every pixel. 1 for RGB colour and for methods whose paths draw their wavelengths.
  std::uint32_t parts = 1;
  std::uint64_t photons = 0;  ///< light paths per part of a pass
  /// Light paths whose photons are in memory at once, for methods that can gather from blocks of photons one after the
  /// other. Fixed, so that no sum depends on the available memory: about the default number for a picture of 3840 x
  /// 2160.
  std::uint64_t photon_block = std::uint64_t{1} << 23;
  std::uint64_t memory = std::uint64_t{1} << 30;  ///< bytes for methods that work in blocks of pixels
};

/// Scene, view and settings. Together with the method's own parameters they determine the picture.
struct RenderJob {
  const Scene& scene;
  const View& view;
  const RenderSettings& settings;
};

}  // namespace lanthorn
