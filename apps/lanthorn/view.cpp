// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/image_file.h"
#include "lanthorn/methods.h"
#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "lanthorn/threads.h"
#include "lanthorn/version.h"
#include "lanthorn/viewer.h"
#include "output.h"
#include "output_check.h"
#include "render_command.h"
#include "report_json.h"

namespace lanthorn::program {

namespace {

namespace fs = std::filesystem;

struct ViewCommand : RenderArguments {
  std::string method = "ispm", output, json;
  std::uint32_t frames = 0;
  bool headless = false;
  OutputSettings picture;
  SceneChanges changes;
};

nlohmann::json report_json(const ViewerReport& r) {
  nlohmann::json stages = nlohmann::json::array();
  for (const FrameStage& s : r.stages) stages.push_back({{"name", s.name}, {"ms", s.milliseconds}});
  return {{"lanthorn", version},
          {"method", r.method},
          {"driver", r.driver},
          {"software", r.software},
          {"width", r.width},
          {"height", r.height},
          {"frames", r.frames},
          {"seconds", r.seconds},
          {"stages", std::move(stages)},
          {"photons_per_bounce", r.photons_per_bounce},
          {"limitations", r.limitations}};
}

std::string known_methods() {
  std::vector<std::string> names;
  for (const MethodInfo& method : realtime_methods()) names.push_back(method.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string method_help() {
  std::string methods;
  for (const MethodInfo& method : realtime_methods()) methods += fmt::format("{} ({}), ", method.name, method.summary);
  return methods + "or an offline method of 'lanthorn list', which refines while the camera rests.";
}

// Lists each parameter once, under the first method that has it.
std::string parameter_help() {
  std::string text;
  std::set<std::string> known;
  for (const MethodInfo& method : realtime_methods())
    for (const ParameterInfo& p : method.parameters)
      if (known.insert(p.name).second)
        text += fmt::format("  {:<9} default {:<7} {}\n", p.name, p.default_value, p.help);
  return text.empty() ? text : "--set of the methods that draw by OpenGL:\n" + text + "\n";
}

void check_arguments(const ViewCommand& a) {
  if (a.headless && a.output.empty()) throw Error("--headless: expected -o FILE, where the picture goes");
  if (!a.headless && !a.output.empty())
    throw Error("-o: goes with --headless; the window saves pictures by its own buttons");
  if (a.headless && a.frames == 0) throw Error("--headless: expected --passes N, the number of frames of the picture");
  const std::vector<MethodInfo> here = realtime_methods();
  const auto is_asked_for = [&](const MethodInfo& method) { return method.name == a.method; };
  if (here.empty() || std::any_of(here.begin(), here.end(), is_asked_for)) return;
  try {
    find_method(a.method);
  } catch (const Error& e) {
    throw Error(
        fmt::format("--integrator {}: expected {}, or an offline method: {}", a.method, known_methods(), e.message));
  }
}

// The command line of an offline render. `film_measures`: as for `shown_as`.
std::string command_of(const ViewCommand& a, const ShownRender& shown, bool film_measures) {
  RenderCommand render;
  render.scene = shown.scene.string();
  render.options = shown.options;
  render.options.memory.reset();
  render.reading = a.reading;
  // A saved scene contains the camera of the window.
  const bool is_saved = shown.scene != a.scene;
  render.changes = moved(a.changes, shown.look || is_saved ? shown.look : a.changes.look, shown.light_factors);
  if (is_saved) render.changes.lens.orbit.reset();
  render.output = shown_as(shown.display, shown.measures_exposure, film_measures);
  render.output.denoise = shown.denoises;
  render.outputs = {shown.picture};
  return render_command_line(render);
}

void show(const ViewCommand& a, const SharedScene& original, const ViewerOptions& options) {
  const SharedScene scene = scale_lights(original, a.changes.lights);
  const ViewDescription view = view_of(*scene, a.changes, options.render);
  if (!a.headless) {
    const ViewerReport report = run_viewer(original, view, options);
    if (!a.json.empty()) write_file(a.json, report_text(report_json(report)));
    return;
  }
  const ViewerFrames frames = render_frames(scene, view, options);
  for (const std::string& limitation : frames.report.limitations) warn("{}", limitation);
  // No times in the file: equal pictures give equal files.
  const nlohmann::json metadata{
      {"version", version}, {"method", frames.report.method}, {"frames", frames.report.frames}};
  write_picture(a.output, picture_for(a.output, frames.image), a.picture, view.film.measures_exposure, metadata.dump());
  if (!a.json.empty()) write_file(a.json, report_text(report_json(frames.report)));
  announce("{}: {} frames by {}{}\n", a.output, frames.report.frames, frames.report.method,
           frames.report.software ? " (OpenGL in software)" : "");
}

void run_view(const ViewCommand& a) {
  check_arguments(a);
  const ThreadLimit limit(a.threads);
  ViewerOptions options;
  options.method = a.method;
  options.render = a.options;
  options.display = a.picture.display;
  options.scene_file = a.scene;
  options.frames = a.frames;
  options.light_factors = a.changes.lights;
  options.denoises = a.picture.denoise;
  SceneDescription description = read_scene(a.scene, a.reading);
  const bool film_measures = description.view.film.measures_exposure;
  options.measures_exposure = a.picture.measures_exposure.value_or(film_measures);
  options.display.curve = curve_of(a.picture, options.measures_exposure);
  options.command = [&a, film_measures](const ShownRender& shown) { return command_of(a, shown, film_measures); };
  check_view(description.view, options.render);
  std::vector<OutputFile> outputs;
  if (!a.output.empty()) outputs.push_back({a.output, "-o", picture_extensions()});
  if (!a.json.empty()) outputs.push_back({a.json, "--json"});
  check_outputs(files_of(description.files, a.scene), outputs);
  if (!a.headless) make_nodes_movable(description);
  const SharedScene scene = build_scene(std::move(description));
  try {
    show(a, scene, options);
  } catch (const ViewerUnavailable& e) {
    throw Error(
        fmt::format("{}. 'lanthorn serve {}' shows the scene in a browser, without OpenGL", e.message, a.scene));
  }
}

OptionTable view_options(ViewCommand& a) {
  constexpr std::uint64_t most_frames = 1'000'000;
  OptionTable own{
      {.names = "-i,--integrator",
       .value = into(a.method, text_type("INTEGRATOR")),
       .brief = "Method that is shown first",
       .details = method_help(),
       .otherwise = a.method},
      {.names = "--headless",
       .value = flag(a.headless),
       .brief = "Draw without a window or display; needs --passes and -o"},
      {.names = "-p,--passes",
       .value = into(a.frames, count_type({1, most_frames})),
       .brief = "With --headless: passes (frames) to average. Else: close after this many"},
      file_option("-o,--output", a.output, "With --headless: the picture (.png, .jpg, .tif, or .exr with all layers)"),
      file_option("--json", a.json, "Write frame times by stage and photons per bounce as JSON")};
  OptionTable render = without(render_options(a), "--integrator");
  OptionTable table = joined(joined(std::move(render), scene_change_options(a.changes)), std::move(own));
  table.push_back(denoise_option(a.picture.denoise, "Remove the noise of pictures of offline methods, layer by layer"));
  return joined(std::move(table), display_options(a.picture, exposure_of_scene));
}

}  // namespace

void add_view(CLI::App& app) {
  const auto a = std::make_shared<ViewCommand>();
  const std::string footer = parameter_help() +
                             "Drag: orbit; right drag: look around; middle or Shift drag: pan; wheel: zoom; W A S D E "
                             "Q: fly; click: select a\n"
                             "light or an object, and drag it. docs/viewer.md has the rest.\n\nExamples:\n"
                             "  lanthorn view scene.pbrt\n"
                             "  lanthorn view scene.pbrt -i vcm -r 640x360\n"
                             "  lanthorn view scene.pbrt --headless -p 16 -o picture.png";
  add_command(app, {"view", "Show a scene in a window; global illumination follows edits in real time",
                    view_options(*a), footer, [a] { run_view(*a); }});
}

}  // namespace lanthorn::program
