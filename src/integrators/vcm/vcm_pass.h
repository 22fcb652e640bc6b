// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// State that the light paths and the eye paths of a pass of vertex connection and merging share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "integrators/integrator.h"
#include "integrators/vcm/effort.h"
#include "integrators/vcm/merge_map.h"
#include "integrators/vcm/merge_radii.h"
#include "integrators/vcm/vcm_settings.h"
#include "integrators/vcm/volume_merge.h"
#include "path/connections.h"
#include "path/eye_pass.h"
#include "path/light_pass.h"
#include "path/light_vertices.h"
#include "path/path_draw.h"
#include "path/render_job.h"

namespace lanthorn {

/// Data that all passes share.
struct VcmPreparation {
  Emission emission;
  EmissionDensities densities;  // points to `emission`
  FirstMergeRadii radii;
  FirstVolumeRadii volume_radii;
  Effort effort;
  std::string remark;  ///< as of Integrator
  std::optional<EffortReport> findings;

  VcmPreparation(const RenderJob& job, const VcmSettings& settings);
  VcmPreparation(const VcmPreparation&) = delete;
  VcmPreparation& operator=(const VcmPreparation&) = delete;
};

/// One pass. Its light paths come in blocks (`LightPathBlocks`): the light paths of one block are traced, sorted, and
/// met by all eye paths before the next block begins. Keeps references to everything that it is made from. `tests`: see
/// MergeShrinks; null if all radii shrink alike.
struct VcmPass {
  const RenderJob& job;
  const VcmSettings& settings;
  const Effort& effort;
  std::uint32_t number;
  PassDraw draw;
  LightPathBlocks blocks;
  LightPaths light_paths;  ///< of the block
  VolumeKernels volume_kernels;
  bool sees;                    ///< light paths are connected to the lens somewhere
  float beam_share;             ///< of light paths whose flights are kept
  Bidirectional bidirectional;  ///< without η, which each pixel has of its own
  UniformityTests* uniformity;  ///< to be told of the photons of this pass; null: they are not counted
  MergeRadii radii;
  LightVertices& vertices;  ///< of the block
  // Merges with the block's light paths, once these are traced:
  std::optional<SurfaceMerges> surface_merges;
  std::optional<VolumeMerges> volume_merges;  ///< none if there are none in media

  VcmPass(const RenderJob& job, std::uint32_t number, const VcmSettings& settings, const VcmPreparation& prepared,
          LightVertices& vertices, UniformityTests* tests = nullptr);
  /// Goes on to a block; the pass begins with the first one.
  void begin_block(std::uint32_t block);
  /// True if the block is the first one: eye paths then find the light that does not depend on light paths, too.
  bool is_first_block() const { return light_paths.first() == 0; }
  /// Sorts the vertices of the light paths for merging.
  void build_merges(PassReport& report);

  int max_depth() const { return job.settings.max_depth; }
  bool connects() const { return settings.switches.connections; }
  /// `flux`: of a photon, W.
  std::uint8_t class_of_flux(float flux) const {
    return static_cast<std::uint8_t>(radii.classes().of(flux * bidirectional.techniques.light_paths));
  }
  /// Whether the film has the light of paths with `s` vertices from the light and `t` from the eye.
  bool shows(int s, int t) const { return !settings.only || *settings.only == Strategy{s, t}; }
  /// Paths through one place on the film are weighed with one radius, whatever technique made them: with
  /// η_VCM = N π r² (TR eq. 20). The same holds for the effort of the place, `here`.
  Bidirectional bidirectional_at(const Vec2& raster, const PlaceEffort& here) const;

  /// The number of the light path that an eye path is connected to. The eye path's sampler draws it: a fixed pairing
  /// would give each pixel the light paths of one light.
  std::size_t partner(Sampler& of_eye_path) const;
  /// Number `i` of `count` light paths, the first of which is `first`, equally spaced among all.
  std::size_t partner(std::size_t first, int i, int count) const;
  bool is_of_block(std::size_t path) const;  ///< whether the light path is one of the present block
  /// The vertices of a light path. None if it belongs to another block.
  std::span<const LightVertex> light_path(std::size_t path) const;
  /// Time and wavelengths of the eye path of a pixel. The time is that of the light path that it is connected to; the
  /// hero is its own.
  PathDraw draw_of_eye_path(Sampler& sampler, const PixelPlace& place) const;
};

}  // namespace lanthorn
