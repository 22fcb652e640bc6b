// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "film/film.h"
#include "film/sensor.h"
#include "path/path_class.h"
#include "spectrum/wavelengths.h"
#include "surface/bsdf.h"

namespace lanthorn {

/// Collects the light of one eye path by class, and the features that it sees, into one film sample.
/// Visitors show it each vertex and flight by `see` before they add light there.
class LightLayers {
 public:
  static constexpr std::size_t most_parts = 4;  ///< of a decomposition

  /// `w` must outlive it, or its next `use`.
  explicit LightLayers(const Wavelengths& w) : w_(&w) {}
  /// The path goes on with another object for the same four wavelengths.
  void use(const Wavelengths& w) { w_ = &w; }

  /// `radiance` is in the path's colour mode. `dispersed`: the path is valid at the hero wavelength only.
  void add(PathClass path_class, const Spectrum& radiance, bool dispersed) {
    if (radiance.is_black()) return;
    const Spectrum light = add_to_class(path_class, radiance, dispersed);
    if (part_ && path_class != PathClass::emission) parts_[*part_] += light;
  }

  /// The same for methods whose film has a decomposition (see Decomposition): `part` is the index of one of its parts.
  void add(PathClass path_class, std::size_t part, const Spectrum& radiance, bool dispersed) {
    if (radiance.is_black()) return;
    parts_[part] += add_to_class(path_class, radiance, dispersed);
    has_parts_ = true;
  }

  /// Adds the estimated bias of light that is added separately.
  void add_bias(const Spectrum& bias, bool dispersed) { bias_ += dispersed ? bias * w_->dispersed : bias; }

  /// Light that the walk finds by hitting an emitter at this vertex; `part` as above.
  void add_hit(const SurfaceVertex& v, const Spectrum& radiance, std::optional<std::size_t> part = {}) {
    come_from(false, v.state);
    add_hit(v.state, v.state.depth - 1, radiance, part);
  }
  void add_hit(const EscapeVertex& v, const Spectrum& radiance, std::optional<std::size_t> part = {}) {
    come_from(false, v.state);
    add_hit(v.state, v.state.depth, radiance, part);
  }
  /// Volumetric emission along the ray to the next vertex.
  void add_hit(const EmissionVertex& v, const Spectrum& radiance, std::optional<std::size_t> part = {}) {
    come_from(true, v.state);
    add_hit(v.state, v.state.depth, radiance, part);
  }

  /// Light that is added by class alone from now on, except emission, belongs to this part.
  void begin_part(std::size_t part) {
    part_ = part;
    has_parts_ = true;
  }
  /// The part begun last. Precondition: there is one.
  std::size_t part() const { return *part_; }

  /// True if the light that is added now comes out of a medium (see media_layer).
  bool is_from_medium() const { return from_medium_; }

  /// Sum of a class so far, with the factor of dispersion.
  const Spectrum& light(PathClass path_class) const { return sums_[static_cast<std::size_t>(path_class)]; }

  /// Records the depth of the first surface, and albedo, normal and position of the first one with a non-delta lobe.
  void see(const SurfaceVertex& vertex) {
    come_from(false, vertex.state);
    if (!features_.depth) features_.depth = std::sqrt(distance_squared(vertex.state.previous, vertex.at.position));
    if (seen_ || !has_non_delta(vertex.at.bsdf)) return;
    seen_ = true;
    features_.albedo = w_->to_rgb(albedo(vertex.at.bsdf, vertex.wi_local));
    features_.normal = vertex.at.shading.n;
    features_.position = {vertex.at.position};
  }

  void see(const MediumVertex& vertex) { come_from(true, vertex.state); }
  void see(const MediumRay& ray) { come_from(true, ray.state); }
  /// For light that is scattered along the flight.
  void see(const FlownSegment& flight) { come_from(true, flight.state); }

  /// The film sample.
  PixelSample sample(FilterPart filter_part, const Sensor& sensor) {
    limit(sensor);
    PixelSample result{.features = features_};
    for (std::size_t c = 0; c < path_class_count; ++c) result.light[c] = w_->to_rgb(sums_[c]);
    if (has_media_) result.light[media_layer] = w_->to_rgb(media_);
    if (!bias_.is_black()) result.bias = w_->to_rgb(bias_);
    for (std::size_t p = 0; p < parts_.size() && has_parts_; ++p) result.parts[p] = w_->to_rgb(parts_[p]);
    if (w_->mode == ColorMode::spectral) {
      Spectrum sum;
      for (const Spectrum& part : sums_) sum += part;
      result.spectrum = SpectralRadiance(sum, *w_);
    }
    result.filter_part = filter_part;
    return result;
  }

 private:
  // Only the walk up to its first non-delta scattering decides where light comes from.
  void come_from(bool medium, const WalkState& state) {
    if (state.non_delta == 0) from_medium_ = medium;
  }
  Spectrum add_to_class(PathClass path_class, const Spectrum& radiance, bool dispersed) {
    const Spectrum light = dispersed ? radiance * w_->dispersed : radiance;
    sums_[static_cast<std::size_t>(path_class)] += light;
    if (from_medium_) {
      media_ += light;
      has_media_ = true;
    }
    return light;
  }
  void add_hit(const WalkState& state, int scatterings, const Spectrum& radiance, std::optional<std::size_t> part) {
    const PathClass path_class = class_of_hit(state);
    if (part)
      add(path_class, *part, radiance, state.dispersed);
    else
      add(path_class, radiance, state.dispersed);
    if (scatterings > 0) return;
    directly_seen_ += radiance;
    if (from_medium_) directly_seen_in_media_ += radiance;
    part_of_directly_seen_ = part;
  }
  // Applies the sensor's limit to all but emission that is seen directly.
  void limit(const Sensor& sensor) {
    if (!sensor.path_limit) return;
    Spectrum all;
    for (const Spectrum& sum : sums_) all += sum;
    const float factor = sensor.path_factor(w_->to_rgb(all - directly_seen_));
    if (factor == 1) return;
    for (Spectrum& sum : sums_) sum *= factor;
    for (Spectrum& part : parts_) part *= factor;
    bias_ *= factor;
    sums_[static_cast<std::size_t>(PathClass::emission)] += (1 - factor) * directly_seen_;
    media_ = factor * media_ + (1 - factor) * directly_seen_in_media_;
    if (part_of_directly_seen_) parts_[*part_of_directly_seen_] += (1 - factor) * directly_seen_;
  }

  const Wavelengths* w_;
  std::array<Spectrum, path_class_count> sums_{};
  std::array<Spectrum, most_parts> parts_{};
  Spectrum media_, bias_;
  std::optional<std::size_t> part_;
  Features features_;
  bool seen_ = false;
  bool from_medium_ = false;
  Spectrum directly_seen_;                            // emission, a part of the sum of its class
  Spectrum directly_seen_in_media_;                   // the part of it that media emit
  std::optional<std::size_t> part_of_directly_seen_;  // which holds it, too
  bool has_parts_ = false, has_media_ = false;        // skip the conversion of black sums
};

}  // namespace lanthorn
