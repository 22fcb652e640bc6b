// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "math/transform.h"
#include "math/vec.h"
#include "scene/description.h"
#include "scene/ray.h"

namespace lanthorn {

/// A ray from the camera for a film position.
struct CameraRay {
  Ray ray;
  float weight = 1;  ///< radiance along the ray times this is the pixel's value (1 for all cameras here)
};

/// A connection from a point in the scene to the lens, for light tracing.
struct CameraConnection {
  Vec2 raster{0};           ///< film position, pixels
  Direction towards{0};     ///< from the point to the lens
  Point lens_point{0};
  float distance = 0;       ///< metres to the lens point
  /// W_e |cos at the lens| / (pdf of the lens point per area * distance²): times the radiance that the point sends towards the lens, and
  /// times |cos| at the point, it is the contribution to the sum over pixels, normalised so that a pixel's value is the mean radiance over it.
  float importance = 0;
};

/// Densities of camera rays (for MIS): per area of the lens and per solid angle.
struct CameraPdf {
  float position = 0;
  float direction = 0;
};

/// Perspective (with thin lens), orthographic (with thin lens) or spherical camera; moving if its transform is.
class Camera {
 public:
  Camera() = default;
  /// `width` x `height` is the full film, before cropping.
  Camera(const description::Camera& camera, int width, int height);

  /// Ray through `raster` (pixels from the upper left corner of the full film), lens sample `u_lens` in [0,1)^2, at `time`.
  CameraRay sample_ray(const Vec2& raster, const Vec2& u_lens, float time) const;
  /// Connects `p` to the lens. Empty if p is not in view.
  std::optional<CameraConnection> connect(const Point& p, const Vec2& u_lens, float time) const;
  /// Densities with which `sample_ray`, at uniformly drawn raster positions over the whole film, makes this ray.
  CameraPdf pdf(const Ray& ray) const;

  /// Time in the shutter interval for u in [0,1).
  float time(float u) const;
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  description::Camera description_;
  int width_ = 1, height_ = 1;
};

}  // namespace lanthorn
