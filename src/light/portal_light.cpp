// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/portal_light.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace lanthorn {
namespace {

// The square of angles: ((alpha, beta) + pi/2) / pi, with tan(alpha) = x / z and tan(beta) = y / z.

Vec2 square_from_direction(const Vec3& local) {
  return {std::atan2(local.x, local.z) / pi + 0.5f, std::atan2(local.y, local.z) / pi + 0.5f};
}
Direction direction_from_square(const Vec2& p) {
  // Stays inside the edge of the square, where tangents are infinite.
  constexpr float limit = 0.5f * pi * (1 - 1e-6f);
  const auto tangent = [&](float x) { return std::tan(std::clamp(pi * (x - 0.5f), -limit, limit)); };
  return normalize(Vec3(tangent(p.x), tangent(p.y), 1));
}
/// Solid angle per area of the square, sr.
float solid_angle_per_area(const Direction& local) {
  const float x2 = sqr(local.x), y2 = sqr(local.y), z2 = sqr(local.z);
  return pi * pi * (y2 + z2) * (x2 + z2) / local.z;
}

float luminance_of_sky(const Sky& sky, const Direction& towards) {
  if (const auto* even = std::get_if<EvenSky>(&sky)) return luminance(even->profile.curve.rgb);
  const ImageProfile& image = std::get<ImageSky>(sky).profile;
  return image.scale * luminance(image.colour(towards));
}
Spectrum radiance_of_sky(const Sky& sky, const Point& from, const Direction& towards, const Wavelengths& w) {
  return std::visit([&](const auto& light) { return light.emitted(from, towards, w); }, sky);
}

/// The sky's light over the square of angles, by cell.
struct SkyTable {
  std::size_t side = 64;
  std::vector<float> luminance;  ///< times solid angle
  std::vector<float> cosine;     ///< mean over the cell
  double irradiance = 0;

  SkyTable(const Sky& sky, const Frame& frame) {
    const auto* image = std::get_if<ImageSky>(&sky);
    if (image != nullptr) side = static_cast<std::size_t>(std::clamp(image->profile.image->height, 64, 1024));
    gather(sky, frame);
    if (image != nullptr) splat(image->profile, frame);
    add_floor();
  }

  std::size_t cell_of(const Vec2& p) const {
    const auto index = [&](float x) {
      return std::min(static_cast<std::size_t>(x * static_cast<float>(side)), side - 1);
    };
    return index(p.y) * side + index(p.x);
  }

 private:
  static constexpr int taps = 2;
  std::vector<float> solid_angle_;

  void gather(const Sky& sky, const Frame& frame) {
    const float step = 1 / static_cast<float>(side);
    for (std::size_t y = 0; y < side; ++y)
      for (std::size_t x = 0; x < side; ++x) {
        float light = 0, angle = 0, projected = 0;
        for (int i = 0; i < taps * taps; ++i) {
          const int column = i % taps, row = i / taps;
          const Vec2 offset((static_cast<float>(column) + 0.5f) / taps, (static_cast<float>(row) + 0.5f) / taps);
          const Direction local =
              direction_from_square(step * (Vec2(static_cast<float>(x), static_cast<float>(y)) + offset));
          const float part = solid_angle_per_area(local) * step * step / (taps * taps);
          light += part * luminance_of_sky(sky, frame.to_world(local));
          angle += part;
          projected += part * local.z;
        }
        luminance.push_back(light);
        solid_angle_.push_back(angle);
        cosine.push_back(projected / angle);
        irradiance += static_cast<double>(light * cosine.back());
      }
  }

  // Adds texels smaller than a cell where they lie, so that small bright texels between the cells' samples are not
  // missed.
  void splat(const ImageProfile& sky, const Frame& frame) {
    const SphericalImage& image = *sky.image;
    std::vector<float> found(luminance.size());
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const DirectionMap::Mapped towards = sky.map.world_from_light(image.direction_of_texel(x, y));
        const Direction local = frame.to_local(towards.direction);
        if (!(local.z > 0)) continue;
        const Rgb texel = image.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                       static_cast<std::size_t>(x)];
        const float angle = image.solid_angle_of_texel(y) / towards.compression;
        const float light = sky.scale * lanthorn::luminance(texel) * angle;
        const std::size_t cell = cell_of(square_from_direction(local));
        if (angle < solid_angle_[cell]) found[cell] += light;
        sum += static_cast<double>(light * local.z);
      }
    // Keeps the more finely sampled sum.
    if (static_cast<std::size_t>(image.height) > side) irradiance = sum;
    for (std::size_t i = 0; i < found.size(); ++i) luminance[i] = std::max(luminance[i], found[i]);
  }

  // Gives a positive density to light that the cells' samples missed.
  void add_floor() {
    double sum = 0;
    for (const float x : luminance) sum += static_cast<double>(x);
    const auto share = static_cast<float>(0.01 * sum / (2 * std::numbers::pi));
    for (std::size_t i = 0; i < luminance.size(); ++i) luminance[i] += share * solid_angle_[i];
  }
};

}  // namespace

Portal::Portal(const std::array<Point, 4>& corners, const Sky& sky) : corner(corners[0]) {
  const Vec3 across = corners[3] - corners[0], up = corners[1] - corners[0];
  width = std::sqrt(length_squared(across));
  height = std::sqrt(length_squared(up));
  const Normal n = normalize(cross(across, up));
  frame = Frame(across / width, cross(n, across / width), n);
  SkyTable table(sky, frame);
  towards = WindowedPiecewiseConstant2d(table.luminance, table.side, table.side);
  for (std::size_t i = 0; i < table.luminance.size(); ++i) table.luminance[i] *= table.cosine[i];
  through = PiecewiseConstant2d(std::move(table.luminance), table.side, table.side);
  irradiance = static_cast<float>(table.irradiance);
}

bool Portal::is_crossed(const Point& p, const Direction& direction) const {
  if (!(dot(direction, frame.n) > 0)) return false;
  const Vec2 at = crossing(p, direction);
  return at.x >= 0 && at.x <= width && at.y >= 0 && at.y <= height;
}

Vec2 Portal::crossing(const Point& p, const Direction& direction) const {
  const Vec3 local = frame.to_local(direction), offset = frame.to_local(p - corner);
  const float t = -offset.z / local.z;
  return {offset.x + t * local.x, offset.y + t * local.y};
}

std::optional<WindowedPiecewiseConstant2d::Window> Portal::window(const Point& from) const {
  const Vec3 to_corner = frame.to_local(corner - from);
  if (!(to_corner.z > 0)) return {};
  const Vec2 min = square_from_direction(to_corner);
  const Vec2 max = square_from_direction(to_corner + Vec3(width, height, 0));
  if (!(min.x < max.x && min.y < max.y)) return {};
  return WindowedPiecewiseConstant2d::Window{min, max};
}

std::optional<LightSample> PortalLight::sample_direct(const Point& from, const Vec2& u, const Wavelengths& w) const {
  std::optional<LightSample> result;
  const auto window = portal->window(from);
  if (!window) return result;
  const auto s = portal->towards.sample(u, *window);
  if (!s) return result;
  const Direction local = direction_from_square(s->at);
  LightSample& sample = result.emplace();
  sample.wi = portal->frame.to_world(local);
  sample.radiance = radiance_of_sky(sky, from, sample.wi, w);
  sample.pdf = s->pdf / solid_angle_per_area(local);
  if (!(sample.pdf > 0) || sample.radiance.is_black()) result.reset();
  return result;
}

float PortalLight::pdf_direct(const Point& from, const Direction& towards) const {
  const auto window = portal->window(from);
  if (!window || !portal->is_crossed(from, towards)) return 0;
  const Direction local = portal->frame.to_local(towards);
  return portal->towards.pdf(square_from_direction(local), *window) / solid_angle_per_area(local);
}

Spectrum PortalLight::emitted(const Point& from, const Direction& towards, const Wavelengths& w) const {
  const bool seen = portal->window(from).has_value() && portal->is_crossed(from, towards);
  return seen ? radiance_of_sky(sky, from, towards, w) : Spectrum();
}

std::optional<EmissionSample> PortalLight::sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                           const Wavelengths& w) const {
  std::optional<EmissionSample> result;
  const std::optional<PiecewiseConstant2d::Sample> s = portal->through.sample(u_direction);
  if (!s) return result;
  const Direction local = direction_from_square(s->at);
  const Direction towards = portal->frame.to_world(local);
  const float density = s->pdf / solid_angle_per_area(local);
  if (!(density > 0)) return result;
  EmissionSample& sample = result.emplace();
  sample.origin =
      portal->corner + u_position.x * portal->width * portal->frame.s + u_position.y * portal->height * portal->frame.t;
  sample.direction = -towards;
  // Moves the origin to this side of the portal by the rounding error of a ray from beyond the scene. A wall in the
  // portal's plane then blocks light that passes beside its opening.
  const BoundingSphere& scene = std::visit(
      [](const auto& light) -> const auto& { return light.scene; }, sky);
  const float way = 2 * scene.radius + std::sqrt(distance_squared(scene.centre, sample.origin));
  sample.origin += (0x1p-20f * way / local.z) * sample.direction;
  sample.from_infinity = true;
  sample.pdf_position = 1 / (portal->area() * local.z);
  sample.pdf_direction = density;
  sample.flux = radiance_of_sky(sky, sample.origin, towards, w) / (sample.pdf_position * sample.pdf_direction);
  return result;
}

EmissionPdf PortalLight::pdf_emission(const EmitterHit& origin, const Direction& direction) const {
  if (!portal->is_crossed(origin.position, -direction)) return {};
  const Direction local = portal->frame.to_local(-direction);
  return {1 / (portal->area() * local.z),
          portal->through.pdf(square_from_direction(local)) / solid_angle_per_area(local)};
}

EmissionNumbers PortalLight::invert_emission(const EmitterHit& origin, const Direction& direction) const {
  const Direction local = portal->frame.to_local(-direction);
  const Vec2 at = portal->crossing(origin.position, -direction);
  return {glm::clamp(Vec2(at.x / portal->width, at.y / portal->height), Vec2(0), Vec2(one_minus_epsilon)),
          portal->through.invert(square_from_direction(local))};
}

float PortalLight::power() const { return portal->irradiance * portal->area(); }

float PortalLight::largest_radiance(float far2) const {
  return std::visit([far2](const auto& light) { return light.largest_radiance(far2); }, sky);
}

}  // namespace lanthorn
