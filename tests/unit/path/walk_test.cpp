// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "math/sampling.h"
#include "path/radiance_along.h"
#include "support/scene_text.h"
#include "support/statistics.h"

namespace lanthorn::walk_test {
namespace {

const Wavelengths rgb = Wavelengths::rgb(0.5f);

// A flight, and the position of the vertex after it.
struct SeenFlight {
  Segment segment;
  bool scattered = false;
  Spectrum weight, beta;
  MediumId medium = MediumId::vacuum;
  std::optional<float> pdf;
  std::optional<Point> end;
};

// Records flights and their vertices.
struct FlightRecorder {
  std::vector<SeenFlight>& flights;

  void operator()(const FlownSegment& f) {
    flights.push_back({f.segment, f.scattered, f.weight, f.state.beta, f.state.medium, f.pdf, {}});
  }
  Continuation operator()(const SurfaceVertex& v) {
    flights.back().end = v.at.position;
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& v) {
    flights.back().end = v.position;
    return Continuation::go_on();
  }
  void operator()(const EscapeVertex&) {}
};

// The flights of walks that start at z = 5 towards a ball of fog on a floor.
std::vector<SeenFlight> flights_through(const std::string& fog, RayCounts& counts) {
  const Scene scene = test::world(
      fog +
      R"(AttributeBegin MediumInterface "fog" "" Material "interface" Shape "sphere" "float radius" 1 AttributeEnd
Shape "bilinearmesh" "point3 P" [-9 -1 9  9 -1 9  -9 -1 -9  9 -1 -9]
)");
  std::vector<SeenFlight> flights;
  for (std::uint32_t i = 0; i < 400; ++i) {
    Sampler sampler = Sampler::for_pixel(1, Stream::camera, i, 0);
    const PathContext path{scene, rgb, sampler, counts, {8, 3}};
    const Vec2 u = sampler.next2();
    walk_from_camera(path, {{{u.x - 0.5f, u.y - 0.5f, 5}, {0, 0, -1}}}, MediumId::vacuum, FlightRecorder{flights});
  }
  return flights;
}

TEST(Walk, ShowsEachFlightWithItsDensity) {
  RayCounts counts;
  const auto flights = flights_through(
      R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [.25 .25 .25] "rgb sigma_s" [.75 .75 .75]
)",
      counts);
  EXPECT_EQ(flights.size(), counts.walk) << "each ray is a flight";
  int scattered = 0, passed = 0, in_vacuum = 0;
  for (const SeenFlight& f : flights) {
    const float length = f.segment.length;
    if (f.end) {
      const Point end = f.segment.origin + length * f.segment.direction;
      EXPECT_LT(distance_squared(end, *f.end), 1e-8f * (1 + length * length));
    }
    ASSERT_TRUE(f.pdf.has_value());
    if (f.medium == MediumId::vacuum) {
      ++in_vacuum;
      EXPECT_EQ(*f.pdf, 1);
      EXPECT_EQ(f.weight[0], 1);
      EXPECT_FALSE(f.scattered);
    } else if (f.scattered) {
      ++scattered;
      EXPECT_NEAR(*f.pdf, std::exp(-length), 1e-5f) << "sigma_t is 1";
      EXPECT_NEAR(f.weight[0], 0.75f, 1e-5f);
    } else {
      ++passed;
      EXPECT_NEAR(*f.pdf, std::exp(-length), 1e-5f);
      EXPECT_NEAR(f.weight[0], 1, 1e-5f);
    }
  }
  EXPECT_GT(scattered, 100);
  EXPECT_GT(passed, 100);
  EXPECT_GT(in_vacuum, 400);
}

TEST(Walk, DoesNotKnowTheDensityOfTrackedFlights) {
  RayCounts counts;
  const auto flights = flights_through(
      R"(MakeNamedMedium "fog" "string type" "uniformgrid" "rgb sigma_a" [.2 .2 .2] "rgb sigma_s" [1 1 1] "integer nx" 1 "integer ny" 1 "integer nz" 1 "float density" [1] "point3 p0" [-1 -1 -1] "point3 p1" [1 1 1]
)",
      counts);
  int in_fog = 0;
  for (const SeenFlight& f : flights) {
    EXPECT_EQ(f.pdf.has_value(), f.medium == MediumId::vacuum);
    in_fog += f.medium == MediumId::vacuum ? 0 : 1;
  }
  EXPECT_GT(in_fog, 200);
}

// Radiance along rays from a point, as baking needs it: in a white furnace, L = E / (1 - rho) everywhere.
TEST(RadianceAlong, IsThatOfAFurnaceFromAnyPointInAnyDirection) {
  const Scene scene = test::world(
      R"(AreaLightSource "diffuse" "rgb L" [.5 .5 .5]
Material "diffuse" "rgb reflectance" [.5 .5 .5]
ReverseOrientation Shape "sphere" "float radius" 1
)");
  test::Mean mean;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    Sampler sampler = Sampler::for_pixel(test::seed(0), Stream::camera, i, 0);
    RayCounts counts;
    const PathContext path{scene, rgb, sampler, counts, {64, 3}};
    const Direction direction = sample_uniform_sphere(sampler.next2());
    LightLayers layers(rgb);
    radiance_along(path, {{{0.3f, -0.2f, 0.1f}, direction}}, MediumId::vacuum, layers);
    Rgb sum;
    for (const Rgb& light : layers.sample(FilterPart::positive, {}).light) sum += light;
    mean.add(static_cast<double>(sum.g));
  }
  // Half of it comes directly from the surface, the rest is scattered.
  EXPECT_TRUE(test::within(mean.mean(), 1, test::z_limit() * mean.error() + 1e-3));
  EXPECT_LT(mean.error(), 0.01);
}

}  // namespace
}  // namespace lanthorn::walk_test
