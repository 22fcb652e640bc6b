// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scales follow pbrt-v4: every emission spectrum is brought to luminance 1 (an RGB colour keeps its own), then
// multiplied by `scale` and by what `power` or `illuminance` ask for; a mesh's `power` is that of each primitive.
#include "scene/lights.h"

#include <algorithm>
#include <cmath>

#include "math/octahedral.h"

namespace lanthorn {

namespace {

using description::SpectrumRole;

float radians(float degrees) { return degrees * pi / 180; }

struct Unoriented {
  EmitterShape shape;
  bool flip = false;
};

// The side that evaluate_surface calls outside, against the shape's natural normal.
Unoriented emitter(const ShapeStore& store, const description::Shape& source, const Transform& to_world,
                   std::uint32_t primitive) {
  const GeometryRecord& r = store.record;
  if (r.kind == GeometryRecord::Kind::quadric) {
    if (const auto* sphere = std::get_if<description::Sphere>(&source.geometry))
      return {SphereEmitter(to_world, sphere->radius, std::min(sphere->z_min, sphere->z_max),
                            std::max(sphere->z_min, sphere->z_max), radians(sphere->phi_max)),
              r.flip_normal};
    if (const auto* disk = std::get_if<description::Disk>(&source.geometry))
      return {DiskEmitter(to_world, disk->height, disk->radius, disk->inner_radius, radians(disk->phi_max)),
              r.flip_normal};
    const auto& cylinder = std::get<description::Cylinder>(source.geometry);
    return {CylinderEmitter(to_world, cylinder.radius, std::min(cylinder.z_min, cylinder.z_max),
                            std::max(cylinder.z_min, cylinder.z_max), radians(cylinder.phi_max)),
            r.flip_normal};
  }
  const bool is_patch = !store.patches.empty();
  const SurfaceGeometry middle = is_patch && !r.quads ? evaluate_surface(r, {primitive, 0.5f, 0.5f})
                                 : is_patch           ? evaluate_triangle(r, 2 * primitive, 1.0f / 3, 1.0f / 3)
                                                      : evaluate_triangle(r, primitive, 1.0f / 3, 1.0f / 3);
  if (is_patch) {
    const std::array<std::uint32_t, 4>& c = store.patches[primitive];
    const Point &p00 = r.position(c[0]), &p10 = r.position(c[1]), &p01 = r.position(c[2]), &p11 = r.position(c[3]);
    const Vec3 natural = cross(0.5f * (p10 - p00 + p11 - p01), 0.5f * (p01 - p00 + p11 - p10));
    return {PatchEmitter(p00, p10, p01, p11), dot(natural, middle.normal) < 0};
  }
  const std::array<std::uint32_t, 3>& c = store.triangles[primitive];
  const TriangleEmitter triangle(r.position(c[0]), r.position(c[1]), r.position(c[2]));
  return {triangle, dot(triangle.normal, middle.normal) < 0};
}

EnvironmentImage load_environment(const description::InfiniteLight& light, const SourceLocation& location) {
  const TextureImage image(*light.image, description::Encoding::automatic, 1, light.image_space, location);
  if (image.width() != image.height())
    throw Error(location, "environment image \"" + *light.image + "\" is " + std::to_string(image.width()) + " x " +
                              std::to_string(image.height()) +
                              ": it must be square, in the equal-area octahedral layout (pbrt's imgtool makeequiarea)");
  std::vector<Rgb> rows;
  rows.reserve(static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()));
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) rows.push_back(image.texel(x, y));
  return {image.width(), std::move(rows)};
}

// Illuminance, under unit scale, that pbrt-v4 takes for that of a surface facing the image's upper pole: it weighs
// texels with 2 pi / n where the sphere has 4 pi / n. Scenes are tuned to its images, so this is kept.
double upward_illuminance(const EnvironmentImage& image) {
  double sum = 0;
  for (int y = 0; y < image.resolution; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.resolution);
    for (int x = 0; x < image.resolution; ++x) {
      const auto size = static_cast<float>(image.resolution);
      const Direction d =
          direction_from_octahedral({(static_cast<float>(x) + 0.5f) / size, (static_cast<float>(y) + 0.5f) / size});
      if (d.z > 0) sum += static_cast<double>(d.z) * luminance(image.texels[row + static_cast<std::size_t>(x)]);
    }
  }
  return sum * 2 * std::numbers::pi / (static_cast<double>(image.resolution) * image.resolution);
}

struct LightMaker {
  const Transform& to_world;
  const BoundingSphere& scene;
  SpectrumStore& spectra;
  ColorSpace space;
  std::deque<EnvironmentImage>& images;
  const SourceLocation& location;

  SpectrumCurve emission(const description::Emission& e) {
    return spectra.curve(e.spectrum, SpectrumRole::illuminant, space, location).scaled(e.scale);
  }

  Light operator()(const description::PointLight& l) {
    PointLight light;
    light.position = to_world.point(l.from);
    light.intensity = emission(l.intensity);
    if (l.power) light.intensity = light.intensity.scaled(*l.power / (4 * pi));
    return light;
  }
  Light operator()(const description::SpotLight& l) {
    const Vec3 axis = to_world.vector(l.to - l.from);
    if (!(length_squared(axis) > 0)) throw Error(location, "a spot light needs \"from\" and \"to\" to differ");
    SpotLight light(to_world.point(l.from), normalize(axis), emission(l.intensity),
                    radians(std::max(0.0f, l.cone_angle - l.cone_delta_angle)), radians(l.cone_angle));
    if (l.power) light.intensity = light.intensity.scaled(*l.power / light.solid_angle());
    return light;
  }
  Light operator()(const description::DistantLight& l) {
    const Vec3 towards = to_world.vector(l.from - l.to);
    if (!(length_squared(towards) > 0)) throw Error(location, "a distant light needs \"from\" and \"to\" to differ");
    DistantLight light;
    light.towards = normalize(towards);
    light.irradiance = emission(l.radiance);
    if (l.illuminance) light.irradiance = light.irradiance.scaled(*l.illuminance);
    light.scene = scene;
    return light;
  }
  Light operator()(const description::InfiniteLight& l) {
    if (!l.image) {
      SpectrumCurve radiance = emission(l.radiance);
      if (l.illuminance) radiance = radiance.scaled(*l.illuminance / pi);
      return UniformInfiniteLight{radiance, scene};
    }
    const EnvironmentImage& image = images.emplace_back(load_environment(l, location));
    float scale = l.radiance.scale;
    if (l.illuminance) {
      const double now = upward_illuminance(image);
      scale *= now > 0 ? static_cast<float>(*l.illuminance / now) : 0.0f;
    }
    return ImageInfiniteLight(&image, scale, to_world, scene);
  }
};

float largest_value(const SpectrumCurve& curve) {
  float largest = max_component(curve.rgb);
  for (int nm = static_cast<int>(lambda_min); nm <= static_cast<int>(lambda_max); ++nm)
    largest = std::max(largest, curve.at(static_cast<float>(nm)));
  return largest;
}

}  // namespace

std::vector<Light> make_area_lights(const ShapeStore& shape, const description::Shape& source,
                                    const description::AreaLight& light, const Transform& to_world,
                                    SpectrumStore& spectra, ColorSpace space) {
  const SpectrumCurve radiance =
      spectra.curve(light.radiance.value, SpectrumRole::illuminant, space, light.location).scaled(light.scale);
  const std::size_t count = shape.patches.empty() ? shape.primitives() : shape.patches.size();
  std::vector<Light> lights;
  lights.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Unoriented e = emitter(shape, source, to_world, static_cast<std::uint32_t>(i));
    AreaLight area_light;
    area_light.shape = e.shape;
    area_light.radiance = radiance;
    area_light.two_sided = light.two_sided;
    area_light.flip_normal = e.flip;
    if (light.power) {
      const float sides = light.two_sided ? 2.0f : 1.0f;
      const float at_unit_radiance = sides * pi * area(e.shape);
      area_light.radiance = radiance.scaled(at_unit_radiance > 0 ? *light.power / at_unit_radiance : 0.0f);
    }
    lights.emplace_back(area_light);
  }
  return lights;
}

Light make_light(const description::Light& light, const BoundingSphere& scene, SpectrumStore& spectra, ColorSpace space,
                 std::deque<EnvironmentImage>& images) {
  LightMaker maker{light.light_to_world, scene, spectra, space, images, light.location};
  return std::visit(maker, light.node);
}

float largest_radiance(const Light& light, const BoundingSphere& scene) {
  const float far2 = std::max(scene.radius * scene.radius, 1e-20f);
  if (const auto* area_light = std::get_if<AreaLight>(&light)) return largest_value(area_light->radiance);
  if (const auto* point = std::get_if<PointLight>(&light)) return largest_value(point->intensity) / (pi * far2);
  if (const auto* spot = std::get_if<SpotLight>(&light)) return largest_value(spot->intensity) / (pi * far2);
  if (const auto* distant = std::get_if<DistantLight>(&light)) return largest_value(distant->irradiance) / pi;
  if (const auto* uniform = std::get_if<UniformInfiniteLight>(&light)) return largest_value(uniform->radiance);
  const auto& environment = std::get<ImageInfiniteLight>(light);
  Rgb brightest;
  for (const Rgb& texel : environment.image->texels) {
    brightest.r = std::max(brightest.r, texel.r);
    brightest.g = std::max(brightest.g, texel.g);
    brightest.b = std::max(brightest.b, texel.b);
  }
  return environment.scale * largest_value(SpectrumCurve::illuminant(brightest));
}

}  // namespace lanthorn
