// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/medium_around.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "math/hash.h"

namespace lanthorn {

namespace {

const Wavelengths white_light = Wavelengths::rgb(0.5f);

// Rays that arrive in the medium `around` at a place where the scene declares the medium `claimed`.
struct MediaConflict {
  MediumId around, claimed;
  Ray ray;                             // a ray that meets the conflicting interface first
  std::optional<std::uint32_t> light;  // or the light that the ray reaches
  std::uint32_t count = 0;
};

class Check {
 public:
  explicit Check(const Scene& scene) : scene_(scene) {}

  /// Follows a ray from the camera in `medium` to the visible surface, and from there to a light.
  void follow(const Ray& from_camera, MediumId medium) {
    ++followed_;
    const std::optional<End> end = pass(from_camera, medium);
    if (!end || !end->surface || scene_.lights().empty()) return;
    const auto index = static_cast<std::uint32_t>(rng_.next() * static_cast<float>(scene_.lights().size()));
    const std::optional<LightSample> l =
        sample_direct(scene_.lights()[index], end->surface->position, rng_.next2(), white_light);
    if (!l) return;
    // The medium is known only on the side from which the ray arrived.
    if (dot(l->wi, end->surface->normal) * dot(end->direction, end->surface->normal) >= 0) return;
    const bool is_far = !std::isfinite(l->distance);
    const std::optional<End> at_light =
        pass(is_far ? spawn_ray(*end->surface, l->wi)
                    : spawn_ray_to(*end->surface, l->wi, {l->position, l->normal, l->position_error}),
             end->medium);
    if (!at_light || at_light->surface || is_far) return;
    const MediumInterface media = scene_.light_media(index);
    const MediumId claimed = dot(l->wi, l->normal) > 0 ? media.inside : media.outside;
    if (claimed != at_light->medium) add({at_light->medium, claimed, {}, index});
  }

  std::vector<MediaConflict> take() {
    const std::uint32_t fewest = 2 + followed_ / 512;
    std::erase_if(found_, [fewest](const MediaConflict& c) { return c.count < fewest; });
    return std::move(found_);
  }

 private:
  struct End {
    MediumId medium;
    Direction direction;
    std::optional<SurfacePoint> surface;  ///< surface that stops the ray, if any
  };

  // End of the ray; nullopt if it meets a conflict before.
  std::optional<End> pass(Ray ray, MediumId medium) {
    constexpr int most_interfaces = 64;
    for (int i = 0; i < most_interfaces; ++i) {
      const std::optional<SurfacePoint> at = scene_.intersect(ray, white_light);
      if (!at) return End{medium, ray.direction, {}};
      if (!lets_through(*at)) return End{medium, ray.direction, at};
      if (const MediumId claimed = medium_towards(*at, -ray.direction, medium); claimed != medium) {
        add({medium, claimed, ray, {}});
        return {};
      }
      medium = medium_towards(*at, ray.direction, medium);
      ray = continue_segment(*at, ray);
      if (!(ray.t_max > 0)) return End{medium, ray.direction, {}};
    }
    return {};
  }

  void add(const MediaConflict& conflict) {
    const auto known = std::find_if(found_.begin(), found_.end(), [&](const MediaConflict& c) {
      return c.around == conflict.around && c.claimed == conflict.claimed &&
             c.light.has_value() == conflict.light.has_value();
    });
    ++(known != found_.end() ? *known : found_.emplace_back(conflict)).count;
  }

  const Scene& scene_;
  HashRng rng_{0};
  std::uint32_t followed_ = 0;
  std::vector<MediaConflict> found_;
};

std::vector<MediaConflict> find_conflicts(const Scene& scene, const View& view) {
  constexpr int grid = 48;
  const Vec2 film(static_cast<float>(view.camera.width()), static_cast<float>(view.camera.height()));
  const float time = view.camera.time(0.5f);
  HashRng rng(1);
  Check check(scene);
  for (int y = 0; y < grid; ++y)
    for (int x = 0; x < grid; ++x) {
      const Vec2 cell(static_cast<float>(x), static_cast<float>(y));
      const Vec2 raster = (cell + rng.next2()) / static_cast<float>(grid) * film;
      const CameraRay start = view.camera.sample_ray(raster, rng.next2(), time);
      if (start.weight > 0) check.follow(start.ray, view.medium);
    }
  return check.take();
}

std::optional<description::Warning> warning_of(const Scene& scene, const MediaConflict& conflict) {
  const std::string around = name_of_medium(scene, conflict.around), claimed = name_of_medium(scene, conflict.claimed);
  if (conflict.light)
    return description::Warning{scene.light_location(*conflict.light),
                                "light from here starts in " + claimed + ", but rays get here through " + around +
                                    ": give the light the MediumInterface of its surroundings"};
  const std::optional<SourceLocation> location = scene.locate(conflict.ray);
  if (!location) return {};
  return description::Warning{
      *location, "rays get here through " + around + ", but the shape declares " + claimed +
                     " here: is the shape inside out, or does a surrounding shape, or the camera, lack a medium?"};
}

}  // namespace

std::vector<description::Warning> media_warnings(const Scene& scene, const View& view) {
  std::vector<description::Warning> warnings;
  if (!scene.has_media()) return warnings;
  for (const MediaConflict& conflict : find_conflicts(scene, view)) {
    std::optional<description::Warning> warning = warning_of(scene, conflict);
    const auto says_the_same = [&](const description::Warning& w) { return w.message == warning->message; };
    if (warning && std::none_of(warnings.begin(), warnings.end(), says_the_same))
      warnings.push_back(std::move(*warning));
  }
  return warnings;
}

}  // namespace lanthorn
