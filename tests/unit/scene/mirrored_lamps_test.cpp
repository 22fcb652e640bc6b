// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Lamps of every shape under mirroring, uneven and sheared maps, in the world, in instances and in motion: they emit
// from the side from which they emit without the map, by every way in which light is sampled. The expected side, area
// and irradiance follow from the shape's parametrisation and the map alone.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "support/scene_text.h"

namespace lanthorn::mirrored_lamps_test {
namespace {

using test::white;

struct Lamp {
  std::string shape;
  std::function<DVec3(double, double)> at;     // point of the object at parameters in [0,1]²
  std::function<DVec3(const DVec3&)> outside;  // normal at a point of the object, of any length
  DVec3 in_front{0.0}, behind{0.0};            // places of receivers that the outside and the inside light
};

DVec3 upwards(const DVec3& /*any*/) { return {0, 0, 1}; }

std::vector<Lamp> make_lamps() {
  constexpr double pi = std::numbers::pi;
  const auto on_sphere = [](double low, double high, double phi_max) {
    return [=](double u, double v) {
      const double theta = std::acos(low) + v * (std::acos(high) - std::acos(low)), phi = u * phi_max;
      return DVec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    };
  };
  const auto on_disk = [](double inner, double phi_max) {
    return [=](double u, double v) {
      const double r = 1 + v * (inner - 1), phi = u * phi_max;
      return DVec3(r * std::cos(phi), r * std::sin(phi), .25);
    };
  };
  const auto on_cylinder = [](double phi_max) {
    return [=](double u, double v) {
      const double phi = u * phi_max;
      return DVec3(std::cos(phi), std::sin(phi), -.5 + 1.5 * v);
    };
  };
  const auto outwards = [](const DVec3& p) { return p; };
  const auto from_axis = [](const DVec3& p) { return DVec3(p.x, p.y, 0); };
  const DVec3 above(.3, .4, 3), below(.3, .4, -2), side(2.5, 1, .3), within(.1, .2, .1);
  const std::string square = R"("point3 P" [0 0 0  1 0 0  0 1 0  1 1 0])",
                    corners = R"( "integer indices" [0 1 2 2 1 3])";
  const auto on_square = [](double u, double v) { return DVec3(u, v, 0); };
  return {{R"("sphere")", on_sphere(-1, 1, 2 * pi), outwards, side, within},
          {R"("sphere" "float zmin" -.3 "float zmax" .8 "float phimax" 200)", on_sphere(-.3, .8, 200 * pi / 180),
           outwards, side, within},
          {R"("disk" "float height" .25)", on_disk(0, 2 * pi), upwards, above, below},
          {R"("disk" "float height" .25 "float innerradius" .4 "float phimax" 250)", on_disk(.4, 250 * pi / 180),
           upwards, above, below},
          {R"("cylinder" "float zmin" -.5 "float zmax" 1)", on_cylinder(2 * pi), from_axis, side, within},
          {R"("cylinder" "float zmin" -.5 "float zmax" 1 "float phimax" 160)", on_cylinder(160 * pi / 180), from_axis,
           side, within},
          {R"("trianglemesh" )" + square + corners, on_square, upwards, above, below},
          {R"("trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0])",
           [](double u, double v) { return DVec3(u, (1 - u) * v, 0); }, upwards, above, below},
          {R"("trianglemesh" )" + square + corners + R"( "normal N" [0 0 -1 0 0 -1 0 0 -1 0 0 -1])", on_square,
           [](const DVec3&) { return DVec3(0, 0, -1); }, below, above},
          {R"("bilinearmesh" )" + square, on_square, upwards, above, below},
          {R"("bilinearmesh" "point3 P" [0 0 0  1 0 0  0 1 0  1 1 .4])",
           [](double u, double v) { return DVec3(u, v, .4 * u * v); },
           [](const DVec3& p) { return DVec3(-.4 * p.y, -.4 * p.x, 1); }, above, below}};
}

// How a lamp comes into the world.
struct Place {
  std::string outer, inner;  // maps as directives: of the instance or the world, and of the shape
  bool is_instance = false, moves = false, reversed = false, two_sided = false;

  std::string name() const {
    return outer + "| " + inner + (is_instance ? "instance " : "world ") + (moves ? "moving " : "") +
           (reversed ? "reversed " : "") + (two_sided ? "two-sided" : "");
  }
};

// One lamp a line, from line 5 on, at distances at which they do not meet.
std::string scene_of(const std::vector<Lamp>& lamps, const Place& place) {
  std::string shapes;
  for (std::size_t i = 0; i < lamps.size(); ++i) shapes += "Translate 12 0 0 Shape " + lamps[i].shape + "\n";
  const std::string outer =
      (place.moves ? "ActiveTransform EndTime Translate 2 0 0 ActiveTransform All " : "") + place.outer;
  const std::string emission = R"(AreaLightSource "diffuse" "bool twosided" )" +
                               std::string(place.two_sided ? "true " : "false ") +
                               (place.reversed ? "ReverseOrientation " : "");
  if (!place.is_instance) return outer + place.inner + emission + "\n" + shapes;
  return R"(ObjectBegin "o" )" + emission + place.inner + "\n" + shapes + "ObjectEnd " + outer +
         R"(ObjectInstance "o"
)";
}

// The product of the maps in the middle of the shutter interval.
DMat4 map_of(const Place& place, std::size_t lamp) {
  const auto matrix = [](const std::string& directives) {
    const SceneDescription d = read_pbrt_string("WorldBegin " + directives + R"(Shape "sphere")", ".", "test scene");
    return d.shapes.at(0).object_to_world.start.matrix;
  };
  return translate({place.moves ? 1.0 : 0.0, 0, 0}).matrix * matrix(place.outer) * matrix(place.inner) *
         translate({12.0 * static_cast<double>(lamp + 1), 0, 0}).matrix;
}

// A lamp in the world, by its parametrisation.
class Reference {
 public:
  Reference(const Lamp& lamp, const DMat4& map, bool reversed)
      : lamp_(lamp), map_(map), inverse_(glm::inverse(map)), sign_(reversed ? -1 : 1) {}

  DVec3 point(const DVec3& p) const { return DVec3(map_ * glm::dvec4(p, 1.0)); }
  // The unit normal of the emitting side at a point of the world near the lamp.
  DVec3 outside(const DVec3& p) const {
    const DVec3 n = lamp_.outside(DVec3(inverse_ * glm::dvec4(p, 1.0)));
    return sign_ * glm::normalize(n * DMat3(inverse_));
  }
  // Sums f(point) dA over the lamp.
  template <class Function>
  double integrate(Function&& f) const {
    constexpr int steps = 48;
    constexpr double h = 1.0 / steps;
    double sum = 0;
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < steps; ++j) {
        const double u = (i + .5) * h, v = (j + .5) * h;
        const DVec3 du = point(lamp_.at(u + h / 2, v)) - point(lamp_.at(u - h / 2, v));
        const DVec3 dv = point(lamp_.at(u, v + h / 2)) - point(lamp_.at(u, v - h / 2));
        sum += glm::length(glm::cross(du, dv)) * f(point(lamp_.at(u, v)));
      }
    return sum;
  }

 private:
  const Lamp& lamp_;
  DMat4 map_, inverse_;
  double sign_;
};

// The lights of the lamps, by lamp.
std::map<std::size_t, std::vector<std::uint32_t>> lights_by_lamp(const Scene& scene) {
  std::map<std::size_t, std::vector<std::uint32_t>> lights;
  for (std::uint32_t l = 0; l < scene.lights().size(); ++l)
    lights[static_cast<std::size_t>(scene.light_location(l).line - 5)].push_back(l);
  return lights;
}

class LampCheck {
 public:
  LampCheck(const Scene& scene, const Reference& reference, const Place& place)
      : scene_(scene), reference_(reference), place_(place) {}

  // Light paths leave the lamp on its outside, where rays find it, shining.
  void emission_and_hits(std::uint32_t light) {
    const Light& lamp = scene_.lights()[light];
    for (int i = 0; i < 16; ++i) {
      const auto e = sample_emission(lamp, rng_.next2(), rng_.next2(), white);
      ASSERT_TRUE(e);
      const Normal outside(reference_.outside(DVec3(e->origin)));
      ASSERT_GT(dot(e->normal, outside), .999f);
      if (!place_.two_sided) {
        ASSERT_GT(dot(e->direction, outside), 0);
      }
      for (const bool front : {true, false}) {
        const Normal towards = front ? outside : -outside;
        const auto hit = scene_.intersect({e->origin + 1e-3f * towards, -towards, infinity, .5f}, white);
        ASSERT_TRUE(hit);
        ASSERT_LT(distance_squared(hit->position, e->origin), 1e-7f);
        const float seen =
            emitted(scene_.lights()[hit->light.value()], {hit->position, hit->normal, hit->uv}, towards, white)[0];
        ASSERT_EQ(seen > 0, front || place_.two_sided);
      }
    }
  }
  // Next-event estimation finds the lamp's unoccluded irradiance at a receiver that faces `towards`.
  void irradiance(const std::vector<std::uint32_t>& lights, const DVec3& from, const DVec3& towards) {
    const DVec3 n = glm::normalize(towards - from);
    const double expected = reference_.integrate([&](const DVec3& p) {
      const DVec3 way = p - from;
      const double out = -glm::dot(reference_.outside(p), way);
      return std::max(0.0, glm::dot(n, way)) * (place_.two_sided ? std::fabs(out) : std::max(0.0, out)) /
             std::pow(glm::dot(way, way), 2);
    });
    constexpr int samples = 1024;
    double found = 0;
    for (const std::uint32_t light : lights)
      for (int i = 0; i < samples; ++i)
        if (const auto s = sample_direct(scene_.lights()[light], Point(from), rng_.next2(), white))
          found += std::max(0.0, glm::dot(n, DVec3(s->wi))) * static_cast<double>(s->radiance[0] / s->pdf) / samples;
    ASSERT_GT(expected, 0);
    // The numbers are the same on all machines. Single samples vary by about half of their mean.
    ASSERT_NEAR(found / expected, 1, .12);
  }

 private:
  const Scene& scene_;
  const Reference& reference_;
  const Place& place_;
  HashRng rng_{1};
};

void check(const std::vector<Lamp>& lamps, const Place& place) {
  const Scene scene = test::world(scene_of(lamps, place), "TransformTimes 0 1");
  const auto lights = lights_by_lamp(scene);
  ASSERT_EQ(lights.size(), lamps.size());
  for (const auto& [index, own] : lights) {
    SCOPED_TRACE(lamps[index].shape);
    const Reference reference(lamps[index], map_of(place, index), place.reversed);
    double power = 0;
    for (const std::uint32_t l : own) power += static_cast<double>(lanthorn::power(scene.lights()[l]));
    const double area = reference.integrate([](const DVec3&) { return 1.0; });
    ASSERT_NEAR(power / (std::numbers::pi * area * (place.two_sided ? 2 : 1)), 1, 2e-3);
    LampCheck lamp(scene, reference, place);
    for (const std::uint32_t l : own) lamp.emission_and_hits(l);
    const bool is_whole_sphere = lamps[index].shape == R"("sphere")";
    if (is_whole_sphere && place.two_sided) continue;  // hides its own far side
    lamp.irradiance(own, reference.point(place.reversed ? lamps[index].behind : lamps[index].in_front),
                    reference.point({.2, .3, .1}));
  }
}

TEST(MirroredLamps, EmitFromTheSideTheyHaveWithoutTheMap) {
  const std::vector<Lamp> lamps = make_lamps();
  const std::array<std::string, 6> outer{"",
                                         "Scale -1 1 1 ",
                                         "Scale -2 2 2 ",
                                         "Rotate 40 1 2 3 Scale 1 -.6 1.5 ",
                                         "Scale -1 1 1 LookAt 1 2 3  4 -1 2  0 1 0 ",
                                         "ConcatTransform [.9 .3 0 0  .2 -1.3 .1 0  0 .4 .7 0  3 -2 1 1] "};
  const std::array<std::string, 2> inner{"", "Translate 1 2 0 Scale 1 1 -1.2 "};
  for (const std::string& o : outer)
    for (const std::string& i : inner)
      for (unsigned bits = 0; bits < 16; ++bits) {
        const Place place{o, i, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0};
        SCOPED_TRACE(place.name());
        check(lamps, place);
        if (HasFatalFailure()) return;
      }
}

}  // namespace
}  // namespace lanthorn::mirrored_lamps_test
