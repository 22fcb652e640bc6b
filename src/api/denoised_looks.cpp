// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "lanthorn/denoise.h"
#include "lanthorn/error.h"
#include "lanthorn/state.h"
#include "render/state.h"

namespace lanthorn {

ErrorEstimate DenoisedLooks::operator()(const RenderState& state) {
  constexpr double most_gain = 8;  // the error of `path` at few passes falls by a factor of 6
  found_.reset();
  MeasuredPicture measured = measured_picture_of(state);
  if (!measured.error.is_below(most_gain * limit_)) return std::move(measured.error);
  try {
    DenoisedPicture denoised = denoise(with_noise(state, measured.picture), with_margin(state));
    ErrorEstimate error = denoised.error;
    if (error.is_below(limit_)) found_ = {state.pass_count(), std::move(measured.error), std::move(denoised)};
    return error;
  } catch (const Error& problem) {
    ErrorEstimate unknown;
    unknown.doubt = problem.message;
    return unknown;
  }
}

}  // namespace lanthorn
