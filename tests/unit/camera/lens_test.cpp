// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Glass lenses: their focus, their transmission, and agreement of both directions.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "camera/lens_system.h"
#include "camera/view.h"
#include "lanthorn/scene.h"
#include "math/hash.h"
#include "scene/scene.h"
#include "support/error_text.h"
#include "support/temporary_dir.h"

namespace lanthorn::lens_test {
namespace {

using description::RealisticCamera;

const std::string scenes = LANTHORN_SOURCE_DIR "/tests/scenes/";

// Uses the reader, so that it is tested too.
RealisticCamera double_gauss(float focus_distance, float diameter = 30, float diagonal = 60) {
  const SceneDescription scene =
      read_pbrt_string(R"(Camera "realistic" "string lensfile" "double-gauss.dat" "float focusdistance" )" +
                           std::to_string(focus_distance) + R"( "float aperturediameter" )" + std::to_string(diameter) +
                           R"(
Film "rgb" "float diagonal" )" +
                           std::to_string(diagonal) + "\nWorldBegin\n",
                       scenes, "t.pbrt");
  EXPECT_TRUE(scene.warnings.empty());
  return std::get<RealisticCamera>(scene.view.camera.node);
}

// A thin lens with an aperture stop behind it.
RealisticCamera magnifier(float stop_diameter) {
  RealisticCamera camera;
  camera.elements = {{0.1f, 1e-3f, 1.5f, 0.05f}, {-0.1f, 2e-3f, 1, 0.05f}, {0, 0.1f, 0, stop_diameter}};
  camera.focus_distance = 3;
  camera.film_diagonal = 0.06f;
  return camera;
}

Camera camera_of(const RealisticCamera& lens, int width, int height) {
  description::Camera camera;
  camera.node = lens;
  return {camera, width, height};
}

TEST(Lens, FocalLengthsAreTheLensmakers) {
  const LensSystem thin(magnifier(0.01f), 0.03, {});
  // 1/f = (n - 1) (1/R1 - 1/R2 + (n - 1) t / (n R1 R2)).
  EXPECT_NEAR(1 / thin.focal_length(), 0.5 * (20 - 0.5 * 1e-3 / (1.5 * 0.01)), 1e-4);
  EXPECT_NEAR(LensSystem(double_gauss(5), 0.03, {}).focal_length(), 0.1, 0.001);
}

// Rays from the middle of the film near the axis converge at the focus distance.
TEST(Lens, FocusesWhereItIsTold) {
  for (const float distance : {0.6f, 2.0f, 30.0f}) {
    const LensSystem lens(double_gauss(distance), 0.03, {});
    const auto ray = lens.towards_scene({DVec3(0.0), DVec3(1e-4, 0, lens.rear_z())});
    ASSERT_TRUE(ray);
    const double meets = ray->origin.z - ray->origin.x * ray->direction.z / ray->direction.x;
    EXPECT_NEAR(meets / static_cast<double>(distance), 1, 1e-3);
  }
}

// All light on a film point comes from a small area of the plane in focus, and from large areas of other planes.
TEST(Lens, ThePlaneInFocusIsSharp) {
  const Camera camera = camera_of(double_gauss(2), 60, 40);
  for (const Vec2& raster : {Vec2(30, 20), Vec2(20, 12), Vec2(40, 28)}) {
    const auto spread = [&](float z) {
      HashRng rng(1);
      glm::dvec2 sum(0.0), sum2(0.0);
      int count = 0;
      for (int i = 0; i < 4000; ++i) {
        const CameraRay r = camera.sample_ray(raster, rng.next2(), 0);
        if (!(r.weight > 0)) continue;
        const Point p = r.ray.origin + r.ray.direction * ((z - r.ray.origin.z) / r.ray.direction.z);
        sum += glm::dvec2(p);
        sum2 += glm::dvec2(p) * glm::dvec2(p);
        ++count;
      }
      EXPECT_GT(count, 1000);
      const glm::dvec2 mean = sum / static_cast<double>(count);
      const glm::dvec2 variance = sum2 / static_cast<double>(count) - mean * mean;
      return std::sqrt(variance.x + variance.y);
    };
    // 30 mm wide: a circle of confusion of 30 mm * |z - 2| / 2 in object space, the radius of gyration of which is
    // 1 / sqrt(8) of its diameter.
    EXPECT_LT(spread(2), 1e-3);
    EXPECT_GT(spread(1.6f), 1.5e-3);
    EXPECT_GT(spread(2.5f), 1.5e-3);
  }
}

TEST(Lens, PicturesAreTheRightWayUp) {
  const Camera camera = camera_of(double_gauss(2), 60, 40);
  const auto towards = [&](const Vec2& raster) {
    HashRng rng(1);
    CameraRay r;
    do r = camera.sample_ray(raster, rng.next2(), 0);
    while (!(r.weight > 0));
    return r.ray.direction;
  };
  EXPECT_LT(towards({5, 20}).x, -0.1f);
  EXPECT_GT(towards({55, 20}).x, 0.1f);
  EXPECT_GT(towards({30, 3}).y, 0.1f);
  EXPECT_LT(towards({30, 37}).y, -0.1f);
}

TEST(Lens, WaysAreReversible) {
  const LensSystem lens(double_gauss(1.5f), 0.03, {});
  HashRng rng(2);
  int passed = 0;
  for (int i = 0; i < 2000; ++i) {
    const DVec3 film(0.03 * (rng.next() - 0.5), 0.03 * (rng.next() - 0.5), 0);
    const DVec3 aim(0.03 * (rng.next() - 0.5), 0.03 * (rng.next() - 0.5), lens.rear_z());
    const auto out = lens.towards_scene({film, aim - film});
    if (!out) continue;
    ++passed;
    const auto back = lens.towards_film({out->origin + out->direction, -out->direction});
    ASSERT_TRUE(back);
    EXPECT_NEAR(std::fabs(glm::dot(back->direction, glm::normalize(aim - film))), 1, 1e-12);
    const DVec3 hit = back->origin - back->direction * (back->origin.z / back->direction.z);
    EXPECT_LT(glm::length(hit - film), 1e-9);
  }
  EXPECT_GT(passed, 500);
}

// The stop behind the lens is its exit pupil. Under radiance 1, the irradiance of a point of the film is pi times the
// form factor of a disk (Howell, configuration factor B-13), which falls off like cos^4. Means of n samples within 5
// standard errors: false-alarm rate below 1e-5 for all points.
TEST(Lens, ExposureFallsOffAsTheFormFactorOfThePupil) {
  constexpr int width = 60, height = 40;
  const RealisticCamera lens = magnifier(0.012f);
  const Camera camera = camera_of(lens, width, height);
  const double z = LensSystem(lens, 0.03, {}).rear_z(), a = 0.006;
  const double scale = 0.06 / std::hypot(width, height);
  for (const Vec2& raster : {Vec2(30, 20), Vec2(10, 20), Vec2(1, 1), Vec2(59.5f, 39), Vec2(44, 7)}) {
    const double r = scale * std::hypot(raster.x - 30.0, raster.y - 20.0);
    const double d = z * z + r * r - a * a;
    const double expected = std::numbers::pi * 0.5 * (1 - d / std::sqrt(d * d + 4 * z * z * a * a));
    HashRng rng(3);
    constexpr int samples = 200000;
    double sum = 0, sum2 = 0;
    for (int i = 0; i < samples; ++i) {
      const auto w = static_cast<double>(camera.sample_ray(raster, rng.next2(), 0).weight);
      sum += w;
      sum2 += w * w;
    }
    const double mean = sum / samples, error = std::sqrt((sum2 / samples - mean * mean) / samples);
    EXPECT_NEAR(mean, expected, 5 * error);
    EXPECT_LT(error, 0.005 * expected);
  }
}

// Nothing outside the pupil's bounds on the rear lens lets light through.
TEST(Lens, PupilsHoldAllLight) {
  const LensSystem lens(double_gauss(1, 34.2f), 0.03, {});
  HashRng rng(4);
  int passed = 0;
  for (int i = 0; i < 200000; ++i) {
    const double x = 0.03 * rng.next();
    const DVec3 aim(0.05 * (rng.next() - 0.5), 0.05 * (rng.next() - 0.5), lens.rear_z());
    if (!lens.towards_scene({{x, 0, 0}, aim - DVec3(x, 0, 0)})) continue;
    ++passed;
    const LensSystem::Pupil& pupil = lens.exit_pupil(x);
    EXPECT_TRUE(aim.x > pupil.low.x && aim.x < pupil.high.x && aim.y > pupil.low.y && aim.y < pupil.high.y);
    EXPECT_LT(pupil.area(), 0.05 * 0.05);
  }
  EXPECT_GT(passed, 10000);
}

// The densities of the rays that leave the front integrate to the fraction of rays that the lens transmits.
TEST(Lens, DensitiesIntegrateToWhatPasses) {
  const Camera camera = camera_of(magnifier(0.02f), 60, 40);
  const LensSystem lens(magnifier(0.02f), 0.03, {});
  HashRng rng(5);
  constexpr int samples = 300000;
  int passed = 0;
  for (int i = 0; i < samples; ++i)
    passed += camera.sample_ray({60 * rng.next(), 40 * rng.next()}, rng.next2(), 0).weight > 0 ? 1 : 0;
  double sum = 0, sum2 = 0;
  const double radius = lens.front_radius();
  constexpr float cone = 0.1f;  // 1 - cos
  for (int i = 0; i < samples; ++i) {
    const glm::dvec2 disk = radius * glm::dvec2(sample_concentric_disk(rng.next2()));
    const Vec3 direction = sample_uniform_cone(rng.next2(), cone);
    // Areas are measured perpendicular to the axis: the point of the disk below the surface point along the ray.
    DVec3 at(disk, lens.front_point({0, 0}).position.z);
    const CameraPdf pdf = camera.pdf({Point(at - 1e-6 * DVec3(direction)), direction});
    const double value = static_cast<double>(pdf.position) * static_cast<double>(pdf.direction) * std::numbers::pi *
                         radius * radius / static_cast<double>(pdf_uniform_cone(cone));
    sum += value;
    sum2 += value * value;
  }
  const double error = std::sqrt(sum2) / samples;
  EXPECT_NEAR(sum / samples, passed / static_cast<double>(samples), 5 * error + 5e-3);
  EXPECT_GT(passed, samples / 4);
}

std::string error_of(const std::string& lens, const std::string& parameters = "") {
  const test::TemporaryDir dir;
  dir.write("l.dat", lens);
  std::string text = test::error_text([&] {
    make_view(read_pbrt_string(R"(Camera "realistic" "string lensfile" "l.dat" )" + parameters + "\nWorldBegin",
                               dir.path(), "t.pbrt")
                  .view);
  });
  const std::string folder = dir.path().string() + "/";
  if (const auto at = text.find(folder); at != std::string::npos) text.erase(at, folder.size());
  return text;
}

TEST(Lens, ErrorsNameTheirPlace) {
  const std::string glass = "# a lens\n100 1 1.5 50\n-100 100 1 50\n";
  EXPECT_EQ(error_of(glass), "no error");
  EXPECT_EQ(error_of("100 1 1.5 50\n  -100 100 1"),
            "l.dat:2:3: an element of a lens needs four numbers, this one has 3");
  EXPECT_EQ(error_of("100 1 1.5 x"), R"(l.dat:1:11: expected a number, found "x")");
  EXPECT_EQ(error_of("100 -1 1.5 50"), "l.dat:1:1: the thickness of an element of a lens must not be negative");
  EXPECT_EQ(error_of("100 1 0 50"), "l.dat:1:1: the index of refraction must be at least 1");
  EXPECT_EQ(error_of("100 1 1.5 0"), "l.dat:1:1: the aperture of an element of a lens must be above 0");
  EXPECT_EQ(error_of("# nothing\n"), "l.dat:2:1: the lens has no elements");
  EXPECT_EQ(error_of(glass, R"("float focusdistance" 0.2)").substr(0, 65),
            "t.pbrt:1:1: the lens cannot focus on a distance of 0.200000 m: it");
  EXPECT_EQ(error_of("-100 1 1.5 50\n100 100 1 50\n"),
            "t.pbrt:1:1: the lens is not converging: its focal length is not positive");
  EXPECT_EQ(error_of("100 1 1.5 50\n"), "t.pbrt:1:1: the medium behind the last element of the lens must be air");
  EXPECT_EQ(error_of(glass, R"("float focusdistance" 0)"),
            R"(t.pbrt:1:46: parameter "focusdistance" of Camera "realistic" must be above 0)");
}

}  // namespace
}  // namespace lanthorn::lens_test
