// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render_output.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "console.h"
#include "interim_files.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/image_file.h"
#include "lanthorn/methods.h"
#include "lanthorn/text.h"
#include "lanthorn/threads.h"
#include "output_check.h"
#include "report_json.h"
#include "rescue.h"

namespace lanthorn::program {

namespace fs = std::filesystem;

namespace {

// Refuses to replace a state on disk that has passes which `passes` lack, unless the render resumes it.
void check_state(const RenderFiles& a, const fs::path& path, const RenderState& state,
                 const std::vector<PassRange>& passes) {
  if (path.extension() != ".state" || a.output.force || (!a.resume.empty() && same_file(path, a.resume))) return;
  check_replaced_state(path, state, passes, "go on from it with --resume");
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
  nlohmann::json stages = nlohmann::json::array();
  for (const StageSeconds& stage : s.stages) stages.push_back({{"name", stage.name}, {"seconds", stage.seconds}});
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
          {"stages", std::move(stages)},
          {"photons_per_bounce", s.photons_per_bounce},
          {"cache_records", s.cache_records},
          {"cache_misses", s.cache_misses},
          {"radius", s.radius},
          {"volume_radius", s.volume_radius},
          {"threads", thread_count()},
          {"cpu_seconds_process", cpu_seconds()},
          {"peak_memory_bytes", static_cast<std::uint64_t>(usage.ru_maxrss) * 1024}};
}

nlohmann::json describe(const FilmReport& report) {
  return {{"non_finite", report.non_finite}, {"too_large", report.too_large}, {"saturated", report.saturated}};
}

nlohmann::json describe(const PathEnds& ends) { return {{"paths", ends.paths}, {"cut_share", ends.share()}}; }

// How much throughput the paths of this render's passes had left when they reached the limit.
nlohmann::json describe_limit(int max_depth, const RayCounts& rays) {
  return {{"max_depth", max_depth}, {"eye", describe(rays.eye)}, {"light", describe(rays.light)}};
}

// What the limit of scattering events cut off; empty if that is little. Uses the share in the whole picture: a fifth of
// the light of a glass of milk can be 1 % of the picture's.
std::string loss_by_limit(const StateSummary& state) {
  constexpr double much = 0.002;
  if (state.cut_share < much) return {};
  return fmt::format(
      "the limit of {} scattering events ended paths that still had {} % of the throughput: light may be missing "
      "where paths are long; a higher --max-depth finds it",
      state.record.identity.max_depth, short_number(100 * state.cut_share));
}

void write_report(const std::string& path, const Scene& scene, StatePicture& picture,
                  const RenderStatistics& statistics) {
  nlohmann::json report = describe(statistics);
  const StateSummary& summary = picture.summary();
  report["settings"] = settings_json(summary.record);
  report["film"] = describe(summary.report);
  report["depth_limit"] = describe_limit(summary.record.identity.max_depth, statistics.rays);
  report["error"] = estimate_json(picture.error());
  if (picture.denoised_error()) report["denoised_error"] = estimate_json(*picture.denoised_error());
  report["passes_total"] = summary.pass_count;
  report["scene"] = scene_json(summarize(scene));
  write_file(path, report_text(report));
}

std::string describe_denoised(const std::optional<ErrorEstimate>& error) {
  return error ? fmt::format("; denoised {}", describe_error(*error)) : std::string();
}

}  // namespace

std::vector<fs::path> choose_outputs(const RenderFiles& a, const std::string& scene_file,
                                     const SceneDescription& scene) {
  if (!a.outputs.empty()) return {a.outputs.begin(), a.outputs.end()};
  const std::string& own = scene.view.film.filename;
  return {own.empty() ? fs::path(scene_file).stem().concat(".exr") : fs::path(own).filename()};
}

void check_files(const RenderFiles& a, const std::string& scene_file, const SceneDescription& scene,
                 const std::vector<fs::path>& outputs) {
  // Detects an unusable colour configuration before the render.
  if (a.output.display.ocio) displayed(Image(1, 1, {"R", "G", "B"}), a.output.display);
  std::vector<InputFile> read = files_of(scene.files, scene_file);
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

// Refuses to replace states whose passes the new ones may lack. The first checkpoint, or a render with a time limit,
// may have hardly more passes than the state of --resume.
void check_states(const RenderFiles& a, const std::vector<fs::path>& outputs, const Session& session) {
  const std::vector<PassRange> resumed = summarize(session.state()).passes;
  std::vector<PassRange> expected = resumed;
  if (!session.plan().seconds) expected.push_back(session.plan().passes);
  for (const fs::path& path : outputs) check_state(a, path, session.state(), expected);
  if (a.checkpoint_seconds) check_state(a, checkpoint_path(outputs), session.state(), resumed);
}

void say_once(const std::string& line, SaidLines& said) {
  if (said.is_new(line)) say("{}\n", line);
}

void announce_method(const Scene& scene, const RenderOptions& options, SaidLines& said) {
  if (options.integrator) return;
  const std::string notice = default_method(description_of(scene).hints.integrator).notice;
  if (!notice.empty()) say_once(notice, said);
}

void report_warnings(const std::vector<description::Warning>& warnings, SaidLines& said) {
  for (const description::Warning& warning : warnings) {
    const std::string line = Error(warning.location, warning.message).what();
    if (said.is_new(line)) warn("{}", line);
  }
}

void save_render(const RenderFiles& a, const RenderOptions& options, const std::vector<fs::path>& paths,
                 const Scene& scene, const RenderState& state, const RenderStatistics& statistics,
                 std::optional<DenoisedLooks::Found> found) {
  const nlohmann::json described = describe(statistics);
  StatePicture picture(state, paths, statistics, a.output.denoise, std::move(found));
  const StateSummary& summary = picture.summary();
  OutputSettings settings = a.output;
  settings.hints = !a.quiet;
  std::vector<Output> outputs;
  outputs.reserve(paths.size() + 1);
  for (const fs::path& path : paths)
    outputs.push_back({path, path.extension() == ".state" ? OutputKind::state : OutputKind::picture, [&] {
                         check_state(a, path, state, summary.passes);  // fewer passes than expected, after a signal
                         write_output(path, picture, settings, described);
                       }});
  if (!a.json.empty())
    outputs.push_back({a.json, OutputKind::report, [&] { write_report(a.json, scene, picture, statistics); }});
  write_outputs(outputs, state);
  report_film(summary.report);
  const std::string loss = loss_by_limit(summary);
  if (!loss.empty() && !options.max_depth) warn("{}", loss);
  if (a.quiet) return;
  if (!loss.empty() && options.max_depth) announce("{}\n", loss);  // the user chose the limit
  for (const fs::path& path : paths)
    announce("{}: {} by {} in {}, error {}{}\n", path.string(),
             summary.pass_count == 1 ? "1 pass" : fmt::format("{} passes", summary.pass_count), summary.integrator,
             format_duration(summary.seconds), describe_error(picture.error()),
             describe_denoised(picture.denoised_error()));
}

}  // namespace lanthorn::program
