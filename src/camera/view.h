// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "camera/camera.h"
#include "film/filter.h"
#include "film/pixel_window.h"
#include "film/sensor.h"
#include "lanthorn/render_options.h"
#include "lanthorn/scene_description.h"
#include "medium/medium.h"

namespace lanthorn {

/// A view of a scene: the camera, the rendered part of its film, and the processing of light there. A view is
/// independent of the scene: another view does not require rebuilding the scene.
struct View {
  Camera camera;
  MediumId medium = MediumId::vacuum;  ///< medium around the camera
  PixelWindow window;                  ///< rendered part of the camera's film: the crop and its margin
  PixelWindow crop;                    ///< the part that is shown
  Filter filter;
  Sensor sensor;
  float imaging_ratio = 1;  ///< pixel value / radiance (realistic camera: irradiance)

  /// The full film. Quantities that pilot paths measure or learn over it are the same for every window.
  PixelWindow film() const { return {0, 0, camera.width(), camera.height()}; }
  /// The pixels of the film in which samples of the window's pixels fall: the window, enlarged by the filter's reach.
  PixelWindow filter_reach() const;
  /// Index of a pixel in the full film: the key of its random numbers, independent of the window.
  std::uint32_t pixel_key(int x, int y) const {
    return static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(camera.width()) + static_cast<std::uint32_t>(x);
  }
};

/// Throws Error if the camera or film is invalid, or the window is empty.
View make_view(const ViewDescription& description, const ViewOptions& options = {});

/// The options for a picture of the same part of the scene with `share` times the width and the height.
ViewOptions scaled(ViewOptions options, const description::Film& film, double share);

}  // namespace lanthorn
