// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <optional>

#include "lanthorn/denoise.h"
#include "lanthorn/error.h"
#include "lanthorn/state.h"

namespace lanthorn {

namespace {

ErrorEstimate error_without_noise(const RenderState& state, const MeasuredPicture& measured) {
  try {
    const Image picture = with_noise(state, measured.picture);
    const std::optional<Image> around = with_margin(state);
    return around ? denoise(picture, *around).error : denoise(picture).error;
  } catch (const Error& problem) {
    ErrorEstimate unknown;
    unknown.doubt = problem.message;
    return unknown;
  }
}

// A look costs as much as denoising, so few are taken.
class DenoisedLooks {
 public:
  explicit DenoisedLooks(double limit) : limit_(limit) {}

  ErrorEstimate operator()(const RenderState& state) {
    constexpr double most_gain = 8;  // the error of `path` at few passes falls by a factor of 6
    const auto passes = static_cast<double>(summarize(state).pass_count);
    if (last_ && passes < next_) return *last_;
    MeasuredPicture measured = measured_picture_of(state);
    if (!measured.error.is_below(most_gain * limit_)) return std::move(measured.error);
    last_ = error_without_noise(state, measured);
    // Predictions from few passes are poor.
    constexpr double early = 0.8, latest = 1.5;
    const double growth = last_->is_known() ? growth_to_reach(*last_, limit_) : 1;
    next_ = passes * std::clamp(early * growth, 1.0, latest);
    return *last_;
  }

 private:
  double limit_;
  std::optional<ErrorEstimate> last_;
  double next_ = 0;  // passes
};

}  // namespace

std::function<ErrorEstimate(const RenderState&)> denoised_error(double limit) { return DenoisedLooks(limit); }

}  // namespace lanthorn
