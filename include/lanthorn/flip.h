// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// FLIP: the difference that a viewer sees when alternating between two pictures.
// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A difference evaluator for
//   alternating images"
// Andersson, Nilsson, Shirley, Akenine-Moller 2021, "Visualizing errors in rendered high dynamic range images"
#pragma once

#include <numbers>
#include <vector>

#include "lanthorn/image.h"

namespace lanthorn {

/// Angular resolution of the display. The default is the paper's: a monitor 0.7 m wide with 3840 pixels, seen from 0.7
/// m (67 pixels per degree).
struct FlipOptions {
  double pixels_per_degree = 3840 * std::numbers::pi / 180;
};

struct FlipResult {
  std::vector<float> map;  ///< row-major, in [0,1]: 0 no visible difference, 1 the largest
  double mean = 0;
};

/// LDR-FLIP of the layer `color` of two pictures of equal size, *linear* Rec.709, clamped to [0,1]. Throws
/// `lanthorn::Error` if the sizes differ or a picture has no colour.
FlipResult ldr_flip(const Image& image, const Image& reference, const FlipOptions& options = {});

/// HDR-FLIP: for each pixel the largest LDR-FLIP over a range of exposures, after an ACES-like tone curve. The
/// reference's maximum and median luminance determine the range. Input is linear and unbounded; negative and non-finite
/// values count as 0. Throws Error as `ldr_flip` does.
FlipResult hdr_flip(const Image& image, const Image& reference, const FlipOptions& options = {});

/// Maps an error in [0,1] to a colour (linear Rec.709): from black through purple and orange to pale yellow.
Image flip_colors(const FlipResult& flip, int width, int height);

}  // namespace lanthorn
