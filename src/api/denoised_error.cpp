// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <utility>

#include "lanthorn/denoise.h"
#include "lanthorn/error.h"
#include "lanthorn/state.h"

namespace lanthorn {

namespace {

ErrorEstimate error_without_noise(const RenderState& state, const MeasuredPicture& measured) {
  try {
    return denoise(with_noise(state, measured.picture), with_margin(state)).error;
  } catch (const Error& problem) {
    ErrorEstimate unknown;
    unknown.doubt = problem.message;
    return unknown;
  }
}

}  // namespace

std::function<ErrorEstimate(const RenderState&)> denoised_error(double limit) {
  return [limit](const RenderState& state) {
    constexpr double most_gain = 8;  // the error of `path` at few passes falls by a factor of 6
    MeasuredPicture measured = measured_picture_of(state);
    return measured.error.is_below(most_gain * limit) ? error_without_noise(state, measured)
                                                      : std::move(measured.error);
  };
}

}  // namespace lanthorn
