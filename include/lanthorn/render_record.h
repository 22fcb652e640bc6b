// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The record of a render, which its state, the metadata of its pictures and reports contain.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "lanthorn/color.h"
#include "lanthorn/effort_report.h"
#include "lanthorn/render_options.h"
#include "lanthorn/scene_description.h"

namespace lanthorn {

/// Members of the record or the identity that only other versions of the program know, as JSON text by name. They are
/// compared and passed on.
using OtherMembers = std::map<std::string, std::string>;

/// Everything that decides the picture. States can be resumed or merged only if their identities are equal.
struct RenderIdentity {
  std::string version{};                                 ///< of the program
  std::string scene_hash{};                              ///< of the scene file's content, hexadecimal
  std::map<std::string, std::set<std::string>> files{};  ///< hashes of the files of each name (folders may share names)
  std::string integrator{};
  std::map<std::string, std::string> parameters{};  ///< of the integrator
  std::uint64_t seed = 0;
  ColorMode color = ColorMode::rgb;
  int max_depth = 0;
  std::uint64_t photons = 0;                   ///< light paths per pass
  std::array<int, 2> resolution{};             ///< of the full film, pixels
  std::array<int, 4> crop{};                   ///< x0, y0, x1, y1, pixels; end exclusive
  std::optional<std::array<int, 4>> margin{};  ///< pixels left, top, right and bottom of the crop, in no picture
  description::Filter filter{};
  /// Sets of wavelengths that a pass shares. nullopt: each path draws its own. The name in states is that of the
  /// density of wavelengths: passes drawn with another density have another colour balance.
  std::optional<std::uint32_t> wavelength_sets{};
  bool heroes_of_paths = false;       ///< paths share a set's wavelengths, but each has its own hero (`PassDraw`)
  bool filter_lobes_apart = false;    ///< `FilterPart`
  RenderOptions options{};            ///< those of `RenderOption::is_recorded`
  std::optional<std::string> view{};  ///< hash of a view that is not the scene file's
  std::optional<std::array<int, 2>> coarse{};  ///< size of the coarse picture that takes the place of the first pass
  OtherMembers others{};
};

/// A render's identity, and information for readers of its files.
struct RenderRecord {
  RenderIdentity identity{};
  std::optional<std::string> scene{};                        ///< name of its file
  bool measures_exposure = false, display_emission = false;  ///< see description::Film
  bool bias_not_measured = false;
  std::optional<EffortReport> findings{};  ///< what the method has measured
  OtherMembers others{};
};

/// The record as the text of a JSON object, as states store it under the key "settings". U+FFFD replaces invalid UTF-8.
std::string settings_text(const RenderRecord& record);

}  // namespace lanthorn
