// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A camera's lens as its surfaces: what realistic cameras look through.
#pragma once

#include <optional>
#include <vector>

#include "description/scene_description.h"
#include "math/affine.h"
#include "math/vec.h"

namespace lanthorn {

/// In the lens's own space, metres: the film lies in the plane z = 0, the scene towards +z, the axis is the z axis.
struct LensRay {
  DVec3 origin{0.0};
  DVec3 direction{0.0, 0.0, 1.0};  ///< need not be unit length; unit once it has passed the lens
};

/// Surfaces of revolution about the axis, focused (Kolb, Mitchell, Hanrahan 1995). Nothing is lost to reflection.
class LensSystem {
 public:
  LensSystem() = default;
  /// Focuses on the plane at `focus_distance` from the film by the thick-lens approximation (§3.2). `film_radius`: the
  /// distance from the axis up to which film points will be asked about. Throws Error at `location` for a lens that is
  /// none, or cannot focus so near.
  LensSystem(const description::RealisticCamera& camera, double film_radius, const SourceLocation& location);

  /// From the film, or any point behind the lens, through all elements: the ray that leaves the front, from there.
  /// Empty if a stop or a rim is in the way, or by total reflection.
  std::optional<LensRay> towards_scene(const LensRay& ray) const;
  /// The other way: the ray that leaves the rear, from there.
  std::optional<LensRay> towards_film(const LensRay& ray) const;

  /// Where film points look through: a rectangle of the plane z = rear_z(), for a film point on the x axis at this
  /// distance from its centre; for others it is turned with them. Contains everything that light reaches.
  struct Pupil {
    glm::dvec2 low{0.0}, high{0.0};
    double area() const { return (high.x - low.x) * (high.y - low.y); }
  };
  const Pupil& exit_pupil(double film_distance) const;

  /// A point of the front surface for a point of the disk of radius `front_radius()`.
  struct FrontPoint {
    DVec3 position{0.0};
    DVec3 normal{0.0, 0.0, 1.0};  ///< unit, towards the scene
  };
  FrontPoint front_point(const glm::dvec2& disk) const;
  double front_radius() const { return surfaces_.front().aperture_radius; }
  /// Of the vertex of the last surface.
  double rear_z() const { return surfaces_.back().z; }
  double focal_length() const { return focal_length_; }

 private:
  struct Surface {
    double z = 0;       // of its vertex
    double radius = 0;  // of curvature, centre at z - radius; 0: a stop
    double eta_scene = 1, eta_film = 1;
    double aperture_radius = 0;
  };
  struct Cardinal;
  enum class Towards { scene, film };

  Cardinal cardinal_points() const;
  void focus(double distance, const SourceLocation& location);
  void bound_exit_pupils(double film_radius);
  Pupil bound_exit_pupil(double near, double far) const;
  std::optional<Pupil> search_pupil(const Pupil& searched, double near, double far) const;
  double pupil_reach(double film_distance) const;
  static double rim_z(const Surface& surface);
  template <Towards towards>
  static bool pass(const Surface& surface, LensRay& ray);

  std::vector<Surface> surfaces_;  // from the scene to the film
  std::vector<Pupil> pupils_;      // of equal intervals of the distance from the film's centre
  double film_radius_ = 0;
  double focal_length_ = 0;
};

}  // namespace lanthorn
