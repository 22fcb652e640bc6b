// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The emitting surfaces and lights used by light tests, each surface with its own parametrisation.
#pragma once

#include <array>
#include <functional>
#include <glm/mat3x3.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "light/light.h"
#include "math/octahedral.h"

namespace lanthorn::test {

/// An emitter and, written independently of it, its surface as a function of (u, v) in [0,1]².
struct TestSurface {
  std::string name;
  EmitterShape shape;
  std::function<glm::dvec3(double, double)> at;
  bool natural_normal_is_du_cross_dv = true;

  /// dp/du x dp/dv by central differences.
  glm::dvec3 jacobian(double u, double v) const {
    constexpr double h = 1e-5;
    return glm::cross((at(u + h, v) - at(u - h, v)) / (2 * h), (at(u, v + h) - at(u, v - h)) / (2 * h));
  }
  /// Calls f(u, v, point, normal, dA) for the midpoints of an n x n grid of the parameters.
  template <class F>
  void integrate(int n, F&& f) const {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double u = (i + 0.5) / n, v = (j + 0.5) / n;
        const glm::dvec3 jac = jacobian(u, v);
        const double length = glm::length(jac);
        if (length > 0) f(u, v, at(u, v), jac / length, length / n / n);
      }
  }
};

inline TestSurface test_triangle(const Point& p0, const Point& p1, const Point& p2, std::string name = "triangle") {
  const glm::dvec3 a(p0), b(p1), c(p2);
  return {std::move(name), TriangleEmitter(p0, p1, p2),
          [=](double u, double v) { return a + u * ((1 - v) * (b - a) + v * (c - a)); }};
}
inline TestSurface test_patch(std::string name, const Point& p00, const Point& p10, const Point& p01,
                              const Point& p11) {
  const glm::dvec3 a(p00), b(p10), c(p01), d(p11);
  return {std::move(name), PatchEmitter(p00, p10, p01, p11),
          [=](double u, double v) { return (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * c + u * d); }};
}
inline TestSurface test_parallelogram(std::string name, const Point& p00, const Point& p10, const Point& p01) {
  const glm::dvec3 a(p00), b(p10), c(p01);
  return {std::move(name), ParallelogramEmitter(p00, p10, p01),
          [=](double u, double v) { return a + u * (b - a) + v * (c - a); }};
}
inline TestSurface test_sphere(std::string name, const Transform& t, float radius, float z_min = -infinity,
                               float z_max = infinity, float phi_max = 2 * pi) {
  const double r = static_cast<double>(radius);
  const double z0 = std::fmax(static_cast<double>(z_min), -r), z1 = std::fmin(static_cast<double>(z_max), r);
  const glm::dmat4 m(t.matrix);
  const auto at = [=](double u, double v) {
    const double phi = u * static_cast<double>(phi_max);
    const double theta = std::acos(z0 / r) + v * (std::acos(z1 / r) - std::acos(z0 / r));
    const double s = r * std::sin(theta);
    return glm::dvec3(m * glm::dvec4(s * std::cos(phi), s * std::sin(phi), r * std::cos(theta), 1));
  };
  return {std::move(name), SphereEmitter(t, radius, z_min, z_max, phi_max), at, !t.swaps_handedness()};
}
inline TestSurface test_disk(std::string name, const Transform& t, float height, float radius, float inner = 0,
                             float phi_max = 2 * pi) {
  const glm::dmat4 m(t.matrix);
  const auto at = [=](double u, double v) {
    const double phi = u * static_cast<double>(phi_max),
                 r = static_cast<double>(radius) * (1 - v) + static_cast<double>(inner) * v;
    return glm::dvec3(m * glm::dvec4(r * std::cos(phi), r * std::sin(phi), static_cast<double>(height), 1));
  };
  return {std::move(name), DiskEmitter(t, height, radius, inner, phi_max), at, !t.swaps_handedness()};
}
inline TestSurface test_cylinder(std::string name, const Transform& t, float radius, float z_min, float z_max,
                                 float phi_max = 2 * pi) {
  const glm::dmat4 m(t.matrix);
  const auto at = [=](double u, double v) {
    const double phi = u * static_cast<double>(phi_max), r = static_cast<double>(radius);
    const double z = static_cast<double>(z_min) + v * static_cast<double>(z_max - z_min);
    return glm::dvec3(m * glm::dvec4(r * std::cos(phi), r * std::sin(phi), z, 1));
  };
  return {std::move(name), CylinderEmitter(t, radius, z_min, z_max, phi_max), at, !t.swaps_handedness()};
}

/// Every kind of surface under rigid, uniform, non-uniform, mirroring and shearing transforms, all around the origin
/// and of size 1.
inline std::vector<TestSurface> test_surfaces() {
  const Transform rigid = translate({0.2f, -0.1f, 0.3f}) * rotate(50, {1, 2, 3});
  const Transform uniform = rigid * scale({0.7f, 0.7f, 0.7f});
  const Transform stretched = rigid * scale({1.3f, 0.5f, 0.8f});
  const Transform mirrored = rigid * scale({-1, 1, 1});
  Mat4 shear(1.0f);
  shear[1][0] = 0.6f;
  shear[2][1] = -0.4f;
  const Transform sheared = rigid * Transform(shear) * scale({1, -0.6f, 1.2f});
  std::vector<TestSurface> all;
  all.push_back(test_triangle({-1, -0.2f, 0.3f}, {0.8f, -0.4f, -0.2f}, {0.1f, 0.9f, 0.4f}));
  all.push_back(test_triangle({-1, 0, 0}, {1, 0, 0.1f}, {0, 0.004f, 0}, "sliver"));
  all.push_back(test_parallelogram("square", {-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}));
  all.push_back(test_parallelogram("parallelogram", {-1, -0.8f, 0.1f}, {0.6f, -0.9f, 0.3f}, {-0.7f, 0.5f, -0.2f}));
  all.push_back(test_patch("trapezoid", {-1, -1, 0}, {1, -1, 0}, {-0.2f, 1, 0}, {0.2f, 1, 0}));
  all.push_back(test_patch("saddle", {-1, -1, 0.6f}, {1, -1, -0.5f}, {-1, 1, -0.6f}, {0.5f, 1, 0.7f}));
  all.push_back(test_sphere("sphere", uniform, 1));
  all.push_back(test_sphere("mirrored sphere", mirrored, 0.8f));
  all.push_back(test_sphere("ellipsoid", stretched, 1));
  all.push_back(test_sphere("sheared sphere", sheared, 0.8f));
  all.push_back(test_sphere("partial sphere", rigid, 1, -0.3f, 0.8f, 4));
  all.push_back(test_sphere("partial ellipsoid", stretched, 1, -0.3f, 0.8f, 4));
  all.push_back(test_disk("disk", uniform, 0.3f, 1));
  all.push_back(test_disk("mirrored ring", mirrored, -0.2f, 1, 0.4f, 5));
  all.push_back(test_disk("sheared disk", sheared, 0.2f, 1));
  all.push_back(test_cylinder("cylinder", uniform, 0.6f, -0.9f, 0.7f));
  all.push_back(test_cylinder("mirrored cylinder", mirrored, 0.6f, -0.9f, 0.7f, 4));
  all.push_back(test_cylinder("sheared cylinder", sheared, 0.6f, -0.9f, 0.7f));
  return all;
}

struct NamedLight {
  std::string name;
  Light light;
};

/// 64 texels, some of them black and one bright.
inline std::vector<Rgb> test_texels() {
  std::vector<Rgb> texels;
  for (int i = 0; i < 64; ++i) {
    const float x = static_cast<float>((i * 37) % 64) / 64;
    texels.push_back(i % 7 == 3 ? Rgb{} : Rgb{x, 0.5f * x + 0.1f, 1 - x});
  }
  texels[19] = {40, 30, 20};
  return texels;
}

/// The texels as an 8 x 8 environment, which exists until the program ends.
inline const SphericalImage& test_environment() {
  static const SphericalImage image(SphereLayout::octahedral, 8, 8, test_texels());
  return image;
}

/// The same texels around the equator, 16 x 4, including the bright one.
inline const SphericalImage& test_panorama() {
  static const SphericalImage image(SphereLayout::equirectangular, 16, 4, test_texels());
  return image;
}

/// A grey image for goniometric lights.
inline const SphericalImage& test_profile() {
  static const SphericalImage image = [] {
    std::vector<Rgb> texels = test_texels();
    for (Rgb& c : texels) c = {c.g, c.g, c.g};
    return SphericalImage(SphereLayout::octahedral, 8, 8, texels);
  }();
  return image;
}

/// 6 x 3 texels over 70 degrees (of the shorter side), some black.
inline const ProjectionImage& test_slide() {
  static const ProjectionImage image = [] {
    const std::vector<Rgb> texels = test_texels();
    return ProjectionImage(6, 3, std::vector<Rgb>(texels.begin() + 8, texels.begin() + 26), 70 * pi / 180);
  }();
  return image;
}

inline SpectrumCurve test_colour() { return SpectrumCurve::illuminant({3, 2, 1}); }

/// Brightness over the square from which points are sampled: 4 x 4 cells, up to 200 times as bright as the darkest.
inline const PiecewiseConstant2d& test_brightness() {
  static const std::vector<float> cells{1, 0.1f, 2, 0.1f, 0.3f, 20, 0.1f, 1, 0.1f, 3, 0.5f, 0.1f, 4, 0.1f, 0.1f, 0.7f};
  static const PiecewiseConstant2d table(cells, 4, 4);
  return table;
}

/// Green is 2 for x < 0 and 0.3 elsewhere.
inline const EmissionPattern& test_pattern() {
  static const auto at = [](const Point& p) { return Spectrum(p.x < 0 ? 2 : 0.3f); };
  static const EmissionPattern pattern{
      [](std::uint32_t, const EmitterHit& hit, const Wavelengths&) { return at(hit.position); },
      [](std::uint32_t, const Point& p, const Normal&, const Wavelengths&) { return at(p); }};
  return pattern;
}

/// The surfaces whose points can be sampled by brightness, with a pattern and an unrelated table.
inline std::vector<std::pair<TestSurface, AreaLight>> test_screens() {
  std::vector<std::pair<TestSurface, AreaLight>> all;
  for (const TestSurface& s : test_surfaces()) {
    if (!invert_sample_area(s.shape, Point(0))) continue;
    AreaLight light{s.shape, test_colour()};
    light.pattern = &test_pattern();
    light.brightness = &test_brightness();
    all.emplace_back(s, light);
  }
  return all;
}

inline std::vector<NamedLight> test_lights() {
  std::vector<NamedLight> all;
  for (const TestSurface& s : test_surfaces()) {
    all.push_back({s.name, AreaLight{s.shape, test_colour(), false, false}});
    all.push_back({s.name + " flipped", AreaLight{s.shape, test_colour(), false, true}});
    all.push_back({s.name + " two-sided", AreaLight{s.shape, test_colour(), true, false}});
  }
  for (const auto& [surface, light] : test_screens()) all.push_back({surface.name + " as a screen", light});
  for (const TestSurface& s : test_surfaces()) {
    if (s.name != "square" && s.name != "sphere" && s.name != "mirrored ring") continue;
    AreaLight light{s.shape, test_colour(), s.name == "square", false};
    light.spread = Spread(0.6);
    all.push_back({s.name + " behind slats", light});
  }
  const BoundingSphere scene{{0.5f, 1, -0.2f}, 2.5f};
  const Direction axis = normalize(Vec3(1, -2, 0.5f));
  all.push_back({"point", EvenPointLight{{0.3f, 0.2f, -0.1f}, {test_colour()}}});
  all.push_back({"spot", SpotLight{{0.3f, 0.2f, -0.1f}, SpotProfile(axis, test_colour(), 0.4f, 0.7f)}});
  all.push_back(
      {"spot of glTF",
       SpotLight{{0.3f, 0.2f, -0.1f}, SpotProfile(axis, test_colour(), 0.4f, 0.7f, SpotProfile::Falloff::square)}});
  all.push_back({"narrow spot", SpotLight{{0.3f, 0.2f, -0.1f}, SpotProfile(axis, test_colour(), 0.01f, 0.02f)}});
  all.push_back({"sharp spot", SpotLight{{0.3f, 0.2f, -0.1f}, SpotProfile(axis, test_colour(), 0.5f, 0.5f)}});
  all.push_back({"wide spot", SpotLight{{0.3f, 0.2f, -0.1f}, SpotProfile(axis, test_colour(), 0, 2.5f)}});
  all.push_back({"distant", DistantLight{axis, test_colour(), scene}});
  all.push_back({"sun", SunLight{ConeProfile(axis, 0.3, test_colour()), scene}});
  all.push_back({"small sun", SunLight{ConeProfile(axis, 0.0046, test_colour()), scene}});
  all.push_back({"uniform infinite", EvenSky{{test_colour()}, scene}});
  const Transform turned = rotate(70, {1, 1, 0});
  const auto infinite = [&](const SphericalImage& image, const Transform& t) {
    return ImageSky{{{&image, DirectionMap(t)}, 2}, scene};
  };
  all.push_back({"image infinite", infinite(test_environment(), turned)});
  all.push_back({"mirrored image infinite", infinite(test_environment(), turned * scale({-3, 3, 3}))});
  all.push_back({"stretched image infinite", infinite(test_environment(), turned * scale({1, 2, 0.5f}))});
  all.push_back({"equirectangular infinite", infinite(test_panorama(), turned)});
  // Seen from the tests' receivers, which are around the origin, in direction z.
  static const std::array<Point, 4> corners{Point(-1, -0.5f, 1.5f), Point(-1, 1.5f, 1.5f), Point(2, 1.5f, 1.5f),
                                            Point(2, -0.5f, 1.5f)};
  static const Sky panorama = infinite(test_panorama(), turned), grey = EvenSky{{test_colour()}, scene};
  static const Portal window(corners, panorama), grey_window(corners, grey);
  all.push_back({"portal", PortalLight{panorama, &window}});
  all.push_back({"uniform portal", PortalLight{grey, &grey_window}});
  const Point at(0.3f, 0.2f, -0.1f);
  all.push_back({"goniometric", GoniometricLight{at, {{&test_profile(), DirectionMap(turned)}, test_colour()}}});
  all.push_back(
      {"stretched goniometric",
       GoniometricLight{at, {{&test_profile(), DirectionMap(turned * scale({-1, 2, 0.5f}))}, test_colour()}}});
  all.push_back({"projection", ProjectionLight{at, {2, &test_slide(), DirectionMap(turned)}}});
  all.push_back(
      {"stretched projection", ProjectionLight{at, {2, &test_slide(), DirectionMap(turned * scale({-1, 2, 0.7f}))}}});
  return all;
}

}  // namespace lanthorn::test
