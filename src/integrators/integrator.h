// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/parameters.h"
#include "film/film_pass.h"
#include "lanthorn/effort_report.h"
#include "lanthorn/methods.h"
#include "lanthorn/statistics.h"
#include "path/path_class.h"
#include "path/path_context.h"
#include "path/render_job.h"
#include "photon/photon.h"

namespace lanthorn {

/// Called when a phase begins. Integrators do not measure time themselves.
using PhaseObserver = std::function<void(Phase)>;

/// Adds each stage's time to the stage of the same name; new stages go to the end.
void add_stages(std::vector<StageSeconds>& sum, const std::vector<StageSeconds>& stages);
/// Adds numbers of photons by bounce; `sum` grows to the longer of the two.
void add_bounces(std::vector<std::uint64_t>& sum, const std::vector<std::uint64_t>& photons);

/// Statistics of a pass.
struct PassReport {
  RayCounts rays;
  std::uint64_t light_paths = 0;  ///< photons emitted
  std::uint64_t photons_stored = 0;
  std::size_t photon_map_bytes = 0;
  std::uint64_t cache_records = 0;
  std::uint64_t cache_misses = 0;                 ///< look-ups from eye paths that found no record
  std::vector<StageSeconds> stages;               ///< see RenderStatistics
  std::vector<std::uint64_t> photons_per_bounce;  ///< see RenderStatistics
  float radius = 0;                               ///< of the density estimate, metres; 0 if the method has none
  float volume_radius = 0;                        ///< the same in media; of several estimators the widest

  /// Adds a later part of the same pass.
  PassReport& operator+=(const PassReport& part) {
    rays += part.rays;
    light_paths += part.light_paths;
    photons_stored += part.photons_stored;
    photon_map_bytes = std::max(photon_map_bytes, part.photon_map_bytes);
    cache_records += part.cache_records;
    cache_misses += part.cache_misses;
    add_stages(stages, part.stages);
    add_bounces(photons_per_bounce, part.photons_per_bounce);
    radius = part.radius;
    volume_radius = part.volume_radius;
    return *this;
  }
};

/// Peak memory of a method besides scene and film, bytes.
struct MemoryUse {
  double per_photon = 0;      ///< for each vertex of a light path with a non-delta lobe
  double per_light_path = 0;  ///< for each light path of a pass
  double per_pixel = 0;
  int first_depth = 2;  ///< depth of the first vertex that is kept: 1 if photons straight from the light are
  MediumRecords media = MediumRecords::none;  ///< records of light paths in media
  double per_medium_photon = 0;               ///< for each of these records, if not `bytes_of_medium_photon`
  bool fills_the_rest = false;                ///< works in blocks that take the rest of `RenderSettings::memory`
  /// For methods that work in blocks of light paths (`LightPathBlocks`): the number of light paths whose records are in
  /// memory at once.
  std::uint64_t photon_block = std::numeric_limits<std::uint64_t>::max();
  double per_pixel_of_blocks = 0;  ///< besides `per_pixel`, for each pass that has several blocks
};
/// Bytes of a photon while it is traced and sorted into its map (measured: 104 to 115).
inline constexpr double bytes_per_photon = 130;
/// Bytes of a photon or beam in a medium while it is traced and sorted: estimated from the sizes of its records, not
/// measured.
constexpr double bytes_of_medium_photon(MediumRecords records) {
  return records == MediumRecords::none ? 0 : records == MediumRecords::points ? 250 : 400;
}
/// Bytes of each light path: its entry in the order in which light paths are traced.
inline constexpr double bytes_per_light_path = 16;

/// A rendering method. The object holds state that outlives a pass. All random numbers are functions of (seed, pass).
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Computes what all passes need, such as an automatic radius: a function of the job alone.
  virtual void prepare(const RenderJob& /*job*/) {}
  /// Adds one pass to the film, or one part of a pass (`RenderSettings::parts`). `pass`: its number, which counts the
  /// parts of all passes before it.
  virtual PassReport render_pass(const RenderJob& job, std::uint32_t pass, const FilmPass& film,
                                 const PhaseObserver& begin) = 0;
  /// Message for the user about light of this scene that the method does not find. Empty if it finds all light.
  virtual std::string limitation(const Scene& /*scene*/) const { return {}; }
  /// Message for the user about the results of the preparation for this job. Empty if there is nothing to say.
  virtual std::string remark() const { return {}; }
  /// Measurements of the preparation for this job, for reports.
  virtual std::optional<EffortReport> findings() const { return std::nullopt; }
  /// The film's layers for this scene and whether the method splats. Default: the layers of the path classes.
  virtual FilmContents film_contents(const Scene& scene) const { return path_layers(scene); }
  /// False if the method has an error that does not vanish with more passes and that its film does not estimate
  /// (FilmContents::bias).
  virtual bool knows_bias() const { return true; }
  /// True if all light of a pass, or of its part, has the wavelengths of `draw_for_pass`.
  virtual bool passes_share_wavelengths() const { return false; }
  /// True if `render_pass` may run for several passes at once, each on its own thread.
  virtual bool passes_may_overlap() const { return false; }
  /// False if a pass depends on earlier ones. Such a render can be resumed but not sharded.
  virtual bool passes_are_independent() const { return true; }
  /// False if a pixel may depend on which part of the film is rendered. Such methods render no margin around a crop.
  virtual bool crops_are_exact() const { return true; }
  /// Peak memory with these settings. Zero for methods that do not store light paths.
  virtual MemoryUse memory_use(const RenderSettings& /*settings*/) const { return {}; }
  /// State that later passes depend on, beyond the film. If passes are independent, the state only saves them work and
  /// may be missing.
  virtual std::vector<std::byte> save() const { return {}; }
  /// Restores what `save` returned; called after `prepare`. The bytes may come from a file: throws Error if they are
  /// not a possible state.
  virtual void load(std::span<const std::byte> /*state*/) {}
};

/// Default number of light paths per pass: one per pixel, within these limits.
struct LightPathRange {
  std::uint64_t fewest = 100'000;
  std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
};

/// An entry of the registry.
struct IntegratorInfo : MethodInfo {
  using Make = std::function<std::unique_ptr<Integrator>(const Parameters& parameters)>;

  IntegratorInfo(std::string name_, std::string summary_, std::string paper_, std::vector<ParameterInfo> parameters_,
                 Make make_, LightPathRange light_paths_ = {})
      : MethodInfo{std::move(name_), std::move(summary_), std::move(paper_), std::move(parameters_)},
        make(std::move(make_)),
        light_paths(light_paths_) {}

  Make make;
  LightPathRange light_paths;
};

/// All integrators, in the order in which `lanthorn list` shows them.
const std::vector<IntegratorInfo>& integrator_registry();
/// Adds an integrator. Throws Error if its name is taken. Call it before any render: not thread-safe.
void add_integrator(IntegratorInfo info);
/// Throws Error with the known names if there is no integrator of this name.
const IntegratorInfo& find_integrator(const std::string& name);

}  // namespace lanthorn
