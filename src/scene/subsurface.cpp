// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/subsurface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/scene_data.h"

namespace lanthorn {

bool is_under_surface(const Scene& scene, MediumId medium) {
  const std::vector<bool>& under = scene.data()->is_under_surface;
  return !under.empty() && medium != MediumId::vacuum && under[static_cast<std::size_t>(medium) - 1];
}

int most_under_surface(const Scene& scene) { return scene.data()->most_under_surface; }

int scatterings_until_dark(float albedo) {
  constexpr double least = 64, most = 4096, rest = 1e-3;
  const auto a = static_cast<double>(albedo);
  return static_cast<int>(std::clamp(a < 1 ? std::ceil(std::log(rest) / std::log(a)) : most, least, most));
}

void find_media_under_surfaces(SceneData& data) {
  float albedo = 0;
  for (const description::Material& material : std::as_const(data.description).materials) {
    if (!material.interior) continue;
    if (*material.interior >= data.media->all.size())
      throw Error(material.location, "the medium inside the material does not exist");
    data.is_under_surface.resize(data.media->all.size());
    data.is_under_surface[*material.interior] = true;
    albedo = std::max(albedo, largest_albedo(data.media->all[*material.interior]));
  }
  data.most_under_surface = data.is_under_surface.empty() ? 0 : scatterings_until_dark(albedo);
}

}  // namespace lanthorn
