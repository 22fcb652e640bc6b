// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/plan.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <variant>
#include <vector>

#include "lanthorn/version.h"
#include "math/hash.h"
#include "render/record.h"

namespace lanthorn {

namespace {

namespace fs = std::filesystem;

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

// Files of different folders may share a name here.
std::map<std::string, std::set<std::string>> hashes_of_files(const SceneDescription& scene) {
  std::map<std::string, std::set<std::string>> hashes;
  const fs::path parent = fs::path(scene.filename).parent_path();
  const fs::path folder = parent.empty() ? fs::path(".") : parent;
  for (const auto& [name, file] : scene.files)
    if (file.hash) hashes[portable_name(name, folder)].insert(hash_text(*file.hash));
  return hashes;
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

RenderIdentity identity_of(const Scene& scene, const ViewDescription& view, const RenderOptions& options,
                           const RenderPlan& plan) {
  const SceneDescription& description = scene.description();
  const RenderSettings& s = plan.settings;
  const PixelWindow &crop = plan.view.crop, &window = plan.view.window;
  RenderIdentity identity{.version = version,
                          .scene_hash = hash_text(hash_of(description)),
                          .files = hashes_of_files(description),
                          .integrator = plan.info->name,
                          .parameters = plan.parameters.all(),
                          .seed = s.seed,
                          .color = s.color,
                          .max_depth = s.max_depth,
                          .photons = s.photons * s.parts,
                          .resolution = {plan.view.camera.width(), plan.view.camera.height()},
                          .crop = {crop.x0, crop.y0, crop.x1, crop.y1},
                          .filter = view.filter,
                          .filter_lobes_apart = plan.view.filter.negative_share() != 0};
  for_each_render_option([&](const auto& option) {
    if (option.is_recorded) identity.options.*option.value = options.*option.value;
  });
  if (window != crop)
    identity.margin = {crop.x0 - window.x0, crop.y0 - window.y0, window.x1 - crop.x1, window.y1 - crop.y1};
  if (plan.integrator->passes_share_wavelengths() && s.color == ColorMode::spectral) {
    identity.wavelength_sets = s.parts;
    identity.heroes_of_paths = scene.has_dispersion();
  }
  // The scene file's own view is part of the file, whose hash stands for it.
  const std::uint64_t hash = ViewNumbers(view).hash();
  if (hash != ViewNumbers(description.view).hash()) identity.view = hash_text(hash);
  return identity;
}

}  // namespace

RenderRecord record_of(const Scene& scene, const ViewDescription& view, const RenderOptions& options,
                       const RenderPlan& plan) {
  const RenderRecord record{.identity = identity_of(scene, view, options, plan),
                            .scene = fs::path(scene.description().filename).filename().string(),
                            .measures_exposure = view.film.measures_exposure,
                            .display_emission = view.film.display_emission,
                            .bias_not_measured = !plan.integrator->knows_bias()};
  // As it will be read from a file: names need not be UTF-8.
  return read_record(settings_text(record), scene.description().filename);
}

}  // namespace lanthorn
