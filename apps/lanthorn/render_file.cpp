// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "console.h"
#include "lanthorn/file.h"
#include "lanthorn/image_file.h"
#include "lanthorn/state.h"
#include "lanthorn/text.h"
#include "output.h"
#include "report_json.h"
#include "shards.h"

namespace lanthorn::program {

namespace {

// A value from a file, shortened to a bounded length.
std::string text_of(const nlohmann::json& value) {
  constexpr std::size_t longest = 200;
  const std::string text = value.is_string() ? value.get<std::string>()
                                             : value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return text.substr(0, longest) + (text.size() > longest ? " ..." : "");
}

// Empty if the share is too small to matter.
std::string limit_text(double cut_share) {
  constexpr double least = 1e-4;
  if (cut_share < least) return {};
  return fmt::format("ended paths that still had {} % of the throughput: light may be missing",
                     short_number(100 * cut_share));
}

void print_line(const char* name, const std::string& text) { print("{:<10} {}\n", name, text); }

std::string parameters_text(const nlohmann::json& parameters) {
  if (!parameters.is_object()) return text_of(parameters);
  std::string text;
  for (const auto& [name, value] : parameters.items())
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, text_of(value));
  return text.empty() ? "(none)" : text;
}

// The information that both states and pictures hold, under the names of the options.
void print_settings(const nlohmann::json& settings) {
  constexpr std::array<std::pair<const char*, const char*>, 7> members{{{"integrator", "method"},
                                                                        {"scene", "scene"},
                                                                        {"seed", "seed"},
                                                                        {"color", "color"},
                                                                        {"max_depth", "max-depth"},
                                                                        {"photons", "photons"},
                                                                        {"version", "version"}}};
  for (const auto& [member, name] : members)
    if (const auto found = settings.find(member); found != settings.end()) print_line(name, text_of(*found));
  if (const auto found = settings.find("parameters"); found != settings.end())
    print_line("set", parameters_text(*found));
  const auto findings = settings.find("findings");
  if (findings != settings.end() && findings->is_object() && findings->contains("summary"))
    print_line("found", text_of(findings->at("summary")));
}

std::string size_text(const ImageWindow& window, int width, int height) {
  const std::string size = fmt::format("{} x {} pixels", width, height);
  if (window.full_width == 0 || (window.full_width == width && window.full_height == height)) return size;
  return fmt::format("{}, the part {},{},{},{} of {} x {}", size, window.x, window.y, window.x + width,
                     window.y + height, window.full_width, window.full_height);
}

std::string join(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

std::string passes_text(const StateSummary& state) {
  return fmt::format("{} ({}), rendered in {}", state.pass_count,
                     state.passes.empty() ? "none" : ranges_text(state.passes), format_duration(state.seconds));
}

nlohmann::json settings_of(const StateSummary& state) {
  const nlohmann::json all = settings_json(state.record);
  nlohmann::json settings = all.at("identity");
  settings["integrator"] = state.integrator;
  for (const char* member : {"scene", "findings"})
    if (const auto found = all.find(member); found != all.end()) settings[member] = *found;
  return settings;
}

// Validates untrusted metadata: anybody may have written the picture.
bool is_error(const nlohmann::json& error) {
  constexpr std::array<const char*, 4> numbers{"noise", "bias", "error", "bound"};
  return error.is_object() && error.contains("doubt") && error["doubt"].is_string() &&
         std::all_of(numbers.begin(), numbers.end(),
                     [&](const char* name) { return error.contains(name) && error[name].is_number(); });
}

std::string error_line(const nlohmann::json& error) {
  const auto percent = [&](const char* member) { return short_number(100 * error.at(member).get<double>()); };
  ErrorEstimate e;
  e.bound = error.at("bound").get<double>();
  e.doubt = text_of(error.at("doubt"));
  if (e.is_known())
    return fmt::format("{} with 90 % confidence; noise {} %, bias {} %", describe_error(e), percent("noise"),
                       percent("bias"));
  // An error of 1, the largest one, stands for nothing measured.
  const std::string measured = fmt::format("; noise about {} %, bias about {} %", percent("noise"), percent("bias"));
  return describe_error(e) + (error.at("error").get<double>() < 1 ? measured : "");
}

nlohmann::json state_json(const StateSummary& state, const ErrorEstimate& error,
                          const std::vector<std::string>& layers) {
  nlohmann::json passes = nlohmann::json::array();
  for (const PassRange& range : state.passes) passes.push_back({range.begin, range.end});
  return {{"kind", "state"},
          {"intact", true},
          {"method", state.integrator},
          {"settings", settings_of(state)},
          {"passes", passes},
          {"pass_count", state.pass_count},
          {"seconds", state.seconds},
          {"mergeable", state.mergeable},
          {"cut_share", state.cut_share},
          {"error", estimate_json(error)},
          {"width", state.width},
          {"height", state.height},
          {"layers", layers},
          {"non_finite", state.report.non_finite}};
}

// Lists and objects are JSON text in pictures, and so are numbers in PNG files; the content is untrusted.
nlohmann::json picture_settings(const std::string& file) {
  constexpr int deepest = 8;
  const auto limit_depth = [](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
    return depth <= deepest;
  };
  nlohmann::json settings = nlohmann::json::parse(read_image_metadata(file));
  constexpr std::array<std::string_view, 6> numbers{"seed", "passes", "photons", "max_depth", "seconds", "cut_share"};
  for (const auto& member : settings.items()) {
    nlohmann::json& value = member.value();
    if (!value.is_string()) continue;
    const std::string text = value.get<std::string>();
    const bool is_number = std::find(numbers.begin(), numbers.end(), member.key()) != numbers.end();
    if (!is_number && !text.starts_with('{') && !text.starts_with('[')) continue;
    if (nlohmann::json parsed = nlohmann::json::parse(text, limit_depth, /*allow_exceptions=*/false);
        !parsed.is_discarded())
      value = std::move(parsed);
  }
  return settings;
}

std::uint64_t count_non_finite(const Image& image) {
  return static_cast<std::uint64_t>(
      std::count_if(image.pixels.begin(), image.pixels.end(), [](float x) { return !std::isfinite(x); }));
}

}  // namespace

FileKind kind_of_file(const std::string& file) {
  const std::string extension = lower_extension(file);
  if (extension == ".state") return FileKind::state;
  constexpr std::array<std::string_view, 11> pictures{".exr", ".png", ".hdr", ".pfm",  ".jpg", ".jpeg",
                                                      ".tif", ".tga", ".bmp", ".tiff", ".gif"};
  return std::find(pictures.begin(), pictures.end(), extension) != pictures.end() ? FileKind::picture : FileKind::other;
}

void show_state(const std::string& file, bool as_json) {
  const std::shared_ptr<RenderState> sums = open_state(file);  // verifies the checksum and every number
  const StateSummary state = summarize(*sums);
  const auto [picture, error] = measured_picture_of(*sums);
  const std::vector<std::string> layers = layer_names(picture);
  if (as_json) return print_text(report_text(state_json(state, error, layers)));
  print_line("state", file + " (intact)");
  print_settings(settings_of(state));
  print_line("passes", passes_text(state));
  print_line("error", error_line(estimate_json(error)));
  if (const std::string limit = limit_text(state.cut_share); !limit.empty()) print_line("depth", limit);
  print_line("merge", state.mergeable ? "with states of other passes"
                                      : "not possible: each pass depends on all before it; --resume only");
  print_line("size", size_text(state.window, state.width, state.height));
  print_line("layers", join(layers));
  if (const auto problem = describe_problems(state.report)) print_line("warning", *problem);
}

void show_picture(const std::string& file, std::uint64_t max_pixels, bool as_json) {
  const Image image = read_image(file, ColorEncoding::automatic, max_pixels);
  const nlohmann::json metadata = picture_settings(file);
  const std::vector<std::string> layers = layer_names(image);
  const std::uint64_t non_finite = count_non_finite(image);
  if (as_json) {
    const nlohmann::json report{
        {"kind", "picture"},
        {"method", metadata.value("integrator", nlohmann::json())},
        {"settings", metadata},
        {"width", image.width},
        {"height", image.height},
        {"window", {image.window.x, image.window.y, image.window.full_width, image.window.full_height}},
        {"layers", layers},
        {"non_finite", non_finite}};
    return print_text(report_text(report));
  }
  print_line("picture", file);
  if (metadata.empty()) print_line("method", "(not known: the file holds no settings of Lanthorn)");
  print_settings(metadata);
  if (const auto passes = metadata.find("passes"); passes != metadata.end()) print_line("passes", text_of(*passes));
  for (const auto& [title, member] : {std::pair("error", "error"), std::pair("denoised", "denoised_error")})
    if (const auto error = metadata.find(member); error != metadata.end() && is_error(*error))
      print_line(title, error_line(*error));
  if (const auto cut = metadata.find("cut_share"); cut != metadata.end() && cut->is_number())
    if (const std::string limit = limit_text(cut->get<double>()); !limit.empty()) print_line("depth", limit);
  print_line("size", size_text(image.window, image.width, image.height));
  print_line("layers", join(layers));
  if (non_finite > 0) print_line("warning", fmt::format("{} values are NaN or infinite", non_finite));
}

}  // namespace lanthorn::program
