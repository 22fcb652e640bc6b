// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>

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

/// An option of all commands that render, without its effect. Command line, help, messages, plain
/// data, Python and `RenderIdentity` follow from it.
template <class Value>
struct RenderOption {
  const char* name;  ///< in plain data and Python; for the command line, see `flag_name`
  std::optional<Value> RenderOptions::*value;
  const char* letter = "";  ///< short name in the command line
  std::uint64_t least = 0;  ///< of a count
  bool is_bytes = false;    ///< a count of bytes
  /// The identity has the user's value, if there is one, under the option's name. The identity has other options as
  /// the render has resolved them, or not at all.
  bool is_recorded = false;
  const char* brief = "";      ///< what it is or does, in one line
  const char* details = "";    ///< more sentences
  const char* otherwise = "";  ///< the default, where there is one to tell
};

inline constexpr std::tuple render_option_list{
    RenderOption<std::string>{.name = "integrator",
                              .value = &RenderOptions::integrator,
                              .letter = "i",
                              .brief = "Rendering method; 'lanthorn list' shows them",
                              .otherwise = "auto, or the scene file's if it names a method that only Lanthorn has"},
    RenderOption<std::uint64_t>{
        .name = "photons",
        .value = &RenderOptions::photons,
        .letter = "n",
        .least = 1,
        .brief = "Light paths per pass, such as 500000, 200k or 1M",
        .details = "auto traces as many as reduce the error per work, from none to 4 times this number.",
        .otherwise = "the scene file's (not for auto), else one per pixel, at least 100k (auto, bdpt, vcm: 10k; auto: "
                     "at most 524k)"},
    RenderOption<int>{
        .name = "max_depth",
        .value = &RenderOptions::max_depth,
        .letter = "d",
        .least = 1,
        .brief = "Largest number of scattering events per path",
        .details = "In media of high albedo the default is higher: the depth at which a thousandth of the light is "
                   "left. A passage under the surface of skin or wax counts once. The program reports how much light "
                   "the limit may have cut off.",
        .otherwise = "the scene file's, else 64; in media up to 4096"},
    RenderOption<float>{
        .name = "clamp",
        .value = &RenderOptions::clamp,
        .is_recorded = true,
        .brief = "Clamp each path's contribution to a pixel, except for directly visible lights (biased)",
        .details = "Fireflies become fewer, but light is lost. The EXR file records the limit.",
        .otherwise = "no limit"},
    RenderOption<ColorMode>{
        .name = "color",
        .value = &RenderOptions::color,
        .brief = "Colour mode",
        .otherwise = "spectral if glass disperses light or the scene has measured spectra other than metals', else "
                     "rgb"},
    RenderOption<std::uint64_t>{.name = "seed",
                                .value = &RenderOptions::seed,
                                .letter = "s",
                                .brief = "Seed of all random numbers",
                                .otherwise = "the scene file's, else 0"},
    RenderOption<std::array<int, 2>>{.name = "resolution",
                                     .value = &RenderOptions::resolution,
                                     .letter = "r",
                                     .brief = "Size of the picture: 1000x600, or 1000 (width alone)",
                                     .details = "If only the width is given, the shape stays that of the scene file.",
                                     .otherwise = "the scene file's"},
    RenderOption<std::array<int, 4>>{
        .name = "crop",
        .value = &RenderOptions::crop,
        .brief = "Render only these pixels (x1, y1 excluded)",
        .details =
            "With the same --photons they equal those of the whole picture, exactly or up to rounding (docs/using.md); "
            "not with auto and mlt. --denoise also renders 24 pixels around them, which are kept in states only."},
    RenderOption<std::uint64_t>{
        .name = "memory",
        .value = &RenderOptions::memory,
        .is_bytes = true,
        .brief = "Memory limit for the film and a pass's photons or light vertices: 512M, 2G",
        .details = "The scene is not counted. A render that needs more is refused before it starts; reversephotonmap "
                   "works in blocks of pixels that fit. Most methods keep at most 8.4M light paths at a time (auto, "
                   "bdpt, bpm, vcm: 2.1M; sppm, ppm, photonmap: all). The picture does not depend on the limit.",
        .otherwise = "free memory"}};

template <class Visit>
void for_each_render_option(Visit&& visit) {
  std::apply([&](const auto&... option) { (visit(option), ...); }, render_option_list);
}

/// The option as it is typed: --max-depth.
inline std::string flag_name(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name;
}

}  // namespace lanthorn
