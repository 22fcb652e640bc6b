// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "io/pbrt/builders.h"
#include "io/pbrt/values.h"
#include "medium/half_space.h"
#include "spectrum/curve.h"

namespace lanthorn::pbrt {

namespace {

using namespace description;

// Jensen, Marschner, Levoy, Hanrahan 2001, "A Practical Model for Subsurface Light Transport", figure 5: reduced
// scattering and absorption coefficients, per millimetre.
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

void read_preset(const ParameterList& list, std::string_view parameter, Medium& medium, Context& context) {
  const auto preset = list.find_string(parameter);
  if (!preset || preset->empty()) return;
  const auto found = std::find_if(measured_media.begin(), measured_media.end(),
                                  [&](const MeasuredMedium& m) { return m.name == *preset; });
  if (found == measured_media.end()) {
    context.warn("medium preset " + *preset, list.place(),
                 "measured medium " + in_quotes(*preset) + " is not known: it is replaced by \"Wholemilk\"");
    return;
  }
  medium.sigma_a = RgbSpectrum{found->sigma_a, ColorSpace::srgb};
  medium.sigma_s = RgbSpectrum{found->sigma_s, ColorSpace::srgb};
}

void read_coefficients(const ParameterList& list, Medium& medium, Context& context) {
  const auto coefficient = [&](std::string_view name) -> std::optional<SpectrumValue> {
    if (texture_name(list, name)) return {};
    return find_spectrum(list, name, SpectrumRole::unbounded, context);
  };
  if (auto sigma_a = coefficient("sigma_a")) medium.sigma_a = *sigma_a;
  if (auto sigma_s = coefficient("sigma_s")) medium.sigma_s = *sigma_s;
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
  read_preset(list, "preset", medium, context);
  read_coefficients(list, medium, context);
  read_emission(list, medium, context);
  medium.density = HomogeneousDensity{};
}

// Coefficients of media with varying density, at density 1. Defaults: both 1 per metre.
void read_varying(const ParameterList& list, Medium& medium, Context& context) {
  medium.sigma_a = medium.sigma_s = 1.0f;
  read_preset(list, "preset", medium, context);
  read_coefficients(list, medium, context);
}

// An empty grid with the medium's size and box.
template <class T>
MediumGrid<T> empty_grid(const ParameterList& list) {
  MediumGrid<T> grid;
  constexpr std::int64_t most_cells = std::int64_t{1} << 31;
  std::int64_t cells = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    constexpr std::array<const char*, 3> names{"nx", "ny", "nz"};
    grid.size[axis] = list.get(names[axis], 1);
    if (grid.size[axis] < 1) throw list.error(names[axis], "must be at least 1");
    cells *= grid.size[axis];
    if (cells > most_cells) throw list.error(names[axis], "makes the grid larger than 2^31 cells");
  }
  grid.low = list.get("p0", Point(0));
  grid.high = list.get("p1", Point(1));
  if (!(grid.low.x < grid.high.x && grid.low.y < grid.high.y && grid.low.z < grid.high.z))
    throw list.error("p1", "must be above \"p0\" along every axis");
  return grid;
}

void check_count(const ParameterList& list, std::string_view name, std::size_t given, std::array<int, 3> size,
                 std::size_t per_cell = 1) {
  const std::size_t cells =
      static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  if (given != cells * per_cell)
    throw list.error(name, "has " + std::to_string(given) + " values, but a grid of nx * ny * nz cells needs " +
                               std::to_string(cells * per_cell));
}

std::optional<MediumGrid<float>> find_grid(const ParameterList& list, std::string_view name) {
  std::vector<float> values = list.floats(name);
  if (values.empty()) return {};
  MediumGrid<float> grid = empty_grid<float>(list);
  check_count(list, name, values.size(), grid.size);
  grid.values = std::move(values);
  return grid;
}

void check_not_negative(const ParameterList& list, std::string_view name, const std::vector<float>& values) {
  if (std::any_of(values.begin(), values.end(), [](float v) { return !(v >= 0 && v < infinity); }))
    throw list.error(name, "must hold finite numbers that are not negative");
}

TemperatureGrid temperature_grid(const ParameterList& list, ScalarGrid grid) {
  return {std::move(grid), list.get("temperatureoffset", list.get("temperaturecutoff", 0.0f)),
          list.get("temperaturescale", 1.0f)};
}

void read_uniform_grid(const ParameterList& list, Medium& medium, Context& context) {
  read_varying(list, medium, context);
  auto density = find_grid(list, "density");
  if (!density) throw list.error("density", "is missing");
  check_not_negative(list, "density", density->values);
  GridDensity result{std::move(*density), {}, {}};
  medium.emission = find_spectrum(list, "Le", SpectrumRole::illuminant, context);
  const std::vector<float> factors = list.floats("Lescale");
  if (factors.size() == 1)
    medium.emission_scale = factors[0];
  else
    result.emission_factor = find_grid(list, "Lescale");
  if (auto temperature = find_grid(list, "temperature")) {
    if (medium.emission) throw list.error("temperature", "cannot be given together with \"Le\"");
    result.temperature = temperature_grid(list, std::move(*temperature));
  }
  medium.density = std::move(result);
}

std::optional<MediumGrid<Rgb>> find_rgb_grid(const ParameterList& list, std::string_view name) {
  const Parameter* parameter = list.find(name);
  if (parameter == nullptr) return {};
  const auto* numbers = std::get_if<std::vector<float>>(&parameter->values);
  if (parameter->type != ParameterType::rgb || numbers == nullptr)
    throw list.error(name, "must be of type rgb, with a colour for each cell");
  MediumGrid<Rgb> grid = empty_grid<Rgb>(list);
  check_count(list, name, numbers->size(), grid.size, 3);
  check_not_negative(list, name, *numbers);
  for (std::size_t i = 0; i < numbers->size(); i += 3)
    grid.values.push_back({(*numbers)[i], (*numbers)[i + 1], (*numbers)[i + 2]});
  return grid;
}

void read_rgb_grid(const ParameterList& list, Medium& medium) {
  RgbGridDensity grids{find_rgb_grid(list, "sigma_a"), find_rgb_grid(list, "sigma_s"), find_rgb_grid(list, "Le")};
  if (!grids.sigma_a && !grids.sigma_s) throw list.error("sigma_s", "or \"sigma_a\" must be given");
  if (grids.emission && !grids.sigma_a) throw list.error("Le", "needs \"sigma_a\"");
  medium.density = std::move(grids);
  medium.scale = list.get("scale", 1.0f);
  medium.g = list.get("g", 0.0f);
  medium.emission_scale = list.get("Lescale", 1.0f);
}

void read_nanovdb(const ParameterList& list, Medium& medium, Context& context) {
  read_varying(list, medium, context);
  const std::string file = context.add_file(list.required_string("filename"), list.place()).string();
  GridDensity result{VdbGrid{file, list.get("gridname", "density")}, {}, {}};
  medium.emission_scale = list.get("Lescale", 1.0f);
  if (const auto temperature = list.find_string("temperaturename"))
    result.temperature = temperature_grid(list, VdbGrid{file, *temperature});
  medium.density = std::move(result);
}

void read_cloud(const ParameterList& list, Medium& medium, Context& context) {
  read_varying(list, medium, context);
  const MediumGrid<float> box = empty_grid<float>(list);
  medium.density = CloudDensity{box.low, box.high, list.get("density", 1.0f), list.get("wispiness", 1.0f),
                                list.get("frequency", 5.0f)};
}

Rgb color(const ParameterList& list, std::string_view name, const SpectrumValue& value) {
  if (const auto* number = std::get_if<float>(&value)) return {*number, *number, *number};
  if (const auto* rgb = std::get_if<RgbSpectrum>(&value)) return rgb->rgb;
  throw list.error(name, "must be a number or of type rgb");
}

// One index of refraction for the whole spectrum.
float representative_index(const SpectrumValue& eta) {
  constexpr float green = 550;  // nm
  if (const auto* number = std::get_if<float>(&eta)) return *number;
  if (const auto* rgb = std::get_if<RgbSpectrum>(&eta)) return rgb->rgb.g;
  if (const auto* named = std::get_if<NamedSpectrum>(&eta)) return named_spectrum(named->name.c_str())->at(green);
  const auto* samples = std::get_if<SampledSpectrum>(&eta);
  if (samples == nullptr) return 1.33f;  // a black body has none
  const auto above = std::upper_bound(samples->nm.begin(), samples->nm.end(), green);
  return samples->values[static_cast<std::size_t>(std::max(samples->nm.begin() + 1, above) - samples->nm.begin()) - 1];
}

// The coefficients, per metre, of a medium of this mean free path for which a half-space behind the interface has the
// given reflectance, as the BSSRDF of pbrt-v4 does.
struct Coefficients {
  float scattering, absorption;
};
Coefficients coefficients_of(float reflectance, float mean_free_path, float g, float eta) {
  const double albedo =
      half_space_albedo(static_cast<double>(reflectance), static_cast<double>(g), static_cast<double>(eta));
  const auto length = static_cast<double>(mean_free_path);
  return {static_cast<float>(albedo / length), static_cast<float>((1 - albedo) / length)};
}

void read_reflectance(const ParameterList& list, const SpectrumValue& reflectance, float eta, Medium& medium,
                      Context& context) {
  const Rgb a = color(list, "reflectance", reflectance);
  const SpectrumValue mfp = find_spectrum(list, "mfp", SpectrumRole::unbounded, context).value_or(1.0f);
  const Rgb length = color(list, "mfp", mfp);
  if (!(length.r > 0 && length.g > 0 && length.b > 0)) throw list.error("mfp", "must be positive");
  const Coefficients r = coefficients_of(a.r, length.r, medium.g, eta),
                     g = coefficients_of(a.g, length.g, medium.g, eta),
                     b = coefficients_of(a.b, length.b, medium.g, eta);
  medium.sigma_s = RgbSpectrum{{r.scattering, g.scattering, b.scattering}, ColorSpace::srgb};
  medium.sigma_a = RgbSpectrum{{r.absorption, g.absorption, b.absorption}, ColorSpace::srgb};
}

}  // namespace

Medium make_subsurface_medium(const ParameterList& list, const SpectrumValue& eta, Context& context) {
  Medium medium;
  medium.location = list.place().location();
  medium.sigma_a = RgbSpectrum{{0.0011f, 0.0024f, 0.014f}, ColorSpace::srgb};
  medium.sigma_s = RgbSpectrum{{2.55f, 3.21f, 3.77f}, ColorSpace::srgb};
  read_preset(list, "name", medium, context);
  read_coefficients(list, medium, context);
  for (const std::string_view name : {"reflectance", "sigma_a", "sigma_s", "mfp"})
    if (texture_name(list, name))
      context.warn("subsurface texture", list.place(),
                   "textures inside a \"subsurface\" material are not supported: " + in_quotes(std::string(name)) +
                       " keeps its default");
  if (!texture_name(list, "reflectance") && !texture_name(list, "mfp"))
    if (const auto reflectance = find_spectrum(list, "reflectance", SpectrumRole::albedo, context))
      read_reflectance(list, *reflectance, representative_index(eta), medium, context);
  return medium;
}

Medium make_medium(const std::string& kind, const ParameterList& list, const Transform& medium_to_world,
                   Context& context) {
  Medium medium;
  medium.medium_to_world = medium_to_world;
  medium.location = list.place().location();
  if (kind == "homogeneous") {
    read_homogeneous(list, medium, context);
  } else if (kind == "uniformgrid") {
    read_uniform_grid(list, medium, context);
  } else if (kind == "rgbgrid") {
    read_rgb_grid(list, medium);
  } else if (kind == "nanovdb") {
    read_nanovdb(list, medium, context);
  } else if (kind == "cloud") {
    read_cloud(list, medium, context);
  } else {
    throw Error(medium.location, "unknown medium " + in_quotes(kind));
  }
  report_unused(list, context);
  return medium;
}

}  // namespace lanthorn::pbrt
