// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

#include "lanthorn/color.h"
#include "math/vec.h"

namespace lanthorn {

/// A position as a feature. A separate type, because the film stores it with coarser steps and a larger range than
/// directions and colours.
struct Position {
  Point at{0, 0, 0};
};

/// Quantities recorded along an eye path besides light. Every film has one layer for each member. To add one, add a
/// member here, a line in `for_each`, and the place that records it (path/light_layers.h).
struct Features {
  Rgb albedo{};                  ///< albedo of the first hit that is not a mirror; 0 for misses
  Vec3 normal{0, 0, 0};          ///< world-space shading normal at that hit; 0 for misses
  Position position{};           ///< world-space position of that hit, metres; 0 for misses
  std::optional<float> depth{};  ///< metres from the camera to the first hit; nullopt for misses

  bool is_hit() const { return depth.has_value(); }

  /// Calls `visit(name, value)` for each layer, in their order in films. Numbers are averaged over the samples that hit
  /// a surface, all other features over all samples.
  template <class Visit>
  constexpr void for_each(Visit&& visit) const {
    visit("albedo", albedo);
    visit("normal", normal);
    visit("position", position);
    visit("depth", depth);
  }
};

/// True for layers that are numbers, which are averaged over hits.
template <class Value>
inline constexpr bool is_number = std::is_same_v<Value, std::optional<float>>;

/// Names of a layer's channels, one letter each.
constexpr std::string_view channels_of(const Rgb&) { return "RGB"; }
constexpr std::string_view channels_of(const Vec3&) { return "XYZ"; }
constexpr std::string_view channels_of(const Position&) { return "XYZ"; }
constexpr std::string_view channels_of(const std::optional<float>&) { return "Z"; }

/// Number of channels of all layers.
inline constexpr std::size_t feature_channels = [] {
  std::size_t count = 0;
  Features{}.for_each([&](const char*, const auto& value) { count += channels_of(value).size(); });
  return count;
}();

}  // namespace lanthorn
