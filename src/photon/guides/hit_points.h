// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Where pilot eye paths need photons: hit points, which credit the photons that light them, and landings, where photons
// must land first to light the picture.
#pragma once

#include <vector>

#include "path/path_draw.h"
#include "path/render_job.h"
#include "photon/guides/emission_choice.h"
#include "photon/guides/guide_photons.h"

namespace lanthorn {

/// A point on a visible surface, or in a medium where an eye path scatters, or at the end of a gather ray from there.
struct HitPoint {
  Point position{0};
  Normal normal{0};  ///< 0 in a medium
  float radius = 0;  ///< of the disc or ball whose photons get credit, m; 0: no hit point
  bool ends_gather = false;
  /// Brightness that photons add to the pixel, per irradiance; in a medium, per flux in a volume.
  float throughput = 0;
  float direct = 0;  ///< brightness of the pixel without photons

  /// Share of the pixel's light that photons of this flux contribute.
  float share_of(float flux) const {
    const float disc = pi * radius * radius;
    const float brightness = throughput * flux / (normal == Normal(0) ? disc * (4 * radius / 3) : disc);
    return brightness > 0 ? brightness / (brightness + direct) : 0.0f;
  }
};

/// The hit points of pilot eye paths through the full film; their discs cover the visible surfaces. `in_media`: there
/// are photons in media.
std::vector<HitPoint> find_hit_points(const RenderJob& job, PhotonUse use, bool in_media, const PassDraw& draw);

/// Places where photons must land first to light the picture: the vertices of eye paths after their first wide lobe,
/// and also the vertex of that lobe if direct photons count.
struct Landings {
  std::vector<Point> places;
  std::vector<Importance> importance;  ///< on surfaces

  void append(const Landings& other) {
    places.insert(places.end(), other.places.begin(), other.places.end());
    importance.insert(importance.end(), other.importance.begin(), other.importance.end());
  }
};

/// The landings of further pilot eye paths, not the ones of `find_hit_points`.
Landings find_landings(const RenderJob& job, PhotonUse use, bool in_media, const PassDraw& draw);

}  // namespace lanthorn
