// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "io/pbrt/builders.h"
#include "io/pbrt/values.h"

namespace lanthorn::pbrt {

namespace {

using namespace description;

SpectrumValue white(ColorSpace space) { return RgbSpectrum{{1, 1, 1}, space}; }

// A light's spectrum is by default the colour space's illuminant, which is what RGB (1,1,1) means for a light.
Emission emission(const ParameterList& list, std::string_view name, Context& context) {
  return {find_spectrum(list, name, SpectrumRole::illuminant, context).value_or(white(context.color_space)),
          list.get("scale", 1.0f)};
}

// "power" and "illuminance" count where they are positive.
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
  if (!(light.cone_delta_angle >= 0 && light.cone_delta_angle <= light.cone_angle))
    throw list.error("conedeltaangle", "must be between 0 and the cone angle");
  return light;
}

DistantLight distant_light(const ParameterList& list, Context& context) {
  DistantLight light;
  light.radiance = emission(list, "L", context);
  light.from = list.get("from", light.from);
  light.to = list.get("to", light.to);
  check_aim(list, light.from, light.to);
  light.illuminance = find_positive(list, "illuminance");
  return light;
}

InfiniteLight infinite_light(const ParameterList& list, Context& context) {
  InfiniteLight light;
  light.radiance = emission(list, "L", context);
  light.illuminance = find_positive(list, "illuminance");
  if (const auto name = list.find_string("filename"); name && !name->empty()) {
    if (list.has("L")) throw list.error("filename", "cannot be given together with \"L\"");
    light.image = context.add_file(*name).string();
    light.image_space = ColorSpace::srgb;
  }
  if (const Parameter* portal = list.find("portal"))
    context.warn("portal", portal->place,
                 "portals of infinite lights are not supported yet: the whole sphere gives light");
  return light;
}

}  // namespace

std::optional<Light> make_light(const std::string& kind, const ParameterList& list, const Transform& light_to_world,
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
    context.warn("light goniometric", list.place(),
                 "light \"goniometric\" is not supported yet: replaced by a point light without its image");
    list.find("filename");
    light.node = point_light(list, context);
  } else if (kind == "projection") {
    context.warn("light projection", list.place(), "light \"projection\" is not supported yet: ignored");
    return {};
  } else {
    throw Error(light.location, "unknown light " + in_quotes(kind));
  }
  report_unused(list, context);
  return light;
}

AreaLight make_area_light(const std::string& kind, const ParameterList& list, Context& context) {
  if (kind != "diffuse") throw Error(list.place().location(), "unknown area light " + in_quotes(kind));
  AreaLight light;
  light.location = list.place().location();
  light.radiance.value =
      find_spectrum(list, "L", SpectrumRole::illuminant, context).value_or(white(context.color_space));
  light.scale = list.get("scale", 1.0f);
  light.two_sided = list.get("twosided", false);
  light.power = find_positive(list, "power");
  if (const auto name = list.find_string("filename"); name && !name->empty()) {
    light.image = context.add_file(*name).string();
    context.warn("area light image", list.find("filename")->place,
                 "emission images of area lights are not supported yet: the light is of one colour");
  }
  report_unused(list, context);
  return light;
}

}  // namespace lanthorn::pbrt
