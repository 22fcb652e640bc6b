// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render_arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <map>

#include "lanthorn/error.h"

namespace lanthorn {

template <class Number>
std::vector<Number> parse_numbers(const std::string& text, char separator) {
  std::vector<Number> numbers;
  const char* p = text.data();
  const char* const end = p + text.size();
  while (true) {
    Number value{};
    const auto [next, error] = std::from_chars(p, end, value);
    if (error != std::errc() || (next != end && *next != separator)) return {};
    numbers.push_back(value);
    if (next == end) return numbers;
    p = next + 1;
  }
}
template std::vector<int> parse_numbers(const std::string& text, char separator);
template std::vector<std::uint64_t> parse_numbers(const std::string& text, char separator);

CLI::Validator positive_number() {
  return CLI::Validator(
      [](const std::string& text) {
        double value = 0;
        return CLI::detail::lexical_cast(text, value) && value > 0 ? "" : text + " is not more than 0";
      },
      "POSITIVE");
}

RenderOptions parse_render_arguments(const RenderArguments& a) {
  RenderOptions options = a.options;
  if (!a.color.empty()) options.color = a.color == "rgb" ? ColorMode::rgb : ColorMode::spectral;
  if (!a.resolution.empty()) {
    const std::vector<int> n = parse_numbers<int>(a.resolution, 'x');
    if (n.size() != 2) throw Error(fmt::format("--resolution {}: expected WIDTHxHEIGHT, e.g. 640x480", a.resolution));
    options.resolution = {n[0], n[1]};
  }
  if (!a.crop.empty()) {
    const std::vector<int> n = parse_numbers<int>(a.crop, ',');
    if (n.size() != 4) throw Error(fmt::format("--crop {}: expected x0,y0,x1,y1 in pixels", a.crop));
    options.crop = {n[0], n[1], n[2], n[3]};
  }
  for (const std::string& setting : a.set) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0) throw Error(fmt::format("--set {}: expected name=value", setting));
    options.set[setting.substr(0, equals)] = setting.substr(equals + 1);
  }
  return options;
}

void add_max_pixels(CLI::App& c, std::uint64_t& max_pixels) {
  const std::map<std::string, std::uint64_t> units{{"K", 1'000}, {"M", 1'000'000}, {"G", 1'000'000'000}};
  c.add_option("--max-pixels", max_pixels,
               "Refuse images of more pixels, such as 64M, before memory is taken for them. Default: 2^30")
      ->transform(CLI::AsNumberWithUnit(units))
      ->check(positive_number());
}

void add_read_options(CLI::App& c, ReadOptions& options) {
  c.add_flag("--sandbox", options.sandbox,
             "For scenes from strangers: read only files in the scene file's folder and those below it, whatever names "
             "and links say, and show nothing of what is in them in messages");
  add_max_pixels(c, options.max_pixels);
}

void add_render_arguments(CLI::App& c, RenderArguments& a) {
  c.add_option("scene", a.scene, "Scene file (.pbrt, .gltf, .glb, .obj)")->required()->check(CLI::ExistingFile);
  c.add_option("-i,--integrator", a.options.integrator,
               "Rendering method; 'lanthorn list' shows them. Default: the scene file's choice, else probppm");
  c.add_option("-T,--threads", a.threads, "Threads; 0: all cores. The image does not depend on it")
      ->capture_default_str();
  c.add_option("-s,--seed", a.options.seed, "Seed of all random numbers. Default: the scene file's, else 0");
  c.add_option("--color", a.color,
               "Colour: rgb or spectral. Default: spectral if the scene has measured spectra or dispersion")
      ->check(CLI::IsMember({"rgb", "spectral"}));
  c.add_option("-r,--resolution", a.resolution, "WIDTHxHEIGHT in pixels. Default: the scene file's");
  c.add_option("--crop", a.crop, "x0,y0,x1,y1: render only these pixels (ends not included)");
  c.add_option(
       "-n,--photons", a.options.photons,
       "Light paths per pass. Default: the scene file's, else one per pixel; 100000 at least, 10000 for bdpt and vcm")
      ->check(positive_number());
  c.add_option("-d,--max-depth", a.options.max_depth,
               "Scattering events per path, at most. Default: the scene file's, else 64")
      ->check(positive_number());
  c.add_option(
       "--memory", a.options.memory,
       "What the picture and a pass's photons or light vertices may take together, such as 512M or 2G; a render "
       "that needs more is refused before it starts (reversephotonmap works in blocks of pixels that fit). The "
       "scene does not count. Default: what the machine has left. The image does not depend on it")
      ->transform(CLI::AsSizeValue(false));
  add_read_options(c, a.reading);
  c.add_option("--set", a.set, "name=value: a parameter of the integrator; 'lanthorn list NAME' shows them");
}

}  // namespace lanthorn
