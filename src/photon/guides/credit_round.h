// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A round of learning: light paths of pilot photons, the credit that hit points give to their starts, and the emission
// guide that follows from it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light/emission_guide.h"
#include "math/tree_distribution.h"
#include "path/path_draw.h"
#include "path/render_job.h"
#include "photon/guides/guide_photons.h"
#include "photon/guides/hit_points.h"
#include "photon/guides/learned_emission.h"
#include "scene/scene.h"

namespace lanthorn {

/// A light path of a round.
struct CreditedStart {
  std::uint32_t light = 0;
  TreeDistribution::Numbers at{};
  float credit = 0;
};

/// A photon that a light path of a round leaves.
struct PilotPhoton {
  Point position{0};
  Normal normal{0};  ///< 0 in a medium
  float flux = 0;
  std::size_t path = 0;  ///< index of its start
  bool direct = false, caustic = false;
};

struct CreditRound {
  std::vector<CreditedStart> starts;  ///< of all paths
  std::vector<PilotPhoton> photons;

  void append(const CreditRound& other) {
    for (PilotPhoton photon : other.photons) {
      photon.path += starts.size();
      photons.push_back(photon);
    }
    starts.insert(starts.end(), other.starts.begin(), other.starts.end());
  }
};

/// Traces the light paths of round `number`; the guide determines their starts and directions.
CreditRound trace_round(const RenderJob& job, std::uint32_t number, const LightGuide& guide, bool in_media,
                        const PassDraw& draw);

/// Lets each hit point distribute a credit among the starts of the photons around it, in proportion to their flux: the
/// share of the pixel's light that photons contribute. Returns the mean of these shares.
double give_credit(CreditRound& round, std::span<const HitPoint> hits, PhotonUse use);

/// The guide that starts light paths where `starts` have credit: lights by their credit, and for each light a
/// subdivision of the numbers that sample its emission. `unknown_share`: of photons that ignore the credit.
EmissionGuide guide_from(const Scene& scene, std::vector<CreditedStart> starts, float unknown_share,
                         const std::optional<AimedDisks>& disks);

}  // namespace lanthorn
