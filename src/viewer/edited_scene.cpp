// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/edited_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>
#include <variant>

#include "lanthorn/error.h"
#include "lanthorn/light_names.h"

namespace lanthorn {

namespace {

using namespace description;

std::optional<Point> position_of(const Light& light) {
  return std::visit(
      [&]<class L>(const L& l) -> std::optional<Point> {
        if constexpr (!L::kind.has_place)
          return std::nullopt;
        else if constexpr (requires { l.from; })
          return light.light_to_world.point(l.from);
        else
          return light.light_to_world.point(Point(0));
      },
      light.node);
}

// The emission whose colour the user may choose; null if an image determines the colour.
template <class L>
const Emission* emission_of(const L& light) {
  if constexpr (std::is_same_v<L, InfiniteLight>)
    return light.image || light.texels ? nullptr : &light.radiance;
  else if constexpr (requires { light.intensity; })
    return &light.intensity;
  else if constexpr (requires { light.radiance; })
    return &light.radiance;
  else
    return nullptr;
}
const Emission* emission_of(const Light& light) {
  return std::visit([](const auto& l) { return emission_of(l); }, light.node);
}

void set_colour(LightRow& row, const SpectrumValue& spectrum) {
  row.has_colour = true;
  const auto* rgb = std::get_if<RgbSpectrum>(&spectrum);
  if (rgb == nullptr) return;
  const float largest = std::max({rgb->rgb.r, rgb->rgb.g, rgb->rgb.b});
  if (largest > 0) row.colour = (1 / largest) * rgb->rgb;
}

// The spectrum in another colour, with its strongest component unchanged. A file's spectrum stays as it is until the
// user chooses another colour.
SpectrumValue coloured(const SpectrumValue& original, const Rgb& before, const Rgb& colour) {
  if (colour == before) return original;
  const auto* rgb = std::get_if<RgbSpectrum>(&original);
  if (rgb == nullptr) return RgbSpectrum{colour, ColorSpace::srgb};
  return RgbSpectrum{std::max({rgb->rgb.r, rgb->rgb.g, rgb->rgb.b}) * colour, rgb->space};
}

void colour_light(Light& light, const Rgb& before, const Rgb& colour) {
  auto* emission = const_cast<Emission*>(emission_of(light));  // of a light that is not const
  if (emission != nullptr) emission->spectrum = coloured(emission->spectrum, before, colour);
}

std::vector<LightRow> rows_of(const SceneDescription& scene) {
  std::vector<LightRow> rows;
  for (Index i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    LightRow row;
    row.name = fmt::format("{} {}", std::visit([](const auto& l) { return l.kind.label; }, light.node), i + 1);
    row.id = name_of_light(i);
    row.index = i;
    row.position = position_of(light);
    if (const Emission* emission = emission_of(light)) set_colour(row, emission->spectrum);
    rows.push_back(std::move(row));
  }
  for (Index i = 0; i < scene.area_lights.size(); ++i) {
    LightRow row;
    row.name = fmt::format("Lamp {}", i + 1);
    row.id = name_of_area_light(i);
    row.is_area = true;
    row.index = i;
    if (!scene.area_lights[i].radiance.texture) set_colour(row, scene.area_lights[i].radiance.value);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

EditedScene::EditedScene(SharedScene scene)
    : original_(scene), scene_(std::move(scene)), lights_(rows_of(description_of(*original_))) {
  for (const NamedLight& named : lights_of(*original_))
    for (LightRow& row : lights_)
      if (row.id == named.id) row.name = named.words;
}

EditedScene::EditedScene(SharedScene scene, const std::map<std::string, float>& strengths)
    : EditedScene(std::move(scene)) {
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    const auto found = strengths.find(lights_[i].id);
    if (found == strengths.end() || found->second == 1) continue;
    LightRow row = lights_[i];
    row.on = found->second > 0;
    if (row.on) row.strength = found->second;
    set_light(i, row);
  }
}

SceneDescription EditedScene::with_light(const LightRow& row) const {
  SceneDescription edited = description();
  const SceneDescription& scene = description_of(*original_);
  const Rgb before = rows_of(scene)[row.is_area ? scene.lights.size() + row.index : row.index].colour;
  const float factor = row.on ? row.strength : 0;
  if (row.is_area) {
    AreaLight light = scene.area_lights[row.index];
    scale_light(light, factor);
    if (row.has_colour) light.radiance.value = coloured(light.radiance.value, before, row.colour);
    edited.area_lights[row.index] = std::move(light);
    return edited;
  }
  Light light = scene.lights[row.index];
  scale_light(light, factor);
  if (row.has_colour) colour_light(light, before, row.colour);
  if (row.position) light.light_to_world = translate(*row.position - *position_of(light)) * light.light_to_world;
  edited.lights[row.index] = std::move(light);
  return edited;
}

void EditedScene::set_light(std::size_t row, const LightRow& values) {
  LightRow changed = lights_.at(row);
  changed.colour = values.colour;
  changed.strength = values.strength;
  changed.on = values.on;
  apply(with_light(changed));
  lights_[row] = std::move(changed);
}

void EditedScene::move_light(std::size_t row, const Vec3& metres) {
  LightRow changed = lights_.at(row);
  if (!changed.position) throw Error(changed.name + " has no position that could be moved");
  *changed.position += metres;
  apply(with_light(changed));
  lights_[row] = std::move(changed);
}

void EditedScene::move_instance(description::Index instance, const Vec3& metres) {
  SceneDescription edited = description();
  AnimatedTransform& place = edited.instances.at(instance).object_to_world;
  const Transform move = translate(metres);
  place = place.is_moving() ? AnimatedTransform(move * place.start, move * place.end, place.start_time, place.end_time)
                            : AnimatedTransform(move * place.start);
  apply(std::move(edited));
}

}  // namespace lanthorn
