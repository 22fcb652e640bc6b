// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include "io/pbrt/builders.h"
#include "io/pbrt/values.h"

namespace lanthorn::pbrt {

namespace {

using namespace description;

// Jensen, Marschner, Levoy, Hanrahan 2001, "A Practical Model for Subsurface Light Transport", figure 5: reduced
// scattering and absorption, per millimetre.
struct MeasuredMedium {
  std::string_view name;
  Rgb sigma_s, sigma_a;
};
constexpr std::array<MeasuredMedium, 12> measured_media{{
    {"Apple", {2.29f, 2.39f, 1.97f}, {0.0030f, 0.0034f, 0.046f}},
    {"Chicken1", {0.15f, 0.21f, 0.38f}, {0.015f, 0.077f, 0.19f}},
    {"Chicken2", {0.19f, 0.25f, 0.32f}, {0.018f, 0.088f, 0.20f}},
    {"Cream", {7.38f, 5.47f, 3.15f}, {0.0002f, 0.0028f, 0.0163f}},
    {"Ketchup", {0.18f, 0.07f, 0.03f}, {0.061f, 0.97f, 1.45f}},
    {"Marble", {2.19f, 2.62f, 3.00f}, {0.0021f, 0.0041f, 0.0071f}},
    {"Potato", {0.68f, 0.70f, 0.55f}, {0.0024f, 0.0090f, 0.12f}},
    {"Skimmilk", {0.70f, 1.22f, 1.90f}, {0.0014f, 0.0025f, 0.0142f}},
    {"Skin1", {0.74f, 0.88f, 1.01f}, {0.032f, 0.17f, 0.48f}},
    {"Skin2", {1.09f, 1.59f, 1.79f}, {0.013f, 0.070f, 0.145f}},
    {"Spectralon", {11.6f, 20.4f, 14.9f}, {0.00f, 0.00f, 0.00f}},
    {"Wholemilk", {2.55f, 3.21f, 3.77f}, {0.0011f, 0.0024f, 0.014f}},
}};

void read_preset(const ParameterList& list, Medium& medium, Context& context) {
  const auto preset = list.find_string("preset");
  if (!preset || preset->empty()) return;
  const auto found = std::find_if(measured_media.begin(), measured_media.end(),
                                  [&](const MeasuredMedium& m) { return m.name == *preset; });
  if (found == measured_media.end()) {
    context.warn("medium preset " + *preset, list.place(),
                 "medium preset " + in_quotes(*preset) + " is not known: the medium keeps its default coefficients");
    return;
  }
  medium.sigma_a = RgbSpectrum{found->sigma_a, ColorSpace::srgb};
  medium.sigma_s = RgbSpectrum{found->sigma_s, ColorSpace::srgb};
}

void read_coefficients(const ParameterList& list, Medium& medium, Context& context) {
  if (auto sigma_a = find_spectrum(list, "sigma_a", SpectrumRole::unbounded, context)) medium.sigma_a = *sigma_a;
  if (auto sigma_s = find_spectrum(list, "sigma_s", SpectrumRole::unbounded, context)) medium.sigma_s = *sigma_s;
  medium.scale = list.get("scale", 1.0f);
  if (!(medium.scale >= 0)) throw list.error("scale", "must not be negative");
  medium.g = list.get("g", 0.0f);
  if (!(medium.g > -1 && medium.g < 1)) throw list.error("g", "must be between -1 and 1");
}

void read_emission(const ParameterList& list, Medium& medium, Context& context) {
  medium.emission = find_spectrum(list, "Le", SpectrumRole::illuminant, context);
  medium.emission_scale = list.get("Lescale", 1.0f);
}

void read_homogeneous(const ParameterList& list, Medium& medium, Context& context) {
  medium.sigma_a = RgbSpectrum{{0.0011f, 0.0024f, 0.014f}, ColorSpace::srgb};
  medium.sigma_s = RgbSpectrum{{2.55f, 3.21f, 3.77f}, ColorSpace::srgb};
  read_preset(list, medium, context);
  read_coefficients(list, medium, context);
  read_emission(list, medium, context);
  medium.density = HomogeneousDensity{};
}

}  // namespace

Medium make_medium(const std::string& kind, const ParameterList& list, const Transform& medium_to_world,
                   Context& context) {
  Medium medium;
  medium.medium_to_world = medium_to_world;
  medium.location = list.place().location();
  if (kind == "homogeneous") {
    read_homogeneous(list, medium, context);
  } else if (kind == "uniformgrid" || kind == "rgbgrid" || kind == "nanovdb" || kind == "cloud") {
    context.warn("medium " + kind, list.place(),
                 "medium " + in_quotes(kind) + " is not supported yet: the space of the medium stays empty");
    return medium;
  } else {
    throw Error(medium.location, "unknown medium " + in_quotes(kind));
  }
  report_unused(list, context);
  return medium;
}

}  // namespace lanthorn::pbrt
