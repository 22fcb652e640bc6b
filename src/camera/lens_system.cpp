// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// References:
//   Kolb, Mitchell, Hanrahan 1995, "A Realistic Camera Model for Computer Graphics".
//   Hecht 2017, "Optics" 5e, §6.1 and §6.2 (matrices of paraxial rays, cardinal points).
#include "camera/lens_system.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "base/parallel.h"

namespace lanthorn {

namespace {

constexpr std::size_t pupil_count = 64;

// Refracts the unit vector `d` by Snell's law. `n`: unit normal against `d`; `eta`: index in front over index behind.
// Returns nullopt at total internal reflection.
std::optional<DVec3> refracted(const DVec3& d, const DVec3& n, double eta) {
  const double cos = -glm::dot(d, n);
  const double sin2 = eta * eta * (1 - cos * cos);
  if (sin2 >= 1) return {};
  return glm::normalize(eta * d + (eta * cos - std::sqrt(1 - sin2)) * n);
}

}  // namespace

LensSystem::LensSystem(const description::RealisticCamera& camera, double film_radius, const SourceLocation& location)
    : film_radius_(film_radius) {
  if (camera.elements.empty()) throw Error(location, "the lens has no elements");
  const auto index = [](float eta) { return eta > 0 ? static_cast<double>(eta) : 1.0; };
  double before = 1, z = 0;
  for (const description::LensElement& e : camera.elements) {
    if (!(e.aperture_diameter > 0)) throw Error(location, "an element of the lens has no aperture");
    Surface s;
    s.z = z;
    s.radius = e.curvature_radius;
    s.eta_scene = before;
    s.eta_film = e.curvature_radius == 0 ? before : index(e.eta);
    s.aperture_radius = 0.5 * static_cast<double>(e.aperture_diameter);
    if (s.radius != 0) s.aperture_radius = std::min(s.aperture_radius, std::fabs(s.radius));
    surfaces_.push_back(s);
    before = index(e.eta);
    z -= static_cast<double>(e.thickness);
  }
  constexpr double like_air = 1e-3;
  if (std::fabs(surfaces_.back().eta_film - 1) > like_air)
    throw Error(location, "the medium behind the last element of the lens must be air");
  focus(camera.focus_distance, location);
  bound_exit_pupils(film_radius);
}

double LensSystem::rim_z(const Surface& s) {
  if (s.radius == 0) return s.z;
  const double centre = s.z - s.radius;
  return centre + std::copysign(std::sqrt(s.radius * s.radius - s.aperture_radius * s.aperture_radius), s.radius);
}

// Focal length and principal planes of the system for paraxial rays (height, angle), relative to the rear vertex.
struct LensSystem::Cardinal {
  double focal_length = 0;
  double film_side = 0, scene_side = 0;
};

LensSystem::Cardinal LensSystem::cardinal_points() const {
  // Columns of the matrix from the rear vertex to the front vertex, from tracing the rays (1, 0) and (0, 1).
  std::array<std::pair<double, double>, 2> rays{{{1, 0}, {0, 1}}};
  for (auto& [height, angle] : rays)
    for (std::size_t i = surfaces_.size(); i-- > 0;) {
      const Surface& s = surfaces_[i];
      if (s.radius != 0) {
        const double power = (s.eta_film - s.eta_scene) / s.radius;
        angle = (s.eta_film * angle - power * height) / s.eta_scene;
      }
      if (i > 0) height += angle * (surfaces_[i - 1].z - s.z);
    }
  const double a = rays[0].first, c = rays[0].second, d = rays[1].second;
  const double length = surfaces_.front().z - surfaces_.back().z;
  return {-1 / c, (d - 1) / c, length + (1 - a) / c};
}

// Solves 1/x + 1/(L - x) = 1/f, with x the film's distance from the film-side principal plane and L - x the object's
// distance from the other plane. There are two positions in focus; takes the one near the lens, as cameras do.
void LensSystem::focus(double distance, const SourceLocation& location) {
  const Cardinal lens = cardinal_points();
  focal_length_ = lens.focal_length;
  if (!(focal_length_ > 0) || !std::isfinite(focal_length_))
    throw Error(location, "the lens is not converging: its focal length is not positive");
  const double between = distance + lens.film_side - lens.scene_side;
  const double discriminant = between * between - 4 * between * focal_length_;
  if (!(between > 0) || !(discriminant >= 0))
    throw Error(location, "the lens cannot focus on a distance of " + std::to_string(distance) +
                              " m: its focal length is " + std::to_string(1000 * focal_length_) + " mm");
  const double rear = (between - std::sqrt(discriminant)) / 2 - lens.film_side;
  const double shift = rear - surfaces_.back().z;
  for (Surface& s : surfaces_) s.z += shift;
  if (!(rear > 0) || !(rim_z(surfaces_.back()) > 0))
    throw Error(location, "to focus on " + std::to_string(distance) + " m the lens would have to touch the film");
}

// Traces a ray through one surface; returns false if the ray is blocked.
template <LensSystem::Towards towards>
bool LensSystem::pass(const Surface& s, LensRay& ray) {
  const DVec3 o = ray.origin, d = ray.direction;
  double t = 0;
  const DVec3 centre(0, 0, s.z - s.radius);
  if (s.radius == 0) {
    t = (s.z - o.z) / d.z;
  } else {
    const DVec3 way = o - centre;
    const double b = glm::dot(way, d), c = glm::dot(way, way) - s.radius * s.radius;
    const double discriminant = b * b - c;
    if (discriminant < 0) return false;
    // The root on the side of the sphere where its vertex lies.
    const bool nearer = (towards == Towards::scene) == (s.radius < 0);
    t = -b + (nearer ? -1 : 1) * std::sqrt(discriminant);
  }
  if (!(t >= 0)) return false;
  ray.origin = o + t * d;
  const double across2 = ray.origin.x * ray.origin.x + ray.origin.y * ray.origin.y;
  if (across2 > s.aperture_radius * s.aperture_radius) return false;
  if (s.radius == 0 || s.eta_scene == s.eta_film) return true;
  DVec3 n = (ray.origin - centre) / std::fabs(s.radius);
  if (glm::dot(n, d) > 0) n = -n;
  const double eta = towards == Towards::scene ? s.eta_film / s.eta_scene : s.eta_scene / s.eta_film;
  const std::optional<DVec3> next = refracted(d, n, eta);
  if (!next) return false;
  ray.direction = *next;
  return true;
}

std::optional<LensRay> LensSystem::towards_scene(const LensRay& ray) const {
  LensRay r{ray.origin, glm::normalize(ray.direction)};
  if (!(r.direction.z > 0)) return {};
  for (auto s = surfaces_.rbegin(); s != surfaces_.rend(); ++s)
    if (!pass<Towards::scene>(*s, r)) return {};
  return r;
}

std::optional<LensRay> LensSystem::towards_film(const LensRay& ray) const {
  LensRay r{ray.origin, glm::normalize(ray.direction)};
  if (!(r.direction.z < 0)) return {};
  for (const Surface& s : surfaces_)
    if (!pass<Towards::film>(s, r)) return {};
  return r;
}

LensSystem::FrontPoint LensSystem::front_point(const glm::dvec2& disk) const {
  const Surface& s = surfaces_.front();
  FrontPoint p;
  p.position = DVec3(disk, s.z);
  if (s.radius == 0) return p;
  const double height = std::sqrt(std::max(0.0, s.radius * s.radius - glm::dot(disk, disk)));
  p.position.z = s.z - s.radius + std::copysign(height, s.radius);
  p.normal = DVec3(disk, std::copysign(height, s.radius)) / s.radius;
  return p;
}

// Largest distance from the axis, in the vertex plane of the last surface, of rays through that surface's rim from film
// points up to this distance.
double LensSystem::pupil_reach(double film_distance) const {
  const Surface& s = surfaces_.back();
  const double stretch = s.z / rim_z(s);
  double reach = s.aperture_radius;
  for (const double from : {0.0, film_distance})
    for (const double rim : {-s.aperture_radius, s.aperture_radius})
      reach = std::max(reach, std::fabs(from + (rim - from) * stretch));
  return reach;
}

// Bounds of the rays of a grid over `searched` that pass the lens, for film points in an interval of distances.
// Enlarged by 1.5 cells, more than the pupil changes between the film points tried.
std::optional<LensSystem::Pupil> LensSystem::search_pupil(const Pupil& searched, double near, double far) const {
  constexpr int cells = 48;
  constexpr double margin = 1.5;
  const glm::dvec2 cell = (searched.high - searched.low) / static_cast<double>(cells);
  Pupil pupil{glm::dvec2(infinity), glm::dvec2(-infinity)};
  for (const double from : {near, 0.5 * (near + far), far})
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x) {
        const glm::dvec2 p = searched.low + cell * glm::dvec2(x + 0.5, y + 0.5);
        if (p.x >= pupil.low.x && p.x <= pupil.high.x && p.y >= pupil.low.y && p.y <= pupil.high.y) continue;
        const DVec3 origin(from, 0, 0);
        if (!towards_scene({origin, DVec3(p, rear_z()) - origin})) continue;
        pupil.low = glm::min(pupil.low, p);
        pupil.high = glm::max(pupil.high, p);
      }
  if (pupil.low.x > pupil.high.x) return {};
  return Pupil{pupil.low - margin * cell, pupil.high + margin * cell};
}

// Two passes: a fine grid over the small region found by a coarse grid gives tighter bounds.
LensSystem::Pupil LensSystem::bound_exit_pupil(double near, double far) const {
  const double reach = pupil_reach(far);
  const Pupil all{glm::dvec2(-reach), glm::dvec2(reach)};
  const Pupil coarse = search_pupil(all, near, far).value_or(all);
  return search_pupil(coarse, near, far).value_or(coarse);
}

void LensSystem::bound_exit_pupils(double film_radius) {
  pupils_.resize(pupil_count);
  parallel_for(std::size_t{0}, pupil_count, [&](std::size_t i) {
    const double step = film_radius / pupil_count;
    pupils_[i] = bound_exit_pupil(static_cast<double>(i) * step, static_cast<double>(i + 1) * step);
  });
}

const LensSystem::Pupil& LensSystem::exit_pupil(double film_distance) const {
  const double i = film_distance / film_radius_ * pupil_count;
  return pupils_[std::min(static_cast<std::size_t>(std::max(i, 0.0)), pupil_count - 1)];
}

}  // namespace lanthorn
