// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scales follow pbrt-v4: every emission spectrum is scaled to luminance 1 (an RGB colour keeps its own), then
// multiplied by `scale` and by the factor that `power` or `illuminance` require.
#include "scene/lights.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "base/memory.h"
#include "image/image_file.h"
#include "lanthorn/scene.h"
#include "lanthorn/text.h"

namespace lanthorn {

namespace {

using description::SpectrumRole;

struct Pixels {
  int width = 0, height = 0;
  LightTexels rows;
};

Pixels load_pixels(const std::string& filename, const FileAccess& access, ColorSpace space,
                   const SourceLocation& location) {
  TextureImage image = access.skip_missing && access.is_missing(filename)
                           ? TextureImage(Rgb{0.5f, 0.5f, 0.5f})
                           : TextureImage(filename, access, {{description::Encoding::automatic, 1, space}}, location);
  // Besides the texels, a light keeps two numbers per texel for sampling, and needs a third while these are made.
  constexpr double bytes_for_sampling = 3 * sizeof(float);
  const int width = image.width(), height = image.height();
  require_memory(static_cast<double>(width) * height * bytes_for_sampling + static_cast<double>(image.bytes()),
                 location, "image \"" + printable(filename) + "\" of a light");
  return {width, height, std::move(image).take_colours()};
}

SphericalImage spherical_image(Pixels&& pixels, const std::string& filename, const SourceLocation& location,
                               std::vector<description::Warning>& warnings) {
  SphereLayout layout = SphereLayout::octahedral;
  constexpr int share_of_error = 20;  // some panoramas lack a few rows
  if (share_of_error * std::abs(pixels.width - 2 * pixels.height) <= pixels.width) {
    layout = SphereLayout::equirectangular;
    const std::string message =
        "images of lights that are about twice as wide as high are read as equirectangular, z up; pbrt-v4 takes only "
        "square ones, in the equal-area octahedral layout (its imgtool makeequiarea)";
    if (std::none_of(warnings.begin(), warnings.end(), [&](const auto& w) { return w.message == message; }))
      warnings.push_back({location, message});
  } else if (pixels.width != pixels.height) {
    throw Error(location, "the light's image \"" + printable(filename) + "\" is " + std::to_string(pixels.width) +
                              " x " + std::to_string(pixels.height) +
                              ": it must be square, in the equal-area octahedral layout (pbrt's imgtool makeequiarea), "
                              "or twice as wide as high, equirectangular");
  }
  return {layout, pixels.width, pixels.height, std::move(pixels.rows)};
}

// Illuminance at unit scale that pbrt-v4 assigns to a surface facing the image's upper pole. pbrt-v4 weighs texels with
// 2 pi / n although the sphere has 4 pi / n; scenes are tuned to its images, so this is kept.
double upward_illuminance(const SphericalImage& image) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
    const auto solid_angle = static_cast<double>(image.solid_angle_of_texel(y));
    for (int x = 0; x < image.width; ++x) {
      const Direction d = image.direction_of_texel(x, y);
      if (d.z > 0)
        sum += solid_angle * static_cast<double>(d.z * luminance(image.texels[row + static_cast<std::size_t>(x)]));
    }
  }
  return 0.5 * sum;
}

struct LightMaker {
  const Transform& to_world;
  const BoundingSphere& scene;
  ColorSpace space;
  LightStore& store;
  const SourceLocation& location;
  const FileAccess& access;

  const SphericalImage& keep_spherical(const std::string& filename, ColorSpace image_space) {
    return store.spherical_images.emplace_back(
        spherical_image(load_pixels(filename, access, image_space, location), filename, location, store.warnings));
  }
  DirectionMap direction_map() const {
    if (to_world.is_singular()) throw Error(location, "the light's transformation is singular");
    return DirectionMap(to_world);
  }

  SpectrumCurve emission(const description::Emission& e) {
    return store.spectra.curve(e.spectrum, SpectrumRole::illuminant, space, location).scaled(e.scale);
  }

  Light operator()(const description::PointLight& l) {
    EvenProfile profile{emission(l.intensity)};
    if (l.power) profile.curve = profile.curve.scaled(*l.power / (4 * pi));
    return EvenPointLight{to_world.point(l.from), profile};
  }
  Light operator()(const description::SpotLight& l) {
    const Vec3 axis = to_world.vector(l.to - l.from);
    if (!(length_squared(axis) > 0)) throw Error(location, "a spot light needs \"from\" and \"to\" to differ");
    SpotProfile profile(normalize(axis), emission(l.intensity),
                        to_radians(std::max(0.0f, l.cone_angle - l.cone_delta_angle)), to_radians(l.cone_angle),
                        l.falloff);
    if (l.power) profile.intensity = profile.intensity.scaled(*l.power / profile.solid_angle());
    return SpotLight{to_world.point(l.from), profile};
  }
  Light operator()(const description::DistantLight& l) {
    const Vec3 towards = to_world.vector(l.from - l.to);
    if (!(length_squared(towards) > 0)) throw Error(location, "a distant light needs \"from\" and \"to\" to differ");
    if (!(l.angle >= 0 && l.angle < 180))
      throw Error(location, "the angle of a distant light must be in [0, 180) degrees");
    SpectrumCurve irradiance = emission(l.radiance);
    if (l.illuminance) irradiance = irradiance.scaled(*l.illuminance);
    if (l.angle == 0) return DistantLight{normalize(towards), irradiance, scene};
    const ConeProfile cone(normalize(towards), 0.5 * static_cast<double>(to_radians(l.angle)), irradiance);
    return SunLight{cone, scene, l.visible_to_camera};
  }
  Light operator()(const description::InfiniteLight& l) {
    const Sky all = sky(l);
    if (!l.portal) return std::visit([](const auto& kind) -> Light { return kind; }, all);
    return PortalLight{all, &store.portals.emplace_back(*l.portal, all)};
  }
  const SphericalImage& keep_texels(const description::SphericalTexels& t) {
    const bool is_square = t.width == t.height;
    if (t.width < 1 || (!is_square && t.width != 2 * t.height) ||
        t.rows.size() != static_cast<std::size_t>(t.width) * static_cast<std::size_t>(t.height))
      throw Error(location, "the texels of a light must be a square, or twice as wide as high");
    for (std::size_t i = 0; i < t.rows.size(); ++i)
      if (const Rgb& c = t.rows[i]; !std::isfinite(c.r) || !std::isfinite(c.g) || !std::isfinite(c.b))
        throw Error(location,
                    "the texels of a light cannot be used: " +
                        not_finite(static_cast<std::int64_t>(i) % t.width, static_cast<std::int64_t>(i) / t.width));
    const SphereLayout layout = is_square ? SphereLayout::octahedral : SphereLayout::equirectangular;
    return store.spherical_images.emplace_back(layout, t.width, t.height, t.rows);
  }
  Sky sky(const description::InfiniteLight& l) {
    if (!l.image && !l.texels) {
      SpectrumCurve radiance = emission(l.radiance);
      if (l.illuminance) radiance = radiance.scaled(*l.illuminance / pi);
      return EvenSky{{radiance}, scene};
    }
    const SphericalImage& image = l.texels ? keep_texels(*l.texels) : keep_spherical(*l.image, l.image_space);
    float scale = l.radiance.scale;
    if (l.illuminance) {
      const double now = upward_illuminance(image);
      scale *= now > 0 ? static_cast<float>(*l.illuminance / now) : 0.0f;
    }
    return ImageSky{{{&image, direction_map()}, scale}, scene};
  }
  Light operator()(const description::GoniometricLight& l) {
    const Pixels pixels = load_pixels(l.image, access, ColorSpace::srgb, location);
    std::vector<Rgb> grey(pixels.rows.size());
    for (std::size_t i = 0; i < grey.size(); ++i) {
      const Rgb c = pixels.rows[i];
      const float mean = (c.r + c.g + c.b) / 3;
      grey[i] = {mean, mean, mean};
    }
    const SphericalImage& image = store.spherical_images.emplace_back(
        spherical_image({pixels.width, pixels.height, std::move(grey)}, l.image, location, store.warnings));
    GoniometricProfile profile{{&image, direction_map()}, emission(l.intensity)};
    const float at_unit_intensity = 4 * pi * image.mean_luminance;
    if (l.power)
      profile.intensity = profile.intensity.scaled(at_unit_intensity > 0 ? *l.power / at_unit_intensity : 0.0f);
    return GoniometricLight{to_world.point(Point(0)), profile};
  }
  Light operator()(const description::ProjectionLight& l) {
    Pixels pixels = load_pixels(l.image, access, l.image_space, location);
    const ProjectionImage& image =
        store.projection_images.emplace_back(pixels.width, pixels.height, std::move(pixels.rows), to_radians(l.fov));
    ProjectionProfile profile{l.scale, &image, direction_map()};
    if (l.power) profile.scale *= image.integral > 0 ? *l.power / image.integral : 0.0f;
    return ProjectionLight{to_world.point(Point(0)), profile};
  }
};

// The one value that scales a light: its power or illuminance if given, otherwise the scale of its emission.
template <class L>
float& magnitude_of(L& light) {
  if constexpr (requires { light.power; })
    if (light.power) return *light.power;
  if constexpr (requires { light.illuminance; })
    if (light.illuminance) return *light.illuminance;
  if constexpr (requires { light.intensity; })
    return light.intensity.scale;
  else if constexpr (requires { light.radiance.scale; })
    return light.radiance.scale;
  else
    return light.scale;
}

}  // namespace

Light make_light(const description::Light& light, const FileAccess& access, const BoundingSphere& scene,
                 ColorSpace space, LightStore& store) {
  LightMaker maker{light.light_to_world, scene, space, store, light.location, access};
  return std::visit(maker, light.node);
}

std::optional<Light> make_from(const MadeLight& before, const description::Light& light, const BoundingSphere& scene) {
  const auto* const now = std::get_if<description::InfiniteLight>(&light.node);
  const auto* const then = std::get_if<description::InfiniteLight>(&before.source.node);
  const auto* const made = std::get_if<ImageSky>(&before.light);
  if (now == nullptr || then == nullptr || made == nullptr) return {};
  const bool has_image = now->texels || now->image;
  const bool has_same_image =
      now->texels == then->texels && now->image == then->image && now->image_space == then->image_space;
  if (!has_image || !has_same_image || now->portal || now->illuminance || light.light_to_world.is_singular()) return {};
  const PlacedImage image{made->profile.image, DirectionMap(light.light_to_world)};
  return ImageSky{{image, now->radiance.scale}, scene};
}

void scale_light(description::Light& light, float factor) {
  std::visit([factor](auto& l) { magnitude_of(l) *= factor; }, light.node);
}
void scale_light(description::AreaLight& light, float factor) { magnitude_of(light) *= factor; }

}  // namespace lanthorn
