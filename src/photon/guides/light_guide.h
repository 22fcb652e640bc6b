// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/emission_guide.h"
#include "photon/guides/guide_photons.h"

namespace lanthorn {

/// Where light paths start, and in which directions surfaces scatter them.
struct LightGuide {
  EmissionGuide emission;
  GuidePhotons directions{};  ///< guides by importance; empty: the closures alone decide
};

/// A visitor of light walks whose next directions are guided.
template <class Visitor>
struct GuidedVisitor : Visitor {
  const GuidePhotons& directions;

  using Visitor::operator();
  GuidedContinuation operator()(const SurfaceVertex& vertex) {
    return {Visitor::operator()(vertex), directions.find(vertex)};
  }
};

/// Calls `follow` with the visitor, or with a guided one if there are directions.
template <class Visitor, class Follow>
void with_directions(const LightGuide* guide, const Visitor& visitor, Follow&& follow) {
  if (guide != nullptr && guide->directions.size() > 0)
    follow(GuidedVisitor<Visitor>{visitor, guide->directions});
  else
    follow(visitor);
}

}  // namespace lanthorn
