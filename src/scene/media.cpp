// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Turns described media into Medium values.
#include "scene/scene_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "light/brightness.h"

namespace lanthorn {

namespace {

using description::SpectrumRole;

constexpr int majorant_blocks = 16;  // along each axis

float largest_component(const std::optional<SampledGrid<Vec3>>& values, const Bounds& cell) {
  if (!values) return 1;
  float largest = 0;
  values->for_each_in(cell, [&](const Vec3& v) { largest = std::max(largest, max_component(v)); });
  return largest;
}

float note_largest(float value, float& largest) {
  largest = std::max(largest, value);
  return value;
}

// Longest straight line through the box, in metres of the world.
double diagonal_of(const Bounds& box, const Transform& to_world) {
  float longest2 = 0;
  for (const float x : {-1.0f, 1.0f})
    for (const float y : {-1.0f, 1.0f})
      longest2 = std::max(longest2, length_squared(to_world.vector(Vec3(x, y, 1) * box.extent())));
  return std::sqrt(static_cast<double>(longest2));
}

// Largest extinction coefficient per metre that any channel of either colour mode has where the density is 1.
float largest_extinction(const DensityMedium& m) {
  float largest = m.extinction_bound(Wavelengths::rgb(0.5f));
  constexpr float step = 5;  // nm
  for (float nm = lambda_min; nm <= lambda_max; nm += step)
    largest = std::max(largest, m.sigma_a.at(nm) + m.sigma_s.at(nm));
  return largest;
}

struct Maker {
  const description::Medium& source;
  const FileAccess& access;
  SpectrumStore& spectra;
  ColorSpace space;

  SpectrumCurve coefficient(const description::SpectrumValue& value) const {
    return spectra.curve(value, SpectrumRole::unbounded, space, source.location).scaled(source.scale);
  }
  SpectrumCurve emission() const {
    if (!source.emission) return SpectrumCurve::constant(0);
    const SpectrumCurve curve =
        spectra.curve(*source.emission, SpectrumRole::illuminant, space, source.location).scaled(source.emission_scale);
    check_radiance(largest_value(curve), source.location);
    return curve;
  }
  static bool is_usable(float x) { return std::isfinite(x); }
  static bool is_usable(const Rgb& c) { return is_usable(c.r) && is_usable(c.g) && is_usable(c.b); }
  template <class T, class U>
  SampledGrid<T> grid(const description::MediumGrid<U>& g) const {
    SampledGrid<T> result{g.size, {}, {g.low, g.high}};
    result.values.reserve(g.values.size());
    for (const U& value : g.values) {
      if (!is_usable(value))
        throw Error(source.location,
                    fmt::format("value {} of the medium's grid is infinite or not a number", result.values.size()));
      if constexpr (std::is_same_v<U, Rgb>)
        result.values.push_back({value.r, value.g, value.b});
      else
        result.values.push_back(value);
    }
    return result;
  }
  Density scalar(const description::ScalarGrid& g) const {
    if (const auto* values = std::get_if<description::MediumGrid<float>>(&g)) return GridDensity{grid<float>(*values)};
    const auto& file = std::get<description::VdbGrid>(g);
    try {
      return VdbDensity(file.filename, file.grid, access);
    } catch (const Error& problem) {
      throw Error(source.location, problem.what());
    }
  }
  bool is_missing(const description::ScalarGrid& g) const {
    const auto* file = std::get_if<description::VdbGrid>(&g);
    return file != nullptr && access.is_missing(file->filename);
  }
  // Null-collision tracking of a flight takes as many steps as the flight has mean free paths at the density of the
  // medium's densest part, even where the medium is thin. Far beyond this limit, a single flight takes seconds.
  void require_few_steps(const Bounds& box, float extinction) const {
    constexpr double most_steps = 1e6;
    const auto per_metre = static_cast<double>(extinction);
    const double steps = per_metre > 0 ? per_metre * diagonal_of(box, source.medium_to_world) : 0;
    if (!(steps <= most_steps))
      throw Error(
          source.location,
          fmt::format("the medium's box is {:.2g} mean free paths of its densest part across ({:.2g} per metre); "
                      "at most a million can be rendered: choose smaller coefficients or a smaller scale",
                      steps, per_metre));
  }
  DensityMedium with_density(Density density) const {
    DensityMedium m;
    m.sigma_a = coefficient(source.sigma_a);
    m.sigma_s = coefficient(source.sigma_s);
    m.phase = {source.g};
    m.to_medium = source.medium_to_world.inverted();
    m.density = std::move(density);
    float densest = 0;
    m.majorants = std::visit(
        [&](const auto& d) {
          return BlockGrid(d.box(), majorant_blocks,
                           [&](const Bounds& cell) { return note_largest(d.bound(cell), densest); });
        },
        m.density);
    require_few_steps(m.majorants.box(), densest * largest_extinction(m));
    if (source.emission) m.emission = SpectrumEmission{emission(), {}};
    return m;
  }

  Medium operator()(const description::HomogeneousDensity&) const {
    return HomogeneousMedium{coefficient(source.sigma_a), coefficient(source.sigma_s), emission(), {source.g}};
  }
  Medium operator()(const description::GridDensity& g) const {
    if (access.skip_missing && is_missing(g.density)) return HomogeneousMedium{};  // empty space
    DensityMedium m = with_density(scalar(g.density));
    if (g.temperature)
      m.emission = BlackbodyEmission{scalar(g.temperature->temperature), g.temperature->offset, g.temperature->scale,
                                     source.emission_scale};
    else if (g.emission_factor && source.emission)
      m.emission = SpectrumEmission{emission(), grid<float>(*g.emission_factor)};
    return m;
  }
  Medium operator()(const description::CloudDensity& c) const {
    return with_density(CloudDensity{{c.low, c.high}, c.density, c.wispiness, c.frequency});
  }
  Medium operator()(const description::RgbGridDensity& g) const {
    const auto colors = [this](const std::optional<description::MediumGrid<Rgb>>& values) {
      return values ? std::optional(grid<Vec3>(*values)) : std::nullopt;
    };
    RgbGridMedium m;
    m.sigma_a = colors(g.sigma_a);
    m.sigma_s = colors(g.sigma_s);
    m.emission = colors(g.emission);
    if (m.emission)
      for (Vec3& value : m.emission->values) value *= source.emission_scale;
    m.scale = source.scale;
    m.phase = {source.g};
    m.to_medium = source.medium_to_world.inverted();
    float densest = 0;
    m.majorants = BlockGrid((m.sigma_s ? m.sigma_s : m.sigma_a)->box, majorant_blocks, [&](const Bounds& cell) {
      return note_largest(largest_component(m.sigma_a, cell) + largest_component(m.sigma_s, cell), densest);
    });
    require_few_steps(m.majorants.box(), densest * m.scale);
    return m;
  }
};

}  // namespace

std::vector<Medium> make_media(const SceneDescription& description, SpectrumStore& spectra) {
  if (description.media.size() >= std::numeric_limits<std::uint16_t>::max())
    throw Error(description.media.back().location, "too many media: a scene may have 65534");
  std::vector<Medium> media;
  for (const description::Medium& m : description.media)
    media.push_back(std::visit(Maker{m, description.access, spectra, description.color_space}, m.density));
  return media;
}

void find_media_under_surfaces(SceneData& data) {
  float albedo = 0;
  for (const description::Material& material : std::as_const(data.description).materials) {
    if (!material.interior) continue;
    if (*material.interior >= data.media->all.size())
      throw Error(material.location, "the medium inside the material does not exist");
    data.is_under_surface.resize(data.media->all.size());
    data.is_under_surface[*material.interior] = true;
    albedo = std::max(albedo, largest_albedo(data.media->all[*material.interior]));
  }
  data.most_under_surface = data.is_under_surface.empty() ? 0 : scatterings_until_dark(albedo);
}

}  // namespace lanthorn
