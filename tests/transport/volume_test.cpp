// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photons in media: each estimator against known integrals, against path tracing, and, where path tracing finds
// nothing, against light tracing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "integrators/progressive.h"
#include "integrators/vcm/merge_radii.h"
#include "lanthorn/error.h"
#include "lanthorn/photons.h"
#include "math/sampling.h"
#include "path/walk.h"
#include "photon/media/volume_gather.h"
#include "photon/media/volume_radius.h"
#include "support/runs.h"
#include "support/shapes.h"
#include "support/temporary_dir.h"
#include "support/vdb_file.h"

namespace lanthorn::volume_test {
namespace {

const std::map<std::string, VolumeEstimator> estimators{{"point", VolumeEstimator::point},
                                                        {"beam", VolumeEstimator::beam},
                                                        {"photon-beam", VolumeEstimator::photon_beam},
                                                        {"beams", VolumeEstimator::beams},
                                                        {"short-photon-beam", VolumeEstimator::short_photon_beam},
                                                        {"short-beams", VolumeEstimator::short_beams}};

class Volume : public testing::TestWithParam<std::string> {
 protected:
  static VolumeEstimator estimator() { return estimators.at(GetParam()); }
  static void expect_point_light();
};

// Sums up the light gathered until the eye path's first scattering.
struct FirstFlight {
  const PathContext& path;
  const VolumeGather& gather;
  double& sum;

  void operator()(const FlownSegment& flight) const {
    if (flight.state.medium != MediumId::vacuum) add(gather.along(path, flight));
  }
  Continuation operator()(const MediumVertex& vertex) const {
    add(gather.at(path, vertex));
    return Continuation::stop();
  }
  Continuation operator()(const SurfaceVertex&) const { return Continuation::stop(); }
  void operator()(const EscapeVertex&) const {}

  void add(const GatheredLight& light) const { sum += static_cast<double>((light.caustic + light.indirect)[1]); }
};

// Green light that photons of depth 1 bring to rays, per run. `ray_of` makes a ray from random numbers, in `medium`.
template <class RayOf>
test::Mean single_scattering(const Scene& scene, VolumeEstimator estimator, MediumId medium, float radius,
                             RayOf&& ray_of) {
  constexpr int runs = 16;
  const std::uint32_t rays = records_for(estimator) == MediumRecords::short_beams ? 512 : 128;
  const Wavelengths w = Wavelengths::rgb(0.5f);
  const PassDraw draw{0, 0, w};
  test::Mean mean;
  for (std::uint32_t run = 0; run < runs; ++run) {
    PhotonTracer tracer;
    tracer.trace(scene, {test::seed(run), Stream::light, 0, 20'000},
                 {.max_depth = 1, .media = records_for(estimator), .first_medium_depth = 1}, draw);
    const VolumeGather gather(estimator, {KernelShape::epanechnikov}, radius, tracer.medium_chunks(), ColorMode::rgb);
    HashRng rng(test::seed(run));
    double sum = 0;
    for (std::uint32_t ray = 0; ray < rays; ++ray) {
      Sampler sampler = Sampler::for_pixel(test::seed(run), Stream::camera, ray, 0);
      RayCounts counts;
      const PathContext path{scene, w, sampler, counts, {1, 2}};
      walk_from_camera(path, CameraRay{ray_of(rng)}, medium, FirstFlight{path, gather, sum});
    }
    mean.add(sum / rays);
  }
  return mean;
}

template <class Integrand>
double integral(double length, Integrand&& at) {
  constexpr int steps = 10'000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += length / steps * at(length * (i + 0.5) / steps);
  return sum;
}

double radius_for(VolumeEstimator estimator) {
  if (estimator == VolumeEstimator::short_photon_beam) return 0.15;
  return kernel_dimensions(estimator) == 3 ? 0.2 : 0.1;
}

// A point light in fog, and rays that pass it at a distance of 1 m: the integral of
// sigma_s p(cos) I / d² exp(-sigma_t (t + d)).
void Volume::expect_point_light() {
  const double sigma_s = 0.5, sigma_t = 0.7, g = 0.3, intensity = 2, half = 1.5;
  const Scene scene = test::scene_from_text(
      R"(WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0.9 0.2 0] "rgb sigma_s" [0.1 0.5 1] "float g" 0.3
AttributeBegin MediumInterface "" "fog" LightSource "point" "rgb I" [2 2 2] AttributeEnd
MediumInterface "fog" "" Material "interface" Shape "sphere" "float radius" 2.5
Material "diffuse" Shape "sphere" "float radius" 9
)");
  const test::Mean found = single_scattering(
      scene, estimator(), MediumId{1}, static_cast<float>(radius_for(estimator())), [&](HashRng& rng) {
        const Direction d = sample_uniform_sphere(rng.next2());
        const float angle = 2 * pi * rng.next();
        const Vec3 aside = Frame(d).to_world({std::cos(angle), std::sin(angle), 0});
        return Ray{aside - static_cast<float>(half) * d, d};
      });
  const double to_edge = half + std::sqrt(2.5 * 2.5 - 1);
  const double share = static_cast<double>(gather_probability(HenyeyGreenstein{0.3f}));
  const double expected = integral(to_edge, [&](double t) {
    const double along = t - half, d2 = 1 + along * along, d = std::sqrt(d2);
    // Light travels along (aside + along d) / d, and on towards the eye along -d.
    const double cosine = -along / d, base = 1 + g * g - 2 * g * cosine;
    const double phase = (1 - g * g) / (4 * std::numbers::pi * base * std::sqrt(base));
    return sigma_s * phase * intensity / d2 * std::exp(-sigma_t * (t + d));
  });
  EXPECT_LT(share, 1);
  EXPECT_TRUE(test::runs_agree(found, share * expected, 0.02, 0.25)) << GetParam();
}

TEST_P(Volume, PointLight) { expect_point_light(); }

// Coefficients differ by colour, so the flux that passes a point is weighted.
class ShortBeams : public Volume {};
TEST_P(ShortBeams, PointLight) { expect_point_light(); }
INSTANTIATE_TEST_SUITE_P(Estimators, ShortBeams, testing::Values("short-photon-beam", "short-beams"),
                         [](const auto& c) { return test::identifier(c.param); });

// Collimated light enters a box of fog on a grid with density 2 in the lower half; rays cross the upper half, with
// density 1: sigma_s / (4 pi) E exp(-sigma_t (depth + t)).
TEST_P(Volume, CollimatedLightOnAGrid) {
  const double sigma_s = 0.6, sigma_t = 0.8, irradiance = 3;
  const Scene scene = test::scene_from_text(
      R"(WorldBegin
MakeNamedMedium "fog" "string type" "uniformgrid" "rgb sigma_a" [0.1 0.2 0.3] "rgb sigma_s" [0.8 0.6 0.4] "point3 p0" [-2 -3 -2] "point3 p1" [2 3 2] "integer nx" 1 "integer ny" 6 "integer nz" 1 "float density" [2 2 2 1 1 1]
LightSource "distant" "point3 from" [0 1 0] "point3 to" [0 0 0] "rgb L" [3 3 3]
MediumInterface "fog" "" Material "interface"
)" + test::patch("-1 1 1  1 1 1  -1 1 -1  1 1 -1") +
      R"(Material "diffuse"
)" + test::patch("-1 -1 1  1 -1 1  -1 -1 -1  1 -1 -1") +
      test::patch("-1 -1 1  -1 1 1  -1 -1 -1  -1 1 -1") + test::patch("1 -1 1  1 1 1  1 -1 -1  1 1 -1"));
  const test::Mean found =
      single_scattering(scene, estimator(), MediumId{1}, static_cast<float>(radius_for(estimator())), [](HashRng& rng) {
        return Ray{{-0.999f, 0.5f, rng.next() - 0.5f}, {1, 0, 0}};
      });
  const double expected = integral(
      2, [&](double t) { return sigma_s / (4 * std::numbers::pi) * irradiance * std::exp(-sigma_t * (0.5 + t)); });
  EXPECT_TRUE(test::runs_agree(found, expected, 0.03, 0.25)) << GetParam();
}

// The same light enters a layer of thin fog, 1 m deep, on a floor; rays pass it at 60° to the normal: kernels are wide
// enough to be partly outside at both ends of the rays. With ends perpendicular to the rays, an eighth would be
// missing.
TEST(VolumeMethods, BeamsEndAtThePlanesOfSurfaces) {
  const double sigma_s = 0.27, sigma_t = 0.3, irradiance = 3, cosine = 0.5;
  const Scene scene = test::scene_from_text(
      R"(WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0.03 0.03 0.03] "rgb sigma_s" [0.27 0.27 0.27]
LightSource "distant" "point3 from" [0 1 0] "point3 to" [0 0 0] "rgb L" [3 3 3]
MediumInterface "fog" "" Material "interface"
)" + test::patch("-1.6 1 1  1.6 1 1  -1.6 1 -1  1.6 1 -1") +
      R"(Material "diffuse"
)" + test::patch("-1.6 0 1  1.6 0 1  -1.6 0 -1  1.6 0 -1"));
  const test::Mean found = single_scattering(scene, VolumeEstimator::beam, MediumId::vacuum, 0.4f, [&](HashRng& rng) {
    return Ray{{-1.5f, 1.3f, rng.next() - 0.5f}, {std::sqrt(0.75f), -0.5f, 0}};
  });
  const double expected = integral(1 / cosine, [&](double t) {
    return sigma_s / (4 * std::numbers::pi) * irradiance * std::exp(-sigma_t * (cosine * t + t));
  });
  EXPECT_TRUE(test::runs_agree(found, expected, 0.02, 0.15));
}

// A thin beam of light along the z axis of unbounded fog, seen `aside` metres off the axis: at points, or along rays
// that pass there after `start` metres.
struct ThinBeam {
  static constexpr float aside = 0.6f, start = 2;

  static Scene scene() {
    return test::scene_from_text(
        R"(MediumInterface "" "fog"
Camera "perspective"
WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0.1 0.1 0.1] "rgb sigma_s" [0.4 0.4 0.4]
MediumInterface "" "fog"
LightSource "spot" "rgb I" [1000 1000 1000] "point3 from" [0 0 0] "point3 to" [0 0 1] "float coneangle" 1 "float conedeltaangle" 0.001
)");
  }
};

// Estimates of one pass, in medium 1, at positions `i`.
class PassEstimates {
 public:
  PassEstimates(const Scene& scene, const RenderPlan& plan, PassPhotonSource& source, std::uint32_t pass)
      : scene_(scene),
        seed_(plan.settings.seed),
        estimator_(source.volume()),
        pass_(pass),
        photons_(source.trace(plan.job(scene), pass, FluxClasses{}, 1, [](Phase) {})) {}

  // At the position, or along the way by which an eye path arrives there after `start` metres and continues.
  double at(std::uint32_t i, const Point& place, const Direction& along, float start) const {
    constexpr float reach = 10;
    Sampler sampler = Sampler::for_pixel(seed_, Stream::camera, i, pass_);
    RayCounts counts;
    const PathContext path{scene_, photons_.draw.w, sampler, counts, {2, 2}};
    WalkState state;
    state.medium = MediumId{1};
    GatheredLight light;
    if (is_at_point(estimator_)) {
      state.depth = 1;
      light = photons_.volume->at(path, {state, place, along, phase_of(scene_.medium(state.medium)), 0, true});
    } else {
      const Segment way{place - start * along, along, reach};
      light = photons_.volume->along(path, {state, way, way.length, false, Spectrum(1), 0, {}});
    }
    return static_cast<double>((light.caustic + light.indirect)[1]);
  }

 private:
  const Scene& scene_;
  std::uint64_t seed_;
  VolumeEstimator estimator_;
  std::uint32_t pass_;
  PassPhotons photons_;
};

// Renders with an estimator whose `r_i^D` shrinks with `alpha` from pass to pass.
RenderOptions shrinking(const std::string& estimator, double alpha, float radius, std::uint64_t photons) {
  RenderOptions o = test::options_for(
      fmt::format("probppm:emission=power:volume-radius={}:alpha={}:volume={}", radius, alpha, estimator), 1);
  o.color = ColorMode::rgb;
  o.max_depth = 2;
  o.photons = photons;
  return o;
}

// The exponent of a quantity, by least squares in log-log over 4, 8, 16 and 32 passes: the squares of the octaves add
// up to 5.
struct Slope {
  double exponent = 0;

  void add(std::uint32_t passes, double quantity) { exponent += (std::log2(passes) - 3.5) * std::log2(quantity) / 5; }
};

// r^D of pass i is (i - 1 + alpha) / i times that of the pass before, for each number D of dimensions. The quantity is
// the sum over N passes of (r^D)^`power`, divided by N^`norm`: -1 and 2 for the variance of the mean of N passes, 2 / D
// and 1 for its bias, which is proportional to r² for every D.
double slope_of_theory(double alpha, double power, double norm) {
  Slope slope;
  double size = 1, sum = 0;
  for (std::uint32_t n = 1; n <= 32; ++n) {
    if (n > 1) size *= (n - 1 + alpha) / n;
    sum += std::pow(size, power);
    if (n >= 4 && std::has_single_bit(n)) slope.add(n, sum / std::pow(n, norm));
  }
  return slope.exponent;
}

// Knaus & Zwicker 2011, section 5. The light is scattered twice, and the variance is measured at each position, because
// the theory assumes independent photons at one point. Directly from the lamp, stratified photons have less variance,
// the more so for larger kernels; and estimates at positions with overlapping kernels are correlated.
TEST_P(Volume, VarianceFallsAtTheRateOfItsDimensions) {
  constexpr double alpha = 0.5;
  constexpr std::uint32_t passes = 32, runs = 100, places = 12;
  const Scene scene = ThinBeam::scene();
  RenderPlan plan = test::plan_render(scene, shrinking(GetParam(), alpha, 0.4f, 1000));
  PassPhotonSource source(plan.parameters);
  source.prepare(plan.job(scene));
  std::array<std::array<test::Mean, places>, passes + 1> means{};
  for (std::uint64_t run = 0; run < runs; ++run) {
    plan.settings.seed = test::seed(run);
    std::array<double, places> sums{};
    for (std::uint32_t n = 1; n <= passes; ++n) {
      const PassEstimates estimates(scene, plan, source, n - 1);
      for (std::uint32_t i = 0; i < places; ++i) {
        const float angle = 2 * pi * static_cast<float>(i) / places;
        const Direction out(std::cos(angle), std::sin(angle), 0);
        sums[i] += estimates.at(i, ThinBeam::aside * out + Vec3(0, 0, 1.5f), {-out.y, out.x, 0}, ThinBeam::start);
        means[n][i].add(sums[i] / n);
      }
    }
  }
  Slope found;
  for (std::uint32_t n = 4; n <= passes; n *= 2) {
    double variance = 0;
    for (const test::Mean& mean : means[n]) variance += mean.squared_error();
    found.add(n, variance);
  }
  // At most 0.054 off over five seeds and four estimators, root mean square 0.025.
  EXPECT_TRUE(test::within(found.exponent, slope_of_theory(alpha, -1, 2), 0.15));
}

// A point light in unbounded isotropic fog, seen at positions 1 m away or along ways that pass there: a known integral.
// The light passes through a pane that does not bend it, as a caustic, because photons do not store light that comes
// straight.
struct LightInFog {
  static constexpr double sigma_s = 1.8, sigma_t = 2;
  static constexpr float start = 1;

  static Scene scene() {
    return test::scene_from_text(
        R"(MediumInterface "" "fog"
Camera "perspective"
WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0.2 0.2 0.2] "rgb sigma_s" [1.8 1.8 1.8]
LightSource "point" "rgb I" [1 1 1]
MediumInterface "fog" "fog"
Material "dielectric" "float eta" 1 Shape "sphere" "float radius" 0.01
)");
  }
  // Position `i` of `count`, which are spread over all directions. By symmetry, the bias is the same at each.
  static Direction place(std::uint32_t i, std::uint32_t count) {
    const float turn = static_cast<float>(i) * std::numbers::phi_v<float>;
    return sample_uniform_sphere({(static_cast<float>(i) + 0.5f) / static_cast<float>(count), turn - std::floor(turn)});
  }
  static double radiance(VolumeEstimator estimator) {
    const double evenly = 1 / (4 * std::numbers::pi);
    if (is_at_point(estimator)) return evenly * std::exp(-sigma_t);
    return integral(10, [&](double t) {
      const double d2 = 1 + sqr(t - static_cast<double>(start));
      return sigma_s * evenly / d2 * std::exp(-sigma_t * (t + std::sqrt(d2)));
    });
  }
};

// The same section: the bias of a pass is proportional to r² for any dimension, and so falls faster for fewer
// dimensions: in theory as -0.45 in three, -0.62 in two, -0.91 in one.
TEST_P(Volume, BiasFallsAtTheRateOfItsDimensions) {
  constexpr double alpha = 0.1;
  constexpr std::uint32_t passes = 32, places = 64;
  const int dimensions = kernel_dimensions(estimator());
  const std::uint64_t runs = dimensions == 1 ? 16 : 8;
  // A thousand flights are all kept, without random selection.
  const std::uint64_t photons = records_for(estimator()) == MediumRecords::points ? 4000 : 1000;
  const Scene scene = LightInFog::scene();
  RenderPlan plan = test::plan_render(scene, shrinking(GetParam(), alpha, 0.7f, photons));
  PassPhotonSource source(plan.parameters);
  source.prepare(plan.job(scene));
  std::array<test::Mean, passes + 1> means{};
  for (std::uint64_t run = 0; run < runs; ++run) {
    plan.settings.seed = test::seed(run);
    double sum = 0;
    for (std::uint32_t n = 1; n <= passes; ++n) {
      const PassEstimates estimates(scene, plan, source, n - 1);
      for (std::uint32_t i = 0; i < places; ++i) {
        const Direction out = LightInFog::place(i, places);
        const float angle = 11 * static_cast<float>(i);
        const Direction along = Frame(out).to_world({std::cos(angle), std::sin(angle), 0});
        sum += estimates.at(i, Point(out), along, LightInFog::start) / places;
      }
      means[n].add(sum / n);
    }
  }
  Slope found;
  for (std::uint32_t n = 4; n <= passes; n *= 2)
    found.add(n, std::fabs(means[n].mean() - LightInFog::radiance(estimator())));
  // Terms in r⁴ make it steeper by up to 0.05. Standard deviation over seeds: 0.015, in one dimension 0.04.
  const double limit = dimensions == 1 ? 0.3 : 0.13;
  EXPECT_TRUE(test::within(found.exponent, slope_of_theory(alpha, 2.0 / dimensions, 1), limit));
}

const std::string film =
    R"(Film "rgb" "integer xresolution" [8] "integer yresolution" [8]
PixelFilter "box" "float xradius" [0.5] "float yradius" [0.5]
)";

RenderOptions options(const std::string& integrator, std::uint64_t passes, std::uint64_t photons) {
  RenderOptions o = test::options_for(integrator, passes);
  o.color = ColorMode::rgb;
  if (photons > 0) o.photons = photons;
  for (const char* radius : {"radius", "volume-radius"})
    if (test::has_parameter(integrator, radius)) o.set[radius] = "0.05";
  if (test::has_parameter(integrator, "emission")) o.set["emission"] = "power";
  return o;
}

std::vector<Image> runs(const Scene& scene, const RenderOptions& o, std::uint64_t count, std::uint64_t first_seed) {
  return test::independent_renders(scene, o, count, first_seed);
}

// Walls that emit as much as they absorb around purely scattering fog: radiance is 1 everywhere.
TEST_P(Volume, WhiteFurnace) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 0 0.9  0 0 0  0 1 0
MediumInterface "" "fog"
Camera "perspective" "float fov" [60]
)" + film +
      R"(WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0 0 0] "rgb sigma_s" [1 1 1] "float g" [0.4]
MediumInterface "fog" "fog"
AreaLightSource "diffuse" "rgb L" [.5 .5 .5] "bool twosided" true
Material "diffuse" "rgb reflectance" [.5 .5 .5]
Shape "sphere"
)");
  RenderOptions o = options("probppm:volume=" + GetParam(), 2, 4'000);
  o.set["volume-radius"] = kernel_dimensions(estimator()) == 3 ? "0.2" : "0.1";
  o.max_depth = 100;
  const test::Mean mean = test::mean_of_means(test::select_layers(runs(scene, o, 16, 1), "color"));
  // Within a radius of the wall, part of the kernel receives no photons.
  EXPECT_TRUE(test::runs_agree(mean, 1, 0.04, 0.2));
}

// Fog in a room with a lamp: uniform and coloured, on a grid, with a narrow phase function, and inside glass.
std::string room_with(const std::string& medium, const std::string& material) {
  return R"(LookAt 0 1 3  0 0.8 0  0 1 0
Camera "perspective" "float fov" [22]
)" + film +
         "WorldBegin\n" +
         R"(AttributeBegin
Translate 0 0.8 0
MakeNamedMedium "fog" "string type" )" +
         medium +
         R"(
AttributeEnd
AttributeBegin
AreaLightSource "diffuse" "rgb L" [3 3 3]
)" + test::patch("-0.9 1.99 -0.9  0.9 1.99 -0.9  -0.9 1.99 0.9  0.9 1.99 0.9") +
         R"(AttributeEnd
Material "diffuse" "rgb reflectance" [0.7 0.7 0.7]
)" + test::patch("-1 0 1  1 0 1  -1 0 -1  1 0 -1") +
         test::patch("-1 0 -1  1 0 -1  -1 2 -1  1 2 -1") +
         R"(Translate 0 0.8 0
MediumInterface "fog" ""
Material ")" +
         material +
         R"("
Shape "sphere" "float radius" [0.7]
)";
}

struct Fog {
  const char* name;
  std::string medium, material;
  std::uint64_t passes = 4;
};
const std::vector<Fog> fogs{
    {"coloured", R"("homogeneous" "rgb sigma_a" [0.1 0.2 0.4] "rgb sigma_s" [0.3 1 2] "float g" [0.5])", "interface"},
    {"grid",
     R"("rgbgrid" "point3 p0" [-0.7 -0.7 -0.7] "point3 p1" [0.7 0.7 0.7] "integer nx" 2 "integer ny" 1 )"
     R"("integer nz" 1 "float g" -0.3 "rgb sigma_a" [0.1 0.2 0.3  0.3 0.1 0] "rgb sigma_s" [1 3 0.5  4 1 2])",
     "interface"},
    {"forward", R"("homogeneous" "rgb sigma_a" [0.1 0.2 0.4] "rgb sigma_s" [2 2 1] "float g" [0.9])", "interface", 48},
    {"in glass", R"("homogeneous" "rgb sigma_a" [0.1 0.2 0.4] "rgb sigma_s" [1 2 1])", "dielectric"}};

/// By t-tests of the whole picture; `checks` is their number in a test. Radii of 5 cm blur.
::testing::AssertionResult agree(const std::vector<Image>& found, const std::vector<Image>& expected, int checks) {
  const auto mean = [](const std::vector<Image>& images) {
    return test::mean_of_means(test::select_layers(images, "color"));
  };
  return test::runs_agree(mean(found), mean(expected), 0.02, 0.3, test::sidak(test::false_alarm_rate, checks));
}

// All of the fogs, and one from a NanoVDB file in the folder, densest at a corner and empty at the opposite one.
std::vector<Fog> fogs_and_vdb(const test::TemporaryDir& folder) {
  const auto file = folder.path() / "fog.nvdb";
  constexpr int last = 14;
  test::write_vdb(file, last, 0.1f, Point(-0.7f),
                  [](const Vec3& index) { return std::max(0.0f, (index.x + index.y + index.z) / last - 0.5f); });
  std::vector<Fog> all = fogs;
  all.push_back({"NanoVDB",
                 R"("nanovdb" "string filename" ")" + file.string() +
                     R"(" "rgb sigma_a" [0.1 0.2 0.3] "rgb sigma_s" [1 2 3] "float g" [0.3])",
                 "interface"});
  return all;
}

TEST_P(Volume, AgreesWithPathTracing) {
  const test::TemporaryDir folder;
  for (const Fog& fog : fogs_and_vdb(folder)) {
    const Scene scene = test::scene_from_text(room_with(fog.medium, fog.material));
    RenderOptions path = options("path", 16, 0), photons = options("probppm:volume=" + GetParam(), fog.passes, 3'000);
    path.max_depth = photons.max_depth = 8;
    if (kernel_dimensions(estimator()) == 3) photons.set["volume-radius"] = "0.1";
    if (records_for(estimator()) == MediumRecords::beams)
      photons.passes = 3 * fog.passes;  // with fewer light paths each
    EXPECT_TRUE(agree(runs(scene, photons, 16, 200), runs(scene, path, 16, 100), 5)) << fog.name;
  }
}

// A glass ball under a point light casts a shaft of light into fog, which only light tracing finds, not eye paths.
Scene shaft() {
  return test::scene_from_text(
      R"(LookAt 0 0 4  0 0 0  0 1 0
Camera "perspective" "float fov" [26]
)" + film +
      R"(WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0.2 0.2 0.2] "rgb sigma_s" [0.5 1 1.5] "float g" -0.4
LightSource "point" "point3 from" [0 3 0] "rgb I" [5 5 5]
AttributeBegin MediumInterface "fog" "" Material "interface" Shape "sphere" AttributeEnd
Material "dielectric" Translate 0 1.7 0 Shape "sphere" "float radius" .5
)");
}

void expect_shaft(const Scene& scene, RenderOptions photons) {
  RenderOptions light = options("light", 2, 20'000);
  light.max_depth = photons.max_depth = 4;
  const std::vector<Image> expected = runs(scene, light, 16, 300), found = runs(scene, photons, 16, 400);
  for (const char* layer : {"color", "caustic"}) {
    const std::vector<Image> a = test::select_layers(found, layer), b = test::select_layers(expected, layer);
    EXPECT_TRUE(test::tiles_agree(a, b, test::false_alarm_rate / 4)) << layer;
    EXPECT_TRUE(test::runs_agree(test::mean_of_means(a), test::mean_of_means(b), 0.01, 0.4, test::false_alarm_rate / 4))
        << layer;
  }
}

TEST_P(Volume, CausticOfAPointLight) {
  RenderOptions photons = options("probppm:volume=" + GetParam(), 16, 10'000);
  if (kernel_dimensions(estimator()) == 3) photons.set["volume-radius"] = "0.1";
  if (estimator() == VolumeEstimator::point) photons.passes = 128;
  if (estimator() == VolumeEstimator::photon_beam) photons.passes = 512;
  expect_shaft(shaft(), photons);
}

// Merging in media, by each estimator and by all with combined weights, alone and with connections.
class MergingInMedia : public testing::TestWithParam<std::string> {
 protected:
  static RenderOptions merging(std::uint64_t passes, std::uint64_t photons) {
    RenderOptions o = options(GetParam(), passes, photons);
    if (GetParam().ends_with("point")) o.set["volume-radius"] = "0.1";
    return o;
  }
};

TEST_P(MergingInMedia, AgreeWithPathTracing) {
  const test::TemporaryDir folder;
  for (const Fog& fog : fogs_and_vdb(folder)) {
    const Scene scene = test::scene_from_text(room_with(fog.medium, fog.material));
    RenderOptions path = options("path", 16, 0), merged = merging(4, 3'000);
    path.max_depth = merged.max_depth = 8;
    EXPECT_TRUE(agree(runs(scene, merged, 16, 200), runs(scene, path, 16, 100), 5)) << fog.name;
  }
}

TEST_P(MergingInMedia, CausticOfAPointLight) {
  std::uint64_t passes = 16;
  if (GetParam().ends_with("point")) passes = 128;
  if (GetParam().ends_with("photon-beam")) passes = 256;
  expect_shaft(shaft(), merging(passes, 5'000));
}

// Thin fog in a ball, with kernels of .3 of its radius: a spot light illuminates it, via clear glass for photons, so
// that nothing else finds its light. Cylinders with ends perpendicular to the eye's rays would lie outside by .12 of
// their volume; cylinders that end at tangent planes do so by .05.
TEST(VolumeMethods, LightReachesTheBoundaryOfAMedium) {
  const auto scene_with = [](const std::string& around_light) {
    return test::scene_from_text(
        R"(LookAt 0 0 4  0 0 0  0 1 0
Camera "perspective" "float fov" [30]
Film "rgb" "integer xresolution" [32] "integer yresolution" [32]
WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0 0 0] "rgb sigma_s" [0.05 0.05 0.05]
AttributeBegin Translate 0 3 0
LightSource "spot" "rgb I" [9 9 9] "point3 from" [0 0 0] "point3 to" [0 -1 0] "float coneangle" 25 "float conedeltaangle" 1
)" + around_light +
        R"(AttributeEnd
MediumInterface "fog" "" Material "interface" Shape "sphere"
)");
  };
  RenderOptions path = options("path", 32, 0);
  path.max_depth = 4;
  const test::Mean expected = test::mean_of_means(test::select_layers(runs(scene_with(""), path, 16, 500), "color"));
  const Scene scene = scene_with(R"(Material "dielectric" "float eta" 1 Shape "sphere" "float radius" .1
)");
  for (const std::string method : {"vcm", "probppm"}) {
    RenderOptions photons = options(method, 2, 60'000);
    photons.max_depth = 8;
    photons.set["volume-radius"] = "0.3";
    const test::Mean found = test::mean_of_means(test::select_layers(runs(scene, photons, 32, 600), "color"));
    EXPECT_TRUE(test::runs_agree(found, expected.mean(), 0.065, 0.03)) << method;
  }
}

// Far from the origin, where the first tenths of a millimetre of rays are lost to rounding.
TEST(VolumeMethods, WeightsAreFiniteAtTheLens) {
  const Scene scene = test::scene_from_text(
      R"(Translate -10000 -10000 -10000
MediumInterface "" "fog"
Camera "perspective"
)" + film +
      R"(WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0 0 0] "rgb sigma_s" [1 1 1]
Translate 10000 10000 10000
AttributeBegin MediumInterface "" "fog" LightSource "point" "point3 from" [0 0.5 0] AttributeEnd
MediumInterface "fog" "" Material "interface" Shape "sphere"
)");
  for (const char* integrator : {"bdpt", "vcm", "auto", "vcm:volume=point+beam+photon-beam+beams"}) {
    RenderOptions o = options(integrator, 2, 20'000);
    if (test::has_parameter(integrator, "volume-radius")) o.set["volume-radius"] = "0.3";
    EXPECT_TRUE(test::render_state(scene, o).film.report().clean()) << integrator;
  }
}

// Forward-scattering fog: merging has part of its weight at all vertices of eye paths and light paths.
TEST(VolumeMethods, WeightsInForwardFogSumToOne) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 0 4  0 0 0  0 1 0
Camera "perspective" "float fov" [24]
)" + film +
      R"(WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0 0 0] "rgb sigma_s" [4 4 4] "float g" 0.9
LightSource "distant" "point3 from" [0 1 -0.5]
MediumInterface "fog" "" Material "interface" Shape "sphere"
)");
  const auto mean_of = [&](const char* integrator, std::uint64_t passes, std::uint64_t first_seed) {
    RenderOptions o = options(integrator, passes, 2'000);
    o.max_depth = 5;
    return test::mean_of_means(test::select_layers(runs(scene, o, 32, first_seed), "color"));
  };
  EXPECT_TRUE(test::runs_agree(mean_of("vcm", 24, 200), mean_of("path", 256, 100), 0.002, 0.05));
}

// A ball of fog in a spot light lights a wall, visible in a glossy plate; a screen hides the ball from the plate. Eye
// paths are coherent up to the wall and not beyond, so merging in the ball has no weight there, however large kernels
// are: the picture comes from connections alone, and the connections of plate and wall must know how the wall scatters.
TEST(VolumeMethods, MergingBehindAWallDoesNotCount) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 3 0 -4  0 0 0  0 1 0
Camera "perspective" "float fov" [3]
)" + film +
      R"(WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0 0 0] "rgb sigma_s" [0.5 0.5 0.5]
LightSource "spot" "rgb I" [1e6 1e6 1e6] "point3 from" [-2 1.5 -7.6] "point3 to" [-6 1.5 -7.6] "float coneangle" [5]
Material "diffuse" "rgb reflectance" [0.8 0.8 0.8]
)" + test::patch("-10 -2 -8  -2 -2 -8  -10 3 -8  -2 3 -8") +
      R"(AttributeBegin Material "diffuse" "rgb reflectance" [0 0 0]
Shape "bilinearmesh" "point3 P" [-10 0.8 -7  -2 0.8 -7  -10 3 -7  -2 3 -7] AttributeEnd
AttributeBegin Material "conductor" "rgb reflectance" [0.9 0.9 0.9] "float roughness" [0.25] "bool remaproughness" false
Shape "bilinearmesh" "point3 P" [-0.5 -0.5 0  0.5 -0.5 0  -0.5 0.5 0  0.5 0.5 0] AttributeEnd
MediumInterface "fog" "" Material "interface"
Translate -6 1.5 -7.6 Shape "sphere" "float radius" [0.35]
)");
  const auto mean_of = [&](const char* integrator) {
    RenderOptions o = options(integrator, 4, 2'000);
    o.set["radius"] = "0.001";
    o.set["volume-radius"] = "0.3";
    o.max_depth = 4;
    return test::mean_of_means(test::select_layers(runs(scene, o, 8, 1), "color")).mean();
  };
  const double expected = mean_of("vcm:volume=path");
  EXPECT_GT(expected, 0.1);
  EXPECT_NEAR(mean_of("vcm:volume=point+beam+photon-beam+beams"), expected, 1e-5 * expected);
}

// Mean over all values of the variance between runs.
double variance_of(const std::vector<Image>& images) {
  const std::size_t count = images[0].pixels.size();
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    test::Mean mean;
    for (const Image& image : images) mean.add(static_cast<double>(image.pixels[i]));
    sum += mean.squared_error() * static_cast<double>(images.size()) / static_cast<double>(count);
  }
  return sum;
}

// Beyond walls and fog, eye paths have spread, and many photons merged with one of them are no better than one. Merging
// with weights that ignore this had 1.7 times the variance of connections here.
TEST(VolumeMethods, MergingDoesNotAddNoise) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 1 5.5  0 1 0  0 1 0
MediumInterface "" "fog"
Camera "perspective" "float fov" [22]
)" + film +
      R"(WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0 0 0] "rgb sigma_s" [0.8 0.8 0.8]
MediumInterface "" "fog"
AttributeBegin
AreaLightSource "diffuse" "rgb L" [30 30 30]
)" + test::patch("-0.2 1.9 -0.2  0.2 1.9 -0.2  -0.2 1.9 0.2  0.2 1.9 0.2") +
      R"(AttributeEnd
Material "diffuse" "rgb reflectance" [0.7 0.7 0.7]
MediumInterface "fog" ""
Translate 0 1 0
Shape "sphere" "float radius" [5.7]
)");
  const auto variance = [&](const char* integrator) {
    RenderOptions o = options(integrator, 1, 3'000);
    o.set["volume-radius"] = "0.15";
    o.max_depth = 8;
    return variance_of(test::select_layers(runs(scene, o, 32, 1), "color"));
  };
  EXPECT_LT(variance("vcm:volume=beam"), 0.6 * variance("vcm:volume=path"));
}

// The radii of five pilots, in ascending order, in a ball of fog around the eye, lit by this light.
std::array<float, 5> radii_in_fog(VolumeEstimator estimator, const std::string& light, int first_depth) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 0 -3.5  0 0 0  0 1 0
MediumInterface "" "fog"
Camera "perspective" "float fov" [50]
Film "rgb" "integer xresolution" [128] "integer yresolution" [128]
WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0 0 0] "rgb sigma_s" [.2 .2 .2]
MediumInterface "fog" "fog"
LightSource )" +
      light + R"(
Material "diffuse" "rgb reflectance" [0 0 0]
Shape "sphere" "float radius" [4]
)");
  std::array<float, 5> radii{};
  for (std::size_t i = 0; i < radii.size(); ++i) {
    RenderOptions o = test::options_for("probppm", 1, 20 + i);
    o.photons = 10'000;
    const RenderPlan plan = test::plan_render(scene, o);
    radii[i] = first_volume_radius(plan.job(scene), estimator, {}, {KernelShape::epanechnikov}, nullptr, first_depth);
  }
  std::sort(radii.begin(), radii.end());
  return radii;
}
// The median in a beam of this half angle (degrees), where the eye sees it, 3.5 m from its source.
double radius_in_beam(VolumeEstimator estimator, double angle) {
  const std::string light = fmt::format(
      R"("spot" "point3 from" [-3.5 0 0] "point3 to" [0 0 0] "float coneangle" [{}] "float conedeltaangle" [{}])",
      angle, angle / 8);
  return static_cast<double>(radii_in_fog(estimator, light, 1)[2]);
}

// At most as wide as the beam, so that it is not lost, but not so narrow that it adds unnecessary noise.
TEST(NightlyVolumeMethods, RadiusKnowsTheScaleOfDetail) {
  for (const double angle : {0.5, 1.0, 2.0, 4.0}) {
    const double width = 2 * 3.5 * std::tan(angle * std::numbers::pi / 180);
    const double radius = radius_in_beam(VolumeEstimator::beam, angle);
    EXPECT_LT(radius, width) << angle;
    EXPECT_GT(radius, width / 8) << angle;
    if (angle < 1) continue;
    for (const VolumeEstimator crossed : {VolumeEstimator::beams, VolumeEstimator::short_beams})
      EXPECT_LT(radius_in_beam(crossed, angle), width) << angle;
  }
  EXPECT_GT(radius_in_beam(VolumeEstimator::beam, 40), 0.08);
}

// Photons near the eye, which are visible all over the picture, do not determine the radius.
TEST(VolumeMethods, RadiusIsThatOfAnySeed) {
  const std::array<float, 5> radii = radii_in_fog(VolumeEstimator::beam, R"("point" "point3 from" [0 3 0])", 2);
  EXPECT_LT(radii.back(), 1.5f * radii.front());
}

// Merging's own schedule: kernel sizes shrink equally in all dimensions.
TEST(VolumeMethods, KernelsOfMergesShrinkAlike) {
  const Scene scene = test::scene_from_text(room_with(fogs[0].medium, fogs[0].material));
  const RenderPlan plan =
      test::plan_render(scene, test::options_for("vcm:volume=point+beam+photon-beam+beams:volume-radius=0.2", 1));
  const FirstVolumeRadii radii(plan.job(scene), VcmSettings(plan.parameters, {}), nullptr);
  const auto kernels = [&](std::uint32_t pass) { return radii.kernels(pass); };
  const VolumeMerging first = kernels(0).merging(1, 1), later = kernels(6).merging(1, 1);
  const double shrunk = RadiusSchedule{1, 2.0 / 3}.shrink2(6);
  for (const auto size :
       {&VolumeMerging::point, &VolumeMerging::beam, &VolumeMerging::photon_beam, &VolumeMerging::beams})
    EXPECT_NEAR(static_cast<double>(later.*size / first.*size), shrunk, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Methods, MergingInMedia,
                         testing::Values("vcm", "bpm", "vcm:volume=point+beam",
                                         "vcm:volume=point+beam+photon-beam+beams",
                                         "bpm:volume=point+beam+photon-beam+beams", "bpm:volume=point",
                                         "bpm:volume=photon-beam", "bpm:volume=beams"),
                         [](const auto& c) { return test::identifier(c.param); });

// The other methods that gather in media, with their own terms and shortcuts.
TEST(VolumeMethods, AgreeWithPathTracing) {
  const Scene scene = test::scene_from_text(room_with(fogs[0].medium, fogs[0].material));
  RenderOptions path = options("path", 16, 0);
  path.max_depth = 3;
  const std::vector<Image> expected = runs(scene, path, 16, 100);
  for (const char* integrator : {"sppm", "ppm:volume=beams", "photonmap:gather=4", "reversephotonmap:gather=4",
                                 "photonmap:final-gather=cached:cache-rays=64:volume=photon-beam",
                                 "probppm:volume=short-beams", "sppm:volume=short-photon-beam"}) {
    RenderOptions photons = options(integrator, 3, 3'000);
    photons.max_depth = 3;
    EXPECT_TRUE(agree(runs(scene, photons, 16, 200), expected, 7)) << integrator;
  }
}

// A ball of white fog, ten mean free paths in radius, lit from the side: its light falls off within a mean free path,
// and kernels wider than that lost up to a quarter of it.
TEST(VolumeMethods, DenseFogLitFromTheSide) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 0 -25  0 0 0  0 1 0
Camera "perspective" "float fov" 50
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [1 1 1] "rgb sigma_a" [0 0 0]
LightSource "point" "rgb I" [1000 1000 1000] "point3 from" [-20 10 -20]
MediumInterface "fog" "" Material "interface" Shape "sphere" "float radius" 10
)");
  const auto mean_by = [&](const std::string& integrator, std::uint64_t passes, std::uint64_t seed) {
    RenderOptions o = options(integrator, passes, 20'000);
    o.max_depth = 200;
    return test::mean_of_means(test::select_layers(runs(scene, o, 16, seed), "color"));
  };
  const test::Mean expected = mean_by("path", 64, 100);
  for (const char* integrator : {"vcm", "vcm:volume=point"})
    EXPECT_TRUE(test::runs_agree(mean_by(integrator, 24, 200), expected, .02, .1)) << integrator;
}

// White fog, in which each light path leaves many photons.
Scene milk() {
  return test::scene_from_text(film +
                               R"(WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0 0 0] "rgb sigma_s" [9 9 9]
AttributeBegin MediumInterface "" "fog" LightSource "point" AttributeEnd
MediumInterface "fog" "" Material "interface" Shape "sphere"
)");
}

TEST(VolumeMethods, MemoryForPhotonsInMediaIsBounded) {
  const Scene scene = milk();
  for (const char* integrator : {"probppm", "sppm:volume=beams", "photonmap"}) {
    RenderOptions o = options(integrator, 1, 20'000);
    o.memory = 40'000'000;
    EXPECT_THROW(test::plan_render(scene, o), Error) << integrator;
    o.set["volume"] = "path";
    EXPECT_NO_THROW(test::plan_render(scene, o)) << integrator;
  }
}

// Writes the photons that are stored for the point estimators, without normals; on request also photons that come
// straight from the light.
TEST(VolumeMethods, PhotonsAreWrittenFromMedia) {
  const Scene scene = milk();
  const RenderOptions o = options("probppm", 1, 500);
  const Photons later = trace_photons(scene, scene.description().view, o, 0, false);
  const Photons all = trace_photons(scene, scene.description().view, o, 0, true);
  EXPECT_GT(later.size(), 1000u);
  EXPECT_NEAR(static_cast<double>(all.size() - later.size()), 500, 5) << "each path scatters at least once";
  for (const Normal& normal : all.normals) EXPECT_EQ(normal, Normal(0));
}

INSTANTIATE_TEST_SUITE_P(Estimators, Volume, testing::Values("point", "beam", "photon-beam", "beams"),
                         [](const auto& c) { return test::identifier(c.param); });

}  // namespace
}  // namespace lanthorn::volume_test
