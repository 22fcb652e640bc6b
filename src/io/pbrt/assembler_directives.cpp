// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Maps directives to the assembler's functions, and implements those that change the current transform.
#include <unordered_map>
#include <utility>

#include "io/pbrt/assembler.h"
#include "math/vec.h"

namespace lanthorn::pbrt {

namespace {

Transform matrix(const Directive& d) {
  DMat4 m;
  for (std::size_t i = 0; i < 16; ++i)
    m[static_cast<glm::length_t>(i / 4)][static_cast<glm::length_t>(i % 4)] = d.numbers[i];
  return Transform(m);
}

}  // namespace

void Assembler::look_at(Directive& d) {
  const auto& v = d.numbers;
  const DVec3 eye{v[0], v[1], v[2]}, target{v[3], v[4], v[5]}, up{v[6], v[7], v[8]};
  if (eye == target || !(glm::length(glm::cross(target - eye, up)) > 0))
    throw Error(d.place.location(), "LookAt needs a target apart from the eye, and an up vector not along the view");
  change_transform([&](const Transform& t) { return t * lanthorn::look_at(eye, target, up); });
}

void Assembler::translate_by(Directive& d) {
  const auto& v = d.numbers;
  change_transform([&](const Transform& t) { return t * translate({v[0], v[1], v[2]}); });
}

void Assembler::rotate_by(Directive& d) {
  const auto& v = d.numbers;
  const DVec3 axis{v[1], v[2], v[3]};
  if (axis == DVec3(0)) throw Error(d.place.location(), "Rotate needs an axis that is not zero");
  change_transform([&](const Transform& t) { return t * rotate(v[0], axis); });
}

void Assembler::scale_by(Directive& d) {
  const auto& v = d.numbers;
  change_transform([&](const Transform& t) { return t * scale({v[0], v[1], v[2]}); });
}

void Assembler::set_transform(Directive& d) {
  const Transform value = matrix(d);
  change_transform([&](const Transform&) { return value; });
}

void Assembler::concat_transform(Directive& d) {
  const Transform value = matrix(d);
  change_transform([&](const Transform& t) { return t * value; });
}

void Assembler::identity(Place) {
  change_transform([](const Transform&) { return Transform(); });
}

void Assembler::transform_begin(Place place) {
  context_.warn("TransformBegin", place, "TransformBegin and TransformEnd are read as AttributeBegin and AttributeEnd");
  attribute_begin(place);
}

void Assembler::world_end(Place place) {
  context_.warn("WorldEnd", place, "WorldEnd has no meaning in pbrt-v4: ignored");
}

template <void (Assembler::*call)(const std::string&, Parameters, Place)>
void Assembler::with_parameters(Directive& d) {
  (this->*call)(d.strings.front(), std::move(d.parameters), d.place);
}

template <void (Assembler::*call)(const std::string&, Place)>
void Assembler::with_name(Directive& d) {
  (this->*call)(d.strings.front(), d.place);
}

template <void (Assembler::*call)(Place)>
void Assembler::alone(Directive& d) {
  (this->*call)(d.place);
}

Assembler::Handler Assembler::handler(std::string_view directive) {
  using A = Assembler;
  static const std::unordered_map<std::string_view, Handler> handlers = {
      {"Accelerator", &A::alone<&A::accelerator>},
      {"ActiveTransform", &A::active_transform},
      {"AreaLightSource", &A::with_parameters<&A::area_light_source>},
      {"Attribute", &A::with_parameters<&A::attribute>},
      {"AttributeBegin", &A::alone<&A::attribute_begin>},
      {"AttributeEnd", &A::alone<&A::attribute_end>},
      {"Camera", &A::with_parameters<&A::camera>},
      {"ColorSpace", &A::with_name<&A::color_space>},
      {"ConcatTransform", &A::concat_transform},
      {"CoordSysTransform", &A::with_name<&A::coord_sys_transform>},
      {"CoordinateSystem", &A::with_name<&A::coordinate_system>},
      {"Film", &A::with_parameters<&A::film>},
      {"Identity", &A::alone<&A::identity>},
      {"Integrator", &A::with_parameters<&A::integrator>},
      {"LightSource", &A::with_parameters<&A::light_source>},
      {"LookAt", &A::look_at},
      {"MakeNamedMaterial", &A::with_parameters<&A::make_named_material>},
      {"MakeNamedMedium", &A::with_parameters<&A::make_named_medium>},
      {"Material", &A::with_parameters<&A::material>},
      {"MediumInterface", &A::medium_interface},
      {"NamedMaterial", &A::with_name<&A::named_material>},
      {"ObjectBegin", &A::with_name<&A::object_begin>},
      {"ObjectEnd", &A::alone<&A::object_end>},
      {"ObjectInstance", &A::with_name<&A::object_instance>},
      {"Option", &A::option},
      {"PixelFilter", &A::with_parameters<&A::pixel_filter>},
      {"ReverseOrientation", &A::alone<&A::reverse_orientation>},
      {"Rotate", &A::rotate_by},
      {"Sampler", &A::with_parameters<&A::sampler>},
      {"Scale", &A::scale_by},
      {"Shape", &A::with_parameters<&A::shape>},
      {"Texture", &A::texture},
      {"Transform", &A::set_transform},
      {"TransformBegin", &A::alone<&A::transform_begin>},
      {"TransformEnd", &A::alone<&A::attribute_end>},
      {"TransformTimes", &A::transform_times},
      {"Translate", &A::translate_by},
      {"WorldBegin", &A::alone<&A::world_begin>},
      {"WorldEnd", &A::alone<&A::world_end>},
      {import_begin, &A::alone<&A::begin_import>},
      {import_end, &A::alone<&A::end_import>},
  };
  return handlers.at(directive);
}

void Assembler::execute(Directive directive) {  // NOLINT(performance-unnecessary-value-param): handlers move from it
  (this->*handler(directive.name))(directive);
}

}  // namespace lanthorn::pbrt
