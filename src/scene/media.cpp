// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/media.h"

#include <limits>

namespace lanthorn {

namespace {

using description::SpectrumRole;

Medium make_medium(const description::Medium& m, SpectrumStore& spectra, ColorSpace space) {
  HomogeneousMedium medium;
  medium.sigma_a = spectra.curve(m.sigma_a, SpectrumRole::unbounded, space, m.location).scaled(m.scale);
  medium.sigma_s = spectra.curve(m.sigma_s, SpectrumRole::unbounded, space, m.location).scaled(m.scale);
  medium.phase = {m.g};
  if (m.emission)
    medium.emission = spectra.curve(*m.emission, SpectrumRole::illuminant, space, m.location).scaled(m.emission_scale);
  return medium;
}

}  // namespace

std::vector<Medium> make_media(const SceneDescription& description, SpectrumStore& spectra) {
  if (description.media.size() >= std::numeric_limits<std::uint16_t>::max())
    throw Error(description.media.back().location, "too many media: a scene may have 65534");
  std::vector<Medium> media;
  for (const description::Medium& m : description.media)
    media.push_back(make_medium(m, spectra, description.color_space));
  return media;
}

}  // namespace lanthorn
