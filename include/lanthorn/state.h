// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The state of a render: common to checkpoints, shards and finished renders.
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
#include "lanthorn/render_record.h"

namespace lanthorn {

/// A film's sums, the passes in them, and the settings that produced them. Its members are internal.
struct RenderState;

/// The origin of a contribution to a film.
struct FilmPlace {
  std::uint64_t pass = 0;
  std::uint32_t pixel = 0;  ///< index in the film, rows from the top
  friend auto operator<=>(const FilmPlace&, const FilmPlace&) = default;
};

/// Contributions that a film could not add exactly. All counts are independent of the order of contributions.
struct FilmReport {
  std::uint64_t non_finite = 0;  ///< NaN or infinite values (added as 0)
  std::uint64_t too_large = 0;   ///< values that exceed the headroom of one contribution (clamped to it)
  std::uint64_t saturated = 0;   ///< sums that have reached their limit and stay there
  std::optional<FilmPlace> first_non_finite;
  std::optional<FilmPlace> first_too_large;

  bool clean() const { return non_finite == 0 && too_large == 0 && saturated == 0; }
};
/// One line for the user; nullopt if the report is clean.
std::optional<std::string> describe_problems(const FilmReport& report);

/// A description of a state.
struct StateSummary {
  std::string integrator;
  std::vector<PassRange> passes;  ///< completed passes; sorted, disjoint
  std::uint64_t pass_count = 0;
  double seconds = 0;     ///< spent rendering, summed over all processes
  bool mergeable = true;  ///< passes do not depend on earlier ones
  RenderRecord record;
  int width = 0, height = 0;  ///< pixels
  ImageWindow window;         ///< position of these pixels in the whole picture
  int margin = 0;             ///< ViewOptions::margin
  FilmReport report;
  /// The share of path throughput that reached the limit of scattering events (PathEnds), from the camera or from
  /// lights, whichever is larger: an indication of how much light the limit may have cut off.
  double cut_share = 0;
};
StateSummary summarize(const RenderState& state);

/// The picture so far with all its layers; black before the first pass. Its layer `error` is one standard error of
/// color; `bias` is the estimated error of photon methods that averaging passes does not reduce.
Image picture_of(const RenderState& state);

/// Like `picture_of`, without the layers `error` and `bias`, which cost about as much as all other layers.
Image picture_without_error(const RenderState& state);

/// A picture of this state, extended by what `denoise` needs: for `bias` and each layer of light and of features a
/// layer noise.NAME, the first half of the passes minus all passes; and the channel noise.share, the fraction of the
/// samples that belongs to this half.
Image with_noise(const RenderState& state, const Image& picture);

/// Like `with_noise`, for the picture with all pixels around it that were rendered for `denoise` (ViewOptions::margin);
/// nullopt if there are none.
std::optional<Image> with_margin(const RenderState& state);

/// Estimated error of `picture_of`. Costs about as much as the picture.
ErrorEstimate estimate_error(const RenderState& state);

/// Picture and error, for the cost of `picture_of`.
struct MeasuredPicture {
  Image picture;
  ErrorEstimate error;
};
MeasuredPicture measured_picture_of(const RenderState& state);

class StateReader;  // internal

/// A saved state whose sums stay in the file until they are merged, block by block: merging many states takes no more
/// memory than one.
class SavedState {
 public:
  /// Reads the file except for the sums. Throws Error as `open_state` does.
  explicit SavedState(const std::filesystem::path& path);
  ~SavedState();
  SavedState(SavedState&&) noexcept;
  SavedState& operator=(SavedState&&) noexcept;

  /// Sorted and disjoint.
  const std::vector<PassRange>& passes() const;
  /// Like `lanthorn::identity_difference`.
  std::optional<std::string> identity_difference(const RenderState& other) const;

  /// Loads the whole state.
  std::shared_ptr<RenderState> load() const;
  /// Like `lanthorn::merge_into`. If Error says that the file is damaged or unreadable, the sums of `sum` are invalid,
  /// although its passes stay the same. The constructor misses such damage only if the checksum is forged or the disk
  /// is failing.
  void merge_into(RenderState& sum) const;

 private:
  std::unique_ptr<StateReader> reader_;
};

/// Loads a saved state. Throws Error if the file cannot be read, is truncated, damaged, or of another version.
std::shared_ptr<RenderState> open_state(const std::filesystem::path& path);

/// The state of all passes of both, exact; commutative and associative to the bit. Throws Error if passes overlap,
/// identities differ (naming the first differing field), or passes depend on each other.
std::shared_ptr<RenderState> merge(const RenderState& a, const RenderState& b);
/// Merges `more` into `sum` without a third state in memory. `sum` is unchanged if Error is thrown.
void merge_into(RenderState& sum, const RenderState& more);

/// Options for writing a state.
struct SaveOptions {
  bool times = true;  ///< false: omits the rendering time, so that equal renders give equal files
};
/// The bytes of a state file; they depend only on the state and the options.
std::vector<std::byte> encode_state(const RenderState& state, const SaveOptions& options = {});
/// Writes the file whole or not at all. Throws Error.
void save_state(const RenderState& state, const std::filesystem::path& path, const SaveOptions& options = {});

/// The first difference between the identities of two renders: the option or file that causes it and both values, e.g.
/// "--seed (0 and 7)"; nullopt if they are equal.
std::optional<std::string> identity_difference(const RenderState& a, const RenderState& b);
/// The same, but a coarse picture (`RenderStatistics::coarse`) belongs to the render whose pass it stands in for: no
/// passes are lost if a state of that render replaces it.
std::optional<std::string> difference_to_replaced(const RenderState& there, const RenderState& state);

}  // namespace lanthorn
