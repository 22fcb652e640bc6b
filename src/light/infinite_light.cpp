// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/infinite_light.h"

#include <cassert>
#include <utility>

#include "light/distant_light.h"
#include "math/octahedral.h"
#include "math/sampling.h"

namespace lanthorn {

std::optional<LightSample> UniformInfiniteLight::sample_direct(const Vec2& u, const Wavelengths& w) const {
  LightSample sample;
  sample.wi = sample_uniform_sphere(u);
  sample.radiance = radiance.evaluate(w);
  sample.pdf = pdf_uniform_sphere;
  return sample;
}

float UniformInfiniteLight::pdf_direct() const { return pdf_uniform_sphere; }

Spectrum UniformInfiniteLight::emitted(const Wavelengths& w) const { return radiance.evaluate(w); }

std::optional<EmissionSample> UniformInfiniteLight::sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                                    const Wavelengths& w) const {
  const Direction towards = sample_uniform_sphere(u_direction);
  const float disk_area = covering_disk_area(scene);
  EmissionSample sample;
  sample.origin = sample_covering_disk(scene, towards, u_position);
  sample.direction = -towards;
  sample.flux = radiance.evaluate(w) * (4 * pi * disk_area);
  sample.pdf_position = 1 / disk_area;
  sample.pdf_direction = pdf_uniform_sphere;
  return sample;
}

EmissionPdf UniformInfiniteLight::pdf_emission() const { return {1 / covering_disk_area(scene), pdf_uniform_sphere}; }

float UniformInfiniteLight::power() const { return luminance(radiance.rgb) * 4 * pi * covering_disk_area(scene); }

EnvironmentImage::EnvironmentImage(int resolution_, std::vector<Rgb> rows)
    : resolution(resolution_), texels(std::move(rows)) {
  assert(resolution > 0 &&
         texels.size() == static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution));
  const auto clean = [](float x) { return x > 0 && std::isfinite(x) ? x : 0.0f; };
  std::vector<float> weights;
  weights.reserve(texels.size());
  for (Rgb& texel : texels) {
    texel = {clean(texel.r), clean(texel.g), clean(texel.b)};
    weights.push_back(luminance(texel));
  }
  const auto side = static_cast<std::size_t>(resolution);
  distribution = PiecewiseConstant2d(weights, side, side);
  mean_luminance = distribution.integral();
}

ImageInfiniteLight::ImageInfiniteLight(const EnvironmentImage* image_, float scale_, const Transform& transform,
                                       const BoundingSphere& scene_)
    : image(image_), scale(scale_), scene(scene_) {
  // Lengths do not matter; at determinant 1 or -1 the change of solid angle is 1 / |world_to_light d|³.
  const glm::mat3 linear(transform.matrix);
  const float size = std::cbrt(std::fabs(glm::determinant(linear)));
  light_to_world = linear / size;
  world_to_light = glm::mat3(transform.inverse) * size;
}

namespace {

/// A direction of the light's own space, and how much denser it is per solid angle there than in the world.
struct LocalDirection {
  Vec2 uv;
  float compression;
};
LocalDirection to_image(const ImageInfiniteLight& light, const Direction& towards) {
  const Vec3 d = light.world_to_light * towards;
  const float length2 = length_squared(d), length = std::sqrt(length2);
  return {octahedral_from_direction(d / length), 1 / (length * length2)};
}

Spectrum radiance_of_cell(const ImageInfiniteLight& light, std::size_t cell, const Wavelengths& w) {
  return evaluate_illuminant(light.scale * light.image->texels[cell], w);
}

}  // namespace

std::optional<LightSample> ImageInfiniteLight::sample_direct(const Vec2& u, const Wavelengths& w) const {
  const std::optional<PiecewiseConstant2d::Sample> s = image->distribution.sample(u);
  if (!s) return {};
  const Vec3 d = light_to_world * direction_from_octahedral(s->at);
  const float length2 = length_squared(d), length = std::sqrt(length2);
  LightSample sample;
  sample.wi = d / length;
  sample.radiance = radiance_of_cell(*this, s->cell, w);
  sample.pdf = s->pdf * pdf_uniform_sphere * (length * length2);
  return sample;
}

float ImageInfiniteLight::pdf_direct(const Direction& towards) const {
  const LocalDirection local = to_image(*this, towards);
  return image->distribution.pdf(local.uv) * pdf_uniform_sphere * local.compression;
}

Spectrum ImageInfiniteLight::emitted(const Direction& towards, const Wavelengths& w) const {
  return radiance_of_cell(*this, image->distribution.cell(to_image(*this, towards).uv), w);
}

std::optional<EmissionSample> ImageInfiniteLight::sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                                  const Wavelengths& w) const {
  const std::optional<LightSample> s = sample_direct(u_direction, w);
  if (!s) return {};
  const float disk_area = covering_disk_area(scene);
  EmissionSample sample;
  sample.origin = sample_covering_disk(scene, s->wi, u_position);
  sample.direction = -s->wi;
  sample.flux = s->radiance * (disk_area / s->pdf);
  sample.pdf_position = 1 / disk_area;
  sample.pdf_direction = s->pdf;
  return sample;
}

EmissionPdf ImageInfiniteLight::pdf_emission(const Direction& direction) const {
  return {1 / covering_disk_area(scene), pdf_direct(-direction)};
}

// Exact for transforms that keep angles, which is what scenes have; others share photons a little unevenly.
float ImageInfiniteLight::power() const { return scale * image->mean_luminance * 4 * pi * covering_disk_area(scene); }

}  // namespace lanthorn
