// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "staging/lit_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <variant>

#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

namespace {

using namespace description;

Rgb rgb_of(const SpectrumValue& value) {
  const auto* colour = std::get_if<RgbSpectrum>(&value);
  return colour != nullptr ? colour->rgb : Rgb{1, 1, 1};
}
float luminance_of(const Emission& emission) { return emission.scale * luminance(rgb_of(emission.spectrum)); }

// Irradiance on both sides of the samples.
class Irradiances {
 public:
  Irradiances(const SceneDescription& scene, const ModelSamples& model) : model_(model), sides_(model.samples.size()) {
    constexpr std::size_t most_lights = 64;
    const std::size_t step = scene.lights.size() / most_lights + 1;
    for (std::size_t i = 0; i < scene.lights.size(); i += step) {
      const Light& light = scene.lights[i];
      knows_all_ = knows_all_ && std::visit([&](const auto& l) { return add(l, light.light_to_world); }, light.node);
    }
    add_emitters(scene);
  }

  // The median of the brighter sides of lit samples; 0 if none is lit, or if it cannot be known.
  float typical() const {
    std::vector<float> brighter;
    for (const auto& [front, back] : sides_)
      if (front > 0 || back > 0) brighter.push_back(std::max(front, back));
    if (brighter.empty() || !knows_all_) return 0;
    const auto middle = brighter.begin() + static_cast<std::ptrdiff_t>(brighter.size() / 2);
    std::nth_element(brighter.begin(), middle, brighter.end());
    return *middle;
  }

  std::vector<LitSides> lit() const {
    constexpr float share = 0.05f;
    const float least = share * typical();
    std::vector<LitSides> result;
    if (!(least > 0)) return result;
    result.reserve(sides_.size());
    for (const auto& [front, back] : sides_) result.push_back({front >= least, back >= least});
    return result;
  }

 private:
  bool add(const PointLight& light, const Transform& to_world) {
    add_point(to_world.point(light.from), [&](const Direction&) { return luminance_of(light.intensity); });
    return true;
  }
  bool add(const SpotLight& light, const Transform& to_world) {
    const Point from = to_world.point(light.from);
    const Direction axis = normalize(to_world.point(light.to) - from);
    const float edge = std::cos(to_radians(light.cone_angle));
    add_point(from, [&](const Direction& d) { return dot(d, axis) > edge ? luminance_of(light.intensity) : 0; });
    return true;
  }
  bool add(const DistantLight& light, const Transform& to_world) {
    const Direction towards = normalize(to_world.vector(light.from - light.to));
    if (!std::isfinite(length_squared(towards))) return true;
    const float azimuth = std::atan2(towards.x, towards.z), elevation = std::asin(std::clamp(towards.y, -1.0f, 1.0f));
    const float to_degrees = 180 / pi;
    const OutsideView view(model_, view_from(to_degrees * azimuth, to_degrees * elevation));
    for (const std::size_t i : view.seen()) add_to(i, towards, luminance_of(light.radiance));
    return true;
  }
  template <class Other>
  bool add(const Other&, const Transform&) {
    return false;
  }

  template <class Intensity>
  void add_point(const Point& from, Intensity&& intensity_towards) {
    constexpr float farthest = 1e18f;  // squares of distances must fit into floats
    if (!(distance_squared(from, model_.bounds.centre()) < sqr(farthest))) return;
    const Panorama view(model_, from, Panorama::Sight::through_glass);
    for (const std::size_t i : view.seen()) {
      const Vec3 d = model_.samples[i].position - from;
      if (!(length_squared(d) > 0)) continue;
      const float distance2 = std::max(length_squared(d), sqr(model_.spacing));
      const Direction direction = normalize(d);
      add_to(i, -direction, intensity_towards(direction) / distance2);
    }
  }

  // Represents all emitters by a few points.
  void add_emitters(const SceneDescription& scene) {
    constexpr std::size_t points = 32;
    std::set<Index> lamps;
    for (Index i = 0; i < scene.area_lights.size(); ++i)
      if (shines(scene.area_lights[i])) lamps.insert(i);
    if (lamps.empty()) return;
    const Surfaces emitters(scene, lamps);
    const float area = static_cast<float>(emitters.area() / points);
    for (const Surfaces::Sample& s : emitters.samples(points)) {
      const AreaLight& light = scene.area_lights[*s.area_light];
      const float power = radiance_of(light) * area;
      for (const Normal& n : {s.normal, -s.normal}) {
        if (n != s.normal && !light.two_sided) continue;
        // Far enough from the emitter that its own samples do not cover the hemisphere above them.
        const float height = 4 * model_.spacing;
        if (is_covered(s.position, n, height, lamps)) continue;
        add_point(s.position + height * n, [&](const Direction& d) { return power * dot(d, n); });
      }
    }
  }

  // True if another surface is less than `height` above the point, as a ceiling is above a lamp.
  bool is_covered(const Point& p, const Normal& n, float height, const std::set<Index>& lamps) const {
    return std::any_of(model_.samples.begin(), model_.samples.end(), [&](const Surfaces::Sample& s) {
      const Vec3 d = s.position - p;
      const float above = dot(d, n);
      const bool is_lamp = s.area_light && lamps.count(*s.area_light) > 0;
      return above > 0 && above < height && length_squared(d) - sqr(above) < sqr(1.5f * model_.spacing) && !is_lamp;
    });
  }

  void add_to(std::size_t i, const Direction& towards_light, float irradiance) {
    const float cosine = dot(towards_light, model_.samples[i].normal);
    if (irradiance > 0 && std::isfinite(irradiance)) sides_[i][cosine < 0 ? 1 : 0] += std::fabs(cosine) * irradiance;
  }

  const ModelSamples& model_;
  std::vector<std::array<float, 2>> sides_;
  bool knows_all_ = true;
};

}  // namespace

float radiance_of(const AreaLight& light) { return light.scale * luminance(rgb_of(light.radiance.value)); }

bool shines(const AreaLight& light) {
  const Rgb radiance = light.scale * rgb_of(light.radiance.value);
  return !light.radiance.texture && std::max({radiance.r, radiance.g, radiance.b}) > 1;
}

std::vector<LitSides> lit_sides(const SceneDescription& scene, const ModelSamples& model) {
  return Irradiances(scene, model).lit();
}

float typical_irradiance(const SceneDescription& scene, const ModelSamples& model) {
  return Irradiances(scene, model).typical();
}

}  // namespace lanthorn
