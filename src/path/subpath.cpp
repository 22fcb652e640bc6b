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
  if (std::holds_alternative<AreaLight>(light)) return chosen * pdf_direct(light, from, hit);
  return is_infinite(light) ? chosen * pdf_direct_infinite(light, from, direction) : chosen;
}

// The first vertex of a path: densities of its start (TR eqs. 31-33).
void Subpath::begin(const Scene& scene, const WalkState& state, const Point& position, const Normal& normal,
                    float time) {
  const Vec3 way = position - state.previous;
  const float distance2 = length_squared(way);
  if (at_lens_) {
    const float distance = std::sqrt(distance2);
    const Ray ray{state.previous, way / distance, infinity, time};
    densities_.vcm = techniques_.light_paths / (scene.camera().density_at(ray, distance) * distance2);
    return;
  }
  const Light& light = scene.lights()[light_];
  comes_from_infinity_ = is_infinite(light) || std::holds_alternative<DistantLight>(light);
  const float traced = probability_ * emission_.pdf_position * emission_.pdf_direction;
  const EmitterHit origin{emission_.origin, emission_.normal, Vec2(0)};
  if (!(traced > 0)) return;
  const float direct = next_event_density(scene, light_, position, normal, origin, -emission_.direction);
  const bool has_surface = std::holds_alternative<AreaLight>(light);
  // Per area at the light: what arrive() will multiply by the distance again.
  const float direct_by_area = has_surface ? direct * emission_.cos_origin / distance2 : direct;
  densities_.vcm = direct_by_area / traced;
  densities_.vc = is_delta(light) ? 0.0f : (has_surface ? emission_.cos_origin : 1.0f) / traced;
  densities_.vm = densities_.vc * techniques_.connecting;
}

void Subpath::leave_previous(const WalkState& state, const Direction& direction) {
  const float cos = previous_.is_surface ? std::fabs(dot(previous_.normal, direction)) : 1.0f;
  if (state.last_delta) {
    densities_.scatter_delta(cos);
    return;
  }
  const float pdf_forward = state.pdf_direction;
  // A phase function is as dense in both directions.
  const float reverse = previous_.is_surface
                            ? pdf(previous_.bsdf, previous_.shading.to_local(direction), previous_.wi_local)
                            : pdf_forward;
  densities_.scatter(cos, pdf_forward, reverse, previous_.merges, techniques_);
}

const SubpathDensities& Subpath::arrive(const Scene& scene, const SurfaceVertex& v) {
  if (v.state.depth == 1)
    begin(scene, v.state, v.at.position, v.at.shading.n, v.at.time);
  else
    leave_previous(v.state, -v.wi);
  densities_.arrive(distance_squared(v.at.position, v.state.previous), std::fabs(dot(v.at.normal, v.wi)),
                    v.state.depth == 1 && comes_from_infinity_);
  previous_ = {true, merges_at(v.at), v.at.bsdf, v.at.shading, v.at.normal, v.wi_local};
  return densities_;
}

const SubpathDensities& Subpath::arrive(const Scene& scene, const MediumVertex& v) {
  if (v.state.depth == 1)
    begin(scene, v.state, v.position, Normal(0), v.time);
  else
    leave_previous(v.state, -v.wi);
  densities_.arrive(distance_squared(v.position, v.state.previous), 1, v.state.depth == 1 && comes_from_infinity_);
  previous_ = {};
  return densities_;
}

const SubpathDensities& Subpath::escape(const EscapeVertex& v) {
  if (v.state.depth > 0) leave_previous(v.state, v.direction);
  return densities_;
}

}  // namespace lanthorn
