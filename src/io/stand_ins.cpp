// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/stand_ins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "io/surfaces.h"
#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

namespace {

using namespace description;

constexpr float field_of_view = 40;  // degrees

// Degrees: from +z towards +x, and above the horizon.
struct Viewpoint {
  float azimuth = 0, elevation = 15;
  const char* name = "from the front";
};
// The first is the front; the nearer to it the better.
constexpr std::array<Viewpoint, 16> viewpoints{{{0, 15, "from the front"},
                                                {45, 15, "from the front and right"},
                                                {-45, 15, "from the front and left"},
                                                {0, 40, "from the front and above"},
                                                {45, 40, "from the front, right and above"},
                                                {-45, 40, "from the front, left and above"},
                                                {90, 15, "from the right"},
                                                {-90, 15, "from the left"},
                                                {90, 40, "from the right and above"},
                                                {-90, 40, "from the left and above"},
                                                {180, 15, "from behind"},
                                                {135, 15, "from behind and right"},
                                                {-135, 15, "from behind and left"},
                                                {180, 40, "from behind and above"},
                                                {135, 40, "from behind, right and above"},
                                                {-135, 40, "from behind, left and above"}}};

struct ViewFrame {
  Direction right{1, 0, 0}, up{0, 1, 0}, towards_eye{0, 0, 1};

  explicit ViewFrame(const Viewpoint& from) {
    const float a = to_radians(from.azimuth), e = to_radians(from.elevation);
    towards_eye = {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
    right = {std::cos(a), 0, -std::sin(a)};
    up = cross(towards_eye, right);
  }
};

// How much of the surfaces an eye at this viewpoint sees, in numbers of samples. A depth buffer of points, so that
// nothing has to be built. A surface that is seen at a slant counts less, and so does the back of a one-sided one.
double seen_from(const Viewpoint& viewpoint, const std::vector<Surfaces::Sample>& samples, const Point& centre,
                 float radius, const std::set<Index>& one_sided) {
  constexpr int cells = 48;
  constexpr float back_weight = 0.25f;
  const ViewFrame frame(viewpoint);
  const float distance = radius / std::sin(to_radians(field_of_view / 2));
  const Point eye = centre + distance * frame.towards_eye;
  const float cell = 2 * distance * std::tan(to_radians(field_of_view / 2)) / cells;  // at the centre's distance
  struct Projected {
    std::size_t cell = 0;
    float depth = 0;
  };
  std::vector<Projected> projected(samples.size());
  std::vector<float> nearest(cells * cells, infinity);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 p = samples[i].position - eye;
    const float depth = std::max(-dot(p, frame.towards_eye), 1e-3f * distance);
    const auto column = [&](const Direction& axis) {
      const float x = dot(p, axis) * distance / depth / cell + 0.5f * cells;
      return static_cast<std::size_t>(std::clamp(x, 0.0f, cells - 1.0f));
    };
    projected[i] = {column(frame.up) * cells + column(frame.right), depth};
    nearest[projected[i].cell] = std::min(nearest[projected[i].cell], depth);
  }
  double seen = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (projected[i].depth > nearest[projected[i].cell] + 1.5f * cell) continue;
    const float cosine = dot(normalize(eye - samples[i].position), samples[i].normal);
    const bool is_back = cosine < 0 && one_sided.count(samples[i].material) > 0;
    seen += static_cast<double>(std::min(1.0f, 2 * std::fabs(cosine)) * (is_back ? back_weight : 1));
  }
  return seen;
}

Viewpoint best_viewpoint(const SceneDescription& scene, const std::set<Index>& one_sided) {
  constexpr std::size_t count = std::size_t{1} << 15;
  constexpr double much_more = 1.6, more = 1.15;
  const std::vector<Surfaces::Sample> samples = Surfaces(scene).samples(count);
  Bounds bounds;
  for (const Surfaces::Sample& s : samples) bounds.extend(s.position);
  const float radius = 0.5f * std::sqrt(length_squared(bounds.extent()));
  constexpr float largest = 1e18f;  // squares of distances must fit into floats
  if (samples.empty() || !(radius > 0) || !(radius < largest)) return viewpoints[0];
  const auto seen = [&](const Viewpoint& v) { return seen_from(v, samples, bounds.centre(), radius, one_sided); };
  double most = much_more * seen(viewpoints[0]);
  Viewpoint best = viewpoints[0];
  for (const Viewpoint& candidate : viewpoints)
    if (const double amount = seen(candidate); amount > most) {
      most = more * amount;
      best = candidate;
    }
  return best;
}

// Returns the name of the camera's direction.
const char* add_camera(SceneDescription& scene, const std::set<Index>& one_sided) {
  const Viewpoint viewpoint = best_viewpoint(scene, one_sided);
  const ViewFrame frame(viewpoint);
  // World space is right-handed, camera space left-handed: x runs to the right of the picture in both.
  const Transform to_world(
      Mat4(glm::vec4(frame.right, 0), glm::vec4(frame.up, 0), glm::vec4(-frame.towards_eye, 0), glm::vec4(0, 0, 0, 1)));
  Camera& camera = scene.view.camera;
  camera.node = PerspectiveCamera{.fov = field_of_view};
  camera.camera_to_world = AnimatedTransform(to_world);
  camera.subject = bounds_of(scene, to_world.inverted());
  if (camera.subject->empty() || !std::isfinite(length_squared(camera.subject->extent())))
    camera.subject = Bounds{Point(-1), Point(1)};
  camera.location.file = scene.filename;
  return viewpoint.name;
}

// A lamp of the studio. Degrees: from the camera towards the picture's right, above the horizon, and half its width.
struct SoftLamp {
  float azimuth, elevation, half_width;
  float radiance;
};
// Key, fill and rim light. A white wall that faces the camera has about radiance 1.
constexpr std::array<SoftLamp, 3> soft_lamps{{{-45, 45, 30, 2.2f}, {65, 20, 38, 0.6f}, {160, 50, 26, 2.0f}}};

float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

// Space of the studio: x towards the camera, y to the right of the picture, z up.
float studio_radiance(const Direction& d) {
  constexpr float below = 0.12f, horizon = 0.34f, above = 0.25f;
  float radiance = lerp(std::sqrt(std::fabs(d.z)), horizon, d.z > 0 ? above : below);
  for (const SoftLamp& lamp : soft_lamps) {
    const float a = to_radians(lamp.azimuth), e = to_radians(lamp.elevation);
    const Direction axis(std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e));
    const float inner = std::cos(to_radians(0.6f * lamp.half_width)),
                outer = std::cos(to_radians(1.2f * lamp.half_width));
    radiance += lamp.radiance * smooth_step(outer, inner, dot(d, axis));
  }
  return radiance;
}

void add_studio(SceneDescription& scene) {
  constexpr int width = 256, height = width / 2;
  const auto texels = static_cast<std::size_t>(width) * height;
  InfiniteLight studio;
  studio.texels = SphericalTexels{width, height, {}};
  studio.texels->rows.reserve(texels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float phi = 2 * pi * (static_cast<float>(x) + 0.5f) / width;
      const float theta = pi * (static_cast<float>(y) + 0.5f) / height;
      const float radiance =
          studio_radiance({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
      studio.texels->rows.push_back({radiance, radiance, radiance});
    }
  const Vec3 seen = scene.view.camera.camera_to_world.start.vector({0, 0, -1});
  const Vec3 level(seen.x, 0, seen.z);
  const Direction towards = length_squared(level) > 0 ? normalize(level) : Direction(0, 0, 1);
  Light& light = scene.lights.emplace_back();
  light.node = std::move(studio);
  light.light_to_world = Transform(Mat4(glm::vec4(towards, 0), glm::vec4(cross({0, 1, 0}, towards), 0),
                                        glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 0, 1)));
  light.location.file = scene.filename;
}

}  // namespace

bool is_lit_by(const SceneDescription& scene, std::span<const Index> lamps) {
  constexpr double least = 0.05;
  const Surfaces surfaces(scene);
  double flux = 0, dark_area = surfaces.area();
  for (const Index i : lamps) {
    const AreaLight& light = scene.area_lights[i];
    const auto* colour = std::get_if<RgbSpectrum>(&light.radiance.value);
    const Rgb radiance = light.scale * (colour != nullptr ? colour->rgb : Rgb{1, 1, 1});
    if (!(std::max({radiance.r, radiance.g, radiance.b}) > 1)) continue;
    dark_area -= surfaces.emitting_areas()[i];
    flux += static_cast<double>(luminance(radiance)) * surfaces.emitting_areas()[i];
  }
  return dark_area > 0 && flux > least * dark_area;
}

void add_stand_ins(SceneDescription& scene, const StandIns& lacking) {
  scene.view.film.measures_exposure = !lacking.light;
  if (!lacking.camera && !lacking.light) return;
  const std::string view =
      lacking.camera ? std::string("a view of all of it ") + add_camera(scene, lacking.one_sided) : "";
  if (lacking.light) add_studio(scene);
  const std::string studio = "a studio of three soft lamps";
  Warning& warning = scene.warnings.emplace_back();
  warning.location.file = scene.filename;
  const std::string no_camera =
      lacking.has_blind_camera ? "the file has no camera that sees anything" : "the file has no camera";
  if (!lacking.light)
    warning.message = no_camera + ": " + view + " stands in";
  else if (!lacking.camera)
    warning.message = "the file has no light: " + studio + " stands in";
  else
    warning.message = no_camera + " and no light: " + view + ", in " + studio + ", stands in";
}

}  // namespace lanthorn
