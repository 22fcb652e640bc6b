// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/identity.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <variant>
#include <vector>

#include "lanthorn/plain_data.h"
#include "lanthorn/version.h"
#include "math/hash.h"

namespace lanthorn {

namespace {

namespace fs = std::filesystem;

nlohmann::json describe_filter(const description::Filter& f) {
  nlohmann::json result{{"kind", *plain::write(f.kind).as<std::string>()}, {"radius", {f.radius.x, f.radius.y}}};
  if (f.kind == description::FilterKind::gaussian) result["sigma"] = f.sigma;
  if (f.kind == description::FilterKind::mitchell) result.update({{"b", f.b}, {"c", f.c}});
  if (f.kind == description::FilterKind::sinc) result["tau"] = f.tau;
  return result;
}

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

// A file's name relative to the scene's folder: it does not depend on where the scene lies or how its name was typed.
// Absolute names outside of that folder lose all but their last part.
std::string portable_name(const std::string& name, const fs::path& scene_folder) {
  const fs::path path(name);
  if (path.is_relative()) return path.lexically_normal().generic_string();
  std::error_code code;
  const fs::path inside =
      fs::weakly_canonical(path, code).lexically_relative(fs::weakly_canonical(fs::absolute(scene_folder), code));
  return inside.empty() || inside.native().starts_with("..") ? path.filename().string() : inside.generic_string();
}

// The hash of each file by name. Files of different folders may share a name here: their hashes are sorted.
nlohmann::json describe_files(const SceneDescription& scene) {
  std::map<std::string, std::set<std::string>> hashes;
  const fs::path parent = fs::path(scene.filename).parent_path();
  const fs::path folder = parent.empty() ? fs::path(".") : parent;
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

// All numbers of a view that the identity does not name one by one.
class ViewNumbers {
 public:
  explicit ViewNumbers(const ViewDescription& view) {
    const auto& [camera, film, filter] = view;
    numbers_ = {static_cast<double>(camera.node.index()), camera.shutter_open, camera.shutter_close,
                static_cast<double>(camera.medium ? *camera.medium + 1 : 0)};
    std::visit([&](const auto& node) { add(node); }, camera.node);
    add(camera.camera_to_world.start);
    add(camera.camera_to_world.end);
    add(camera.camera_to_world.start_time, camera.camera_to_world.end_time);
    add(camera.frame_aspect_ratio);
    add(camera.screen_window.has_value());
    for (const float x : camera.screen_window.value_or(std::array<float, 4>{})) add(x);
    add(camera.subject.has_value());
    if (camera.subject)
      for (int i = 0; i < 3; ++i) add(camera.subject->min[i], camera.subject->max[i]);
    add(film.imaging_ratio, film.diagonal, static_cast<int>(film.color_space));
    add(film.white_balance);
    add(film.largest_component);
    add(film.buckets.has_value());
    if (film.buckets) add(film.buckets->count, film.buckets->low, film.buckets->high);
  }

  std::uint64_t hash() const { return hash_bytes(std::as_bytes(std::span(numbers_))); }

 private:
  template <class... Numbers>
  void add(Numbers... numbers) requires(std::is_arithmetic_v<Numbers>&&...) {
    (numbers_.push_back(static_cast<double>(numbers)), ...);
  }
  void add(const std::optional<float>& x) { add(x.has_value(), x.value_or(0)); }
  void add(const Transform& t) {
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row) add(t.matrix[column][row]);
  }
  void add(const description::PerspectiveCamera& c) { add(c.fov, c.lens_radius, c.focal_distance); }
  void add(const description::OrthographicCamera& c) { add(c.lens_radius, c.focal_distance); }
  void add(const description::SphericalCamera& c) { add(static_cast<int>(c.mapping)); }
  void add(const description::RealisticCamera& c) {
    add(c.focus_distance, c.film_diagonal);
    for (const description::LensElement& e : c.elements)
      add(e.curvature_radius, e.thickness, e.eta, e.aperture_diameter);
  }

  std::vector<double> numbers_;
};

// Another environment makes another scene. Files have hashes of their own.
std::uint64_t hash_of(const SceneDescription& scene) {
  constexpr std::uint64_t is_environment = 2;
  const EnvironmentChoice& e = scene.environment;
  if (e.source.empty()) return scene.hash;
  const std::string name = std::filesystem::path(e.source).filename().string();
  const std::uint64_t up = e.up ? static_cast<std::uint64_t>(*e.up) : 2;
  return hash_words({scene.hash, is_environment, std::bit_cast<std::uint32_t>(e.rotation),
                     std::bit_cast<std::uint32_t>(e.scale), up, hash_bytes(std::as_bytes(std::span(name)))});
}

// The values that must be equal for two states to belong together.
nlohmann::json identity(const Scene& scene, const ViewDescription& view, const RenderPlan& plan) {
  const SceneDescription& description = scene.description();
  const RenderSettings& s = plan.settings;
  const Camera& camera = plan.view.camera;
  const PixelWindow &crop = plan.view.crop, &window = plan.view.window;
  nlohmann::json result{
      {"version", version},
      {"scene_hash", hash_text(hash_of(description))},
      {"files", describe_files(description)},
      {"integrator", plan.info->name},
      {"parameters", plan.parameters.all()},
      {"seed", s.seed},
      {"color", s.color == ColorMode::rgb ? "rgb" : "spectral"},
      {"max_depth", s.max_depth},
      {"photons", s.photons * s.parts},
      {"resolution", {camera.width(), camera.height()}},
      {"crop", {crop.x0, crop.y0, crop.x1, crop.y1}},
      {"filter", describe_filter(view.filter)},
  };
  // Named after the density of wavelengths: passes drawn with another density have another colour balance.
  if (plan.integrator->passes_share_wavelengths() && s.color == ColorMode::spectral) {
    result["plateau_wavelength_sets"] = s.parts;
    if (scene.has_dispersion()) result["heroes_of_paths"] = true;  // by `wavelengths_in_order` and `PassDraw`
  }
  if (plan.view.filter.negative_share() != 0) result["filter_lobes_apart"] = true;  // `FilterPart`
  if (window != crop)
    result["margin"] = {crop.x0 - window.x0, crop.y0 - window.y0, window.x1 - crop.x1, window.y1 - crop.y1};
  if (plan.view.sensor.path_limit) result["clamp"] = *plan.view.sensor.path_limit;
  // The scene file's own view is part of the file, whose hash stands for it.
  const std::uint64_t hash = ViewNumbers(view).hash();
  if (hash != ViewNumbers(description.view).hash()) result["view"] = hash_text(hash);
  return result;
}

}  // namespace

std::string describe_render(const Scene& scene, const ViewDescription& view, const RenderPlan& plan) {
  nlohmann::json settings{{"identity", identity(scene, view, plan)},
                          {"measures_exposure", view.film.measures_exposure},
                          {"scene", fs::path(scene.description().filename).filename().string()}};
  if (view.film.display_emission) settings["display_emission"] = true;
  if (!plan.integrator->knows_bias()) settings["bias_not_measured"] = true;
  // File names need not be UTF-8.
  return settings.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace lanthorn
