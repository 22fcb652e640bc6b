// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The state of a render: what a checkpoint, a shard and a finished render have in common.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/error_estimate.h"
#include "lanthorn/image.h"
#include "lanthorn/render_options.h"

namespace lanthorn {

/// A film's sums, the passes in them, and the settings that they belong to. Its members are internal.
struct RenderState;

/// Where a contribution came from.
struct FilmPlace {
  std::uint64_t pass = 0;
  std::uint32_t pixel = 0;  ///< index in the film, rows from the top
  friend auto operator<=>(const FilmPlace&, const FilmPlace&) = default;
};

/// Contributions that a film could not add exactly. All counts are independent of the order of contributions.
struct FilmReport {
  std::uint64_t non_finite = 0;  ///< values that were NaN or infinite (added as 0)
  std::uint64_t too_large = 0;   ///< values beyond the headroom of one contribution (clamped to it)
  std::uint64_t saturated = 0;   ///< sums that have reached their limit and stay at it
  std::optional<FilmPlace> first_non_finite;
  std::optional<FilmPlace> first_too_large;

  bool clean() const { return non_finite == 0 && too_large == 0 && saturated == 0; }
};
/// One line for the user; nothing if the report is clean.
std::optional<std::string> describe_problems(const FilmReport& report);

/// What a state holds.
struct StateSummary {
  std::string integrator;
  std::vector<PassRange> passes;  ///< done; sorted, disjoint
  std::uint64_t pass_count = 0;
  double seconds = 0;     ///< spent rendering, over all processes
  bool mergeable = true;  ///< passes do not depend on earlier ones
  /// A JSON object. Its member "identity" decides the picture (hashes of the scene and its files, seed, method and
  /// parameters, colour mode, resolution, crop ...) and must be equal to resume or to merge.
  std::string settings;
  bool measures_exposure = false, display_emission = false;  ///< see description::Film
  int width = 0, height = 0;                                 ///< pixels
  ImageWindow window;                                        ///< of these pixels in the whole picture
  FilmReport report;
  /// The share of the throughput of paths that reached the limit of scattering events (PathEnds): from the camera or
  /// from lights, whichever is more. It says how much light the limit may have cut off.
  double cut_share = 0;
};
StateSummary summarize(const RenderState& state);

/// The picture so far with all its layers; black before the first pass. Its layer `error` is one standard error of
/// color, `bias` the estimated error of photon methods, which passes do not average out.
Image picture_of(const RenderState& state);

/// The same without the layers `error` and `bias`, which cost about as much as all others.
Image picture_without_error(const RenderState& state);

/// A picture of this state with what `denoise` needs besides: for each layer of light and of features a layer
/// noise.NAME, how much more the first half of the passes has than all of them, and the channel noise.share, the part
/// of the samples that this half has.
Image with_noise(const RenderState& state, const Image& picture);

/// How far that picture is from the truth. Costs about as much as the picture.
ErrorEstimate estimate_error(const RenderState& state);

/// Both, for the cost of `picture_of`.
struct MeasuredPicture {
  Image picture;
  ErrorEstimate error;
};
MeasuredPicture measured_picture_of(const RenderState& state);

class StateReader;  // internal

/// A saved state whose sums stay in the file until they are added up, block by block: merging many states takes no more
/// memory than one.
class SavedState {
 public:
  /// Reads the file but for the sums. Throws Error as `open_state`.
  explicit SavedState(const std::filesystem::path& path);
  ~SavedState();
  SavedState(SavedState&&) noexcept;
  SavedState& operator=(SavedState&&) noexcept;

  /// Sorted and disjoint.
  const std::vector<PassRange>& passes() const;
  /// As `lanthorn::identity_difference`.
  std::optional<std::string> identity_difference(const RenderState& other) const;

  /// The whole state.
  std::shared_ptr<RenderState> load() const;
  /// As `lanthorn::merge_into`. If the Error says that the file is damaged or cannot be read, which the constructor has
  /// not noticed because somebody forged the checksum or the medium fails, `sum` keeps its passes, but not its sums.
  void merge_into(RenderState& sum) const;

 private:
  std::unique_ptr<StateReader> reader_;
};

/// Reads a saved state. Throws Error if the file cannot be read, is truncated, damaged, or of another version.
std::shared_ptr<RenderState> open_state(const std::filesystem::path& path);

/// The state of all passes of both, exactly; commutative and associative to the bit. Throws Error if passes overlap,
/// identities differ (naming the first differing field), or passes depend on each other.
std::shared_ptr<RenderState> merge(const RenderState& a, const RenderState& b);
/// The same, into `sum`, without a third state in memory. `sum` stays as it is if an Error is thrown.
void merge_into(RenderState& sum, const RenderState& more);

/// How the bytes of a saved state come out.
struct SaveOptions {
  bool times = true;  ///< false: without the time spent, so that equal renders are equal files
};
/// The bytes of a state file: a function of the state alone.
std::vector<std::byte> encode_state(const RenderState& state, const SaveOptions& options = {});
/// Writes the file whole or not at all. Throws Error.
void save_state(const RenderState& state, const std::filesystem::path& path, const SaveOptions& options = {});

/// The first difference of the identities of two renders, as the option (or file) that decides it and both values, e.g.
/// "--seed (0 and 7)"; nothing if they are equal.
std::optional<std::string> identity_difference(const RenderState& a, const RenderState& b);

}  // namespace lanthorn
