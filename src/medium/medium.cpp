// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "medium/medium.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <iterator>
#include <limits>

namespace lanthorn {

namespace {

// Affine maps preserve the parameter along a line: distances remain those in the world.
template <class M>
Segment in_medium(const M& medium, const Segment& s) {
  return {medium.to_medium.point(s.origin), medium.to_medium.vector(s.direction), s.length};
}

Attenuation attenuation_of(const HomogeneousMedium& m, const Segment& s, const Wavelengths& w, HashRng&) {
  return m.attenuation(s.length, w);
}
template <class M>
Attenuation attenuation_of(const M& m, const Segment& s, const Wavelengths& w, HashRng& rng) {
  Attenuation result;
  track_transmittance(m, in_medium(m, s), w, rng,
                      [&](float, const Spectrum& estimate) { result.transmittance = estimate; });
  return result;
}

Spectrum scattering_of(const HomogeneousMedium& m, const Point&, const Wavelengths& w) { return m.sigma_s.evaluate(w); }
template <class M>
Spectrum scattering_of(const M& m, const Point& p, const Wavelengths& w) {
  return m.at(m.to_medium.point(p), w).scattered;
}

float scattering_length_of(const HomogeneousMedium& m, const Segment& s, const Wavelengths& w) {
  constexpr float depth = 17.4f;  // optical; its transmittance is below 2^-25
  const Spectrum scattered = m.sigma_s.evaluate(w), extinction = m.extinction(w);
  float length = 0;
  for (int i = 0; i < 4; ++i)
    if (scattered[i] > 0) length = std::max(length, depth / extinction[i]);
  return std::min(s.length, length);
}
template <class M>
float scattering_length_of(const M& m, const Segment& s, const Wavelengths&) {
  float end = 0;
  m.majorants.for_each_piece(in_medium(m, s), [&](float, float t1, float) {
    end = t1;
    return true;
  });
  return end;
}

Flight fly_through(const HomogeneousMedium& m, const Segment& s, const Spectrum& beta, const Wavelengths& w,
                   HashRng& rng) {
  return m.fly(s.length, beta, w, rng);
}
template <class M>
Flight fly_through(const M& m, const Segment& s, const Spectrum& beta, const Wavelengths& w, HashRng& rng) {
  return track_flight(m, in_medium(m, s), beta, w, rng);
}

VolumeEmission emission_in(const HomogeneousMedium& m, const Segment& s, const Wavelengths& w, HashRng&) {
  return m.emission_along(s.length, w);
}
template <class M>
VolumeEmission emission_in(const M& m, const Segment& s, const Wavelengths& w, HashRng& rng) {
  return track_emission(m, in_medium(m, s), w, rng);
}

Spectrum emission_of(const HomogeneousMedium& m, const Point&, const Wavelengths& w) {
  return m.sigma_a.evaluate(w) * m.emission.evaluate(w);
}
template <class M>
Spectrum emission_of(const M& m, const Point& p, const Wavelengths& w) {
  return m.emitted(m.to_medium.point(p), w);
}

}  // namespace

bool scatters(const Medium& medium) {
  return std::visit(
      [](const auto& m) {
        if constexpr (requires { m.sigma_s.is_black(); }) return !m.sigma_s.is_black();
        return true;
      },
      medium);
}

namespace {

// For coefficients that vary with wavelength only.
float albedo_of(const SpectrumCurve& sigma_a, const SpectrumCurve& sigma_s) {
  float largest = 0;
  const auto see = [&](float absorbed, float scattered) {
    if (scattered > 0) largest = std::max(largest, scattered / (absorbed + scattered));
  };
  see(sigma_a.rgb.r, sigma_s.rgb.r);
  see(sigma_a.rgb.g, sigma_s.rgb.g);
  see(sigma_a.rgb.b, sigma_s.rgb.b);
  constexpr float step = 5;  // nm
  for (float nm = lambda_min; nm <= lambda_max; nm += step) see(sigma_a.at(nm), sigma_s.at(nm));
  return largest;
}

// Where no grid is given, the coefficient is 1 everywhere.
float albedo_of(const std::optional<SampledGrid<Vec3>>& sigma_a, const std::optional<SampledGrid<Vec3>>& sigma_s) {
  float least_absorbed = sigma_a ? std::numeric_limits<float>::max() : 1.0f, most_scattered = sigma_s ? 0.0f : 1.0f;
  if (sigma_a)
    for (const Vec3& v : sigma_a->values) least_absorbed = std::min({least_absorbed, v.x, v.y, v.z});
  if (sigma_s)
    for (const Vec3& v : sigma_s->values) most_scattered = std::max({most_scattered, v.x, v.y, v.z});
  return most_scattered > 0 ? most_scattered / (std::max(0.0f, least_absorbed) + most_scattered) : 0.0f;
}

}  // namespace

float largest_albedo(const Medium& medium) {
  return std::visit([](const auto& m) { return albedo_of(m.sigma_a, m.sigma_s); }, medium);
}

bool is_emissive(const Medium& medium) {
  struct IsEmissive {
    bool operator()(const HomogeneousMedium& m) const { return !m.emission.is_black(); }
    bool operator()(const DensityMedium& m) const { return m.emission.has_value(); }
    bool operator()(const RgbGridMedium& m) const { return m.emission.has_value(); }
  };
  return std::visit(IsEmissive{}, medium);
}

Attenuation attenuation(const Medium& medium, const Segment& segment, const Wavelengths& w, HashRng& rng) {
  return std::visit([&](const auto& m) { return attenuation_of(m, segment, w, rng); }, medium);
}

Spectrum scattering_at(const Medium& medium, const Point& p, const Wavelengths& w) {
  return std::visit([&](const auto& m) { return scattering_of(m, p, w); }, medium);
}

float mean_extinction(const Medium& medium, const Wavelengths& w) {
  const auto* homogeneous = std::get_if<HomogeneousMedium>(&medium);
  return homogeneous ? w.mean_of(homogeneous->extinction(w)) : 0.0f;
}

float collision_density(const Medium& medium, const Point& p, const Wavelengths& w) {
  if (std::holds_alternative<HomogeneousMedium>(medium)) return mean_extinction(medium, w);
  return w.mean_of(scattering_at(medium, p, w));
}

float scattering_length(const Medium& medium, const Segment& segment, const Wavelengths& w) {
  return std::visit([&](const auto& m) { return scattering_length_of(m, segment, w); }, medium);
}

TransmittanceCurve::TransmittanceCurve(const Medium& medium, const Segment& segment, const Wavelengths& w,
                                       HashRng& rng) {
  if (const auto* homogeneous = std::get_if<HomogeneousMedium>(&medium)) {
    extinction_ = homogeneous->extinction(w);
    return;
  }
  const auto track = [&](const auto& m) {
    if constexpr (requires { m.majorants; })
      track_transmittance(m, in_medium(m, segment), w, rng, [&](float t, const Spectrum& estimate) {
        steps_.push_back({t, estimate});
      });
  };
  std::visit(track, medium);
}

Spectrum TransmittanceCurve::to(float distance) const {
  const auto next = std::upper_bound(steps_.begin(), steps_.end(), distance,
                                     [](float d, const Step& step) { return d < step.distance; });
  if (next != steps_.begin()) return std::prev(next)->transmittance;
  return map(extinction_, [distance](float sigma) { return std::exp(-sigma * distance); });
}

Flight fly(const Medium& medium, const Segment& segment, const Spectrum& beta, const Wavelengths& w, HashRng& rng) {
  return std::visit([&](const auto& m) { return fly_through(m, segment, beta, w, rng); }, medium);
}

std::optional<Spectrum> passing_weight(const Medium& medium, float distance, const Spectrum& beta,
                                       const Wavelengths& w) {
  const auto* homogeneous = std::get_if<HomogeneousMedium>(&medium);
  if (homogeneous == nullptr) return {};
  // A flight chooses a wavelength by its throughput, and a distance by the extinction at that wavelength
  // (HomogeneousMedium::fly).
  const Spectrum through = homogeneous->attenuation(distance, w).transmittance;
  const float passing = sum_of(beta * through) / sum_of(beta);
  return passing > 0 ? through / passing : Spectrum();
}

VolumeEmission emission_along(const Medium& medium, const Segment& segment, const Wavelengths& w, HashRng& rng) {
  return std::visit([&](const auto& m) { return emission_in(m, segment, w, rng); }, medium);
}

Spectrum emission_at(const Medium& medium, const Point& p, const Wavelengths& w) {
  return std::visit([&](const auto& m) { return emission_of(m, p, w); }, medium);
}

double MediumBox::volume() const {
  const Vec3 e = box.extent();
  const double scale = std::fabs(static_cast<double>(glm::determinant(glm::mat3(to_medium.inverse))));
  return static_cast<double>(e.x) * static_cast<double>(e.y) * static_cast<double>(e.z) * scale;
}

std::optional<MediumBox> box_of(const Medium& medium) {
  return std::visit(
      [](const auto& m) -> std::optional<MediumBox> {
        if constexpr (requires { m.majorants; }) return MediumBox{m.majorants.box(), m.to_medium};
        return std::nullopt;
      },
      medium);
}

const HenyeyGreenstein& phase_of(const Medium& medium) {
  return std::visit([](const auto& m) -> const HenyeyGreenstein& { return m.phase; }, medium);
}

}  // namespace lanthorn
