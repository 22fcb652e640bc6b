// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "lanthorn/error.h"
#include "light/emitter_sampling.h"
#include "math/affine.h"
#include "math/sampler.h"
#include "shape/triangle.h"

namespace lanthorn {

namespace {

struct Unoriented {
  EmitterShape shape;
  bool flip = false;
};

// Emitter of a primitive. `flip`: the side that evaluate_surface calls outside is opposite to the natural normal.
Unoriented shape_of(const EmittingShape& emitter, std::uint32_t primitive) {
  const ShapeStore& store = *emitter.shape;
  const description::Shape& source = *emitter.source;
  const Transform& to_world = emitter.to_world;
  const GeometryRecord& r = store.record;
  if (r.kind == GeometryRecord::Kind::quadric) {
    if (const auto* sphere = std::get_if<description::Sphere>(&source.geometry))
      return {SphereEmitter(to_world, sphere->radius, std::min(sphere->z_min, sphere->z_max),
                            std::max(sphere->z_min, sphere->z_max), to_radians(sphere->phi_max)),
              r.flip_normal};
    if (const auto* disk = std::get_if<description::Disk>(&source.geometry))
      return {DiskEmitter(to_world, disk->height, disk->radius, disk->inner_radius, to_radians(disk->phi_max)),
              r.flip_normal};
    const auto& cylinder = std::get<description::Cylinder>(source.geometry);
    return {CylinderEmitter(to_world, cylinder.radius, std::min(cylinder.z_min, cylinder.z_max),
                            std::max(cylinder.z_min, cylinder.z_max), to_radians(cylinder.phi_max)),
            r.flip_normal};
  }
  if (r.kind == GeometryRecord::Kind::patches) {
    const SurfaceGeometry middle = evaluate_surface(r, {primitive, 0.5f, 0.5f});
    const std::array<std::uint32_t, 4>& c = store.patches[primitive];
    const Point &p00 = r.position(c[0]), &p10 = r.position(c[1]), &p01 = r.position(c[2]), &p11 = r.position(c[3]);
    const Vec3 natural = cross(0.5f * (p10 - p00 + p11 - p01), 0.5f * (p01 - p00 + p11 - p10));
    const bool flip = dot(natural, middle.normal) < 0;
    if (is_parallelogram(p00, p10, p01, p11)) return {ParallelogramEmitter(p00, p10, p01), flip};
    return {PatchEmitter(p00, p10, p01, p11), flip};
  }
  const std::uint32_t first = r.lit_in_pairs ? 2 * primitive : primitive;
  const std::array<Point, 3> c = corners_of(r, first);
  const Normal outside = evaluate_triangle(r, first, 1.0f / 3, 1.0f / 3).normal;
  const bool flip = dot(cross(c[1] - c[0], c[2] - c[0]), outside) < 0;
  if (!r.lit_in_pairs) return {TriangleEmitter(c[0], c[1], c[2]), flip};
  if (r.quads) {
    const std::array<std::uint32_t, 4>& patch = store.patches[primitive];
    return {ParallelogramEmitter(r.position(patch[0]), r.position(patch[1]), r.position(patch[2])), flip};
  }
  const std::array<Point, 4> pair = *parallelogram_of(c, corners_of(r, first + 1));
  return {ParallelogramEmitter(pair[0], pair[1], pair[2]), flip};
}

// Bound of the distance between a triangle and the plane that rays are tested with, metres.
float error_of_plane(const GeometryRecord& r, std::uint32_t triangle) {
  const std::array<Point, 3> c = corners_of(r, triangle);
  const FlatTriangle t = flat_triangle(c, false);
  const float off_plane = dot(abs(c[1] - c[0]) + abs(c[2] - c[0]), t.off_plane);
  return off_plane < t.most_off_plane ? off_plane : t.most_off_plane;
}

// Sampled points are rounded in proportion to their coordinates, the surface in proportion to its extent and the ray's
// length. Mapping rays into an instance multiplies these errors by at most the condition number of the map.
void set_errors(AreaLight& light, const EmittingShape& emitter) {
  const Bounds box = bounds(light.shape);
  const GeometryRecord& r = emitter.shape->record;
  float reach = max_component(glm::max(abs(box.min), abs(box.max))) + std::sqrt(distance_squared(box.min, box.max));
  light.position_error = 0;
  if (r.kind == GeometryRecord::Kind::triangles) {
    const std::uint32_t count = r.lit_in_pairs ? 2 : 1;
    for (std::uint32_t i = 0; i < count; ++i)
      light.position_error = std::max(light.position_error, error_of_plane(r, count * light.primitive + i));
  }
  double stretch = 1;
  if (emitter.is_placed) {
    const Affine map(emitter.to_world);
    stretch = row_norm(map.linear) * row_norm(map.inverse);
    reach += max_component(abs(Vec3(map.translation)));
  }
  constexpr float rounding = 0x1p-20f;
  light.position_error = static_cast<float>(stretch) * (light.position_error + rounding * reach);
  light.tracing_error = static_cast<float>(stretch - 1) * rounding;
}

// The surface at a point of the shape's emitter `i`.
SurfaceGeometry surface_at(const ShapeStore& shape, std::uint32_t i, const Point& point) {
  const GeometryRecord& r = shape.record;
  if (r.kind == GeometryRecord::Kind::quadric) return evaluate_surface(r, {i, 0, 0, DVec3(point), {0, 0, 1}});
  if (r.kind == GeometryRecord::Kind::patches) {
    const Vec2 uv = parameters_at(shape.patch(i), point);
    return evaluate_surface(r, {i, uv.x, uv.y});
  }
  const auto in_triangle = [&](std::uint32_t triangle) {
    const std::array<Point, 3> c = corners_of(r, triangle);
    return barycentric(c[0], c[1], c[2], point);
  };
  if (!r.lit_in_pairs) {
    const Vec2 b = in_triangle(i);
    return evaluate_triangle(r, i, b.x, b.y);
  }
  // The point lies in the half in which its least barycentric coordinate is greater.
  const auto least = [](const Vec2& b) { return std::min({b.x, b.y, 1 - b.x - b.y}); };
  const Vec2 first = in_triangle(2 * i), second = in_triangle(2 * i + 1);
  return least(first) >= least(second) ? evaluate_triangle(r, 2 * i, first.x, first.y)
                                       : evaluate_triangle(r, 2 * i + 1, second.x, second.y);
}

// Emission of a shape, modulated by its textures and alpha.
class Emission {
 public:
  Emission(const ShapeStore& shape, const TextureGraph& textures, const SpectrumInput& radiance, float scale)
      : shape_(&shape), textures_(&textures), radiance_(radiance), opacity_(shape.alpha), scale_(scale) {
    // pbrt-v4's convention for an invisible lamp.
    if (is_invisible()) opacity_ = {1, {}};
  }

  bool is_invisible() const { return !shape_->alpha.node && !(shape_->alpha.value > 0); }
  bool varies() const { return radiance_.node || opacity_.node || opacity_.value < 1; }

  Spectrum seen(const TexturePoint& at, const Wavelengths& w) const {
    return textures_->evaluate(radiance_, at, w) * scale_;
  }
  Spectrum drawn(std::uint32_t primitive, const Point& point, const Normal& normal, const Wavelengths& w) const {
    const SurfaceGeometry s = surface_at(*shape_, primitive, point);
    const TexturePoint at{point, normal, s.uv, s.color};
    return seen(at, w) * std::clamp(shape_->textures->evaluate(opacity_, at), 0.0f, 1.0f);
  }
  SpectrumCurve constant() const { return radiance_.curve.scaled(scale_); }

  EmissionPattern pattern() const {
    return {[e = *this](std::uint32_t primitive, const EmitterHit& hit, const Wavelengths& w) {
              TexturePoint at{hit.position, hit.normal, hit.uv};
              if (e.shape_->record.has_colors) at.color = surface_at(*e.shape_, primitive, hit.position).color;
              return e.seen(at, w);
            },
            [e = *this](std::uint32_t primitive, const Point& point, const Normal& normal, const Wavelengths& w) {
              return e.drawn(primitive, point, normal, w);
            }};
  }

 private:
  const ShapeStore* shape_;
  const TextureGraph* textures_;
  SpectrumInput radiance_;
  FloatInput opacity_;
  float scale_;
};

// Mean radiance of the light's primitive in RGB mode, estimated from a point in each of `side` x `side` cells. Positive
// even if all of them are dark, because lights without power are never sampled.
Rgb mean_colour(const Emission& emission, const AreaLight& light, float scale, std::uint32_t side) {
  constexpr float least = 0.01f;
  if (!(area(light.shape) > 0)) return {};
  const Wavelengths w = Wavelengths::rgb(0.5f);
  Rgb sum;
  const std::uint32_t samples = side * side;
  for (std::uint32_t i = 0; i < samples; ++i) {
    const std::uint32_t column = i % side, row = i / side;
    const Vec2 cell(static_cast<float>(column), static_cast<float>(row));
    const Vec2 u = (cell + Sampler::for_pass(0, i).next2()) / static_cast<float>(side);
    const EmitterPoint at = sample_area(light.shape, min(u, Vec2(one_minus_epsilon)));
    const Spectrum s = emission.drawn(light.primitive, at.point, light.flip_normal ? -at.normal : at.normal, w);
    sum += {s[0], s[1], s[2]};
  }
  if (max_component(sum) > 0) return (1.0f / static_cast<float>(samples)) * sum;
  return least * scale * Rgb{1, 1, 1};
}

// The same as a flat spectrum: it is never evaluated at a wavelength, and there may be millions.
SpectrumCurve mean_radiance(const Emission& emission, const AreaLight& light, float scale, std::uint32_t side) {
  const Rgb colour = mean_colour(emission, light, scale, side);
  SpectrumCurve mean = SpectrumCurve::constant(max_component(colour));
  mean.rgb = colour;
  return mean;
}

// Table of the primitive's brightness in RGB mode, with `side` cells along each side. No cell is darker than a
// twentieth of the mean, because textures may be bright between the sampled points. Returns nullopt if the pattern is
// so uniform, or so dark, that no table is needed.
std::optional<PiecewiseConstant2d> brightness_of(const Emission& emission, const AreaLight& light, std::size_t side) {
  if (!(area(light.shape) > 0)) return {};
  constexpr std::size_t points = 3;  // along each side of a cell
  constexpr float least = 0.05f, even = 1.5f;
  const Wavelengths w = Wavelengths::rgb(0.5f);
  std::vector<float> cells(side * side);
  float sum = 0;
  const auto spacing = 1 / static_cast<float>(side * points);
  for (std::size_t i = 0; i < side * points; ++i)
    for (std::size_t j = 0; j < side * points; ++j) {
      const EmitterPoint at =
          sample_area(light.shape, spacing * Vec2(static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f));
      const Spectrum s = emission.drawn(light.primitive, at.point, light.flip_normal ? -at.normal : at.normal, w);
      const float brightness = std::fmax(0.0f, s[0] + s[1] + s[2]);
      cells[j / points * side + i / points] += brightness;
      sum += brightness;
    }
  const float mean = sum / static_cast<float>(cells.size());
  if (!std::isfinite(mean) || *std::max_element(cells.begin(), cells.end()) <= even * mean) return {};
  for (float& cell : cells) cell = std::fmax(cell, least * mean);
  return PiecewiseConstant2d(std::move(cells), side, side);
}

// Cells along each side of the tables of a shape's primitives, such that all tables together have at most a few
// thousand cells.
std::size_t table_side(std::size_t primitives) {
  constexpr double most_cells = 8192, longest = 64;
  return static_cast<std::size_t>(std::min(longest, std::sqrt(most_cells / static_cast<double>(primitives))));
}

// Cells along each side of a primitive in which its brightness is sampled, such that all primitives of a shape together
// have about a quarter of a million. Small primitives have little in them that could differ.
std::uint32_t sampled_side(std::size_t primitives) {
  constexpr double all = 1 << 18, most = 64, least = 2;
  return static_cast<std::uint32_t>(std::clamp(std::sqrt(all / static_cast<double>(primitives)), least, most));
}

// Scales the lights by one factor, so that no seams are visible and together they emit `power` watts.
void set_power(std::vector<AreaLight>& lights, float power) {
  double total = 0;
  for (const AreaLight& l : lights) total += static_cast<double>(l.power());
  const float factor = total > 0 ? static_cast<float>(static_cast<double>(power) / total) : 0.0f;
  for (AreaLight& l : lights) {
    l.radiance = l.radiance.scaled(factor);
    l.pattern_scale = factor;
  }
}

}  // namespace

std::size_t light_count(const ShapeStore& shape) {
  return shape.record.lit_in_pairs ? shape.primitives() / 2 : shape.primitives();
}

std::vector<Light> make_area_lights(const EmittingShape& emitter, const description::AreaLight& light,
                                    const TextureGraph& textures, const SpectrumInput& radiance, LightStore& store) {
  const ShapeStore& shape = *emitter.shape;
  const Emission emission(shape, textures, radiance, light.scale);
  const EmissionPattern* pattern = emission.varies() ? &store.patterns.emplace_back(emission.pattern()) : nullptr;
  if (!(light.spread > 0 && light.spread <= 180))
    throw Error(light.location,
                fmt::format("expected a spread of more than 0 and at most 180 degrees, got {}", light.spread));
  const Spread spread(static_cast<double>(light.spread) / 360 * std::numbers::pi);
  const std::size_t count = light_count(shape);
  const std::size_t side = table_side(count);
  const std::uint32_t sampled = sampled_side(count);
  std::vector<AreaLight> lights(count);
  std::vector<std::optional<PiecewiseConstant2d>> tables(side < 2 ? 0 : count);
  parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    AreaLight& l = lights[i];
    l.primitive = static_cast<std::uint32_t>(i);
    const Unoriented e = shape_of(emitter, l.primitive);
    l.shape = e.shape;
    l.flip_normal = e.flip;
    set_errors(l, emitter);
    l.pattern = pattern;
    l.two_sided = light.two_sided;
    l.spread = spread;
    l.invisible = emission.is_invisible();
    l.radiance = pattern != nullptr ? mean_radiance(emission, l, light.scale, sampled) : emission.constant();
    if (pattern != nullptr && side >= 2 && invert_sample_area(l.shape, Point(0)))
      tables[i] = brightness_of(emission, l, side);
  });
  for (std::size_t i = 0; i < tables.size(); ++i)
    if (tables[i]) lights[i].brightness = &store.brightnesses.emplace_back(std::move(*tables[i]));
  if (light.power) set_power(lights, *light.power);
  return {lights.begin(), lights.end()};
}

}  // namespace lanthorn
