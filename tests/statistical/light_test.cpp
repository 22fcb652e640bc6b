// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Lights: chi-squared tests of densities, and z-tests of irradiance against quadrature or closed forms.
#include "light/light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "light/light_sampler.h"
#include "math/frame.h"
#include "math/hash.h"
#include "math/sampling.h"
#include "support/chi2.h"
#include "support/statistics.h"
#include "support/test_lights.h"

namespace lanthorn::test {
namespace {

const Wavelengths rgb = Wavelengths::rgb(0.5f);

constexpr double pi_d = std::numbers::pi;

double to_double(float x) { return static_cast<double>(x); }

/// Relative tolerance for quadrature and rounding.
constexpr double slack = 2e-4;

double limit_of(int checks) { return z_limit(sidak(false_alarm_rate, checks)); }

/// Numbers of surface points by voxel and by side of the normal.
using Cells = std::map<int, detail::Cell>;
int cell_of(const Bounds& box, const glm::dvec3& p, const glm::dvec3& n) {
  int cell = 0;
  for (int i = 0; i < 3; ++i) {
    const double extent = std::fmax(to_double(box.extent()[i]), 0.05);
    cell = cell * 16 + static_cast<int>(std::floor((p[i] - to_double(box.min[i])) / extent * 6 + 1.37));
    cell = cell * 2 + (std::fabs(n[i]) > 0.1 && n[i] > 0);
  }
  return cell;
}
::testing::AssertionResult judge(const Cells& cells, const Chi2Options& options) {
  std::vector<detail::Cell> list;
  for (const auto& [index, cell] : cells) list.push_back(cell);
  return detail::judge(list, options);
}

/// Convex surfaces hide their far side for a cone of directions.
bool hides_far_side(const EmitterShape& shape, const Point& from) {
  const auto* sphere = std::get_if<SphereEmitter>(&shape);
  return sphere && sphere->world_radius > 0 && distance_squared(from, sphere->centre) > sqr(sphere->world_radius);
}

TEST(LightStatistics, SurfacePositionsAreUniformByArea) {
  const std::vector<TestSurface> surfaces = test_surfaces();
  Chi2Options options;
  options.tests = static_cast<int>(surfaces.size());
  options.samples = 50000;
  for (const TestSurface& s : surfaces) {
    const Bounds box = bounds(s.shape);
    const double sign = s.natural_normal_is_du_cross_dv ? 1 : -1;
    Cells cells;
    s.integrate(700, [&](double, double, const glm::dvec3& p, const glm::dvec3& n, double da) {
      cells[cell_of(box, p, sign * n)].expected += options.samples * da / to_double(area(s.shape));
    });
    const AreaLight light{s.shape, test_colour()};
    HashRng rng(seed(1));
    for (int i = 0; i < options.samples; ++i) {
      const auto e = sample_emission(light, rng.next2(), rng.next2(), rgb);
      ++cells[cell_of(box, e->origin, e->normal)].observed;
    }
    EXPECT_TRUE(judge(cells, options)) << s.name;
  }
}

TEST(LightStatistics, DirectSamplesOfSurfacesFollowTheirDensity) {
  const std::vector<TestSurface> surfaces = test_surfaces();
  const std::vector<Point> receivers{{2, 1, 3}, {0.3f, 0.2f, 0.1f}, {1.1f, 0.5f, 0.9f}, {0.1f, -0.3f, -7}};
  Chi2Options options;
  options.tests = static_cast<int>(surfaces.size() * receivers.size());
  options.samples = 30000;
  for (const TestSurface& s : surfaces)
    for (const Point& from : receivers) {
      const Bounds box = bounds(s.shape);
      const double sign = s.natural_normal_is_du_cross_dv ? 1 : -1;
      Cells cells;
      s.integrate(400, [&](double, double, const glm::dvec3& p, const glm::dvec3& n, double da) {
        const glm::dvec3 d = glm::dvec3(from) - p;
        const double cos = glm::dot(n, d) / glm::length(d);
        if (hides_far_side(s.shape, from) && sign * cos <= 0) return;
        const double pdf = to_double(pdf_towards(s.shape, from, Point(p), Normal(n)));
        cells[cell_of(box, p, sign * n)].expected += options.samples * pdf * std::fabs(cos) / glm::dot(d, d) * da;
      });
      HashRng rng(seed(2));
      for (int i = 0; i < options.samples; ++i) {
        const auto e = sample_towards(s.shape, from, rng.next2());
        if (e) ++cells[cell_of(box, e->point, e->normal)].observed;
      }
      EXPECT_TRUE(judge(cells, options)) << s.name << " from " << from.x << " " << from.y << " " << from.z;
    }
}

TEST(LightStatistics, PointsOfScreensFollowTheirBrightness) {
  const auto screens = test_screens();
  ASSERT_EQ(screens.size(), 11u);
  const std::vector<Point> receivers{{2, 1, 3}, {0.3f, 0.2f, 0.4f}, {0.1f, -0.3f, 40}};
  Chi2Options options;
  options.tests = static_cast<int>(screens.size() * (1 + receivers.size()));
  options.samples = 30000;
  for (const auto& [s, light] : screens) {
    const Bounds box = bounds(s.shape);
    const double side = s.natural_normal_is_du_cross_dv ? 1 : -1;
    Cells cells;
    s.integrate(700, [&](double, double, const glm::dvec3& p, const glm::dvec3& du_cross_dv, double da) {
      const glm::dvec3 n = side * du_cross_dv;
      const double pdf = to_double(light.pdf_emission({Point(p), Normal(n), {}}, Direction(n)).position);
      cells[cell_of(box, p, n)].expected += options.samples * pdf * da;
    });
    HashRng rng(seed(1));
    for (int i = 0; i < options.samples; ++i) {
      const auto e = light.sample_emission(rng.next2(), rng.next2(), rgb);
      ++cells[cell_of(box, e->origin, e->normal)].observed;
    }
    EXPECT_TRUE(judge(cells, options)) << s.name;
    for (const Point& from : receivers) {
      AreaLight both_sides = light;
      both_sides.two_sided = true;
      Cells seen;
      s.integrate(700, [&](double, double, const glm::dvec3& p, const glm::dvec3& du_cross_dv, double da) {
        const glm::dvec3 n = side * du_cross_dv, d = glm::dvec3(from) - p;
        const double pdf = to_double(light.pdf_direct(from, {Point(p), Normal(n), {}}));
        seen[cell_of(box, p, n)].expected +=
            options.samples * pdf * std::fabs(glm::dot(n, d)) / std::pow(glm::length(d), 3) * da;
      });
      for (int i = 0; i < options.samples; ++i) {
        const auto e = both_sides.sample_direct(from, rng.next2(), rgb);
        if (e) ++seen[cell_of(box, e->position, e->normal)].observed;
      }
      EXPECT_TRUE(judge(seen, options)) << s.name << " from " << from.x << " " << from.y << " " << from.z;
    }
  }
}

/// The point from which a light's rays start in all directions, if the point matters.
EmitterHit on_light(const Light& light) {
  const auto* portal = std::get_if<PortalLight>(&light);
  return portal ? EmitterHit{portal->portal->corner + 0.4f * (portal->portal->width * portal->portal->frame.s +
                                                              portal->portal->height * portal->portal->frame.t),
                             {},
                             {}}
                : EmitterHit{};
}

TEST(LightStatistics, DirectionsOfInfiniteAndPointLightsFollowTheirDensity) {
  std::vector<NamedLight> lights;
  for (NamedLight& l : test_lights())
    if (is_infinite(l.light) || std::holds_alternative<EvenPointLight>(l.light) ||
        std::holds_alternative<GoniometricLight>(l.light) || std::holds_alternative<ProjectionLight>(l.light))
      lights.push_back(std::move(l));
  Chi2Options options;
  options.tests = 2 * static_cast<int>(lights.size());
  options.samples = 50000;
  options.cells_log2 = 7;
  for (const NamedLight& l : lights) {
    const DirectionSampler emission{
        [&](float u, const Vec2& v) {
          return std::optional(sample_emission(l.light, {u, 0.5f}, v, rgb)->direction);
        },
        [&](const Vec3& d) { return pdf_emission(l.light, on_light(l.light), d).direction; }};
    EXPECT_TRUE(chi2_test(emission, options)) << l.name;
    if (!is_infinite(l.light)) continue;
    const DirectionSampler direct{
        [&](float, const Vec2& v) { return std::optional(sample_direct(l.light, {}, v, rgb)->wi); },
        [&](const Vec3& d) { return pdf_direct_towards(l.light, {}, d); }};
    EXPECT_TRUE(chi2_test(direct, options)) << l.name;
  }
}

// In cells of 1 - cos, because narrow cones are too small for the quadrature of chi2_test.
TEST(LightStatistics, DirectionsOfSpotsFollowTheirDensity) {
  std::vector<NamedLight> lights;
  for (NamedLight& l : test_lights())
    if (std::holds_alternative<SpotLight>(l.light)) lights.push_back(std::move(l));
  Chi2Options options;
  options.tests = static_cast<int>(lights.size());
  constexpr int rings = 20, sectors = 8;
  for (const NamedLight& l : lights) {
    const SpotProfile& spot = std::get<SpotLight>(l.light).profile;
    const Frame frame(spot.axis);
    std::vector<detail::Cell> cells(rings * sectors);
    constexpr int steps = 500;
    for (int i = 0; i < rings * steps; ++i) {
      const double h = (i + 0.5) / (rings * steps) * to_double(spot.one_minus_cos_total);
      const Vec3 d(static_cast<float>(std::sqrt(h * (2 - h))), 0, static_cast<float>(1 - h));
      const double mass = to_double(pdf_emission(l.light, {}, frame.to_world(d)).direction) * 2 * pi_d *
                          to_double(spot.one_minus_cos_total) / (rings * steps);
      for (int j = 0; j < sectors; ++j)
        cells[static_cast<std::size_t>(i / steps * sectors + j)].expected += options.samples * mass / sectors;
    }
    HashRng rng(seed(4));
    for (int i = 0; i < options.samples; ++i) {
      const Direction d = sample_emission(l.light, {}, rng.next2(), rgb)->direction;
      const float h = 0.5f * distance_squared(d, spot.axis) / spot.one_minus_cos_total;
      const Vec3 local = frame.to_local(d);
      const auto sector = static_cast<int>((std::atan2(local.y, local.x) / (2 * pi) + 0.5f) * sectors);
      const int ring = std::min(static_cast<int>(h * rings), rings - 1);
      ++cells[static_cast<std::size_t>(ring * sectors + std::min(sector, sectors - 1))].observed;
    }
    EXPECT_TRUE(detail::judge(cells, options)) << l.name;
  }
}

TEST(LightStatistics, SurfaceEmissionFollowsItsDensity) {
  for (const bool two_sided : {false, true}) {
    AreaLight light_of_disk{DiskEmitter(Transform(), 0, 1), test_colour(), two_sided, false};
    if (two_sided) light_of_disk.spread = Spread(0.8);
    const Light light = light_of_disk;
    const DirectionSampler sampler{[&](float u, const Vec2& v) {
                                     return std::optional(sample_emission(light, {u, 0.3f}, v, rgb)->direction);
                                   },
                                   [&](const Vec3& d) { return pdf_emission(light, {}, d).direction; }};
    Chi2Options options;
    options.tests = 2;
    EXPECT_TRUE(chi2_test(sampler, options));
  }
}

TEST(LightStatistics, PhotonsOfPortalsCoverThemUniformly) {
  Chi2Options options;
  options.tests = 2;
  options.samples = 50000;
  for (const NamedLight& l : test_lights()) {
    const auto* light = std::get_if<PortalLight>(&l.light);
    if (light == nullptr) continue;
    const Portal& portal = *light->portal;
    std::vector<detail::Cell> cells(64);
    for (detail::Cell& cell : cells) cell.expected = options.samples / 64.0;
    HashRng rng(seed(3));
    for (int i = 0; i < options.samples; ++i) {
      const auto s = sample_emission(l.light, rng.next2(), rng.next2(), rgb);
      const Vec3 start = portal.frame.to_local(s->origin - portal.corner), d = portal.frame.to_local(s->direction);
      const Vec3 p = start - start.z / d.z * d;
      const auto index = [](float x) {
        return std::min(static_cast<std::size_t>(std::fmax(0.0f, x) * 8), std::size_t{7});
      };
      ++cells[index(p.y / portal.height) * 8 + index(p.x / portal.width)].observed;
    }
    EXPECT_TRUE(detail::judge(cells, options)) << l.name;
  }
}

TEST(LightStatistics, PhotonsOfInfiniteLightsCoverTheDiskUniformly) {
  std::vector<NamedLight> lights;
  for (NamedLight& l : test_lights())
    if ((is_infinite(l.light) && !std::holds_alternative<PortalLight>(l.light)) ||
        std::holds_alternative<DistantLight>(l.light))
      lights.push_back(std::move(l));
  Chi2Options options;
  options.tests = static_cast<int>(lights.size());
  options.samples = 50000;
  for (const NamedLight& l : lights) {
    std::vector<detail::Cell> cells(64);
    for (detail::Cell& cell : cells) cell.expected = options.samples / 64.0;
    HashRng rng(seed(3));
    for (int i = 0; i < options.samples; ++i) {
      const auto s = sample_emission(l.light, rng.next2(), rng.next2(), rgb);
      const Vec3 p = Frame(s->direction).to_local(s->origin - Point(0.5f, 1, -0.2f)) / 2.5f;
      const auto ring = std::min(static_cast<std::size_t>((p.x * p.x + p.y * p.y) * 8), std::size_t{7});
      const auto sector = static_cast<std::size_t>((std::atan2(p.y, p.x) + pi) / (2 * pi) * 7.999f);
      ++cells[ring * 8 + sector].observed;
    }
    EXPECT_TRUE(detail::judge(cells, options)) << l.name;
  }
}

/// Irradiance (green channel) at `p` on the side of `n`, by next-event estimation without occlusion.
Mean irradiance(const Light& light, const Point& p, const Normal& n, int samples, std::uint64_t number) {
  HashRng rng(seed(number));
  Mean mean;
  for (int i = 0; i < samples; ++i) {
    const auto s = sample_direct(light, p, rng.next2(), rgb);
    mean.add(s ? to_double(s->radiance[1] / s->pdf) * std::fmax(0.0, to_double(dot(n, s->wi))) : 0);
  }
  return mean;
}

constexpr double radiance = 2;  // green of test_colour()

TEST(LightStatistics, IrradianceInClosedForm) {
  const double z = limit_of(10);
  const Normal up(0, 0, 1);
  for (const float height : {1.001f, 2.0f, 50.0f}) {
    const Light sphere = AreaLight{SphereEmitter(translate({0, 0, height}), 1), test_colour()};
    EXPECT_TRUE(
        agrees(irradiance(sphere, {0, 0, 0}, up, 20000, 1), radiance * pi_d / sqr(to_double(height)), z, slack));
  }
  const Light inside = AreaLight{SphereEmitter(Transform(), 1), test_colour(), false, true};
  EXPECT_TRUE(agrees(irradiance(inside, {0.3f, 0.2f, 0.1f}, up, 100000, 1), radiance * pi_d, z, slack));
  const Light disk = AreaLight{DiskEmitter(Transform(), 1.5f, 2), test_colour(), false, true};
  EXPECT_TRUE(agrees(irradiance(disk, {0, 0, 0}, up, 50000, 1), radiance * pi_d * 4 / (4 + 2.25), z, slack));

  // Lambert's formula for a polygon above the horizon.
  const std::array<Point, 3> corner{Point(-1, 0.2f, 1), Point(0.3f, 1.5f, 0.4f), Point(1, -0.5f, 0.7f)};
  double lambert = 0;
  for (unsigned i = 0; i < 3; ++i) {
    const glm::dvec3 a = glm::normalize(glm::dvec3(corner[i])), b = glm::normalize(glm::dvec3(corner[(i + 1) % 3]));
    const glm::dvec3 normal = glm::cross(a, b);
    lambert += std::atan2(glm::length(normal), glm::dot(a, b)) * normal.z / glm::length(normal);
  }
  const Light triangle = AreaLight{TriangleEmitter(corner[0], corner[1], corner[2]), test_colour(), true, false};
  EXPECT_TRUE(agrees(irradiance(triangle, {0, 0, 0}, up, 20000, 1), radiance * std::fabs(lambert) / 2, z, slack));

  const Light point = EvenPointLight{{1, 0, 2}, {test_colour()}};
  EXPECT_NEAR(irradiance(point, {0, 0, 0}, up, 2, 1).mean(), radiance * 2 / std::pow(5, 1.5), 1e-6);
  const Light spot = SpotLight{{1, 0, 2}, SpotProfile(normalize(Vec3(-1, 0, -2)), test_colour(), 0.1f, 0.2f)};
  EXPECT_NEAR(irradiance(spot, {0, 0, 0}, up, 2, 1).mean(), radiance * 2 / std::pow(5, 1.5), 1e-6);
  const Light distant = DistantLight{normalize(Vec3(1, 0, 2)), test_colour(), {}};
  EXPECT_NEAR(irradiance(distant, {0, 0, 0}, up, 2, 1).mean(), radiance * 2 / std::sqrt(5), 1e-6);
  for (const double half_angle : {1e-3, 0.5, 1.2}) {
    const Light sun = SunLight{ConeProfile(up, half_angle, test_colour()), {}};
    EXPECT_TRUE(agrees(irradiance(sun, {0, 0, 0}, up, 20000, 1), radiance, z, slack)) << half_angle;
  }
  EXPECT_TRUE(agrees(irradiance(EvenSky{{test_colour()}, {}}, {}, up, 50000, 1), radiance * pi_d, z, slack));
}

TEST(LightStatistics, IrradianceOfSurfacesByQuadrature) {
  const std::vector<TestSurface> surfaces = test_surfaces();
  const std::vector<Point> receivers{{2, 1, 3}, {-1.1f, 0.5f, -1.9f}};
  const double z = limit_of(static_cast<int>(4 * surfaces.size() * receivers.size()));
  for (const TestSurface& s : surfaces)
    for (const Point& from : receivers)
      for (const bool flip : {false, true})
        for (const bool two_sided : {false, true}) {
          const bool far_hidden = hides_far_side(s.shape, from);
          const Normal up = normalize(-from + Vec3(0.3f, -0.2f, 0.1f));
          const double sign = (s.natural_normal_is_du_cross_dv ? 1 : -1) * (flip ? -1 : 1);
          double expected = 0;
          s.integrate(250, [&](double, double, const glm::dvec3& p, const glm::dvec3& n, double da) {
            const glm::dvec3 d = p - glm::dvec3(from);
            const double distance = glm::length(d), cos_light = -sign * glm::dot(n, d) / distance;
            if (!two_sided && cos_light <= 0) return;
            if (far_hidden && (flip ? -cos_light : cos_light) <= 0) return;
            const double cos = std::fmax(0.0, glm::dot(glm::dvec3(up), d) / distance);
            expected += radiance * cos * std::fabs(cos_light) / (distance * distance) * da;
          });
          if (far_hidden && flip && !two_sided) expected = 0;
          const Light light = AreaLight{s.shape, test_colour(), two_sided, flip};
          EXPECT_TRUE(agrees(irradiance(light, from, up, 10000, 5), expected, z, 1e-3))
              << s.name << (flip ? " flipped" : "") << (two_sided ? " two-sided" : "");
        }
}

TEST(LightStatistics, IrradianceOfScreensByQuadrature) {
  const std::vector<Point> receivers{{2, 1, 3}, {-1.1f, 0.5f, 1.9f}, {0.1f, -0.3f, 40}};
  const double z = limit_of(static_cast<int>(3 * receivers.size()));
  for (auto [s, light] : test_screens())
    for (const Point& from : receivers) {
      light.two_sided = true;
      const Normal up = normalize(-from + Vec3(0.3f, -0.2f, 0.1f));
      double expected = 0;
      s.integrate(1000, [&](double, double, const glm::dvec3& p, const glm::dvec3& n, double da) {
        const glm::dvec3 d = p - glm::dvec3(from);
        const double cos = std::fmax(0.0, glm::dot(glm::dvec3(up), d)) * std::fabs(glm::dot(n, d));
        expected += (p.x < 0 ? 2 : 0.3) * cos / std::pow(glm::length(d), 4) * da;
      });
      EXPECT_TRUE(agrees(irradiance(light, from, up, 50000, 5), expected, z, 1e-3)) << s.name;
    }
}

TEST(LightStatistics, IrradianceOfImagesByQuadrature) {
  const double z = limit_of(16);
  for (const NamedLight& l : test_lights()) {
    if (!is_infinite(l.light) || l.name == "small sun") continue;  // smaller than a step
    for (const Normal& n : {Normal(0, 0, 1), normalize(Vec3(1, -1, 0.5f))}) {
      double expected = 0;
      constexpr int side = 1000;
      for (int i = 0; i < side * side; ++i) {
        const Direction d = direction_from_octahedral((Vec2(i % side, i / side) + 0.5f) / static_cast<float>(side));
        expected +=
            to_double(emitted_infinite(l.light, {}, d, rgb)[1] * std::fmax(0.0f, dot(n, d))) * 4 * pi_d / side / side;
      }
      EXPECT_TRUE(agrees(irradiance(l.light, {}, n, 50000, 6), expected, z, 2e-3)) << l.name;
    }
  }
}

/// A square that receives light on one side.
struct Receiver {
  Point centre;
  Frame frame;
  float half;

  Point at(const Vec2& u) const { return centre + half * ((2 * u.x - 1) * frame.s + (2 * u.y - 1) * frame.t); }
  bool is_hit_by(const Point& origin, const Direction& direction) const {
    const float cos = dot(direction, frame.n);
    if (cos >= 0) return false;
    const float t = dot(centre - origin, frame.n) / cos;
    const Vec3 local = frame.to_local(origin + t * direction - centre);
    return t > 0 && std::fabs(local.x) < half && std::fabs(local.y) < half;
  }
};

TEST(LightStatistics, PhotonsBringWhatNextEventEstimationSees) {
  const std::vector<NamedLight> lights = test_lights();
  const double z = limit_of(static_cast<int>(lights.size()));
  int seen = 0;
  for (const NamedLight& l : lights) {
    // Occlusion is ignored on both sides, which differ where the inside of a sphere is visible through its front.
    const auto* surface = std::get_if<AreaLight>(&l.light);
    const Point centre = surface ? Point(1.2f, 1.8f, -1.5f) : Point(0.6f, -0.2f, 0.1f);
    if (surface && hides_far_side(surface->shape, centre) && (surface->two_sided || surface->flip_normal)) continue;
    const Receiver receiver{centre, Frame(normalize(Vec3(-1, 2, 0.5f) * (surface ? -1.0f : 1.0f) + 0.1f)), 0.7f};
    HashRng rng(seed(7));
    Mean photons, direct;
    for (int i = 0; i < 60000; ++i) {
      const auto s = sample_emission(l.light, rng.next2(), rng.next2(), rgb);
      photons.add(receiver.is_hit_by(s->origin, s->direction) ? to_double(s->flux[1]) : 0);
      const Point p = receiver.at(rng.next2());
      const auto d = sample_direct(l.light, p, rng.next2(), rgb);
      const double cos = d ? std::fmax(0.0, to_double(dot(receiver.frame.n, d->wi))) : 0;
      direct.add(d ? to_double(d->radiance[1] / d->pdf) * cos * to_double(4 * sqr(receiver.half)) : 0);
    }
    seen += direct.mean() > 0;
    const double error = std::hypot(photons.error(), direct.error());
    EXPECT_TRUE(within(photons.mean(), direct.mean(), z * error + 1e-9))
        << l.name << ", photons and next-event estimation";
  }
  EXPECT_GT(seen, 45);
}

}  // namespace
}  // namespace lanthorn::test
