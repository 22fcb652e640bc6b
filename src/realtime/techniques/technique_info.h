// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A technique as users see it. Plain data, because the window, which links nothing of the library, shows it, too.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/methods.h"

namespace lanthorn {

/// Numbers that a parameter takes.
struct NumberRange {
  double least = 0, most = std::numeric_limits<double>::infinity();
  enum class Kind : std::uint8_t { real, above_least, whole, power_of_two } kind = Kind::real;
};

/// How the panel shows a parameter: a list of its words, or a slider for its numbers.
struct PanelControl {
  std::string label;
  std::string tip{};
  std::vector<std::string> words{};  ///< labels, in the order of TechniqueParameter::words
  double low = 0, high = 1;          ///< ends of the slider
  std::string format = "%.3g";       ///< of the number, as printf has it
  bool is_logarithmic = false;
  bool is_length = false;  ///< low and high are shares of the scene's radius
};

/// A parameter of a technique, as `--set`, the panel and the documents describe it.
struct TechniqueParameter {
  ParameterInfo info;                ///< default: of `render`
  std::string viewer_default{};      ///< empty: the default of `render`
  std::vector<std::string> words{};  ///< accepted words. "auto": a value that fits scene and view
  std::optional<NumberRange> numbers{};
  std::optional<PanelControl> control{};  ///< none: the panel does not show it

  const std::string& default_in_viewer() const { return viewer_default.empty() ? info.default_value : viewer_default; }
};

struct TechniqueDescription {
  std::string name;     ///< of `view --method`, and of `render -i` if it has no other `offline_method`
  std::string title;    ///< in the panel
  std::string summary;  ///< in one line
  std::string paper{};
  std::vector<TechniqueParameter> parameters{};  ///< its own. Parameters of one name mean the same in all techniques
  bool has_photons = false;                      ///< `-n` is their number
  /// The frame has views and maps of the lights, and draws direct light by them. False: the technique draws all light.
  bool has_light_views = true;
  /// The method of `render` that shows the same; empty: `render` takes the mean of frames of the technique.
  std::string offline_method{};
  std::optional<int> offline_depth{};  ///< `-d` of that method
};

/// Parameters that all techniques with views of lights have besides their own.
const std::vector<TechniqueParameter>& light_parameters();
/// The technique's own parameters and these.
std::vector<TechniqueParameter> all_parameters(const TechniqueDescription& technique);

}  // namespace lanthorn
