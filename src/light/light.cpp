// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/light.h"

namespace lanthorn {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

/// Dispatches to the function for the light's kind.
template <class... F>
auto match(const Light& light, F&&... f) {
  return std::visit(Overloaded{std::forward<F>(f)...}, light);
}

}  // namespace

std::optional<LightSample> sample_direct(const Light& light, const Point& from, const Vec2& u, const Wavelengths& w) {
  return match(
      light, [&](const AreaLight& l) { return l.sample_direct(from, u, w); },
      [&](const PointLight& l) { return l.sample_direct(from, w); },
      [&](const SpotLight& l) { return l.sample_direct(from, w); },
      [&](const GoniometricLight& l) { return l.sample_direct(from, w); },
      [&](const ProjectionLight& l) { return l.sample_direct(from, w); },
      [&](const DistantLight& l) { return l.sample_direct(w); },
      [&](const UniformInfiniteLight& l) { return l.sample_direct(u, w); },
      [&](const ImageInfiniteLight& l) { return l.sample_direct(u, w); },
      [&](const PortalLight& l) { return l.sample_direct(from, u, w); });
}

float pdf_direct(const Light& light, const Point& from, const EmitterHit& hit) {
  const auto* surface = std::get_if<AreaLight>(&light);
  return surface ? surface->pdf_direct(from, hit) : 0;
}

float pdf_direct_infinite(const Light& light, const Point& from, const Direction& towards) {
  return match(
      light, [](const UniformInfiniteLight& l) { return l.pdf_direct(); },
      [&](const ImageInfiniteLight& l) { return l.pdf_direct(towards); },
      [&](const PortalLight& l) { return l.pdf_direct(from, towards); }, [](const auto&) { return 0.0f; });
}

Spectrum emitted(const Light& light, const EmitterHit& hit, const Direction& direction, const Wavelengths& w) {
  const auto* surface = std::get_if<AreaLight>(&light);
  return surface ? surface->emitted(hit, direction, w) : Spectrum();
}

Spectrum emitted_infinite(const Light& light, const Point& from, const Direction& towards, const Wavelengths& w) {
  return match(
      light, [&](const UniformInfiniteLight& l) { return l.emitted(w); },
      [&](const ImageInfiniteLight& l) { return l.emitted(towards, w); },
      [&](const PortalLight& l) { return l.emitted(from, towards, w); }, [](const auto&) { return Spectrum(); });
}

std::optional<EmissionSample> sample_emission(const Light& light, const Vec2& u_position, const Vec2& u_direction,
                                              const Wavelengths& w) {
  return match(
      light, [&](const AreaLight& l) { return l.sample_emission(u_position, u_direction, w); },
      [&](const PointLight& l) { return l.sample_emission(u_direction, w); },
      [&](const SpotLight& l) { return l.sample_emission(u_direction, w); },
      [&](const GoniometricLight& l) { return l.sample_emission(u_direction, w); },
      [&](const ProjectionLight& l) { return l.sample_emission(u_direction, w); },
      [&](const DistantLight& l) { return l.sample_emission(u_position, w); },
      [&](const UniformInfiniteLight& l) { return l.sample_emission(u_position, u_direction, w); },
      [&](const ImageInfiniteLight& l) { return l.sample_emission(u_position, u_direction, w); },
      [&](const PortalLight& l) { return l.sample_emission(u_position, u_direction, w); });
}

EmissionPdf pdf_emission(const Light& light, const EmitterHit& origin, const Direction& direction) {
  return match(
      light, [&](const AreaLight& l) { return l.pdf_emission(origin, direction); },
      [](const PointLight& l) { return l.pdf_emission(); },
      [&](const SpotLight& l) { return l.pdf_emission(direction); },
      [&](const GoniometricLight& l) { return l.pdf_emission(direction); },
      [&](const ProjectionLight& l) { return l.pdf_emission(direction); },
      [](const DistantLight& l) { return l.pdf_emission(); },
      [](const UniformInfiniteLight& l) { return l.pdf_emission(); },
      [&](const ImageInfiniteLight& l) { return l.pdf_emission(direction); },
      [&](const PortalLight& l) { return l.pdf_emission(origin.position, direction); });
}

float power(const Light& light) {
  return std::visit([](const auto& l) { return l.power(); }, light);
}

bool is_delta(const Light& light) {
  return match(
      light, [](const AreaLight& l) { return l.invisible; }, [](const UniformInfiniteLight&) { return false; },
      [](const ImageInfiniteLight&) { return false; }, [](const PortalLight&) { return false; },
      [](const auto&) { return true; });
}

bool is_infinite(const Light& light) {
  return std::holds_alternative<UniformInfiniteLight>(light) || std::holds_alternative<ImageInfiniteLight>(light) ||
         std::holds_alternative<PortalLight>(light);
}

}  // namespace lanthorn
