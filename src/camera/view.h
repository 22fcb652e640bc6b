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

/// A view of a scene: the camera, the rendered part of its film, and the processing of light there. A view is
/// independent of the scene: another view does not require rebuilding the scene.
struct View {
  Camera camera;
  MediumId medium = MediumId::vacuum;  ///< medium around the camera
  PixelWindow window;                  ///< rendered part of the camera's film
  Filter filter;
  Sensor sensor;
  float imaging_ratio = 1;  ///< pixel value / radiance (realistic camera: irradiance)

  /// Index of a pixel in the full film: the key of its random numbers, independent of the window.
  std::uint32_t pixel_key(int x, int y) const {
    return static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(camera.width()) + static_cast<std::uint32_t>(x);
  }
};

/// Settings that override the scene file's.
struct ViewOptions {
  std::optional<std::array<int, 2>> resolution;  ///< width, height of the full film, pixels
  std::optional<std::array<int, 4>> crop;        ///< x0, y0, x1, y1, pixels; end exclusive
};

/// The view that a scene file describes. Throws Error if its camera or film is invalid, or its window is empty.
View make_view(const SceneDescription& description, const ViewOptions& options = {});

}  // namespace lanthorn
