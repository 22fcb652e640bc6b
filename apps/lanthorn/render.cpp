// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "commands.h"
#include "console.h"
#include "interim_files.h"
#include "lanthorn/denoise.h"
#include "lanthorn/error.h"
#include "lanthorn/image_file.h"
#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "lanthorn/text.h"
#include "lanthorn/threads.h"
#include "progress.h"
#include "render_command.h"
#include "signals.h"
#include "team.h"
#include "tev.h"

namespace lanthorn::program {

namespace {

namespace fs = std::filesystem;

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
      checkpoints.automatic() ? " (--checkpoint none: no file)" : "");
}

// Reports a choice that the scene made because the user did not.
void announce_color(const RenderCommand& a, const RenderState& state, SaidLines& said) {
  if (a.quiet || a.options.color) return;
  const bool is_rgb = summarize(state).record.identity.color == ColorMode::rgb;
  say_once(is_rgb ? "color rgb: nothing in the scene disperses light (--color spectral: exact spectra)"
                  : "color spectral: glass disperses light, or spectra are measured (--color rgb: less noise)",
           said);
}

// Previews are written if requested, or if a user sits at the terminal.
std::optional<Previews> plan_previews(const RenderCommand& a, const std::vector<fs::path>& outputs,
                                      const StopRule& plan, ProgressDisplay& progress) {
  constexpr double automatic_interval = 2;  // seconds
  const bool is_watched = !a.quiet && isatty(STDERR_FILENO) != 0;
  if (a.no_preview || (!a.preview_seconds && !is_watched)) return {};
  return Previews(outputs, a.output, a.preview_seconds.value_or(automatic_interval), plan, progress);
}

// Everything that shows or saves the picture while it is rendered.
struct Onlookers {
  ProgressDisplay progress;
  std::optional<Checkpoints> checkpoints{};
  std::optional<Previews> previews{};
  std::optional<TevLink> tev{};
};

// Throws Error if the value of --tev is not a host and port.
std::optional<HostPort> viewer_of(const RenderCommand& a) {
  return a.tev.empty() ? std::nullopt : std::optional(parse_host_port(a.tev, "--tev"));
}

// The predictions of `auto` for each choice, including that for the whole picture as one region.
void print_efforts(const EffortReport& report) {
  say("light paths  connections  lens  merged      variance   work   product\n");
  const auto row = [&](const std::string& techniques, double light_paths, double variance, double work) {
    const double v = variance / report.variance, w = work / report.work;
    say("{:11.3g}  {:29}  {:8.3g}  {:5.3g}  {:8.3g}\n", light_paths, techniques, v, w, v * w);
  };
  row("as it pays", report.light_paths_per_pixel, report.variance, report.work);
  for (const UniformEffort& choice : report.uniform) {
    const PlaceEffort& place = choice.place;
    const char* merged =
        place.merges ? (place.merges_in_media ? "all" : "surfaces") : (place.merges_in_media ? "media" : "-");
    if (!place.goes_on) merged = "once";
    const char* lens = choice.light_paths_per_pixel > 0 && place.sees ? "yes" : "-";
    row(fmt::format("{:11}  {:4}  {}", place.connections, lens, merged), choice.light_paths_per_pixel, choice.variance,
        choice.work);
  }
}

Observer make_observer(const RenderCommand& a, Onlookers& onlookers) {
  Observer observer;
  observer.progress = [&](const RenderState& state, const RenderStatistics& s) {
    onlookers.progress.update(state, s);
    if (onlookers.previews) onlookers.previews->write_if_due(state, s);
    if (onlookers.tev && onlookers.tev->is_ready()) onlookers.tev->show(picture_of(state));
  };
  observer.can_drop = set_can_drop;
  if (!a.quiet) observer.remark = [](const std::string& text) { say("{}\n", text); };
  if (a.verbose)
    observer.prepared = [](const RenderState& state) {
      if (const auto findings = summarize(state).record.findings) print_efforts(*findings);
    };
  if (onlookers.checkpoints)
    observer.checkpoint = [&](const RenderState& state, double since) {
      return onlookers.checkpoints->save_if_due(state, since);
    };
  return observer;
}

// An entirely black picture, or one that needs a huge exposure, does not show its cause: explain it. `exposure`: if it
// was measured.
void explain_darkness(const RenderCommand& a, const Scene& scene, const ViewDescription& view, const fs::path& output,
                      const Session& session, const std::optional<float>& exposure) {
  constexpr float most_stops = 12;
  if (a.quiet) return;
  if (exposure > most_stops)
    warn("{}: the camera sees next to nothing, so that an exposure of {:.1f} stops was measured: {}", output.string(),
         *exposure, reason_for_faint(scene, view));
  const auto color = select_layer(picture_without_error(session.state()), "color");
  if (!color || std::any_of(color->pixels.begin(), color->pixels.end(), [](float x) { return x != 0; })) return;
  warn("{}: the picture is black: {}", output.string(), reason_for_black(scene, view));
}

// Shared state of the frames of a film: all use the exposure and highlights of the first frame and, where the file has
// no camera that sees anything, the previous frame's. No message is repeated for a later frame.
struct Film {
  SaidLines said{};
  std::optional<DisplaySettings> measured{};
  std::optional<description::Camera> camera{};
  DVec3 origin{0.0};  ///< of camera space

  void keep_exposure(OutputSettings& settings) const {
    if (!measured) return;
    settings.display.exposure = measured->exposure;
    settings.display.brightest = measured->brightest;
    settings.curve = measured->curve;
    settings.measures_exposure = false;
    settings.hints = false;
  }
  void keep_camera(SceneDescription& scene) {
    const bool stands_in = scene.view.camera.subject.has_value();
    if (!stands_in || !camera) {
      camera = scene.view.camera;
      origin = scene.origin;
      return;
    }
    const Transform moved = translate(origin - scene.origin);
    scene.view.camera = *camera;
    AnimatedTransform& to_world = scene.view.camera.camera_to_world;
    to_world = {moved * to_world.start, moved * to_world.end, to_world.start_time, to_world.end_time};
  }
};

void explain_coarse(const CoarsePicture& coarse) {
  warn(
      "there was no time for a whole pass: the picture is coarse, rendered with {} x {} pixels and enlarged; a whole "
      "pass takes about {}, and the render cannot be resumed from a state of this picture",
      coarse.width, coarse.height, format_duration(coarse.pass_seconds));
}

bool measures_exposure(const RenderCommand& a, const Session& session) {
  return a.output.measures_exposure.value_or(summarize(session.state()).record.measures_exposure);
}

// How all frames of a film are shown, as far as it follows from the first frame.
std::optional<DisplaySettings> measured_display(const RenderCommand& a, const Session& session) {
  const bool measures = measures_exposure(a, session);
  const ToneCurve curve = curve_of(a.output, measures);
  if (!measures && curve != ToneCurve::highlights) return {};
  const Image picture = picture_without_error(session.state());
  return DisplaySettings{.exposure = measures ? measured_exposure(picture) : a.output.display.exposure,
                         .curve = curve,
                         .brightest = brightest_level(picture)};
}

// What is checked and read once before the render.
struct Prepared {
  SharedScene scene;  // without --light
  std::vector<fs::path> outputs;
};

// `like`: the scene at another time, or null.
Prepared prepare(const RenderCommand& a, const Team* team, SceneDescription description, Film& film,
                 const SharedScene& like = {}) {
  film.keep_camera(description);
  check_view(description.view, a.options);
  std::vector<fs::path> outputs = choose_outputs(a, a.scene, description);
  if (is_first(team)) check_files(a, a.scene, description, outputs);
  return {build_scene(std::move(description), like), std::move(outputs)};
}

// For rank 0: when it needs the sums of the other processes.
void plan_gathering(const Onlookers& onlookers, const RenderCommand& a, Team& team) {
  constexpr double automatic_interval = 2;  // seconds
  team.gather_seconds.reset();
  if (onlookers.checkpoints) team.gather_seconds = onlookers.checkpoints->interval();
  team.preview_seconds.reset();
  if (onlookers.previews || onlookers.tev) team.preview_seconds = a.preview_seconds.value_or(automatic_interval);
}

// Renders in a process of a team that leaves files and messages to rank 0.
void help_to_render(Session& session, Team& team) {
  StopRule stop = session.plan();
  stop.team = &team;
  session.render(stop);
}

void save_view(const RenderCommand& a, const std::vector<fs::path>& outputs, const Scene& scene,
               const ViewDescription& view, const Session& session, const RenderStatistics& statistics,
               std::optional<DenoisedLooks::Found> found, Film& film) {
  save_render(a, a.options, outputs, scene, session.state(), statistics, std::move(found));
  std::optional<float> measured_now;
  if (!film.measured) {
    film.measured = measured_display(a, session);
    if (measures_exposure(a, session)) measured_now = film.measured->exposure;
  }
  explain_darkness(a, scene, view, outputs.front(), session, measured_now);
  if (statistics.out_of_memory)
    throw Error(fmt::format(
        "not enough memory for a pass: the pictures hold the {} passes before it; fewer --photons need less",
        session.pass_count()));
}

// A resumed render keeps the margin of its state, because passes with different margins cannot be added.
RenderOptions with_margin_for_denoising(const RenderCommand& a, const RenderState* resumed) {
  RenderOptions options = a.options;
  options.margin = resumed ? summarize(*resumed).margin : a.output.denoise ? denoising_margin : 0;
  return options;
}

void render_view(const RenderCommand& a, Team* team, const Prepared& prepared, const ViewDescription& view,
                 Film& film) {
  const std::vector<fs::path>& outputs = prepared.outputs;
  const SharedScene scene = scale_lights(prepared.scene, a.changes.lights);
  const std::shared_ptr<RenderState> resumed = a.resume.empty() ? nullptr : open_state(a.resume);
  Session session(scene, view, with_margin_for_denoising(a, resumed.get()));
  if (resumed) session.resume(resumed, a.resume);
  if (!is_first(team)) return help_to_render(session, *team);
  check_states(a, outputs, session);

  Onlookers onlookers{ProgressDisplay(session.plan(), a.quiet)};
  if (auto planned = plan_checkpoints(a, outputs, session, onlookers.progress)) onlookers.checkpoints.emplace(*planned);
  if (auto planned = plan_previews(a, outputs, session.plan(), onlookers.progress))
    onlookers.previews.emplace(*planned);
  if (const auto viewer = viewer_of(a)) onlookers.tev.emplace(*viewer, printable(outputs.front().filename().string()));
  set_stage(Stage::rendering);
  if (onlookers.checkpoints && !a.quiet) announce_checkpoints(*onlookers.checkpoints);
  if (!a.quiet) announce_method(*scene, a.options, film.said);
  announce_color(a, session.state(), film.said);
  report_warnings(session.warnings(), film.said);

  StopRule stop = session.plan();
  stop.interrupted = &stop_requested();
  stop.drop = &drop_requested();
  stop.team = team;
  DenoisedLooks looks(stop.noise.value_or(0));
  if (stop.noise && a.output.denoise) stop.error_of = std::ref(looks);
  if (team) plan_gathering(onlookers, a, *team);
  const RenderStatistics statistics = session.render(stop, make_observer(a, onlookers));
  onlookers.progress.finish();
  if (statistics.coarse) explain_coarse(*statistics.coarse);
  if (session.pass_count() == 0) {
    if (statistics.out_of_memory) throw std::bad_alloc();
    say("lanthorn: no pass was rendered: nothing to save\n");
    end_by_signal();
  }
  if (onlookers.tev) onlookers.tev->show(session.picture());
  save_view(a, outputs, *scene, view, session, statistics, looks.take(), film);
  if (onlookers.checkpoints) onlookers.checkpoints->finish(session.state(), stop_requested());
}

ViewDescription first_view(const RenderCommand& a, const Scene& scene) { return view_of(scene, a.changes, a.options); }

// The scene is read and built once: only the camera moves.
void render_turntable(const RenderCommand& a, Team* team) {
  const FrameRange frames = frames_of(a);
  const RenderCommand first = of_frame(a, frames.begin);
  Film film;
  Prepared prepared = prepare(first, team, read_scene(first.scene, first.reading), film);
  const Scene& scene = *prepared.scene;
  std::vector<ViewDescription> views = turntable(first_view(a, scene), scene, *a.turntable);
  for (std::uint64_t i = frames.begin; i < frames.end && !stop_requested(); ++i) {
    RenderCommand one = of_frame(a, i);
    film.keep_exposure(one.output);
    prepared.outputs = choose_outputs(one, a.scene, description_of(scene));
    if (is_first(team)) check_files(one, a.scene, description_of(scene), prepared.outputs);
    focus(views[i], a.changes.lens, scene, a.options);
    render_view(one, team, prepared, views[i], film);
  }
}

// The file is read once and its frames share images; moving geometry is rebuilt.
void render_animation(const RenderCommand& a, Team* team) {
  SceneFile file(a.scene, a.reading);
  SharedScene last;
  Film film;
  for (std::uint64_t i = a.frames->begin; i < a.frames->end && !stop_requested(); ++i) {
    RenderCommand one = of_frame(a, i);
    film.keep_exposure(one.output);
    const Prepared prepared = prepare(one, team, file.at(one.reading.at), film, std::exchange(last, nullptr));
    render_view(one, team, prepared, first_view(one, *prepared.scene), film);
    last = prepared.scene;
  }
}

void run_render(RenderCommand& command) {
  viewer_of(command);
  const ThreadLimit limit(command.threads);
  run_in_team(command, [&](Team* team) {
    const RenderCommand& a = command;
    if (a.frames || a.turntable) check_frames(a);
    if (a.turntable) return render_turntable(a, team);
    if (a.frames) return render_animation(a, team);
    Film film;
    const Prepared prepared = prepare(a, team, read_scene(a.scene, a.reading), film);
    render_view(a, team, prepared, first_view(a, *prepared.scene), film);
  });
}

}  // namespace

void add_render(CLI::App& app) {
  const auto a = std::make_shared<RenderCommand>();
  constexpr const char* footer =
      "Ctrl-C ends the render after the current pass and saves it; a second one saves it without that pass, a third "
      "ends\nthe program. SIGTERM, SIGHUP and other signals do the same.\n\n"
      "Layers of .exr: color is the sum of emission (lights seen directly, or through mirrors and clear glass), "
      "direct\n"
      "(light scattered once by a surface or in a medium), caustic (the same behind mirrors or clear glass) and\n"
      "indirect (the rest). media repeats all light that comes out of media.\n\nExamples:\n"
      "  lanthorn render scene.pbrt --noise 5% --denoise -o picture.png\n"
      "  lanthorn render scene.pbrt --time 10m -o a.exr -o a.state\n"
      "  lanthorn render scene.pbrt --time 10m -o a.exr --resume a.state\n"
      "  lanthorn render ring.glb --environment sky.hdr --turntable 48 -o ring.####.png";
  add_command(app,
              {"render", "Render a scene to an image", render_command_options(*a), footer, [a] { run_render(*a); }});
}

}  // namespace lanthorn::program
