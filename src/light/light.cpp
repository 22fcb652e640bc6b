// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Each function calls the light's member. Functions that a light's traits exclude return 0; any other missing member is
// a compile error.
#include "light/light.h"

#include <algorithm>
#include <type_traits>

namespace lanthorn {

namespace {

template <class L>
constexpr LightTraits traits_of_light = std::remove_cvref_t<L>::traits;

}  // namespace

std::optional<LightSample> sample_direct(const Light& light, const Point& from, const Vec2& u, const Wavelengths& w) {
  return std::visit([&](const auto& l) { return l.sample_direct(from, u, w); }, light);
}

float pdf_direct(const Light& light, const Point& from, const EmitterHit& hit) {
  return std::visit(
      [&](const auto& l) {
        if constexpr (traits_of_light<decltype(l)>.has_surface) return l.pdf_direct(from, hit);
        return 0.0f;
      },
      light);
}

float pdf_direct_towards(const Light& light, const Point& from, const Direction& towards) {
  return std::visit(
      [&](const auto& l) {
        constexpr LightTraits traits = traits_of_light<decltype(l)>;
        if constexpr (traits.is_infinite || traits.is_volume) return l.pdf_direct(from, towards);
        return 0.0f;
      },
      light);
}

Spectrum emitted(const Light& light, const EmitterHit& hit, const Direction& direction, const Wavelengths& w) {
  return std::visit(
      [&](const auto& l) {
        if constexpr (traits_of_light<decltype(l)>.has_surface) return l.emitted(hit, direction, w);
        return Spectrum();
      },
      light);
}

Spectrum emitted_infinite(const Light& light, const Point& from, const Direction& towards, const Wavelengths& w) {
  return std::visit(
      [&](const auto& l) {
        if constexpr (traits_of_light<decltype(l)>.is_infinite) return l.emitted(from, towards, w);
        return Spectrum();
      },
      light);
}

float texels_across_right_angle(const Light& light) {
  const auto across = [](const auto& l) {
    if constexpr (requires { l.profile.texels_across_right_angle(); })
      return l.profile.texels_across_right_angle();
    else
      return 0.0f;
  };
  if (const auto* const portal = std::get_if<PortalLight>(&light)) return std::visit(across, portal->sky);
  return std::visit(across, light);
}

std::optional<EmissionSample> sample_emission(const Light& light, const Vec2& u_position, const Vec2& u_direction,
                                              const Wavelengths& w) {
  return std::visit([&](const auto& l) { return l.sample_emission(u_position, u_direction, w); }, light);
}

EmissionPdf pdf_emission(const Light& light, const EmitterHit& origin, const Direction& direction) {
  return std::visit([&](const auto& l) { return l.pdf_emission(origin, direction); }, light);
}

EmissionNumbers invert_emission(const Light& light, const EmitterHit& origin, const Direction& direction) {
  return std::visit([&](const auto& l) { return l.invert_emission(origin, direction); }, light);
}

float power(const Light& light) {
  return std::visit([](const auto& l) { return l.power(); }, light);
}

float largest_radiance(const Light& light, float distance) {
  const float far2 = std::max(distance * distance, 1e-20f);
  return std::visit([far2](const auto& l) { return l.largest_radiance(far2); }, light);
}

bool set_scene_bounds(Light& light, const BoundingSphere& scene) {
  return std::visit(
      [&](auto& l) {
        if constexpr (requires { l.scene = scene; }) {
          l.scene = scene;
          return true;
        }
        return !traits_of_light<decltype(l)>.is_far;
      },
      light);
}

std::optional<EmissionBounds> emission_bounds(const Light& light) {
  return std::visit(
      [](const auto& l) -> std::optional<EmissionBounds> {
        if constexpr (traits_of_light<decltype(l)>.is_far)
          return std::nullopt;
        else
          return l.bounds();
      },
      light);
}

bool is_delta(const Light& light) {
  return std::visit(
      [](const auto& l) {
        if constexpr (traits_of_light<decltype(l)>.has_surface)
          return l.invisible;
        else
          return !traits_of_light<decltype(l)>.is_infinite && !traits_of_light<decltype(l)>.is_volume;
      },
      light);
}

}  // namespace lanthorn
