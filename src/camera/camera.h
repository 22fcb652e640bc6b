// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "camera/lens_system.h"
#include "lanthorn/scene_description.h"
#include "lanthorn/transform.h"
#include "math/affine.h"
#include "math/ray.h"
#include "math/vec.h"

namespace lanthorn {

/// A camera ray for a film position, with the footprint of a pixel.
struct CameraRay {
  Ray ray;
  /// Pixel value = radiance along the ray × this weight. 1 for cameras that measure radiance. A realistic camera
  /// measures the film's irradiance: cos^4 / (z^2 pdf) of the sampled point of the exit pupil (Kolb et al. 1995, eq.
  /// 3), 0 if the lens blocks the ray.
  float weight = 1;
};

/// A connection from a point in the scene to the lens, for light tracing.
struct CameraConnection {
  Vec2 raster{0};        ///< film position, pixels
  Direction towards{0};  ///< from the point to the lens
  Point lens_point{0};
  float distance = 0;  ///< metres to the lens point
  /// W_e |cos at the lens| / (pdf of the lens point per area * distance²). Times the radiance that the point sends
  /// towards the lens and |cos| at the point, this is the contribution to the sum over pixels. Normalised so that a
  /// pixel's value is its mean radiance (realistic camera: irradiance).
  float importance = 0;
};

/// Densities of camera rays, for MIS: per area of the lens, and per solid angle.
struct CameraPdf {
  float position = 0;
  float direction = 0;
};

/// Camera-to-world transform for a film of this size, including the framing of the camera's subject.
AnimatedTransform framing(const description::Camera& camera, int width, int height);

/// A perspective or orthographic camera (both with thin lens), a spherical or a realistic camera. It moves if its
/// transform does.
class Camera {
 public:
  Camera() = default;
  /// `width` x `height`: the full film, before cropping. `margin`: pixels beyond its edges that the pixel filter
  /// reaches, so that `connect` includes them. Throws Error for an invalid camera (singular transform, no aperture).
  Camera(const description::Camera& camera, int width, int height, const Vec2& margin = Vec2(0));

  /// Samples the ray through `raster` (pixels from the upper left corner of the full film), with lens sample `u_lens`
  /// in [0,1)^2, at `time`.
  CameraRay sample_ray(const Vec2& raster, const Vec2& u_lens, float time) const;
  /// Connects `p` to the lens (realistic: to a point of its front surface). Returns nullopt if `p` is not in view.
  std::optional<CameraConnection> connect(const Point& p, const Vec2& u_lens, float time) const;
  /// The point of the lens to which `connect` connects `p`, whether or not `p` is in the picture. Returns nullopt if no
  /// light from `p` passes the lens.
  std::optional<Point> lens_point_for(const Point& p, const Vec2& u_lens, float time) const;
  /// Densities with which `sample_ray`, for raster positions uniform over the whole film, samples this ray. For a
  /// realistic camera only their product is meaningful; 0 if the lens blocks the ray.
  CameraPdf pdf(const Ray& ray) const;
  /// Density, per area perpendicular to `ray`, of a pixel's rays at `distance` along it. These rays are uniform over
  /// the pixel and share the lens sample of `ray`. For MIS; 0 if the lens blocks the ray.
  float density_at(const Ray& ray, float distance) const;

  /// Time in the shutter interval for u in [0,1).
  float time(float u) const;
  int width() const { return width_; }
  int height() const { return height_; }
  /// True if the camera moves while the shutter is open.
  bool moves() const { return to_world_.is_moving() && shutter_close_ > shutter_open_; }

 private:
  enum class Kind : std::uint8_t { perspective, orthographic, equirectangular, equal_area, realistic };

  // Camera space: x right, y up, z forward.
  struct LocalRay {
    DVec3 origin{0.0};
    DVec3 direction{0.0, 0.0, 1.0};  // of any length
  };
  LocalRay local_ray(const Vec2& raster, const Vec2& u_lens) const;
  void set_footprint(const DVec3& direction, Ray& ray) const;
  struct WeightedRay {
    LocalRay ray;
    double weight = 0;
  };
  WeightedRay through_lens(const Vec2& raster, const Vec2& u_lens) const;
  // The point at which a ray from the scene reaches the film, and its direction there.
  struct FilmHit {
    glm::dvec2 film{0.0};
    DVec3 from_pupil{0.0};  // unit length, from the exit pupil to the film
  };
  std::optional<FilmHit> film_hit(const LensRay& from_scene) const;
  CameraPdf lens_pdf(const DVec3& origin, const DVec3& direction) const;
  struct Sight {
    DVec3 lens{0.0};  // sampled point of the lens
    Vec2 raster{0};
    // Density of the direction (orthographic: of the lens position) for positions uniform over the whole film.
    // Realistic: area of the lens as seen from the point, per area of the film.
    double density = 0;
  };
  std::optional<Sight> sight(const DVec3& local, const Vec2& u_lens) const;
  std::optional<Sight> sight_through_plane(const DVec3& local, const Vec2& u_lens) const;
  std::optional<Sight> sight_through_lens(const DVec3& local, const Vec2& u_lens) const;

  glm::dvec2 screen(const Vec2& raster) const;
  Vec2 raster(const glm::dvec2& screen) const;
  glm::dvec2 lens_point(const Vec2& u_lens) const;
  DVec3 spherical_direction(const Vec2& raster) const;
  bool sees(const Vec2& raster) const;
  double direction_density(double cos) const;

  Kind kind_ = Kind::perspective;
  Motion to_world_;
  glm::dvec2 screen_min_{-1.0}, screen_size_{2.0};  // at z = 1 (perspective) or in metres (others)
  glm::dvec2 screen_corner_{-1.0, 1.0};             // the upper left corner of the film
  glm::dvec2 pixel_step_{2.0, -2.0};
  double lens_radius_ = 0, focal_distance_ = 1e6;
  LensSystem lens_;
  float shutter_open_ = 0, shutter_close_ = 1;
  Vec2 margin_{0};
  int width_ = 1, height_ = 1;
};

}  // namespace lanthorn
