// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render_arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <memory>

#include "lanthorn/error.h"
#include "lanthorn/shell.h"
#include "lanthorn/text.h"
#include "quantities.h"

namespace lanthorn::program {

namespace {

// Numbers between separators; empty if the text is anything else.
std::vector<int> parse_numbers(const std::string& text, char separator) {
  std::vector<int> numbers;
  const char* p = text.data();
  const char* const end = p + text.size();
  while (true) {
    int value = 0;
    const auto [next, error] = std::from_chars(p, end, value);
    if (error != std::errc() || (next != end && *next != separator)) return {};
    numbers.push_back(value);
    if (next == end) return numbers;
    p = next + 1;
  }
}

constexpr auto most_threads = 1 << 16;
constexpr auto largest_int = static_cast<std::uint64_t>(std::numeric_limits<int>::max());

// A word of a few, checked when the command line is read.
void add_choice(CLI::App& c, const std::string& names, std::string& value, const std::vector<std::string>& choices,
                const std::string& help) {
  const std::string name = names.substr(names.find("--"));
  const auto take = [name, choices, &value](const std::string& text) {
    if (std::find(choices.begin(), choices.end(), text) == choices.end())
      throw CLI::ValidationError(
          fmt::format("{} {}: expected {}{}", name, text, fmt::join(choices, " or "), did_you_mean(text, choices)));
    value = text;
  };
  c.add_option_function<std::string>(names, take, help)->type_name(fmt::format("{}", fmt::join(choices, "|")));
}

// The time of an animation, in seconds or as the number of a frame. `at` must outlive the parsing.
void add_time_options(CLI::App& c, std::optional<double>& at) {
  struct Frame {
    std::optional<double> number;
    double per_second = 24;
  };
  const auto frame = std::make_shared<Frame>();
  // The two options of a frame come in any order.
  const auto part = [&at, frame](auto member) {
    return [&at, frame, member](double value) {
      (*frame).*member = value;
      if (frame->number) at = *frame->number / frame->per_second;
    };
  };
  CLI::Option* const seconds = add_number_option(
      c, "--at", "Seconds into the first animation of a glTF file. Default: everything is at rest", {}, into(at));
  CLI::Option* const number = add_number_option(
      c, "--frame", "The same by the number of a frame; frame 0 is at 0 seconds", {}, part(&Frame::number));
  number->excludes(seconds);
  add_number_option(c, "--fps", "Frames a second of --frame. Default: 24", {.low = 1e-3}, part(&Frame::per_second))
      ->needs(number);
}

}  // namespace

RenderOptions parse_render_arguments(const RenderArguments& a) {
  RenderOptions options = a.options;
  if (!a.color.empty()) options.color = a.color == "rgb" ? ColorMode::rgb : ColorMode::spectral;
  if (!a.resolution.empty()) {
    const std::vector<int> n = parse_numbers(a.resolution, 'x');
    if (n.size() != 2) throw Error(fmt::format("--resolution {}: expected WIDTHxHEIGHT, e.g. 640x480", a.resolution));
    options.resolution = {n[0], n[1]};
  }
  if (!a.crop.empty()) {
    const std::vector<int> n = parse_numbers(a.crop, ',');
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

std::string text_of_other_options(const RenderArguments& a) {
  std::string text;
  const auto add = [&text](const std::string& option, const std::string& value) {
    text += fmt::format(" {} {}", option, shell_word(value));
  };
  if (!a.crop.empty()) add("--crop", a.crop);
  if (!a.color.empty()) add("--color", a.color);
  if (a.options.clamp) add("--clamp", fmt::format("{}", *a.options.clamp));
  if (a.reading.window_glass) text += " --window-glass";
  if (a.reading.sandbox) text += " --sandbox";
  if (a.reading.skip_missing) add("--missing", "skip");
  if (a.reading.at) add("--at", fmt::format("{}", *a.reading.at));
  return text;
}

void add_max_pixels(CLI::App& c, std::uint64_t& max_pixels) {
  add_count_option(c, "--max-pixels",
                   "Refuse images with more pixels, such as 64M, before allocating memory. Default: 2^30", {.low = 1},
                   into(max_pixels));
}

void add_read_options(CLI::App& c, ReadOptions& options) {
  c.add_flag(
      "--window-glass", options.window_glass,
      "Let light pass straight through panes (thindielectric, and flat slabs of clear dielectric), so that every "
      "method finds what comes through windows; an approximation for slabs");
  c.add_flag("--sandbox", options.sandbox,
             "For untrusted scenes: read only files in the scene file's folder and below it, whatever names and links "
             "say; messages show no content of files");
  add_max_pixels(c, options.max_pixels);
  c.add_option_function<std::string>(
       "--missing", [&options](const std::string& choice) { options.skip_missing = choice == "skip"; },
       "Missing files that the scene names: error (default), or skip: meshes and media are left out, images grey, "
       "spectra 1, lenses of 50 mm, and a warning names each")
      ->type_name("error|skip")
      ->check(CLI::IsMember({"error", "skip"}));
  add_time_options(c, options.at);
}

void add_render_arguments(CLI::App& c, RenderArguments& a) {
  c.add_option("scene", a.scene, "Scene file (.pbrt, .gltf, .glb, .obj)")->required()->check(CLI::ExistingFile);
  c.add_option("-i,--integrator", a.options.integrator,
               "Rendering method; 'lanthorn list' shows them. Default: the scene file's choice, else probppm")
      ->type_name("INTEGRATOR");
  add_count_option(c, "-T,--threads", "Threads; 0 (default): all cores. The image does not depend on it",
                   {0, most_threads}, into(a.threads));
  add_count_option(c, "-s,--seed", "Seed of all random numbers, 0 or more. Default: the scene file's, else 0", {},
                   into(a.options.seed));
  add_choice(
      c, "--color", a.color, {"rgb", "spectral"},
      "Colour mode. Default: spectral if glass disperses light or spectra other than metals' are measured, else rgb");
  c.add_option("-r,--resolution", a.resolution, "WIDTHxHEIGHT in pixels. Default: the scene file's");
  c.add_option("--clamp", a.options.clamp,
               "Limit what a path adds to a pixel, lamps seen directly left out, to this value: fewer fireflies, but "
               "biased; the EXR says so. Default: no limit")
      ->type_name("VALUE");
  c.add_option("--crop", a.crop,
               "x0,y0,x1,y1: render only these pixels (x1, y1 excluded). With the same --photons they equal those of "
               "the whole picture, for every method but mlt, exactly or up to rounding (docs/using.md)");
  add_count_option(c, "-n,--photons",
                   "Light paths per pass, such as 500000, 200k or 1M. Default: the scene file's, else one per pixel, "
                   "at least 100k (bdpt, vcm: 10k)",
                   {.low = 1}, into(a.options.photons));
  add_count_option(c, "-d,--max-depth", "Scattering events per path, at most. Default: the scene file's, else 64",
                   {1, largest_int}, into(a.options.max_depth));
  add_bytes_option(c, "--memory",
                   "Limit for the picture and the photons or light vertices of a pass together, such as 512M or 2G, "
                   "without the scene. A render that needs more is refused before it starts; reversephotonmap works in "
                   "blocks of pixels that fit. Default: free memory. The image does not depend on it",
                   into(a.options.memory));
  add_read_options(c, a.reading);
  c.add_option("--set", a.set,
               "A parameter of the integrator; may be given several times. 'lanthorn list INTEGRATOR' shows them")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
}

}  // namespace lanthorn::program
