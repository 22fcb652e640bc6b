// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "lanthorn/color.h"

namespace lanthorn {

/// Passes [begin, end).
struct PassRange {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
  friend bool operator==(const PassRange&, const PassRange&) = default;
};

/// Settings that override those of a view.
struct ViewOptions {
  std::optional<std::array<int, 2>> resolution{};  ///< width, height of the full film, pixels
  std::optional<std::array<int, 4>> crop{};        ///< x0, y0, x1, y1, pixels; end exclusive
  /// Pixels to render around the crop, where the film has them, so that it can be denoised as well at its border as
  /// inside. They are kept in states, and are in no picture. The crop's pixels do not depend on it. Methods whose
  /// pixels depend on the rendered part (`sppm`, `mlt` and so on) render no margin.
  int margin = 0;
  /// Clamps each path's contribution to a pixel, except for directly visible lights; biased. Default: no clamping.
  std::optional<float> clamp{};
};

/// The user's options. Empty members come from the scene file or have a default.
struct RenderOptions : ViewOptions {
  std::optional<std::string> integrator{};  ///< name of a method
  std::optional<std::uint64_t> passes{};
  std::optional<double> seconds{};  ///< stop after the pass in which this time elapses
  /// Stop when the picture's error is below this bound (ErrorEstimate::bound), in (0, 1].
  std::optional<double> noise{};
  std::optional<PassRange> pass_range{};  ///< for shards; excludes `passes`
  std::optional<std::uint64_t> seed{};
  std::optional<ColorMode> color{};
  std::optional<std::uint64_t> photons{};    ///< light paths per pass
  std::optional<int> max_depth{};            ///< scattering events of a whole path, from light to eye
  std::optional<std::uint64_t> memory{};     ///< bytes for film, photons and pixels; default: all available
  std::map<std::string, std::string> set{};  ///< the method's parameters
};

}  // namespace lanthorn
