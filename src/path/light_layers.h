// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "film/film.h"
#include "path/direct_light.h"
#include "spectrum/wavelengths.h"
#include "surface/bsdf.h"

namespace lanthorn {

/// Collects the light of one eye path by class, and what is known of its first surfaces, into one film sample.
class LightLayers {
 public:
  explicit LightLayers(const Wavelengths& w) : w_(w) {}

  /// `radiance` in the path's colour mode; `dispersed` if any part of the path is right for the hero wavelength only.
  void add(PathClass path_class, const Spectrum& radiance, bool dispersed) {
    sums_[static_cast<std::size_t>(path_class)] += dispersed ? radiance * w_.dispersed : radiance;
  }

  /// The same for methods whose films tell techniques apart.
  void add(PathClass path_class, Technique technique, const Spectrum& radiance, bool dispersed) {
    const Spectrum light = dispersed ? radiance * w_.dispersed : radiance;
    sums_[static_cast<std::size_t>(path_class)] += light;
    techniques_[static_cast<std::size_t>(technique)] += light;
    knows_techniques_ = true;
  }

  /// What has been added of a class, with the factor of dispersion.
  const Spectrum& light(PathClass path_class) const { return sums_[static_cast<std::size_t>(path_class)]; }

  /// Depth of the first surface; albedo and normal of the first that is more than a mirror or clear glass.
  void see(const SurfaceVertex& vertex) {
    if (!sample_.depth) sample_.depth = std::sqrt(distance_squared(vertex.state.previous, vertex.at.position));
    if (seen_ || !has_non_delta(vertex.at.bsdf)) return;
    seen_ = true;
    sample_.albedo = w_.to_rgb(albedo(vertex.at.bsdf, vertex.wi_local));
    sample_.normal = vertex.at.shading.n;
  }

  /// The sample, `weight` being the reconstruction filter's.
  PixelSample sample(float weight) const {
    PixelSample result = sample_;
    result.emission = w_.to_rgb(sums_[static_cast<std::size_t>(PathClass::emission)]);
    result.direct = w_.to_rgb(sums_[static_cast<std::size_t>(PathClass::direct)]);
    result.indirect = w_.to_rgb(sums_[static_cast<std::size_t>(PathClass::indirect)]);
    result.caustic = w_.to_rgb(sums_[static_cast<std::size_t>(PathClass::caustic)]);
    for (std::size_t t = 0; t < technique_count && knows_techniques_; ++t)
      result.techniques[t] = w_.to_rgb(techniques_[t]);
    if (w_.mode == ColorMode::spectral) {
      Spectrum sum;
      for (const Spectrum& part : sums_) sum += part;
      result.spectrum = SpectralRadiance(sum, w_);
    }
    result.weight = weight;
    return result;
  }

 private:
  const Wavelengths& w_;
  std::array<Spectrum, path_class_count> sums_{};
  std::array<Spectrum, technique_count> techniques_{};
  PixelSample sample_;
  bool seen_ = false;
  bool knows_techniques_ = false;  // most methods do not, and need no conversions of what is black
};

}  // namespace lanthorn
