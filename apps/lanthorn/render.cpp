// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>

#include "checkpoint.h"
#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "lanthorn/threads.h"
#include "output.h"
#include "output_check.h"
#include "preview.h"
#include "progress.h"
#include "quantities.h"
#include "render_arguments.h"
#include "rescue.h"
#include "scene_report.h"
#include "signals.h"

namespace lanthorn {

namespace {

namespace fs = std::filesystem;

struct RenderCommand : RenderArguments {
  std::vector<std::string> outputs;
  std::string pass_range, json, resume;
  std::optional<double> checkpoint_seconds, preview_seconds;
  OutputSettings output;
  bool no_checkpoint = false, no_preview = false, quiet = false;
};

// "0:50", "1k:2k"
PassRange parse_pass_range(const std::string& text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto begin = parse_count(text.substr(0, colon)),
             end = parse_count(text.substr(std::min(colon + 1, text.size())));
  if (!begin || !end || *begin >= *end)
    throw Error(fmt::format("--pass-range {}: expected FIRST:END with FIRST < END, e.g. 0:50", text));
  if (*end > most_passes) throw Error(fmt::format("--pass-range {}: there are {} passes at most", text, most_passes));
  return {*begin, *end};
}

RenderOptions parse_options(const RenderCommand& a) {
  RenderOptions options = parse_render_arguments(a);
  if (!a.pass_range.empty()) options.pass_range = parse_pass_range(a.pass_range);
  return options;
}

// The files asked for: those of -o, or else the scene's own name with .exr, in the working folder.
std::vector<fs::path> choose_outputs(const RenderCommand& a, const SceneDescription& description) {
  if (!a.outputs.empty()) return {a.outputs.begin(), a.outputs.end()};
  const std::string& own = description.view.film.filename;
  return {own.empty() ? fs::path(a.scene).stem().concat(".exr") : fs::path(own).filename()};
}

// Refuses before the render what could not be written after it, and what would be lost by it.
void check_files(const RenderCommand& a, const SceneDescription& description, const std::vector<fs::path>& outputs) {
  std::vector<InputFile> read = files_of(description.files, a.scene);
  if (!a.resume.empty()) read.push_back({a.resume, "the state of --resume"});
  const auto is_resumed = [&](const fs::path& path) { return !a.resume.empty() && same_file(path, a.resume); };
  std::vector<OutputFile> written;
  written.reserve(outputs.size() + 2);
  for (const fs::path& path : outputs)
    written.push_back(
        {path, a.outputs.empty() ? "the scene's output" : "-o", output_extensions, is_resumed(path), false});
  if (a.checkpoint_seconds) {
    const fs::path path = checkpoint_path(outputs);
    written.push_back({path, "--checkpoint", {".state"}, is_resumed(path), true});
  }
  if (!a.json.empty()) written.push_back({a.json, "--json", {}, false, false});
  check_outputs(read, written, a.output.force);
}

// Refuses to replace a state on disk that has passes which `passes` lack; the one that the render goes on from may be.
void check_state(const RenderCommand& a, const fs::path& path, const RenderState& state,
                 const std::vector<PassRange>& passes) {
  if (path.extension() != ".state" || a.output.force || (!a.resume.empty() && same_file(path, a.resume))) return;
  check_replaced_state(path, state, passes, "go on from it with --resume");
}

// The first checkpoint, or a render with a time limit, may hold little more than the passes of --resume.
void check_states(const RenderCommand& a, const std::vector<fs::path>& outputs, const Session& session) {
  const std::vector<PassRange> resumed = summarize(session.state()).passes;
  std::vector<PassRange> expected = resumed;
  if (!session.plan().seconds) expected.push_back(session.plan().passes);
  for (const fs::path& path : outputs) check_state(a, path, session.state(), expected);
  if (a.checkpoint_seconds) check_state(a, checkpoint_path(outputs), session.state(), resumed);
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

nlohmann::json describe(const RenderStatistics& s) {
  nlohmann::json phases;
  for (std::size_t i = 0; i < phase_count; ++i) phases[phase_name(static_cast<Phase>(i))] = s.phase_seconds[i];
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {{"passes", s.passes},
          {"seconds", s.seconds},
          {"prepare_seconds", s.prepare_seconds},
          {"first_pass_seconds", s.first_pass_seconds},
          {"phase_seconds", phases},
          {"rays", {{"nearest", s.rays.walk}, {"shadow", s.rays.shadow}, {"shadow_spared", s.rays.spared}}},
          {"photons_emitted", s.light_paths},
          {"photons_stored", s.photons_stored},
          {"photon_map_bytes", s.photon_map_bytes},
          {"cache_records", s.cache_records},
          {"cache_misses", s.cache_misses},
          {"radius", s.radius},
          {"threads", thread_count()},
          {"cpu_seconds_process", cpu_seconds()},
          {"peak_memory_bytes", static_cast<std::uint64_t>(usage.ru_maxrss) * 1024}};
}

nlohmann::json describe(const FilmReport& report) {
  return {{"non_finite", report.non_finite}, {"too_large", report.too_large}, {"saturated", report.saturated}};
}

void report_warnings(const std::vector<description::Warning>& warnings) {
  for (const description::Warning& warning : warnings)
    spdlog::warn("{}", Error(warning.location, warning.message).what());
}

std::optional<Checkpoints> plan_checkpoints(const RenderCommand& a, const std::vector<fs::path>& outputs,
                                            const Session& session, ProgressDisplay& progress) {
  if (a.checkpoint_seconds) return Checkpoints(checkpoint_path(outputs), *a.checkpoint_seconds, false, progress);
  const std::optional<double>& seconds = session.plan().seconds;
  const bool is_short = seconds && *seconds <= automatic_checkpoint_seconds;
  if (a.no_checkpoint || is_short) return {};
  return Checkpoints(automatic_checkpoint_path(outputs, a.resume, session.state()), automatic_checkpoint_seconds, true,
                     progress);
}

void announce_checkpoints(const Checkpoints& checkpoints) {
  say("checkpoint every {} in {}{}\n", format_duration(checkpoints.interval()), checkpoints.path().string(),
      checkpoints.automatic() ? " (--no-checkpoint: none)" : "");
}

// Says what the scene decided, where the user did not.
void announce_color(const RenderCommand& a, const RenderState& state) {
  if (a.quiet || !a.color.empty()) return;
  const std::string color = nlohmann::json::parse(summarize(state).settings)["identity"]["color"];
  say("color {}\n", color == "rgb"
                        ? "rgb: nothing in the scene disperses light (--color spectral: exact spectra)"
                        : "spectral: glass disperses light, or spectra are measured (--color rgb: less noise)");
}

// Asked for, or somebody sits before the terminal.
std::optional<Previews> plan_previews(const RenderCommand& a, const std::vector<fs::path>& outputs,
                                      const StopRule& plan, ProgressDisplay& progress) {
  constexpr double automatic_interval = 2;  // seconds
  const bool is_watched = !a.quiet && isatty(STDERR_FILENO) != 0;
  if (a.no_preview || (!a.preview_seconds && !is_watched)) return {};
  return Previews(outputs, a.output, a.preview_seconds.value_or(automatic_interval), plan, progress);
}

Observer make_observer(const RenderCommand& a, std::optional<Checkpoints>& checkpoints,
                       std::optional<Previews>& previews, ProgressDisplay& progress) {
  Observer observer;
  observer.progress = [&](const RenderState& state, const RenderStatistics& s) {
    progress.update(state, s);
    if (previews) previews->write_if_due(state, s);
  };
  observer.can_drop = set_can_drop;
  if (!a.quiet) observer.remark = [](const std::string& text) { say("{}\n", text); };
  if (checkpoints)
    observer.checkpoint = [&](const RenderState& state, double since) {
      return checkpoints->save_if_due(state, since);
    };
  return observer;
}

void write_report(const std::string& path, const Scene& scene, const RenderState& state,
                  const RenderStatistics& statistics) {
  nlohmann::json report = describe(statistics);
  const StateSummary summary = summarize(state);
  report["settings"] = nlohmann::json::parse(summary.settings);
  report["film"] = describe(summary.report);
  report["passes_total"] = summary.pass_count;
  report["scene"] = scene_report(summarize(scene));
  const std::string text = report.dump(2) + "\n";
  write_file(path, std::as_bytes(std::span(text)));
}

void save_render(const RenderCommand& a, const std::vector<fs::path>& paths, const Scene& scene,
                 const RenderState& state, const RenderStatistics& statistics) {
  const nlohmann::json described = describe(statistics);
  const StateSummary summary = summarize(state);
  OutputSettings settings = a.output;
  settings.hints = !a.quiet;
  std::vector<Output> outputs;
  outputs.reserve(paths.size() + 1);
  for (const fs::path& path : paths)
    outputs.push_back({path, path.extension() == ".state" ? OutputKind::state : OutputKind::picture, [&] {
                         check_state(a, path, state, summary.passes);  // fewer than expected, after a signal
                         write_output(path, state, settings, described);
                       }});
  if (!a.json.empty())
    outputs.push_back({a.json, OutputKind::report, [&] { write_report(a.json, scene, state, statistics); }});
  write_outputs(outputs, state);
  report_film(summary.report);
  if (a.quiet) return;
  for (const fs::path& path : paths)
    announce("{}: {} passes by {} in {}\n", path.string(), summary.pass_count, summary.integrator,
             format_duration(summary.seconds));
}

void run_render(const RenderCommand& a) {
  handle_signals();
  const RenderOptions options = parse_options(a);
  const ThreadLimit limit(a.threads);
  SceneDescription description = read_scene(a.scene, a.reading);
  place_camera(a, description.view);
  check_view(description.view, options);
  const std::vector<fs::path> outputs = choose_outputs(a, description);
  check_files(a, description, outputs);
  const SharedScene scene = build_scene(std::move(description));
  Session session(scene, options);
  if (!a.resume.empty()) session.resume(open_state(a.resume), a.resume);
  check_states(a, outputs, session);

  ProgressDisplay progress(session.plan(), session.state(), a.quiet);
  std::optional<Checkpoints> checkpoints = plan_checkpoints(a, outputs, session, progress);
  std::optional<Previews> previews = plan_previews(a, outputs, session.plan(), progress);
  set_stage(Stage::rendering);
  if (checkpoints && !a.quiet) announce_checkpoints(*checkpoints);
  announce_color(a, session.state());
  report_warnings(session.warnings());

  StopRule stop = session.plan();
  stop.interrupted = &stop_requested();
  stop.drop = &drop_requested();
  const RenderStatistics statistics = session.render(stop, make_observer(a, checkpoints, previews, progress));
  progress.finish();
  if (session.pass_count() == 0) {
    if (statistics.out_of_memory) throw std::bad_alloc();
    say("lanthorn: no pass was rendered: nothing to save\n");
    end_by_signal();
  }
  save_render(a, outputs, *scene, session.state(), statistics);
  if (statistics.out_of_memory)
    throw Error(
        fmt::format("not enough memory for a pass: the pictures have the {} passes before it; fewer --photons "
                    "need less",
                    session.pass_count()));
  if (checkpoints) checkpoints->finish(session.state(), stop_requested());
}

}  // namespace

void add_render(CLI::App& app) {
  CLI::App& c = *app.add_subcommand("render", "Render a scene to an image");
  auto a = std::make_shared<RenderCommand>();
  add_render_arguments(c, *a);
  c.add_option(
       "-o,--output", a->outputs,
       "Where to write: .exr (all layers), .png (color) or .state (to resume or merge); may be given several times. "
       "Default: the name in the scene file")
      ->type_name("FILE")
      ->allow_extra_args(false);
  auto* passes = add_count_option(c, "-p,--passes",
                                  "Passes to render (samples per pixel for path). Default: the scene file's, else 64",
                                  {1, most_passes}, into(a->options.passes));
  add_duration_option(c, "-t,--time", "Stop after the pass during which this time is reached: 30s, 1.5m, 2h",
                      into(a->options.seconds));
  c.add_option("--pass-range", a->pass_range,
               "Passes FIRST:END (END not included), for a shard to be merged with others")
      ->excludes(passes);
  add_duration_option(c, "--checkpoint",
                      "Save the state at this interval (90s, 10m) beside the first output (.state), and keep it. "
                      "Default: every ten minutes, in a file that is removed after the render",
                      into(a->checkpoint_seconds));
  c.add_flag("--no-checkpoint", a->no_checkpoint, "Save no states while rendering");
  add_duration_option(c, "--preview",
                      "Write the pictures after the first pass, too, and then at times that double, at least this far "
                      "apart. Default on a terminal: 2s; else none",
                      into(a->preview_seconds));
  c.add_flag("--no-preview", a->no_preview, "Write the pictures at the end alone");
  c.add_option("--resume", a->resume, "Continue a saved state of the same scene and settings")
      ->check(CLI::ExistingFile);
  c.add_option("--json", a->json, "Write statistics (times, rays, photons, memory) as JSON to this file")
      ->type_name("FILE");
  add_output_options(c, a->output);
  c.add_flag("-q,--quiet", a->quiet, "No progress, no closing line");
  c.footer(
      "Ctrl-C ends the render after the current pass and saves it; a second one saves it without that pass, a third "
      "ends\nthe program. So do SIGTERM, SIGHUP and other signals.\n\n"
      "Layers of .exr: color is the sum of emission (lights seen directly or by way of mirrors and clear glass), "
      "direct\n"
      "(light scattered once by a surface or in a medium), caustic (the same behind mirrors or clear glass) and "
      "indirect\n(the rest). media has all light that comes out of media once more.\n\nExamples:\n"
      "  lanthorn render scene.pbrt -o picture.png --time 30s\n"
      "  lanthorn render scene.pbrt -o a.exr -o a.state --integrator probppm --passes 200 --checkpoint 10m\n"
      "  lanthorn render scene.pbrt -o a.exr --passes 400 --resume a.state");
  c.callback([a] { run_render(*a); });
}

}  // namespace lanthorn
