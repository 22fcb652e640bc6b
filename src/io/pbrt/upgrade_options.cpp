// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Camera, film, filter, sampler, integrator, media and shapes.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "io/pbrt/upgrade_parts.h"
#include "lanthorn/text.h"
#include "math/vec.h"

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
  return {std::move(kind), old.with_rest(std::move(parameters))};
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
    output.note("pixels of the camera \"realistic\" hold the film's irradiance, as in pbrt-v4: the brightness differs",
                old.place());
  }
  return with_rest(kind, std::move(parameters), old);
}

// In pbrt-v3, the exposure time does not affect the brightness.
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

namespace {

// A pbrt-v2 integrator. Lanthorn's method of the same name has the same parameters under other names.
Upgraded upgrade_photon_map(const std::string& kind, OldParameters old, UpgradeOutput& output) {
  constexpr std::array<Renamed, 4> names = {{{"causticphotons", "caustic-photons"},
                                             {"finalgathersamples", "gather"},
                                             {"indirectphotons", "photonsperiteration"},
                                             {"maxdist", "max-radius"}}};
  constexpr int most_nearest = 256;  // limit of `photonmap`
  Parameters parameters;
  for (const auto& [v2, ours] : names)
    if (auto given = old.take(v2)) parameters.push_back(renamed(std::move(*given), std::string(ours)));
  if (const auto nearest = old.take_integer("nused"))
    parameters.push_back(integer_parameter("nearest", std::min(*nearest, most_nearest), old.place()));
  // Limits for the eye path up to the first surface that is not a mirror, and for photon paths.
  const auto eye = old.take_integer("maxspeculardepth"), photon = old.take_integer("maxphotondepth");
  constexpr int otherwise = 5, most = 1 << 20;
  if (eye || photon)
    parameters.push_back(integer_parameter(
        "maxdepth", std::min(eye.value_or(otherwise), most) + std::min(photon.value_or(otherwise), most), old.place()));
  old.take("gatherangle");
  const bool gathers = old.take_bool("finalgather").value_or(true);
  output.note("the integrator " + in_quotes(kind) + " is of pbrt-v2: Lanthorn's photonmap replaces it" +
                  (gathers ? "" : ", which uses final gathering although \"finalgather\" is false"),
              old.place());
  return with_rest("photonmap", std::move(parameters), old);
}

}  // namespace

UpgradedIntegrator upgrade_integrator(const std::string& kind, OldParameters old, UpgradeOutput& output) {
  const bool is_sppm = kind == "sppm";
  std::optional<int> passes;
  for (const char* name : {"iterations", "numiterations"})
    if (const auto given = is_sppm ? old.take_integer(name) : std::nullopt) passes = given;
  if (is_sppm) old.take("imagewritefrequency");
  if (kind == "ambientocclusion") old.take("nsamples");
  for (const char* without_meaning : {"rrthreshold", "lightsamplestrategy"}) old.take(without_meaning);
  if (kind == "photonmap" || kind == "exphotonmap") return {upgrade_photon_map(kind, std::move(old), output), passes};
  if (kind != "whitted" && kind != "directlighting") return {with_rest(kind, {}, old), passes};
  old.take("strategy");
  output.note(
      "the integrator " + in_quotes(kind) + " is replaced by \"path\", which also includes all other light paths",
      old.place());
  return {with_rest("path", {}, old), passes};
}

Parameters upgrade_medium(OldParameters old) {
  const Place place = old.place();
  const std::string kind = old.take_string("type").value_or("");
  const bool is_grid = kind == "heterogeneous";
  Parameters parameters{string_parameter("type", is_grid ? "uniformgrid" : kind, place)};
  if (is_grid && !old.has("preset")) {  // default milk, as for a homogeneous medium
    if (!old.has("sigma_a")) parameters.push_back(rgb_parameter("sigma_a", {0.0011f, 0.0024f, 0.014f}, place));
    if (!old.has("sigma_s")) parameters.push_back(rgb_parameter("sigma_s", {2.55f, 3.21f, 3.77f}, place));
  }
  return old.with_rest(std::move(parameters));
}

namespace {

// Texture coordinates as a list of "float" or "point2", under either of two names.
Parameters texture_coordinates(OldParameters& old) {
  std::optional<Parameter> uv;
  for (const char* name : {"st", "uv"})
    if (auto given = old.take(name)) uv = std::move(given);
  if (!uv) return {};
  if (uv->type == ParameterType::real) uv->type = ParameterType::point2;
  uv->name = "uv";
  return {std::move(*uv)};
}

// Normals may be empty.
Upgraded triangle_mesh(std::vector<float> points, std::vector<float> normals, std::vector<float> texture_coordinates,
                       std::vector<std::int32_t> triangles, OldParameters& old) {
  const Place place = old.place();
  Parameters parameters;
  const auto add = [&](const char* name, ParameterType type, auto values) {
    parameters.push_back(float_parameter(name, 0, place));
    parameters.back().type = type;
    parameters.back().values = std::move(values);
  };
  add("P", ParameterType::point3, std::move(points));
  if (!normals.empty()) add("N", ParameterType::normal, std::move(normals));
  add("uv", ParameterType::point2, std::move(texture_coordinates));
  add("indices", ParameterType::integer, std::move(triangles));
  return with_rest("trianglemesh", std::move(parameters), old);
}

// The surface of revolution of a curve around the z axis. `curve`: its points at v in [0,1].
template <class Curve>
Upgraded swept(const Curve& curve, OldParameters& old) {
  constexpr int around = 128, along = 32;
  const float phi_max = to_radians(std::clamp(old.take_float("phimax").value_or(360), 0.0f, 360.0f));
  std::vector<float> points, normals, uvs;
  std::vector<std::int32_t> triangles;
  for (int j = 0; j <= along; ++j) {
    const float v = sqr(static_cast<float>(j) / along);  // denser towards v = 0, the tip of a paraboloid
    constexpr float inside = 1e-3f;                      // a tip takes its normal from slightly inside
    const float w = std::clamp(v, inside, 1 - inside);
    const Vec3 at = curve(v), near = curve(w);
    const Vec3 normal = cross(Vec3(-near.y, near.x, 0), curve(w + inside) - curve(w - inside));
    for (int i = 0; i <= around; ++i) {
      const float u = static_cast<float>(i) / around, c = std::cos(phi_max * u), s = std::sin(phi_max * u);
      const auto append = [&](std::vector<float>& list, const Vec3& x) {
        list.insert(list.end(), {c * x.x - s * x.y, s * x.x + c * x.y, x.z});
      };
      append(points, at);
      append(normals, normal);
      uvs.insert(uvs.end(), {u, v});
      const int here = j * (around + 1) + i, up = here + around + 1;
      if (i < around && j < along) triangles.insert(triangles.end(), {here, here + 1, up + 1, here, up + 1, up});
    }
  }
  return triangle_mesh(std::move(points), std::move(normals), std::move(uvs), std::move(triangles), old);
}

Vec3 take_point(OldParameters& old, const char* name, const Vec3& otherwise) {
  const auto given = old.take(name);
  if (!given) return otherwise;
  const auto* values = std::get_if<std::vector<float>>(&given->values);
  if (values == nullptr || values->size() != 3)
    throw Error(given->place.location(), old.entity() + ": " + in_quotes(name) + " must be a point");
  return {(*values)[0], (*values)[1], (*values)[2]};
}

// The quadrics that pbrt-v4 does not have; nullopt for other kinds.
std::optional<Upgraded> quadric(const std::string& kind, OldParameters& old) {
  const auto line = [&](const Vec3& from, const Vec3& to) {
    return swept([&](float v) { return from + v * (to - from); }, old);
  };
  if (kind == "cone") {
    const float radius = old.take_float("radius").value_or(1), height = old.take_float("height").value_or(1);
    return line({radius, 0, 0}, {0, 0, height});
  }
  if (kind == "hyperboloid") {
    const Vec3 first = take_point(old, "p1", Vec3(0));
    return line(first, take_point(old, "p2", Vec3(1)));
  }
  if (kind != "paraboloid") return {};
  const float radius = old.take_float("radius").value_or(1);
  const float low = old.take_float("zmin").value_or(0), high = old.take_float("zmax").value_or(1);
  if (!(low >= 0 && low < high)) throw Error(old.place().location(), old.entity() + " needs 0 <= zmin < zmax");
  return swept(
      [&](float v) {
        const float z = low + v * (high - low);
        return Vec3(radius * std::sqrt(z / high), 0, z);
      },
      old);
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
  return triangle_mesh(std::move(points), {}, std::move(uvs), std::move(triangles), old);
}

}  // namespace

std::optional<Upgraded> upgrade_shape(const std::string& kind, OldParameters old, UpgradeOutput& output) {
  if (kind == "nurbs") {
    output.note("shapes of kind \"nurbs\", which pbrt-v4 does not have, are left out", old.place());
    return {};
  }
  if (old.take("shadowalpha")) output.note("\"shadowalpha\", a transparency for shadows only, is ignored", old.place());
  old.take("discarddegenerateUVs");
  if (kind == "heightfield") return height_field(old);
  if (auto mesh = quadric(kind, old)) {
    output.note("shapes of kind " + in_quotes(kind) + ", which pbrt-v4 does not have, are converted to triangles",
                old.place());
    return mesh;
  }
  if (kind == "trianglemesh") return with_rest(kind, texture_coordinates(old), old);
  Parameters parameters;
  if (kind == "loopsubdiv")
    if (auto levels = old.take("nlevels")) parameters.push_back(renamed(std::move(*levels), "levels"));
  return with_rest(kind, std::move(parameters), old);
}

}  // namespace lanthorn::pbrt
