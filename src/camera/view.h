// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "camera/camera.h"
#include "description/scene_description.h"
#include "film/filter.h"
#include "film/pixel_window.h"
#include "film/sensor.h"
#include "medium/medium.h"

namespace lanthorn {

/// Who looks at a scene: the camera, the part of its film that is rendered, and what becomes of the light there. A view
/// stands beside the scene: another one needs nothing of the scene to be built again.
struct View {
  Camera camera;
  MediumId medium = MediumId::vacuum;  ///< that the camera stands in
  PixelWindow window;                  ///< rendered part of the camera's film
  Filter filter;
  Sensor sensor;
  float imaging_ratio = 1;  ///< pixel value / radiance (realistic camera: irradiance)

  /// Index of a pixel of the full film: the key of its random numbers, the same whatever the window.
  std::uint32_t pixel_key(int x, int y) const {
    return static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(camera.width()) + static_cast<std::uint32_t>(x);
  }
};

/// What may differ from the scene file's own choice.
struct ViewOptions {
  std::optional<std::array<int, 2>> resolution;  ///< width, height of the full film, pixels
  std::optional<std::array<int, 4>> crop;        ///< x0, y0, x1, y1, pixels; end exclusive
};

/// The view that a scene file describes. Throws Error for what is no camera, no film, or no part of it.
View make_view(const SceneDescription& description, const ViewOptions& options = {});

}  // namespace lanthorn
