// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Camera, film, filter, sampler, integrator, media and shapes.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "io/pbrt/upgrade_parts.h"

namespace lanthorn::pbrt {

namespace {

struct Renamed {
  std::string_view v3, v4;
};
template <std::size_t N>
std::string new_name(const std::array<Renamed, N>& names, const std::string& old) {
  const auto it = std::find_if(names.begin(), names.end(), [&](const Renamed& r) { return r.v3 == old; });
  return it == names.end() ? old : std::string(it->v4);
}

Upgraded with_rest(std::string kind, Parameters parameters, OldParameters& old) {
  Parameters rest = old.rest();
  parameters.insert(parameters.end(), std::make_move_iterator(rest.begin()), std::make_move_iterator(rest.end()));
  return {std::move(kind), std::move(parameters)};
}

}  // namespace

Upgraded upgrade_camera(const std::string& kind, OldParameters old, UpgradeOutput& output) {
  Parameters parameters;
  if (const auto half = old.take_float("halffov"); half && *half > 0) {
    old.take("fov");
    parameters.push_back(float_parameter("fov", 2 * *half, old.place()));
  }
  if (kind == "environment") {
    parameters.push_back(string_parameter("mapping", "equirectangular", old.place()));
    return with_rest("spherical", std::move(parameters), old);
  }
  if (kind == "realistic") {
    old.take("simpleweighting");
    output.note("pixels of the camera \"realistic\" hold the irradiance of the film, as in pbrt-v4: another brightness",
                old.place());
  }
  return with_rest(kind, std::move(parameters), old);
}

// The time that the shutter is open does not change the brightness in pbrt-v3.
Upgraded upgrade_film(const std::string& kind, OldParameters old, float exposure_time, UpgradeOutput& output) {
  if (kind != "image") throw output.context().unknown("film", "Film", kind, old.place());
  Parameters parameters;
  if (auto limit = old.take("maxsampleluminance"))
    parameters.push_back(renamed(std::move(*limit), "maxcomponentvalue"));
  if (const float scale = old.take_float("scale").value_or(1) / exposure_time; scale != 1)
    parameters.push_back(float_parameter("iso", 100 * scale, old.place()));
  return with_rest("rgb", std::move(parameters), old);
}

Upgraded upgrade_filter(const std::string& kind, OldParameters old) {
  Parameters parameters;
  for (const auto& [v3, v4] : {std::pair("xwidth", "xradius"), std::pair("ywidth", "yradius")}) {
    constexpr float gaussian_radius = 2;
    if (auto width = old.take(v3))
      parameters.push_back(renamed(std::move(*width), v4));
    else if (kind == "gaussian")
      parameters.push_back(float_parameter(v4, gaussian_radius, old.place()));
  }
  if (const auto alpha = old.take_float("alpha"))  // exp(-alpha x^2)
    parameters.push_back(float_parameter("sigma", 1 / std::sqrt(2 * *alpha), old.place()));
  return with_rest(kind, std::move(parameters), old);
}

Upgraded upgrade_sampler(const std::string& kind, OldParameters old) {
  constexpr std::array<Renamed, 5> samplers = {{{"02sequence", "paddedsobol"},
                                                {"lowdiscrepancy", "paddedsobol"},
                                                {"zerotwosequence", "paddedsobol"},
                                                {"maxmindist", "pmj02bn"},
                                                {"random", "independent"}}};
  old.take("dimensions");
  return with_rest(new_name(samplers, kind), {}, old);
}

UpgradedIntegrator upgrade_integrator(const std::string& kind, OldParameters old, UpgradeOutput& output) {
  const bool is_sppm = kind == "sppm";
  std::optional<int> passes;
  for (const char* name : {"iterations", "numiterations"})
    if (const auto given = is_sppm ? old.take_integer(name) : std::nullopt) passes = given;
  if (is_sppm) old.take("imagewritefrequency");
  if (kind == "ambientocclusion") old.take("nsamples");
  for (const char* without_meaning : {"rrthreshold", "lightsamplestrategy"}) old.take(without_meaning);
  if (kind != "whitted" && kind != "directlighting") return {with_rest(kind, {}, old), passes};
  old.take("strategy");
  output.note("the integrator " + in_quotes(kind) + " is replaced by \"path\", which adds light of all other paths",
              old.place());
  return {with_rest("path", {}, old), passes};
}

Parameters upgrade_medium(OldParameters old) {
  const Place place = old.place();
  const std::string kind = old.take_string("type").value_or("");
  const bool is_grid = kind == "heterogeneous";
  Parameters parameters{string_parameter("type", is_grid ? "uniformgrid" : kind, place)};
  if (is_grid && !old.has("preset")) {  // milk, as in a homogeneous medium
    if (!old.has("sigma_a")) parameters.push_back(rgb_parameter("sigma_a", {0.0011f, 0.0024f, 0.014f}, place));
    if (!old.has("sigma_s")) parameters.push_back(rgb_parameter("sigma_s", {2.55f, 3.21f, 3.77f}, place));
  }
  return with_rest({}, std::move(parameters), old).parameters;
}

namespace {

// Texture coordinates as a list of "float" or "point2", by two names.
Parameters texture_coordinates(OldParameters& old) {
  std::optional<Parameter> uv;
  for (const char* name : {"st", "uv"})
    if (auto given = old.take(name)) uv = std::move(given);
  if (!uv) return {};
  if (uv->type == ParameterType::real) uv->type = ParameterType::point2;
  uv->name = "uv";
  return {std::move(*uv)};
}

// A grid of heights over the unit square, as triangles.
Upgraded height_field(OldParameters& old) {
  constexpr int most = 1 << 15;
  const Place place = old.place();
  const int width = old.take_integer("nu").value_or(0), height = old.take_integer("nv").value_or(0);
  const auto heights = old.take("Pz");
  const auto* z = heights ? std::get_if<std::vector<float>>(&heights->values) : nullptr;
  if (width < 2 || height < 2 || width > most || height > most || z == nullptr ||
      z->size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw Error(place.location(), old.entity() + " needs \"nu\" and \"nv\" from 2 to " + std::to_string(most) +
                                      " and nu * nv numbers \"Pz\"");
  std::vector<float> points, uvs;
  std::vector<std::int32_t> triangles;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(width - 1);
      const float v = static_cast<float>(y) / static_cast<float>(height - 1);
      const int here = y * width + x;
      points.insert(points.end(), {u, v, (*z)[static_cast<std::size_t>(here)]});
      uvs.insert(uvs.end(), {u, v});
      if (x + 1 < width && y + 1 < height)
        triangles.insert(triangles.end(), {here, here + 1, here + width + 1, here, here + width + 1, here + width});
    }
  Parameter p = float_parameter("P", 0, place), uv = float_parameter("uv", 0, place);
  Parameter indices = integer_parameter("indices", 0, place);
  p.type = ParameterType::point3;
  p.values = std::move(points);
  uv.type = ParameterType::point2;
  uv.values = std::move(uvs);
  indices.values = std::move(triangles);
  return with_rest("trianglemesh", {std::move(p), std::move(uv), std::move(indices)}, old);
}

}  // namespace

std::optional<Upgraded> upgrade_shape(const std::string& kind, OldParameters old, UpgradeOutput& output) {
  constexpr std::array<std::string_view, 4> left_out = {"cone", "hyperboloid", "nurbs", "paraboloid"};
  if (std::find(left_out.begin(), left_out.end(), kind) != left_out.end()) {
    output.note("shapes of kind " + in_quotes(kind) + ", which pbrt-v4 does not have, are left out", old.place());
    return {};
  }
  if (old.take("shadowalpha"))
    output.note("\"shadowalpha\", a transparency for shadows alone, is ignored", old.place());
  old.take("discarddegenerateUVs");
  if (kind == "heightfield") return height_field(old);
  if (kind == "trianglemesh") return with_rest(kind, texture_coordinates(old), old);
  Parameters parameters;
  if (kind == "loopsubdiv")
    if (auto levels = old.take("nlevels")) parameters.push_back(renamed(std::move(*levels), "levels"));
  return with_rest(kind, std::move(parameters), old);
}

}  // namespace lanthorn::pbrt
