// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/flip.h"
#include "lanthorn/image_file.h"
#include "lanthorn/metrics.h"
#include "output_check.h"
#include "read_layer.h"
#include "render_arguments.h"
#include "report_json.h"
#include "rescue.h"

namespace lanthorn::program {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
  std::string image, reference;
  std::string layer = "color";
  std::string sem;
  std::vector<std::string> runs, reference_runs;
  std::string diff, json;
  ErrorOptions errors;
  FlipOptions flip;
  std::optional<double> max_mse, max_rel_mse, max_flip, max_mean_difference;
  bool require_agreement = false;
  std::uint64_t max_pixels = FileAccess::default_max_pixels;
};

struct CompareResult {
  int width = 0, height = 0;
  ImageErrors errors;
  std::optional<FlipResult> flip;
  bool flip_is_hdr = true;
  std::optional<Agreement> agreement;
  std::optional<Comparison> welch;
};

// Rate of false alarms over the whole picture.
constexpr double significance = 0.01;

/// 8-bit formats hold display values, so FLIP needs no exposure (LDR-FLIP).
bool is_display_format(const fs::path& path) {
  constexpr std::array extensions{".png", ".jpg", ".jpeg", ".bmp", ".tga", ".gif"};
  return std::find(extensions.begin(), extensions.end(), lower_extension(path)) != extensions.end();
}

void require_same_picture(const Image& image, const std::string& file, const Image& reference,
                          const std::string& reference_file) {
  if (image.width != reference.width || image.height != reference.height)
    throw Error({file}, fmt::format("is {} x {} pixels, but {} is {} x {}; render both at one resolution", image.width,
                                    image.height, reference_file, reference.width, reference.height));
  const bool both_know_their_window = lower_extension(file) == ".exr" && lower_extension(reference_file) == ".exr";
  if (both_know_their_window && (image.window.x != reference.window.x || image.window.y != reference.window.y))
    throw Error({file},
                fmt::format("shows another part of the picture than {}: their crop windows differ", reference_file));
}

std::vector<Image> read_runs(const std::string& first, const std::vector<std::string>& more, const CompareOptions& o,
                             const Image& reference, const std::string& reference_file) {
  std::vector<Image> runs;
  std::vector<std::string> files{first};
  files.insert(files.end(), more.begin(), more.end());
  for (const std::string& file : files) {
    runs.push_back(read_layer(file, o.layer, o.max_pixels));
    require_same_picture(runs.back(), file, reference, reference_file);
  }
  return runs;
}

CompareResult compare(const CompareOptions& o) {
  Image image = read_layer(o.image, o.layer, o.max_pixels), reference = read_layer(o.reference, o.layer, o.max_pixels);
  require_same_picture(image, o.image, reference, o.reference);
  CompareResult result;
  result.width = image.width;
  result.height = image.height;
  result.errors = image_errors(image, reference, o.errors);
  if (!o.sem.empty()) {
    const Image sem = read_layer(o.sem, o.layer, o.max_pixels);
    require_same_picture(sem, o.sem, reference, o.reference);
    const auto runs = read_runs(o.image, o.runs, o, reference, o.reference);
    result.agreement = agreement_with_reference(reference, sem, runs);
  }
  if (!o.reference_runs.empty()) {
    const auto runs = read_runs(o.image, o.runs, o, reference, o.reference);
    const auto reference_runs = read_runs(o.reference, o.reference_runs, o, reference, o.reference);
    result.welch = welch_tile_test(runs, reference_runs);
  }
  // FLIP compares colours: it applies to every colour layer, but not to normals or depths.
  if (o.layer != "normal" && image.channel_count() == 3) {
    image.channels = reference.channels = {"R", "G", "B"};
    result.flip_is_hdr = !(is_display_format(o.image) && is_display_format(o.reference));
    result.flip = result.flip_is_hdr ? hdr_flip(image, reference, o.flip) : ldr_flip(image, reference, o.flip);
  }
  return result;
}

void print_table(const CompareOptions& o, const CompareResult& r) {
  print("{} against {} (layer {}, {} x {})\n", o.image, o.reference, o.layer, r.width, r.height);
  print("  MSE             {:.6g}\n", r.errors.mse);
  print("  relMSE          {:.6g}   (epsilon {:g})\n", r.errors.rel_mse, o.errors.epsilon);
  if (r.errors.mean_ratio)
    print("  mean ratio      {:.6f}   ({:.6g} / {:.6g})\n", *r.errors.mean_ratio, r.errors.mean_image,
          r.errors.mean_reference);
  print("  max difference  {:.6g}\n", r.errors.max_difference);
  if (r.flip)
    print("  FLIP            {:.6f}   ({}, {:.1f} pixels per degree)\n", r.flip->mean, r.flip_is_hdr ? "HDR" : "LDR",
          o.flip.pixels_per_degree);
  if (r.errors.non_finite > 0) print("  NaN or infinite {}   (values excluded from the above)\n", r.errors.non_finite);
  if (r.agreement)
    print(
        "  z-test          {}: mean {:+.2f} % (standard error {:.2f} %), {:.1f} % of tiles beyond |z| = 4, "
        "relMSE of tiles {:.2e}, {} runs\n",
        r.agreement->agrees ? "agrees" : "DIFFERS", 100 * r.agreement->mean_difference, 100 * r.agreement->mean_error,
        100 * r.agreement->outliers, r.agreement->rel_mse, o.runs.size() + 1);
  if (r.welch)
    print("  Welch's test    {}: p = {:.3g} over {} tile channels (smallest {:.3g}, tile {}, {})\n",
          r.welch->p >= significance ? "agrees" : "DIFFERS", r.welch->p, r.welch->tests, r.welch->smallest_p,
          r.welch->tile_x, r.welch->tile_y);
}

nlohmann::json report(const CompareOptions& o, const CompareResult& r) {
  nlohmann::json json{{"image", o.image},
                      {"reference", o.reference},
                      {"layer", o.layer},
                      {"width", r.width},
                      {"height", r.height},
                      {"mse", r.errors.mse},
                      {"rel_mse", r.errors.rel_mse},
                      {"mean_image", r.errors.mean_image},
                      {"mean_reference", r.errors.mean_reference},
                      {"max_difference", r.errors.max_difference},
                      {"non_finite", r.errors.non_finite}};
  if (r.errors.mean_ratio) json["mean_ratio"] = *r.errors.mean_ratio;
  if (r.flip) json["flip"] = {{"mean", r.flip->mean}, {"kind", r.flip_is_hdr ? "hdr" : "ldr"}};
  if (r.agreement)
    json["z_test"] = {{"agrees", r.agreement->agrees},
                      {"mean_difference", r.agreement->mean_difference},
                      {"mean_error", r.agreement->mean_error},
                      {"outliers", r.agreement->outliers},
                      {"rel_mse", r.agreement->rel_mse}};
  if (r.welch)
    json["welch"] = {{"agrees", r.welch->p >= significance},
                     {"p", r.welch->p},
                     {"smallest_p", r.welch->smallest_p},
                     {"tests", r.welch->tests}};
  return json;
}

/// FLIP if available; otherwise each pixel's largest channel difference relative to the picture's largest.
FlipResult difference_map(const CompareOptions& o, const CompareResult& r) {
  if (r.flip) return *r.flip;
  const Image image = read_layer(o.image, o.layer, o.max_pixels),
              reference = read_layer(o.reference, o.layer, o.max_pixels);
  const std::size_t channels = image.channel_count();
  const double scale = r.errors.max_difference > 0 ? 1 / r.errors.max_difference : 0;
  FlipResult map{std::vector<float>(image.pixels.size() / channels)};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double d = scale * std::fabs(static_cast<double>(image.pixels[i]) - static_cast<double>(reference.pixels[i]));
    map.map[i / channels] = std::fmax(map.map[i / channels], static_cast<float>(std::isfinite(d) ? d : 1.0));
  }
  return map;
}

/// Prints each limit that is exceeded; returns false if there is one.
bool within_limits(const CompareOptions& o, const CompareResult& r) {
  bool good = true;
  const auto check = [&](const char* name, const std::optional<double>& limit, double value) {
    if (!limit || value <= *limit) return;
    say("{} is {:.6g}, more than {:g}\n", name, value, *limit);
    good = false;
  };
  check("MSE", o.max_mse, r.errors.mse);
  check("relMSE", o.max_rel_mse, r.errors.rel_mse);
  if (o.max_flip && !r.flip)
    throw Error(fmt::format("--max-flip: the layer {} has no FLIP; it is not a colour", o.layer));
  if (r.flip) check("FLIP", o.max_flip, r.flip->mean);
  const double both_black = r.errors.mean_image == 0 ? 0.0 : HUGE_VAL;
  check("the difference of the mean ratio from 1", o.max_mean_difference,
        r.errors.mean_ratio ? std::fabs(*r.errors.mean_ratio - 1) : both_black);
  const bool limited = o.max_mse || o.max_rel_mse || o.max_flip || o.max_mean_difference;
  if (limited && r.errors.non_finite > 0) {
    say("{} values are NaN or infinite\n", r.errors.non_finite);
    good = false;
  }
  if (!o.require_agreement) return good;
  return good && (!r.agreement || r.agreement->agrees) && (!r.welch || r.welch->p >= significance);
}

void check_files(const CompareOptions& o) {
  std::vector<InputFile> read{{o.image, "IMAGE"}, {o.reference, "REFERENCE"}};
  if (!o.sem.empty()) read.push_back({o.sem, "the picture of --sem"});
  for (const std::string& file : o.runs) read.push_back({file, "a picture of --runs"});
  for (const std::string& file : o.reference_runs) read.push_back({file, "a picture of --reference-runs"});
  std::vector<OutputFile> written;
  if (!o.diff.empty()) written.push_back({o.diff, "--diff", {".png"}});
  if (!o.json.empty() && o.json != "-") written.push_back({o.json, "--json", {}});
  check_outputs(read, written);
}

void run(const CompareOptions& o) {
  if (o.require_agreement && o.sem.empty() && o.reference_runs.empty())
    throw Error("--require-agreement needs --sem, or --runs and --reference-runs");
  check_files(o);
  const CompareResult result = compare(o);
  // Programs parse a report on standard output: print nothing else there.
  const std::string text = report_text(report(o, result));
  std::vector<Output> outputs{{"standard output", OutputKind::report, [&] {
                                 if (o.json == "-") return print_text(text);
                                 print_table(o, result);
                               }}};
  if (!o.json.empty() && o.json != "-")
    outputs.push_back({o.json, OutputKind::report, [&] { write_file(o.json, text); }});
  if (!o.diff.empty())
    outputs.push_back({o.diff, OutputKind::picture, [&] {
                         write_png(o.diff, flip_colors(difference_map(o, result), result.width, result.height));
                       }});
  write_all(outputs);
  if (!within_limits(o, result)) throw CLI::RuntimeError(1);
}

OptionTable error_options(CompareOptions& o) {
  const auto limit = [](const char* name, std::optional<double>& value, const char* what) {
    return Option{.names = name,
                  .value = into(value, number_type({.low = 0})),
                  .brief = std::string("Exit with 1 if ") + what + " more than this"};
  };
  return {{.names = "--epsilon",
           .value = into(o.errors.epsilon, number_type({.low = 1e-30})),
           .brief = "relMSE is the mean of (a - r)^2 / (r^2 + epsilon)",
           .otherwise = fmt::format("{}", o.errors.epsilon)},
          {.names = "--clamp",
           .value = into(o.errors.rel_clamp, number_type({.low = 0})),
           .brief = "Largest contribution of one value to relMSE, against fireflies",
           .group = "Method"},
          limit("--max-mse", o.max_mse, "MSE is"),
          limit("--max-relmse", o.max_rel_mse, "relMSE is"),
          limit("--max-flip", o.max_flip, "the mean FLIP is"),
          limit("--max-mean-difference", o.max_mean_difference, "the ratio of means differs from 1 by")};
}

OptionTable compare_options(CompareOptions& o) {
  const OptionTable pictures{
      required_file("IMAGE", o.image, "Picture: .exr, .png, .hdr, .pfm ..."),
      required_file("REFERENCE", o.reference, "Reference of the same size"),
      layer_option(o.layer, "Layer to compare"),
      file_option("--sem", o.sem, "Standard error of the reference's pixels: enables the z-test (needs --runs)"),
      {.names = "--runs",
       .value = each_into(o.runs, text_type("FILE"), Arity::several),
       .brief = "More renders like IMAGE with other seeds, for the tests"},
      {.names = "--reference-runs",
       .value = each_into(o.reference_runs, text_type("FILE"), Arity::several),
       .brief = "More renders like REFERENCE with other seeds: enables Welch's t-test (needs --runs)"},
      file_option("--diff", o.diff, "Write the map of differences as a .png (FLIP: black 0, pale yellow 1)"),
      file_option("--json", o.json, "Write the numbers as JSON; - for standard output, instead of the table")};
  const OptionTable last{max_pixels_option(o.max_pixels),
                         {.names = "--require-agreement",
                          .value = flag(o.require_agreement),
                          .brief = "Exit with 1 if the z-test or Welch's test finds a difference"}};
  return joined(joined(pictures, error_options(o)), last);
}

}  // namespace

void add_compare(CLI::App& app) {
  const auto o = std::make_shared<CompareOptions>();
  constexpr const char* footer =
      "Exit code: 0, or 1 if a limit is exceeded, or 2 if a picture cannot be used.\n"
      "The z-test compares means of 8x8 tiles: they agree if at most 3 % of them differ by more than 4 standard "
      "errors\n"
      "and 3 % of the mean, and the picture's mean by at most 1 % or 4 standard errors. Welch's test is two-sided "
      "with\n"
      "1 % false alarms for the whole picture.\n\n"
      "Examples:\n"
      "  lanthorn compare a.exr b.exr --diff difference.png --max-flip 0.05\n"
      "  lanthorn compare s1.exr reference.exr --sem reference.sem.exr --runs s2.exr s3.exr --require-agreement";
  add_command(app, {"compare", "Measure the difference of two pictures, and test whether noise explains it",
                    compare_options(*o), footer, [o] { run(*o); }});
}

}  // namespace lanthorn::program
