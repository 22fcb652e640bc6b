// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/thin_film.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "math/vec.h"
#include "spectrum/cie.h"

namespace lanthorn {

namespace {

/// Cosine transform of white light as each channel of the film sees it: the mean of cos(2 pi D / lambda), by path
/// difference D. [B17 §4] fits it by Gaussians. Beyond the last node all colours have mixed, and it is 0.
class WhiteTransform {
 public:
  static constexpr float step = 4, range = 16000;  // nm

  WhiteTransform() : nodes_(static_cast<std::size_t>(range / step) + 1) {
    std::array<Tristimulus, spectrum_samples> response;
    Tristimulus sum;
    for (std::size_t i = 0; i < spectrum_samples; ++i) {
      response[i] = xyz_to_rec709 * (static_cast<double>(illuminant_d65.values[i]) * cie_1931[i]);
      sum = sum + response[i];
    }
    for (std::size_t k = 0; k + 1 < nodes_.size(); ++k) {
      const double phase = 2 * static_cast<double>(pi) * static_cast<double>(step) * static_cast<double>(k);
      Tristimulus at;
      for (std::size_t i = 0; i < spectrum_samples; ++i)
        at = at + std::cos(phase / (static_cast<double>(lambda_min) + static_cast<double>(i))) * response[i];
      const auto g = static_cast<float>(at.y / sum.y);
      nodes_[k] = {static_cast<float>(at.x / sum.x), g, static_cast<float>(at.z / sum.z), g};
    }
  }

  /// `difference` in [0, range).
  Spectrum operator()(float difference) const {
    const float x = difference * (1 / step);
    const auto low = static_cast<std::size_t>(x);
    const float fraction = x - static_cast<float>(low);
    return nodes_[low] * (1 - fraction) + nodes_[low + 1] * fraction;
  }

 private:
  std::vector<Spectrum> nodes_;
};

const WhiteTransform& white_transform() {
  static const WhiteTransform only;
  return only;
}

/// One polarisation: products of Fresnel's amplitudes at the two faces.
struct Faces {
  Spectrum through;  ///< (1 - r12^2)(1 - r23^2)
  Spectrum round;    ///< r12 r23: the amplitude left after one round trip in the film, without its phase

  Faces(float r12, const Spectrum& r23) : through((1 - r12 * r12) * (Spectrum(1) - r23 * r23)), round(r12 * r23) {}
};

/// Airy's sum of all transmitted light [BW eq. 1.6.58 and 59]: through / (1 + round^2 + 2 round cos(phase)), with a
/// denominator that does not cancel.
float transmittance(float through, float round, float half_phase) {
  const float swing = round > 0 ? std::cos(half_phase) : std::sin(half_phase);
  const float apart = 1 - std::fabs(round);
  return through / std::max(sqr(apart) + 4 * std::fabs(round) * sqr(swing), 1e-10f);
}

Spectrum transmittance(const Faces& faces, float difference, const std::array<float, 4>& lambda) {
  Spectrum result;
  for (unsigned i = 0; i < 4; ++i)
    result.v[i] = transmittance(faces.through.v[i], faces.round.v[i], pi * difference / lambda[i]);
  return result;
}

/// The same under white light; a channel, which sees some colours as negative, may have a little less than 0 or more
/// than 1. Airy's sum is a Poisson kernel, whose Fourier series is through / (1 - round^2) * (1 + 2
/// sum_m (-round)^m cos(m phase)); white light turns the cosines into their means.
Spectrum white_transmittance(const Faces& faces, float difference) {
  constexpr float least = 1e-4f;
  const Spectrum scale = faces.through / map(faces.round, [](float a) { return std::max(1 - a * a, 1e-10f); });
  Spectrum sum = scale, power = 2 * scale;
  for (float at = difference; at < WhiteTransform::range; at += difference) {
    power *= Spectrum(-1) * faces.round;
    if (max_component(map(power, [](float x) { return std::fabs(x); })) < least) break;
    sum += power * white_transform()(at);
  }
  return sum;
}

}  // namespace

Spectrum film_reflectance(const ThinFilm& film, float cos_i, const Spectrum& eta) {
  const float sin2 = 1 - cos_i * cos_i, n = film.eta;
  const float cos_film = safe_sqrt(1 - sin2 / (n * n));
  const Spectrum cos_t = sqrt(Spectrum(1) - Spectrum(sin2) / (eta * eta));
  const Spectrum in_film(cos_film);
  const Faces perpendicular((cos_i - n * cos_film) / (cos_i + n * cos_film),
                            (n * in_film - eta * cos_t) / (n * in_film + eta * cos_t));
  const Faces parallel((n * cos_i - cos_film) / (n * cos_i + cos_film),
                       (eta * cos_film - n * cos_t) / (eta * cos_film + n * cos_t));
  const float difference = 2 * n * film.thickness * cos_film;  // of the paths of neighbouring terms, nm
  const auto passed = [&](const Faces& faces) {
    return film.lambda[0] > 0 ? transmittance(faces, difference, film.lambda) : white_transmittance(faces, difference);
  };
  return map(Spectrum(1) - 0.5f * (passed(perpendicular) + passed(parallel)),
             [](float r) { return std::clamp(r, 0.0f, 1.0f); });
}

Spectrum index_from_reflectance(const Spectrum& reflectance) {
  return map(reflectance, [](float r) {
    const float root = std::sqrt(std::clamp(r, 0.0f, 0.9999f));
    return (1 + root) / (1 - root);
  });
}

}  // namespace lanthorn
