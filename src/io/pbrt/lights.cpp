// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "io/pbrt/builders.h"
#include "io/pbrt/values.h"
#include "math/vec.h"

namespace lanthorn::pbrt {

namespace {

using namespace description;

SpectrumValue white(ColorSpace space) { return RgbSpectrum{{1, 1, 1}, space}; }

// A light's default spectrum is the colour space's illuminant, which is also what RGB (1,1,1) means for a light.
Emission emission(const ParameterList& list, std::string_view name, Context& context) {
  return {find_spectrum(list, name, SpectrumRole::illuminant, context).value_or(white(context.color_space)),
          list.get("scale", 1.0f)};
}

// "power" and "illuminance" take effect only if they are positive.
std::optional<float> find_positive(const ParameterList& list, std::string_view name) {
  const auto value = list.find_float(name);
  return value && *value > 0 ? value : std::nullopt;
}

PointLight point_light(const ParameterList& list, Context& context) {
  return {emission(list, "I", context), list.get("from", Point(0)), find_positive(list, "power")};
}

void check_aim(const ParameterList& list, const Point& from, const Point& to) {
  if (from == to) throw list.error("from", "is the same point as \"to\"");
}

SpotLight spot_light(const ParameterList& list, Context& context) {
  SpotLight light;
  light.intensity = emission(list, "I", context);
  light.from = list.get("from", light.from);
  light.to = list.get("to", light.to);
  check_aim(list, light.from, light.to);
  light.cone_angle = list.get("coneangle", light.cone_angle);
  light.cone_delta_angle = list.get("conedeltaangle", light.cone_delta_angle);
  light.power = find_positive(list, "power");
  if (!(light.cone_angle > 0 && light.cone_angle <= 180)) throw list.error("coneangle", "must be in (0, 180] degrees");
  if (!(light.cone_delta_angle >= 0)) throw list.error("conedeltaangle", "must not be negative");
  // pbrt takes the cosine of the angle at which the edge begins, so its sign does not matter. If that angle exceeds the
  // cone's, the edge is sharp, as in pbrt-v3. pbrt-v4 would turn such a spot inside out: with the default of 5 degrees,
  // a cone of 2 degrees would light everything outside it.
  const float edge_start = std::fabs(light.cone_angle - light.cone_delta_angle);
  light.cone_delta_angle = light.cone_angle - std::min(edge_start, light.cone_angle);
  return light;
}

DistantLight distant_light(const ParameterList& list, Context& context) {
  DistantLight light;
  light.radiance = emission(list, "L", context);
  light.from = list.get("from", light.from);
  light.to = list.get("to", light.to);
  check_aim(list, light.from, light.to);
  light.angle = list.get("angle", light.angle);
  if (!(light.angle >= 0 && light.angle < 180)) throw list.error("angle", "must be in [0, 180) degrees");
  light.illuminance = find_positive(list, "illuminance");
  return light;
}

// The corners of a rectangle, in order. As in pbrt-v4, they are in world space, unaffected by the current transform.
std::array<Point, 4> portal(const ParameterList& list) {
  const std::vector<Vec3> p = list.vec3s("portal");
  if (p.size() != 4) throw list.error("portal", "needs four points, has " + std::to_string(p.size()));
  const Vec3 up = p[1] - p[0], across = p[3] - p[0], closing = p[2] - p[0] - up - across;
  const float size = std::sqrt(std::max(length_squared(up), length_squared(across)));
  constexpr float tolerance = 1e-3f;
  const bool is_rectangle =
      std::sqrt(length_squared(closing)) <= tolerance * size &&
      std::fabs(dot(up, across)) <= tolerance * std::sqrt(length_squared(up) * length_squared(across));
  if (!is_rectangle || !(length_squared(cross(up, across)) > 0))
    throw list.error("portal", "must go around the corners of a rectangle");
  return {p[0], p[1], p[2], p[3]};
}

InfiniteLight infinite_light(const ParameterList& list, Context& context) {
  InfiniteLight light;
  light.radiance = emission(list, "L", context);
  light.illuminance = find_positive(list, "illuminance");
  if (const auto name = list.find_string("filename"); name && !name->empty()) {
    if (list.has("L")) throw list.error("filename", "cannot be given together with \"L\"");
    light.image = context.add_file(*name, list.place()).string();
    light.image_space = ColorSpace::srgb;
  }
  if (list.has("portal")) light.portal = portal(list);
  return light;
}

GoniometricLight goniometric_light(const ParameterList& list, Context& context) {
  return {emission(list, "I", context), context.add_file(list.required_string("filename"), list.place()).string(),
          find_positive(list, "power")};
}

ProjectionLight projection_light(const ParameterList& list, Context& context) {
  ProjectionLight light;
  light.image = context.add_file(list.required_string("filename"), list.place()).string();
  light.scale = list.get("scale", light.scale);
  light.fov = list.get("fov", light.fov);
  light.power = find_positive(list, "power");
  if (!(light.fov > 0 && light.fov < 180)) throw list.error("fov", "must be between 0 and 180 degrees");
  return light;
}

// The image of a goniometric light has y up.
Transform swapped_y_and_z() {
  DMat4 m(1.0);
  m[1] = {0, 0, 1, 0};
  m[2] = {0, 1, 0, 0};
  return {m, m};
}

}  // namespace

Light make_light(const std::string& kind, const ParameterList& list, const Transform& light_to_world,
                 Context& context) {
  Light light;
  light.light_to_world = light_to_world;
  light.location = list.place().location();
  if (kind == "point") {
    light.node = point_light(list, context);
  } else if (kind == "spot") {
    light.node = spot_light(list, context);
  } else if (kind == "distant") {
    light.node = distant_light(list, context);
  } else if (kind == "infinite") {
    light.node = infinite_light(list, context);
  } else if (kind == "goniometric") {
    light.node = goniometric_light(list, context);
    light.light_to_world = light_to_world * swapped_y_and_z();
  } else if (kind == "projection") {
    light.node = projection_light(list, context);
  } else {
    throw Error(light.location, "unknown light " + in_quotes(kind));
  }
  report_unused(list, context);
  return light;
}

namespace {

// An emitter's image is a bilinear texture with its top at v = 1. Black if the image is missing and skipped.
SpectrumParameter emission_image(const std::string& name, const SourceLocation& location, Context& context) {
  ImageTexture image;
  image.filename = context.add_file(name, location).string();
  if (context.leaves_out(image.filename)) return {0.0f, {}};
  image.wrap = Wrap::clamp;
  context.scene.spectrum_textures.push_back({image, location});
  return {white(context.color_space), static_cast<Index>(context.scene.spectrum_textures.size() - 1)};
}

}  // namespace

AreaLight make_area_light(const std::string& kind, const ParameterList& list, Context& context) {
  if (kind != "diffuse") throw context.unknown("area light", "AreaLightSource", kind, list.place());
  AreaLight light;
  light.location = list.place().location();
  light.radiance = find_spectrum_or_texture(list, "L", SpectrumRole::illuminant, context)
                       .value_or(SpectrumParameter{white(context.color_space), {}});
  light.scale = list.get("scale", 1.0f);
  light.two_sided = list.get("twosided", false);
  light.power = find_positive(list, "power");
  if (const auto name = list.find_string("filename"); name && !name->empty()) {
    if (list.has("L")) throw list.error("filename", "cannot be given together with \"L\"");
    light.radiance = emission_image(*name, light.location, context);
  }
  report_unused(list, context);
  return light;
}

}  // namespace lanthorn::pbrt
