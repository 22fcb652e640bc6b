// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The lens of a realistic camera as a system of surfaces.
#pragma once

#include <optional>
#include <vector>

#include "lanthorn/scene_description.h"
#include "math/affine.h"
#include "math/vec.h"

namespace lanthorn {

/// A ray in the lens's own space, metres: the film lies in the plane z = 0, the scene towards +z; the z axis is the
/// optical axis.
struct LensRay {
  DVec3 origin{0.0};
  DVec3 direction{0.0, 0.0, 1.0};  ///< any length on input; unit after the lens
};

/// Surfaces of revolution about the axis, with focus (Kolb, Mitchell, Hanrahan 1995). Ignores losses by reflection.
class LensSystem {
 public:
  LensSystem() = default;
  /// Focuses on the plane at `focus_distance` from the film by the thick-lens approximation (§3.2). `film_radius`:
  /// largest distance of film points from the axis. Throws Error at `location` if the lens is invalid or cannot focus
  /// so near.
  LensSystem(const description::RealisticCamera& camera, double film_radius, const SourceLocation& location);

  /// Traces a ray from the film, or from any point behind the lens, through all elements. Returns the ray that leaves
  /// the front, or nullopt if a stop, a rim or total internal reflection blocks it.
  std::optional<LensRay> towards_scene(const LensRay& ray) const;
  /// Traces a ray in the opposite direction: returns the ray that leaves the rear.
  std::optional<LensRay> towards_film(const LensRay& ray) const;

  /// Bounds of the exit pupil: a rectangle in the plane z = rear_z(), for a film point on the x axis at this distance
  /// from the film's centre; it rotates with other film points. Contains every point that transmits light.
  struct Pupil {
    glm::dvec2 low{0.0}, high{0.0};
    double area() const { return (high.x - low.x) * (high.y - low.y); }
  };
  const Pupil& exit_pupil(double film_distance) const;

  /// The point of the front surface above a point of the disk of radius `front_radius()`.
  struct FrontPoint {
    DVec3 position{0.0};
    DVec3 normal{0.0, 0.0, 1.0};  ///< unit length, towards the scene
  };
  FrontPoint front_point(const glm::dvec2& disk) const;
  double front_radius() const { return surfaces_.front().aperture_radius; }
  /// z of the vertex of the last surface.
  double rear_z() const { return surfaces_.back().z; }
  double focal_length() const { return focal_length_; }

 private:
  struct Surface {
    double z = 0;       // z of the vertex
    double radius = 0;  // radius of curvature, centre at z - radius; 0: a stop
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
  std::vector<Pupil> pupils_;      // for equal intervals of the distance from the film's centre
  double film_radius_ = 0;
  double focal_length_ = 0;
};

}  // namespace lanthorn
