// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <system_error>
#include <utility>

#include "lanthorn/error.h"
#include "lanthorn/version.h"
#include "render/memory_need.h"

namespace lanthorn {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t default_passes = 64;
constexpr int default_max_depth = 64;

// pbrt's SPPM limits eye and light paths separately, ours their sum.
int scene_max_depth(const description::RenderHints& hints) {
  if (!hints.max_depth) return default_max_depth;
  const int depth = *hints.max_depth;
  return std::max(1, hints.integrator == "sppm" ? 2 * std::min(depth, std::numeric_limits<int>::max() / 2) : depth);
}

std::string choose_integrator(const description::RenderHints& hints, const RenderOptions& options) {
  if (options.integrator) return *options.integrator;
  const std::string mapped = integrator_for_pbrt(hints.integrator);
  return mapped.empty() ? "probppm" : mapped;
}

PassRange choose_passes(const description::RenderHints& hints, const RenderOptions& options) {
  constexpr std::uint64_t never = std::numeric_limits<std::uint32_t>::max();
  if (options.pass_range) return *options.pass_range;
  if (options.passes) return {0, *options.passes};
  if (options.seconds) return {0, never};
  return {0, hints.pixel_samples ? static_cast<std::uint64_t>(std::max(1, *hints.pixel_samples)) : default_passes};
}

nlohmann::json describe_filter(const description::Filter& f) {
  constexpr std::array names{"box", "triangle", "gaussian", "mitchell", "sinc"};
  nlohmann::json result{{"kind", names[static_cast<std::size_t>(f.kind)]}, {"radius", {f.radius.x, f.radius.y}}};
  if (f.kind == description::FilterKind::gaussian) result["sigma"] = f.sigma;
  if (f.kind == description::FilterKind::mitchell) result.update({{"b", f.b}, {"c", f.c}});
  if (f.kind == description::FilterKind::sinc) result["tau"] = f.tau;
  return result;
}

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

// The name that the scene gives it, seen from the scene's folder: the same wherever the scene lies and however its own
// name was typed. Of an absolute name that leads out of that folder, the last part.
std::string portable_name(const std::string& name, const fs::path& scene_folder) {
  const fs::path path(name);
  if (path.is_relative()) return path.lexically_normal().generic_string();
  std::error_code code;
  const fs::path inside =
      fs::weakly_canonical(path, code).lexically_relative(fs::weakly_canonical(fs::absolute(scene_folder), code));
  return inside.empty() || inside.native().starts_with("..") ? path.filename().string() : inside.generic_string();
}

// A hash for each name; several, sorted, where files of several folders have the same name here.
nlohmann::json describe_files(const SceneDescription& scene) {
  std::map<std::string, std::set<std::string>> hashes;
  const fs::path folder = fs::path(scene.filename).parent_path();
  for (const auto& [name, file] : scene.files)
    if (file.hash) hashes[portable_name(name, folder)].insert(hash_text(*file.hash));
  nlohmann::json result = nlohmann::json::object();
  for (const auto& [name, of_name] : hashes)
    if (of_name.size() == 1)
      result[name] = *of_name.begin();
    else
      result[name] = of_name;
  return result;
}

RenderSettings choose_settings(const Scene& scene, const View& view, const RenderOptions& options,
                               const IntegratorInfo& info) {
  const SceneDescription& description = scene.description();
  const description::RenderHints& hints = description.hints;
  RenderSettings s;
  s.seed = options.seed.value_or(hints.seed.value_or(0));
  const auto& buckets = description.film.buckets;
  const bool wants_spectra = scene.has_measured_spectra() || scene.has_dispersion() || buckets;
  s.color = options.color.value_or(wants_spectra ? ColorMode::spectral : ColorMode::rgb);
  if (buckets && s.color == ColorMode::rgb)
    throw Error("--color rgb: the scene's film is \"spectral\", which only spectral rendering can fill");
  s.max_depth = options.max_depth.value_or(scene_max_depth(hints));
  const auto pixels =
      static_cast<std::uint64_t>(view.window.width()) * static_cast<std::uint64_t>(view.window.height());
  const std::uint64_t automatic = std::max(pixels, info.fewest_light_paths);
  s.photons = options.photons.value_or(hints.photons_per_iteration && *hints.photons_per_iteration > 0
                                           ? static_cast<std::uint64_t>(*hints.photons_per_iteration)
                                           : automatic);
  return s;
}

// What must be equal for two states to belong together.
nlohmann::json identity(const Session& session, const Parameters& parameters, const SceneDescription& description) {
  const RenderSettings& s = session.settings;
  const View& view = session.view;
  return {
      {"version", version},
      {"scene_hash", hash_text(description.hash)},
      {"files", describe_files(description)},
      {"integrator", session.info->name},
      {"parameters", parameters.all()},
      {"seed", s.seed},
      {"color", s.color == ColorMode::rgb ? "rgb" : "spectral"},
      {"max_depth", s.max_depth},
      {"photons", s.photons},
      {"resolution", {view.camera.width(), view.camera.height()}},
      {"crop", {view.window.x0, view.window.y0, view.window.x1, view.window.y1}},
      {"filter", describe_filter(description.filter)},
  };
}

}  // namespace

std::string integrator_for_pbrt(const std::string& name) {
  if (name == "lightpath") return "light";
  if (name == "sppm" || name == "bdpt" || name == "mlt") return name;
  for (const char* known : {"path", "volpath", "simplepath", "simplevolpath", "randomwalk", "ambientocclusion"})
    if (name == known) return "path";
  return "";
}

Session open_session(const Scene& scene, View view, const RenderOptions& options) {
  const SceneDescription& description = scene.description();
  const description::RenderHints& hints = description.hints;
  Session session;
  session.view = std::move(view);
  session.info = &find_integrator(choose_integrator(hints, options));

  std::map<std::string, std::string> set = options.set;
  const auto takes = [&](const char* name) {
    return std::any_of(session.info->parameters.begin(), session.info->parameters.end(),
                       [&](const ParameterInfo& p) { return p.name == name; });
  };
  if (hints.radius && takes("radius")) set.emplace("radius", fmt::format("{}", *hints.radius));
  const Parameters parameters(session.info->parameters, set, session.info->name);
  session.integrator = session.info->make(parameters);

  FilmContents contents = session.integrator->film_contents();
  contents.buckets = description.film.buckets;
  session.settings = choose_settings(scene, session.view, options, *session.info);
  plan_memory(scene, session.view, *session.integrator, contents, options.memory, session.settings);
  session.stop.passes = choose_passes(hints, options);
  if (session.stop.passes.begin > 0 && !session.integrator->passes_are_independent())
    throw Error(
        fmt::format("--pass-range: each pass of {} depends on all before it, so that it can start with pass 0 only",
                    session.info->name));
  session.stop.seconds = options.seconds;

  RenderState& state = session.state;
  const PixelWindow& window = session.view.window;
  state.film = Film(window.width(), window.height(), scene.largest_radiance(), contents);
  state.integrator = session.info->name;
  state.shardable = session.integrator->passes_are_independent();
  state.settings["identity"] = identity(session, parameters, description);
  state.settings["scene"] = fs::path(description.filename).filename().string();
  // As a file will hold them, so that they compare equal: names of files need not be UTF-8.
  state.settings = nlohmann::json::parse(state.settings.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  return session;
}

RenderState render(const Scene& scene, Session& session, const Observer& observer, RenderStatistics& statistics) {
  return render(session.job(scene), *session.integrator, std::move(session.state), session.stop, observer, statistics);
}

}  // namespace lanthorn
