// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Merging in media: eye paths gather a pass's photons and photon beams, at points and along rays. Each contribution has
// its MIS weight among all techniques (Křivánek, Georgiev, Hachisuka, Vévoda, Šik, Nowrouzezahrai & Jarosz 2014,
// "Unifying Points, Beams, and Paths in Volumetric Light Transport Simulation").
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "index/ball_bvh.h"
#include "index/beam_bvh.h"
#include "integrators/vcm/eye_path_log.h"
#include "integrators/vcm/merge_radii.h"
#include "path/connections.h"
#include "path/light_layers.h"
#include "path/light_vertices.h"
#include "path/path_context.h"
#include "path/subpath.h"
#include "path/vertex.h"

namespace lanthorn {

/// Data for the merges of an eye path besides their vertex or flight.
struct VolumeMergeContext {
  const PathContext& path;
  const Bidirectional& bidirectional;
  const Subpath& subpath;  ///< of the eye path
  int max_depth;           ///< scatterings of a whole path
  LightLayers& layers;
  EyePathLog* log = nullptr;
};

/// The photons of a pass in media, one set of indices for each medium. Keeps pointers to the light vertices.
class VolumeMerges {
 public:
  VolumeMerges(const LightVertices& vertices, const VolumeKernels& kernels);

  std::size_t size() const;
  std::size_t memory_bytes() const;

  /// Adds the light of photons and beams that an eye path's flight passes; the subpath has departed for it.
  void add_along(const VolumeMergeContext& context, const FlownSegment& flight) const;
  /// Adds the light of photons and beams around a vertex at which the eye path has arrived.
  void add_at(const VolumeMergeContext& context, const MediumVertex& vertex) const;

 private:
  /// Items of type `Item` in the order of their light paths, and an index of their balls or beams.
  template <class Index, class Item>
  struct Indexed {
    Index index;
    std::vector<const Item*> items;  ///< by slot

    std::size_t memory_bytes() const { return index.memory_bytes() + std::span(items).size_bytes(); }
  };
  using Points = Indexed<BallBvh, LightVertex>;
  using Beams = Indexed<BeamBvh, LightBeam>;
  struct OfMedium {
    std::unique_ptr<Points> around, along;         ///< for estimates at points and along rays
    std::unique_ptr<Beams> beams_around, crossed;  ///< the same
  };

  VolumeKernels kernels_;
  std::vector<OfMedium> media_;
};

}  // namespace lanthorn
