// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/parameters.h"
#include "film/film.h"
#include "lanthorn/methods.h"
#include "lanthorn/statistics.h"
#include "path/direct_light.h"
#include "path/ray_counts.h"
#include "path/render_job.h"

namespace lanthorn {

/// Called when a phase begins. Integrators do not look at clocks.
using PhaseObserver = std::function<void(Phase)>;

/// What a pass did.
struct PassReport {
  RayCounts rays;
  std::uint64_t light_paths = 0;  ///< photons emitted
  std::uint64_t photons_stored = 0;
  std::size_t photon_map_bytes = 0;
  std::uint64_t cache_records = 0;
  std::uint64_t cache_misses = 0;  ///< look-ups at eye paths that found no record
  float radius = 0;                ///< of the density estimate, metres; 0 if the method has none
};

/// Bytes that a method takes at most at one time, besides scene and film.
struct MemoryUse {
  double per_photon = 0;      ///< for each vertex of a light path that is no perfect mirror or clear glass
  double per_light_path = 0;  ///< of a pass
  double per_pixel = 0;
  int first_depth = 2;          ///< of the vertices that are kept: 1 if those straight from the light are, else 2
  bool fills_the_rest = false;  ///< works in blocks that take what `RenderSettings::memory` leaves
};
/// Bytes of a photon while it is traced and sorted into its map (measured: 104 to 115).
inline constexpr double bytes_per_photon = 130;
/// Bytes of each light path: its place in the order in which they are traced.
inline constexpr double bytes_per_light_path = 16;

/// A rendering method. Holds what outlives a pass; everything random is a function of (seed, pass).
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// What must be known before any pass, a function of the job alone (an automatic radius).
  virtual void prepare(const RenderJob& /*job*/) {}
  /// Adds one pass to the film.
  virtual PassReport render_pass(const RenderJob& job, std::uint32_t pass, Film& film, const PhaseObserver& begin) = 0;
  /// What this method leaves out of this scene's light, for the user; empty if nothing.
  virtual std::string limitation(const Scene& /*scene*/) const { return {}; }
  /// The layers that it gives, and whether it splats. By default those of path classes.
  virtual FilmContents film_contents() const { return {path_class_names()}; }
  /// True if all light of a pass has the wavelengths of `draw_for_pass`.
  virtual bool passes_share_wavelengths() const { return false; }
  /// False if a pass depends on earlier ones: such a render can be resumed but not sharded.
  virtual bool passes_are_independent() const { return true; }
  /// What it takes with these settings: nothing if its light paths are not kept.
  virtual MemoryUse memory_use(const RenderSettings& /*settings*/) const { return {}; }
  /// State that later passes depend on, beyond the film.
  virtual std::vector<std::byte> save() const { return {}; }
  virtual void load(std::span<const std::byte> /*state*/) {}
};

/// An entry of the registry.
struct IntegratorInfo : MethodInfo {
  std::unique_ptr<Integrator> (*make)(const Parameters& parameters) = nullptr;
  /// Default number of light paths per pass: one per pixel, and at least this many.
  std::uint64_t fewest_light_paths = 100'000;
};

/// All integrators, in the order in which `lanthorn list` shows them.
const std::vector<IntegratorInfo>& integrator_registry();
/// Adds one of the caller's own, under a name that is not taken yet (Error). Before renders begin: not thread-safe.
void add_integrator(IntegratorInfo info);
/// Throws Error naming the known ones if there is none of this name.
const IntegratorInfo& find_integrator(const std::string& name);

}  // namespace lanthorn
