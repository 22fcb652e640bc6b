// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/subpath.h"

namespace lanthorn {

std::vector<float> emission_probabilities(const Scene& scene) {
  std::vector<float> result;
  double sum = 0;
  for (const Light& light : scene.lights()) {
    result.push_back(std::fmax(0.0f, power(light)));
    sum += static_cast<double>(result.back());
  }
  for (float& p : result) p = sum > 0 ? static_cast<float>(static_cast<double>(p) / sum) : 0;
  return result;
}

float next_event_density(const Scene& scene, std::uint32_t index, const Point& from, const Normal& normal,
                         const EmitterHit& hit, const Direction& direction) {
  const Light& light = scene.lights()[index];
  const float chosen = scene.light_bvh().pmf(from, normal, index);
  if (has_surface(light)) return chosen * pdf_direct(light, from, hit);
  return is_infinite(light) || is_volume(light) ? chosen * pdf_direct_towards(light, from, direction) : chosen;
}

// The first vertex of a path: densities of its start (TR eqs. 31-33).
void Subpath::begin(const Scene& scene, const WalkState& state, const Position& at, float distance2) {
  if (camera_) {
    first_distance_ = std::sqrt(distance2);
    const Ray ray{state.previous, (at.position - state.previous) / first_distance_, infinity, at.time};
    step_ = {camera_->density_at(ray, first_distance_) * distance2, 1};
    densities_.vcm = techniques_.light_paths / step_.pdf;
    return;
  }
  const Light& light = scene.lights()[light_];
  comes_as_ray_ = is_of_rays(light);
  // Where on the ray the light path has started is no part of the path that the weights know.
  if (is_volume(light)) {
    const EmitterHit here{at.position, Normal(0), Vec2(0)};
    emission_.pdf_position = pdf_emission(light, here, emission_.direction).position;
  }
  const float traced = probability_ * emission_.pdf_position * emission_.pdf_direction;
  if (!(traced > 0)) {
    if (trails_) trails_->emplace_back();
    return;
  }
  const EmitterHit origin{emission_.origin, emission_.normal, Vec2(0)};
  const bool on_surface = has_surface(light);
  const float cos_origin = on_surface ? emission_.cos_origin : 1.0f;
  // Per area at the light. arrive() will multiply by the squared distance.
  const float direct = next_event_density(scene, light_, at.position, at.normal, origin, -emission_.direction) *
                       (on_surface ? cos_origin / distance2 : 1.0f);
  densities_.vcm = direct / traced;
  densities_.vc = is_delta(light) ? 0.0f : cos_origin / traced;
  if (!trails_) return;
  const float pdf_light = comes_as_ray_ ? emission_.pdf_direction : emission_.pdf_position;
  step_ = {comes_as_ray_ ? emission_.pdf_position * distance2 : emission_.pdf_direction, 1};
  const float geometry = comes_as_ray_ ? 1.0f : cos_origin / distance2;
  trails_->push_back(
      {.arrives = probability_ * pdf_light, .geometry = is_delta(light) ? 0.0f : geometry, .direct = direct});
}

void Subpath::leave_previous(const WalkState& state, const Direction& direction) {
  const float cos = previous_.surface ? geometric_cosine(*previous_.surface, direction) : 1.0f;
  // The density of a phase function is the same in both directions.
  const auto reverse_density = [&] {
    if (!previous_.surface) return state.pdf_direction;
    const SurfacePoint& at = *previous_.surface;
    return pdf_reverse(at.bsdf, previous_.wi_local, at.shading.to_local(direction));
  };
  const float reverse = state.last_delta ? 1.0f : reverse_density();
  step_ = {state.last_delta ? 1.0f : state.pdf_direction, cos};
  if (state.last_delta)
    densities_.scatter_delta(cos);
  else
    densities_.scatter(cos, step_.pdf, reverse, previous_.merges);
  if (!trails_) return;
  trails_->back().delta = state.last_delta;
  if (trail().size() < 2) return;
  TrailVertex& before = trails_->end()[-2];
  before.back = reverse * before.geometry;
}

void Subpath::arrive_at(const Scene& scene, const WalkState& state, const Position& at, const Direction& wi) {
  const float distance2 = distance_squared(at.position, state.previous);
  if (state.depth == 1)
    begin(scene, state, at, distance2);
  else
    leave_previous(state, -wi);
  densities_.arrive(distance2, at.cos, state.depth == 1 && comes_as_ray_);
  if (!trails_) return;
  if (state.depth > 1) trails_->back().geometry = step_.cos / distance2;
  trails_->push_back({.arrives = step_.pdf * at.cos / distance2, .merges = at.merges});
}

void Subpath::arrive(const Scene& scene, const SurfaceVertex& v) {
  const bool is_direct = !camera_ && v.state.depth == 1;
  const bool merges = merges_at(v.at) && !(is_direct && techniques_.connects);
  const float cos = geometric_cosine(v.at, v.wi);
  arrive_at(scene, v.state, {v.at.position, receiver_normal(v.at), v.at.time, cos, merges}, v.wi);
  previous_ = {v.at, v.wi_local, merges};
}

void Subpath::arrive(const Scene& scene, const MediumVertex& v) {
  arrive_at(scene, v.state, {v.position, Normal(0), v.time, 1, false}, v.wi);
  previous_ = {};
}

void Subpath::escape(const WalkState& state, const Direction& direction) {
  if (state.depth > 0) leave_previous(state, direction);
}

}  // namespace lanthorn
