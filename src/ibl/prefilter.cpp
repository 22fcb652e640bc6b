// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "ibl/prefilter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "ibl/cube_map.h"
#include "ibl/environment.h"
#include "ibl/point_sums.h"
#include "math/frame.h"

namespace lanthorn {

namespace {

/// Corners in the plane of a face, in units of the map's texels from the upper left corner.
using Polygon = std::vector<glm::dvec2>;

/// Clips the polygon to the half-plane sign · (coordinate - limit) >= 0 along an axis (Sutherland & Hodgman 1974).
Polygon clipped(const Polygon& polygon, int axis, double sign, double limit) {
  Polygon kept;
  const auto side = [&](const glm::dvec2& p) { return sign * (p[axis] - limit); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double from = side(a), to = side(b);
    if (from >= 0) kept.push_back(a);
    if ((from < 0) != (to < 0)) {
      glm::dvec2 crossing = a + from / (from - to) * (b - a);
      crossing[axis] = limit;  // so that a polygon that fills a texel becomes exactly the texel
      kept.push_back(crossing);
    }
  }
  return kept;
}

/// Solid angle of a polygon on a face of a map of `size`, sr: the sum over a triangle fan (Van Oosterom & Strackee
/// 1983).
double solid_angle_of(const Polygon& polygon, int size) {
  std::vector<glm::dvec3> corners;
  corners.reserve(polygon.size());
  for (const glm::dvec2& p : polygon) corners.emplace_back(2.0 / size * p - 1.0, 1.0);
  double sum = 0;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const glm::dvec3 &a = corners[0], &b = corners[i - 1], &c = corners[i];
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    // The triple product of three points at height 1.
    const double volume = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    sum += 2 * std::atan2(volume, la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return std::fabs(sum);
}

/// A rectangle of the image, in texels.
struct ImagePart {
  float x, y, width, height;
};

/// Directions along its border. Horizontal lines of equirectangular images are curves on a face.
std::vector<Direction> outline_of(const Environment& environment, const ImagePart& part) {
  constexpr int steps = 4;  // along each side
  std::vector<Direction> outline;
  const auto side = [&](float x, float y, float dx, float dy) {
    for (int i = 0; i < steps; ++i) {
      const float t = static_cast<float>(i) / steps;
      outline.push_back(
          environment.direction_at(part.x + (x + t * dx) * part.width, part.y + (y + t * dy) * part.height));
    }
  };
  side(0, 0, 1, 0);
  side(1, 0, 0, 1);
  side(1, 1, -1, 0);
  side(0, 1, 0, -1);
  return outline;
}

/// The outline projected onto the plane of a face. Empty if it is not near this face; requires a small outline.
Polygon on_face(const std::vector<Direction>& outline, int face, int size) {
  Polygon polygon;
  for (const Direction& d : outline) {
    const std::optional<Vec2> place = place_on_face(face, d);
    if (!place) return {};
    polygon.push_back(static_cast<double>(size) * glm::dvec2(*place));
  }
  return polygon;
}

/// Adds `excess` where the polygon covers the face.
void add_polygon(const Polygon& polygon, const Spectrum& excess, int face, const std::vector<float>& solid_angles,
                 CubeMap& map) {
  if (polygon.empty()) return;
  const int size = map.size();
  glm::dvec2 low(size), high(0);
  for (const glm::dvec2& p : polygon) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const auto begin = [&](double v) { return static_cast<int>(std::floor(std::max(v, 0.0))); };
  const auto end = [&](double v) { return static_cast<int>(std::ceil(std::min(v, static_cast<double>(size)))); };
  for (int y = begin(low.y); y < end(high.y); ++y) {
    const Polygon row = clipped(clipped(polygon, 1, 1, y), 1, -1, y + 1);
    for (int x = begin(low.x); x < end(high.x); ++x) {
      const double covered = solid_angle_of(clipped(clipped(row, 0, 1, x), 0, -1, x + 1), size);
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x);
      map.texel(face, x, y) += excess * (static_cast<float>(covered) / solid_angles[i]);
    }
  }
}

// Adds to each texel of an unfiltered map the excess of each sun, times the fraction of the texel's solid angle that
// the sun covers. This preserves the suns' flux, and no texel becomes brighter than the image texels that it shows.
// Does not close the seams.
void add_suns(const Environment& environment, CubeMap& map) {
  const std::vector<float> solid_angles = cube_solid_angles(map.size());
  constexpr float widest = 0.1f;  // widest part, rad
  const float texel_width = 0.5f * pi / environment.texels_per_face();
  const int parts = std::max(1, static_cast<int>(std::ceil(texel_width / widest)));
  const float step = 1 / static_cast<float>(parts);
  const auto place = [&](int texel, int part) { return static_cast<float>(texel) + static_cast<float>(part) * step; };
  for (const Environment::Sun& sun : environment.suns())
    for (int j = 0; j < parts; ++j)
      for (int i = 0; i < parts; ++i) {
        const std::vector<Direction> outline = outline_of(environment, {place(sun.x, i), place(sun.y, j), step, step});
        for (int face = 0; face < cube_faces; ++face)
          add_polygon(on_face(outline, face, map.size()), sun.excess, face, solid_angles, map);
      }
}

// The cosine n·l of the direction mirrored by a GGX normal sampled with u; its density is D n·h.
float reflected_cosine(float alpha, float u) {
  const float cos2 = (1 - u) / (1 + (alpha * alpha - 1) * u);
  return 2 * cos2 - 1;
}

// Ratio of the solid angles of the level's texel and of the sample. Twice as much blurs more than it smooths.
constexpr float footprint = 1;

struct FrameBatch {
  DirectionBatch s, t, n;
};

// Texture look-ups in a map: the first of four texels and the position between them.
struct Lookups {
  alignas(64) std::array<std::int32_t, batch_size> first{};
  alignas(64) FloatBatch x{}, y{};
};

// `cube_point` without branches: only selections between numbers, which vectorise.
struct FacePoint {
  int face;
  float s, t, major;
};
float signed_by(float sign, float value) { return sign >= 0 ? value : -value; }
FacePoint face_point(float x, float y, float z) {
  const float ax = std::fabs(x), ay = std::fabs(y), az = std::fabs(z);
  const bool is_x = ax >= ay && ax >= az, is_y = !is_x && ay >= az;
  const float along = is_x ? x : is_y ? y : z;
  const float s = is_x ? signed_by(x, -z) : is_y ? x : signed_by(z, x);
  const int axis = is_x ? 0 : is_y ? 2 : 4;
  return {axis + (along >= 0 ? 0 : 1), s, is_y ? signed_by(y, z) : -y, std::fabs(along)};
}

void locate(const CubeMap& map, const FrameBatch& frames, const Vec3& local, Lookups& out) {
  const int stride = map.stride(), face_texels = stride * stride;
  const auto scale = 0.5f * static_cast<float>(map.size());
  for (std::size_t i = 0; i < batch_size; ++i) {
    const float x = local.x * frames.s.x[i] + local.y * frames.t.x[i] + local.z * frames.n.x[i];
    const float y = local.x * frames.s.y[i] + local.y * frames.t.y[i] + local.z * frames.n.y[i];
    const float z = local.x * frames.s.z[i] + local.y * frames.t.z[i] + local.z * frames.n.z[i];
    const FacePoint p = face_point(x, y, z);
    const float per = scale / p.major;
    const float column = p.s * per + (scale + 0.5f), row = p.t * per + (scale + 0.5f);
    const int c = static_cast<int>(column), r = static_cast<int>(row);
    out.first[i] = p.face * face_texels + r * stride + c;
    out.x[i] = column - static_cast<float>(c);
    out.y[i] = row - static_cast<float>(r);
  }
}

void add_sample(const CubeMap& map, const FrameBatch& frames, const LobeSample& sample,
                std::array<Spectrum, batch_size>& sums) {
  Lookups at;
  locate(map, frames, sample.local, at);
  const auto stride = static_cast<std::ptrdiff_t>(map.stride());
  for (std::size_t i = 0; i < batch_size; ++i) {
    const Spectrum* const texels = map.data() + at.first[i];
    const float right = sample.weight * at.x[i], left = sample.weight - right, below = at.y[i], above = 1 - below;
    sums[i] += (left * above) * texels[0] + (right * above) * texels[1] + (left * below) * texels[stride] +
               (right * below) * texels[stride + 1];
  }
}

}  // namespace

// A spiral whose angle advances by the golden ratio: low discrepancy, and isotropic. The spiral's order is also the
// order of levels.
std::vector<LobeSample> sample_lobe(const Lobe& lobe, const CubePyramid& source) {
  const float alpha = lobe.alpha;
  const int count = lobe.samples;
  const float texel = 4 * pi / (cube_faces * sqr(static_cast<float>(source.front().size())));
  const int last = static_cast<int>(source.size()) - 1;
  std::vector<LobeSample> samples;
  double weight_sum = 0;
  for (int i = 0; i < count; ++i) {
    const float u = (static_cast<float>(i) + 0.5f) / static_cast<float>(count), cos = reflected_cosine(alpha, u);
    if (cos <= 0) break;
    const double turns = i / std::numbers::phi;
    const auto azimuth = static_cast<float>(2 * std::numbers::pi * (turns - std::floor(turns)));
    const float sin = safe_sqrt(1 - cos * cos), cos2 = 0.5f * (1 + cos), e = 1 + (alpha * alpha - 1) * cos2;
    const float density = alpha * alpha / (4 * pi * e * e);
    const float lod = 0.5f * std::log2(footprint / (static_cast<float>(count) * density * texel));
    samples.push_back({{sin * std::cos(azimuth), sin * std::sin(azimuth), cos},
                       lobe_weight(lobe.weight, alpha * alpha, cos),
                       std::clamp(static_cast<int>(std::lround(lod)), 0, last)});
    weight_sum += static_cast<double>(samples.back().weight);
  }
  for (LobeSample& s : samples) s.weight /= static_cast<float>(weight_sum);
  return samples;
}

// Half the kernel's width, within limits.
float sun_spacing(float alpha) { return std::clamp(0.3f * alpha, 0.006f, 0.02f); }

GgxKernel::GgxKernel(float alpha, LobeWeight weight) : weight_(weight), alpha2_(alpha * alpha), scale_(0) {
  // The integral is the mean of the weight over reflected directions.
  constexpr int steps = 4096;
  double mean = 0;
  for (int i = 0; i < steps; ++i) {
    const float cos = reflected_cosine(alpha, (static_cast<float>(i) + 0.5f) / steps);
    if (cos > 0) mean += static_cast<double>(lobe_weight(weight, alpha2_, cos)) / steps;
  }
  scale_ = static_cast<float>(static_cast<double>(alpha2_) / (4 * std::numbers::pi * mean));
}

CubeMap mirror_level(const CubePyramid& source, const Environment& environment, int size) {
  const auto level = std::find_if(source.begin(), source.end(), [&](const CubeMap& map) { return map.size() == size; });
  CubeMap map = *level;
  add_suns(environment, map);
  map.close_seams();
  return map;
}

CubeMap prefilter(const CubePyramid& source, const Environment& environment, const Lobe& lobe, int size) {
  const std::vector<LobeSample> samples = sample_lobe(lobe, source);
  const std::vector<PointFlux> suns = environment.sun_points(sun_spacing(lobe.alpha));
  const GgxKernel kernel(lobe.alpha, lobe.weight);
  CubeMap map(size);
  for_texel_batches(map, [&](const DirectionBatch& at, auto&& store) {
    FrameBatch frames;
    for (std::size_t i = 0; i < batch_size; ++i) {
      const Frame frame(at[i]);
      frames.s.set(i, frame.s);
      frames.t.set(i, frame.t);
      frames.n.set(i, frame.n);
    }
    std::array<Spectrum, batch_size> sums{};
    for (const LobeSample& sample : samples)
      add_sample(source[static_cast<std::size_t>(sample.level)], frames, sample, sums);
    SpectrumBatch of_suns;
    for (const PointFlux& sun : suns) add_point(sun, kernel, at, of_suns);
    store([&](std::size_t i) { return sums[i] + of_suns[i]; });
  });
  return map;
}

}  // namespace lanthorn
