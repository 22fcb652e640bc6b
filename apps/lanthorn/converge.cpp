// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "commands.h"
#include "console.h"
#include "lanthorn/convergence.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/image_file.h"
#include "lanthorn/metrics.h"
#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "lanthorn/threads.h"
#include "output_check.h"
#include "progress.h"
#include "render_arguments.h"
#include "report_json.h"
#include "rescue.h"
#include "signals.h"

namespace lanthorn::program {
namespace {

struct ConvergeCommand : RenderArguments {
  std::string reference, plot, json;
  bool quiet = false;
  ConvergenceSettings settings;
};

std::string format_slope(const std::optional<double>& slope) { return slope ? fmt::format("{:.3f}", *slope) : "-"; }

void print_slopes(const Convergence& c, const ConvergenceSettings& settings) {
  if (!c.variance_slope) {
    print("no exponents: they take two numbers of passes, the first of them {} (--fit-from)\n", settings.fit_from);
    return;
  }
  print("from {} passes on: variance ~ passes^{}{}\n", settings.fit_from, format_slope(c.variance_slope),
        c.bias_slope ? ", bias ~ passes^" + format_slope(c.bias_slope) : "");
}

void print_table(const Convergence& c, const ConvergenceSettings& settings) {
  const auto optional = [](const std::optional<double>& x) { return x ? fmt::format("{:.5g}", *x) : "-"; };
  print("{:>8}  {:>12}  {:>12}  {:>12}\n", "passes", "deviation", "bias", "RMS error");
  for (const ConvergencePoint& p : c.points)
    print("{:>8}  {:>12.5g}  {:>12}  {:>12}\n", p.passes, p.deviation, optional(p.bias), optional(p.error));
  print_slopes(c, settings);
}

nlohmann::json report(const Convergence& c, const ConvergeCommand& a) {
  nlohmann::json points = nlohmann::json::array();
  for (const ConvergencePoint& p : c.points)
    points.push_back(
        {{"passes", p.passes}, {"deviation", p.deviation}, {"bias", or_null(p.bias)}, {"rms_error", or_null(p.error)}});
  return {{"scene", a.scene},
          {"runs", c.runs},
          {"fit_from", a.settings.fit_from},
          {"points", points},
          {"variance_slope", or_null(c.variance_slope)},
          {"bias_slope", or_null(c.bias_slope)}};
}

// Log-log plot of the curves as SVG.
class Plot {
 public:
  explicit Plot(const Convergence& c) : points_(c.points) {
    for (const ConvergencePoint& p : points_)
      for (const double y : {p.deviation, p.bias.value_or(0), p.error.value_or(0)})
        if (y > 0) {
          low_ = std::min(low_, std::floor(std::log10(y)));
          high_ = std::max(high_, std::ceil(std::log10(y)));
        }
    last_ = std::max(1.0, std::log2(static_cast<double>(points_.back().passes)));
  }

  std::string svg(const Convergence& c) const {
    std::string s = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" font-family=\"sans-serif\" "
        "font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        left + width + right, top + height + bottom);
    for (double decade = low_; decade <= high_; ++decade) s += grid_line(y_of(decade), fmt::format("1e{:g}", decade));
    for (const ConvergencePoint& p : points_)
      s += text(x_of(p), top + height + 16, fmt::format("{}", p.passes), "middle");
    s += text(left + width / 2, top + height + 34, "passes", "middle");
    double line = top + 16;
    const auto curve = [&](const char* colour, const std::string& name, auto&& value) {
      const std::string path = polyline(colour, value);
      if (path.empty()) return;
      s += path + fmt::format("<g fill=\"{}\">{}</g>\n", colour, text(left + width + 12, line, name, "start"));
      line += 18;
    };
    curve("#1f77b4", "deviation (variance ~ N^" + format_slope(c.variance_slope) + ")",
          [](const ConvergencePoint& p) { return p.deviation; });
    curve("#d62728", "bias ~ N^" + format_slope(c.bias_slope),
          [](const ConvergencePoint& p) { return p.bias.value_or(0); });
    curve("#444444", "RMS error", [](const ConvergencePoint& p) { return p.error.value_or(0); });
    return s + "</svg>\n";
  }

 private:
  static constexpr double left = 60, right = 230, top = 20, bottom = 50, width = 420, height = 300;

  double x_of(const ConvergencePoint& p) const {
    return left + width * std::log2(static_cast<double>(p.passes)) / last_;
  }
  double y_of(double decade) const { return top + height * (high_ - decade) / std::max(1.0, high_ - low_); }
  static std::string text(double x, double y, const std::string& what, const char* anchor) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, what);
  }
  static std::string grid_line(double y, const std::string& label) {
    return fmt::format("<line x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" stroke=\"#cccccc\"/>\n", left,
                       left + width, y) +
           text(left - 6, y + 4, label, "end");
  }
  template <class Value>
  std::string polyline(const char* colour, Value&& value) const {
    std::string places;
    for (const ConvergencePoint& p : points_)
      if (const double y = value(p); y > 0) places += fmt::format("{:.1f},{:.1f} ", x_of(p), y_of(std::log10(y)));
    if (places.empty()) return {};
    return fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"2\" points=\"{}\"/>\n", colour, places);
  }

  const std::vector<ConvergencePoint>& points_;
  double low_ = 0, high_ = -300, last_ = 1;
};

std::optional<Image> read_reference(const std::string& file, std::uint64_t max_pixels) {
  if (file.empty()) return {};
  std::optional<Image> color = select_layer(read_image(file, ColorEncoding::automatic, max_pixels), "color");
  if (!color) throw Error({file}, "has no colour");
  return color;
}

void check_files(const ConvergeCommand& a, const SceneDescription& description) {
  std::vector<InputFile> read = files_of(description.files, a.scene);
  if (!a.reference.empty()) read.push_back({a.reference, "the picture of --reference"});
  std::vector<OutputFile> written;
  if (!a.plot.empty()) written.push_back({a.plot, "--plot", {".svg"}});
  if (!a.json.empty()) written.push_back({a.json, "--json", {}});
  check_outputs(read, written);
}

// Stops early at a signal.
Convergence measure(const Scene& scene, const RenderOptions& options, const ConvergeCommand& a,
                    const std::optional<Image>& reference) {
  ConvergenceSettings settings = a.settings;
  ProgressLine line(a.quiet);
  const std::uint64_t passes = options.passes.value_or(1);
  const auto start = std::chrono::steady_clock::now();
  settings.progress = [&](std::uint64_t runs, std::uint64_t done) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double fraction = static_cast<double>(runs * passes + done) / static_cast<double>(settings.runs * passes);
    line.show(fraction, seconds, [&] {
      return fmt::format("render {}/{}  pass {}/{}  {} left", runs + 1, settings.runs, done, passes,
                         format_duration(seconds_left(fraction, seconds)));
    });
  };
  settings.stop = &drop_requested();
  set_stage(Stage::measuring);
  Convergence result = measure_convergence(scene, description_of(scene).view, options, settings, reference);
  line.finish();
  return result;
}

void run(const ConvergeCommand& a) {
  handle_signals();
  const RenderOptions& options = a.options;
  const ThreadLimit limit(a.threads);
  SceneDescription description = read_scene(a.scene, a.reading);
  check_files(a, description);
  const std::optional<Image> reference = read_reference(a.reference, a.reading.max_pixels);
  check_view(description.view, options);
  const SharedScene scene = build_scene(std::move(description));
  const Convergence c = measure(*scene, options, a, reference);
  if (c.points.empty()) {
    say("lanthorn: {} of {} renders complete: too early for a table\n", c.runs, a.settings.runs);
    end_by_signal();
  }
  if (c.runs < a.settings.runs) say("lanthorn: {} of {} renders complete\n", c.runs, a.settings.runs);
  set_stage(Stage::saving);
  std::vector<Output> outputs{{"standard output", OutputKind::report, [&] { print_table(c, a.settings); }}};
  if (!a.json.empty())
    outputs.push_back({a.json, OutputKind::report, [&] { write_file(a.json, report_text(report(c, a))); }});
  if (!a.plot.empty()) outputs.push_back({a.plot, OutputKind::report, [&] { write_file(a.plot, Plot(c).svg(c)); }});
  write_all(outputs);
}

OptionTable converge_options(ConvergeCommand& a) {
  OptionTable own{{.names = "-p,--passes",
                   .value = into(a.options.passes, count_type({1, most_passes})),
                   .brief = "Passes of each render; measured at 1, 2, 4, ... of them",
                   .otherwise = std::to_string(*a.options.passes)},
                  {.names = "--runs",
                   .value = into(a.settings.runs, count_type({2, 1'000'000})),
                   .brief = "Number of renders; their seeds count up from --seed",
                   .otherwise = std::to_string(a.settings.runs)},
                  file_option("--reference", a.reference, "Converged picture of the same size, for bias and error"),
                  {.names = "--fit-from",
                   .value = into(a.settings.fit_from, count_type({1, most_passes})),
                   .brief = "First number of passes that counts for the fitted exponents",
                   .otherwise = std::to_string(a.settings.fit_from)},
                  file_option("--plot", a.plot, "Write the curves as .svg"),
                  file_option("--json", a.json, "Write the numbers as JSON"),
                  {.names = "-q,--quiet", .value = flag(a.quiet), .brief = "Print no progress"}};
  return joined(render_options(a), std::move(own));
}

}  // namespace

void add_converge(CLI::App& app) {
  const auto a = std::make_shared<ConvergeCommand>();
  a->options.passes = 64;
  constexpr const char* footer =
      "Deviation is a pixel's standard deviation over the renders; bias the difference of their mean from the "
      "reference;\nboth are root mean squares over pixels and channels.\n"
      "On Ctrl-C and other signals it ends with the complete renders, if there are at least two.\n\nExample:\n"
      "  lanthorn render scene.pbrt -i path -r 16x16 --passes 100000 -o reference.exr\n"
      "  lanthorn converge scene.pbrt -i probppm -r 16x16 --set alpha=0.7 --set radius=0.2 --passes 512 "
      "--reference reference.exr --plot slopes.svg";
  add_command(app, {"converge", "Measure how noise and bias fall with the number of passes", converge_options(*a),
                    footer, [a] { run(*a); }});
}

}  // namespace lanthorn::program
