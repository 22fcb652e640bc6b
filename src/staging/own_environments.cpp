// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// References:
//   Preetham, Shirley & Smits 1999, "A Practical Analytic Model for Daylight", appendices A.1 (attenuation of sunlight)
//   and A.2 (luminance and chromaticity of the sky).
//   Perez, Seals & Michalsky 1993, "All-weather model for sky luminance distribution".
//   Moon & Spencer 1942, "Illumination from a non-uniform sky" (the CIE's overcast sky).
#include "staging/environments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "lanthorn/scene.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

namespace {

// A light of the studio. Degrees: from the camera towards the picture's right, above the horizon, and half its width.
struct SoftLamp {
  float azimuth, elevation, half_width;
  float radiance;
};
constexpr std::array<SoftLamp, 3> soft_lamps{{{-45, 45, 30, 2.2f}, {65, 20, 38, 0.6f}, {160, 50, 26, 2.0f}}};

float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

constexpr float ground_albedo = 0.2f;

/// Directions of an equirectangular picture, y up: the top row is +y, the centre +x, a quarter of the width to its
/// right +z.
struct EquirectangularMap {
  int width, height;

  Direction direction(float x, float y) const {
    const float azimuth = 2 * pi * x / static_cast<float>(width) - pi, polar = pi * y / static_cast<float>(height);
    return {std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)};
  }
  Direction direction_of_texel(int x, int y) const {
    return direction(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  }
  float solid_angle_of_texel(int y) const {
    const float h = static_cast<float>(height);
    return 4 * pi / static_cast<float>(width) * std::sin(pi * (static_cast<float>(y) + 0.5f) / h) *
           std::sin(0.5f * pi / h);
  }
  template <class Radiance>
  Image image(Radiance&& radiance) const {
    Image result(width, height, {"R", "G", "B"});
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) set(result, x, y, radiance(direction_of_texel(x, y)));
    return result;
  }
  static void set(Image& image, int x, int y, const Rgb& colour) {
    float* const texel = image.pixels.data() + image.index(x, y);
    texel[0] = colour.r, texel[1] = colour.g, texel[2] = colour.b;
  }
};

Image studio() {
  return EquirectangularMap{256, 128}.image([](const Direction& d) {
    const float radiance = studio_radiance({d.z, d.x, d.y});
    return Rgb{radiance, radiance, radiance};
  });
}

// L(e) = Lz (1 + 2 sin e) / 3 gives a level surface the irradiance 7 pi / 9 Lz; Lz is chosen to make it pi.
Image overcast() {
  return EquirectangularMap{256, 128}.image([](const Direction& d) {
    constexpr float zenith = 9.0f / 7;
    const float radiance = d.y > 0 ? zenith * (1 + 2 * d.y) / 3 : ground_albedo;
    return Rgb{radiance, radiance, radiance};
  });
}

/// The sky of Preetham, Shirley & Smits for a given turbidity and sun direction.
class PreethamSky {
 public:
  PreethamSky(float turbidity, const Direction& sun) : turbidity_(turbidity), sun_(sun) {
    const float t = turbidity, s = std::acos(sun.y), s2 = s * s, s3 = s2 * s;
    luminance_ = {{0.1787f * t - 1.4630f, -0.3554f * t + 0.4275f, -0.0227f * t + 5.3251f, 0.1206f * t - 2.5771f,
                   -0.0670f * t + 0.3703f},
                  (4.0453f * t - 4.9710f) * std::tan((4.0f / 9 - t / 120) * (pi - 2 * s)) - 0.2155f * t + 2.4192f};
    x_ = {{-0.0193f * t - 0.2592f, -0.0665f * t + 0.0008f, -0.0004f * t + 0.2125f, -0.0641f * t - 0.8989f,
           -0.0033f * t + 0.0452f},
          t * t * (0.00166f * s3 - 0.00375f * s2 + 0.00209f * s) +
              t * (-0.02903f * s3 + 0.06377f * s2 - 0.03202f * s + 0.00394f) + 0.11693f * s3 - 0.21196f * s2 +
              0.06052f * s + 0.25886f};
    y_ = {{-0.0167f * t - 0.2608f, -0.0950f * t + 0.0092f, -0.0079f * t + 0.2102f, -0.0441f * t - 1.6537f,
           -0.0109f * t + 0.0529f},
          t * t * (0.00275f * s3 - 0.00610f * s2 + 0.00317f * s) +
              t * (-0.04214f * s3 + 0.08970f * s2 - 0.04153f * s + 0.00516f) + 0.15346f * s3 - 0.26756f * s2 +
              0.06670f * s + 0.26688f};
    for (Distribution* const d : {&luminance_, &x_, &y_}) d->zenith /= d->perez(1, s);
  }

  /// Colour of the sky above the horizon in linear Rec.709; luminance in kcd/m².
  Rgb radiance(const Direction& d) const {
    const float cos = std::max(d.y, 1e-3f), gamma = std::acos(std::clamp(dot(d, sun_), -1.0f, 1.0f));
    const float luminance = luminance_.at(cos, gamma), x = x_.at(cos, gamma), y = y_.at(cos, gamma);
    const float big_x = luminance * x / y, big_z = luminance * (1 - x - y) / y;
    // XYZ to linear Rec.709 (IEC 61966-2-1). Negative components are outside its gamut.
    return {std::max(0.0f, 3.2406f * big_x - 1.5372f * luminance - 0.4986f * big_z),
            std::max(0.0f, -0.9689f * big_x + 1.8758f * luminance + 0.0415f * big_z),
            std::max(0.0f, 0.0557f * big_x - 0.2040f * luminance + 1.0570f * big_z)};
  }
  /// Illuminance of a surface that faces the sun, in klx: sunlight above the atmosphere, attenuated by Rayleigh
  /// scattering and haze at wavelengths of the three primaries. Ozone and vapour are neglected.
  Rgb sunlight() const {
    constexpr float above_atmosphere = 128;  // klx
    const float degrees = std::acos(sun_.y) * 180 / pi;
    const float mass = 1 / (sun_.y + 0.15f * std::pow(93.885f - degrees, -1.253f));
    const float haze = 0.04608f * turbidity_ - 0.04586f;  // Ångström's beta
    const auto left = [&](float micrometres) {
      return above_atmosphere *
             std::exp(-mass * (0.008735f * std::pow(micrometres, -4.08f) + haze * std::pow(micrometres, -1.3f)));
    };
    return {left(0.610f), left(0.550f), left(0.465f)};
  }

 private:
  struct Distribution {
    std::array<float, 5> c{};
    float zenith = 0;  // first the zenith's value, then divided by F(0, theta of the sun)

    float perez(float cos, float gamma) const {
      const float cos_gamma = std::cos(gamma);
      return (1 + c[0] * std::exp(c[1] / cos)) * (1 + c[2] * std::exp(c[3] * gamma) + c[4] * cos_gamma * cos_gamma);
    }
    float at(float cos, float gamma) const { return zenith * perez(cos, gamma); }
  };

  float turbidity_;
  Direction sun_;
  Distribution luminance_, x_, y_;
};

// Fractions of the texels that the sun's disc covers.
struct Coverage {
  struct Texel {
    int x, y;
    float share;
  };
  std::vector<Texel> texels{};
  float solid_angle = 0;

  Coverage(const EquirectangularMap& map, const Direction& sun) {
    const float least_cos = std::cos(to_radians(0.2666f));
    constexpr int parts = 16;  // subdivisions of a texel along each axis
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) {
        if (dot(map.direction_of_texel(x, y), sun) < 0.999f) continue;
        int inside = 0;
        for (int i = 0; i < parts * parts; ++i) {
          const auto at = [&](int texel, int part) {
            return static_cast<float>(texel) + (static_cast<float>(part) + 0.5f) / parts;
          };
          if (dot(map.direction(at(x, i % parts), at(y, i / parts)), sun) > least_cos) ++inside;
        }
        if (inside == 0) continue;
        texels.push_back({x, y, static_cast<float>(inside) / (parts * parts)});
        solid_angle += texels.back().share * map.solid_angle_of_texel(y);
      }
  }
};

// Illuminance of a level surface.
float level_illuminance(const EquirectangularMap& map, const Image& image) {
  double sum = 0;
  for (int y = 0; 2 * y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const Rgb c{image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
      sum += static_cast<double>(luminance(c) * map.solid_angle_of_texel(y) * map.direction_of_texel(x, y).y);
    }
  return static_cast<float>(sum);
}

Image sunny() {
  constexpr EquirectangularMap map{1024, 512};
  constexpr float turbidity = 3;
  const float elevation = to_radians(40.0f), aside = to_radians(45.0f);
  const Direction sun(-std::sin(aside) * std::cos(elevation), std::sin(elevation),
                      std::cos(aside) * std::cos(elevation));
  const PreethamSky sky(turbidity, sun);
  Image image = map.image([&](const Direction& d) { return d.y > 0 ? sky.radiance(d) : Rgb{}; });
  const Coverage disc(map, sun);
  const Rgb radiance_of_sun = (1 / disc.solid_angle) * sky.sunlight();
  for (const auto& [x, y, share] : disc.texels) {
    const Rgb behind{image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
    EquirectangularMap::set(image, x, y, behind + share * radiance_of_sun);
  }
  const float scale = pi / level_illuminance(map, image);
  for (float& value : image.pixels) value *= scale;
  for (int y = map.height / 2; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      EquirectangularMap::set(image, x, y, {ground_albedo, ground_albedo, ground_albedo});
  return image;
}

struct OwnEnvironment {
  const char* name;
  Image (*make)();
};
constexpr std::array<OwnEnvironment, 3> own_environments{
    {{"studio", studio}, {"overcast", overcast}, {"sunny", sunny}}};

}  // namespace

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

std::vector<std::string> environment_names() {
  std::vector<std::string> names;
  names.reserve(own_environments.size());
  for (const OwnEnvironment& own : own_environments) names.emplace_back(own.name);
  return names;
}

std::optional<Image> own_environment(std::string_view name) {
  for (const OwnEnvironment& own : own_environments)
    if (own.name == name) return own.make();
  return std::nullopt;
}

}  // namespace lanthorn
