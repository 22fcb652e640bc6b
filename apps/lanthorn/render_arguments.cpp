// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render_arguments.h"

#include <limits>
#include <utility>

namespace lanthorn::program {

namespace {

constexpr std::uint64_t most_threads = 1 << 16;
constexpr auto largest_int = static_cast<std::uint64_t>(std::numeric_limits<int>::max());

}  // namespace

Option max_pixels_option(std::uint64_t& max_pixels) {
  return {.names = "--max-pixels",
          .value = into(max_pixels, count_type({.low = 1})),
          .brief = "Refuse images with more pixels, such as 64M",
          .details = "The check comes before memory is allocated.",
          .otherwise = "2^30"};
}

Option threads_option(unsigned& threads, const std::string& independence) {
  return {.names = "-T,--threads",
          .value = into(threads, count_type({0, most_threads})),
          .brief = "Number of threads; 0 uses all cores",
          .details = independence +
                     " All cores are those that CPU affinity and the quota of a control group (container) leave to the "
                     "program; 'lanthorn info --machine' shows them.",
          .otherwise = "0"};
}

OptionTable read_options(ReadOptions& o) {
  return {{.names = "--window-glass",
           .value = flag(o.window_glass),
           .brief = "Let light pass straight through panes of glass",
           .details = "Panes are thindielectric surfaces and flat slabs of clear dielectric. Every method then finds "
                      "the light that comes through windows. For slabs this is an approximation."},
          {.names = "--sandbox",
           .value = flag(o.sandbox),
           .brief = "For untrusted scenes: read files only from the scene's folder and below",
           .details = "Paths and symbolic links that lead elsewhere are refused. Messages show no content of files."},
          max_pixels_option(o.max_pixels),
          {.names = "--texture-memory",
           .value = into(o.texture_memory, bytes_type()),
           .brief = "Limit for the textures in memory, such as 4G",
           .details = "Larger textures go to a temporary file, of which a render reads the parts that it needs. The "
                      "picture does not depend on the limit.",
           .otherwise = "half of the free memory"},
          {.names = "--missing",
           .value = into(o.skip_missing, choice_type<bool>({{"error", false}, {"skip", true}})),
           .brief = "Refuse a scene whose files are missing, or skip them",
           .details = "skip leaves out meshes and media, and replaces images by grey, spectra by 1 and lenses by one "
                      "of 50 mm. A warning names each file.",
           .otherwise = "error"},
          {.names = "--at",
           .value = into(o.at, animation_time_type()),
           .brief = "Time in the first animation of a glTF file: 1.5 (seconds) or frame=36@24",
           .details = "frame=36@24 is frame 36 at 24 frames a second; frame 0 is at 0 seconds.",
           .otherwise = "everything is at rest"}};
}

ValueType<float> environment_rotation_type() {
  constexpr double most_degrees = 1e6;
  return number_type<float>({-most_degrees, most_degrees});
}
ValueType<float> environment_scale_type() {
  constexpr double brightest = 1e12;
  return number_type<float>({0, brightest});
}

namespace {

OptionTable environment_options(EnvironmentChoice& e) {
  return {{.names = "--environment",
           .value = into(e.source, existing_file_or_word_type(environment_names())),
           .brief = "Light by an image, or by studio, overcast or sunny",
           .details = "It replaces the scene's environment and the stand-in studio; lamps stay. The image can have the "
                      "shape 2:1 (equirectangular) or 1:1 (octahedral), or be a cube map. y is up."},
          {.names = "--environment-rotate",
           .value = into(e.rotation, environment_rotation_type()),
           .brief = "Turn the environment by degrees, counter-clockwise from above",
           .details = "At 0 the centre of an equirectangular image lies in the direction +x, at 90 in -z.",
           .otherwise = "0"},
          {.names = "--environment-scale",
           .value = into(e.scale, environment_scale_type()),
           .brief = "Multiply the environment's radiance",
           .otherwise = "1"},
          {.names = "--environment-up",
           .value = into(e.up, choice_type<UpAxis>({{"y", UpAxis::y}, {"z", UpAxis::z}})),
           .brief = "The scene's up axis",
           .otherwise = "y; for pbrt files the axis nearer to the camera's up vector, named in a warning"}};
}

OptionTable scene_options(ReadOptions& o) {
  return joined({{.names = "--camera",
                  .value = into(o.camera, text_type("NAME")),
                  .brief = "A camera of a glTF file, by name or number (from 1)",
                  .otherwise = "the first one"},
                 {.names = "--variant",
                  .value = into(o.variant, text_type("NAME")),
                  .brief = "A variant of a glTF file's materials, by name or number (from 1)",
                  .otherwise = "the materials that the file gives to its meshes"}},
                environment_options(o.environment));
}

Option parameter_option(RenderOptions& o) {
  return {.names = "--set",
          .value = each_into(o.set, setting_type()),
          .brief = "Set a parameter of the method (repeatable)",
          .details = "'lanthorn list INTEGRATOR' shows its parameters."};
}

ValueType<std::string> type_of(const RenderOption<std::string>&) { return text_type("INTEGRATOR"); }
ValueType<float> type_of(const RenderOption<float>&) { return number_type<float>(); }
ValueType<ColorMode> type_of(const RenderOption<ColorMode>&) {
  const auto& [rgb, spectral] = color_mode_names;
  return choice_type<ColorMode>({{std::string(rgb), ColorMode::rgb}, {std::string(spectral), ColorMode::spectral}});
}
ValueType<std::array<int, 2>> type_of(const RenderOption<std::array<int, 2>>&) { return resolution_type(); }
ValueType<std::array<int, 4>> type_of(const RenderOption<std::array<int, 4>>&) { return pixel_window_type(); }
ValueType<std::uint64_t> type_of(const RenderOption<int>& option) { return count_type({option.least, largest_int}); }
ValueType<std::uint64_t> type_of(const RenderOption<std::uint64_t>& option) {
  return option.is_bytes ? bytes_type() : count_type({.low = option.least});
}

}  // namespace

OptionTable render_options(RenderArguments& a) {
  RenderOptions& o = a.options;
  OptionTable picture{{.names = "scene",
                       .value = into(a.scene, existing_file_type()),
                       .brief = "Scene file (.pbrt, .gltf, .glb, .obj)",
                       .required = true}};
  for_each_render_option([&](const auto& option) {
    const std::string letter = option.letter;
    picture.push_back({.names = (letter.empty() ? "" : '-' + letter + ',') + flag_name(option.name),
                       .value = into(o.*option.value, type_of(option)),
                       .brief = option.brief,
                       .details = option.details,
                       .otherwise = option.otherwise,
                       .group = "Method"});
  });
  picture.push_back(threads_option(a.threads));
  return joined(joined(joined(std::move(picture), read_options(a.reading)), scene_options(a.reading)),
                {parameter_option(o)});
}

}  // namespace lanthorn::program
