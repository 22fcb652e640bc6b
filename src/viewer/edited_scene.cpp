// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/edited_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <type_traits>
#include <utility>
#include <variant>

#include "io/pbrt/tokenizer.h"
#include "lanthorn/error.h"
#include "lanthorn/scene.h"

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

namespace {

// Byte of the text at a line and column, both from 1.
std::size_t offset_of(std::string_view text, const SourceLocation& at) {
  std::size_t start = 0;
  for (int line = 1; line < at.line; ++line) {
    start = text.find('\n', start);
    if (start == text.npos) throw Error(at, "the file has changed since it was read");
    ++start;
  }
  const std::size_t offset = start + static_cast<std::size_t>(std::max(at.column, 1)) - 1;
  if (offset > text.size()) throw Error(at, "the file has changed since it was read");
  return offset;
}

bool is_name(const pbrt::Token& token) {
  return token.kind == pbrt::TokenKind::word && std::isalpha(static_cast<unsigned char>(token.text.front())) != 0 &&
         token.text != "true" && token.text != "false";
}

// The end of the directive that begins here: of its last string, number or list before the next name.
std::size_t end_of_directive(std::string_view text, std::size_t at) {
  const auto end_of = [&](const pbrt::Token& token) {
    const std::size_t quote = token.kind == pbrt::TokenKind::string ? 1 : 0;
    return static_cast<std::size_t>(token.text.data() - text.data()) + token.text.size() + quote;
  };
  pbrt::Tokenizer tokens(text.substr(at), nullptr);
  std::size_t end = end_of(tokens.next());
  for (pbrt::Token token = tokens.next(); token.kind != pbrt::TokenKind::end && !is_name(token); token = tokens.next())
    end = end_of(token);
  return end;
}

// Written as a float if it is one, which takes fewer digits.
std::string text_of(double x) {
  const auto single = static_cast<float>(x);
  return static_cast<double>(single) == x ? fmt::format("{}", single) : fmt::format("{}", x);
}

std::string transform_text(const Transform& t) {
  std::string text = "Transform [";
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) text += " " + text_of(t.matrix[column][row]);
  return text + " ]";
}

// The parameter if it differs from `before`. A parameter replaces earlier ones of the same name (the reader warns of
// this).
template <class Number>
std::string real(const char* name, const Number& now, const Number& before) {
  if (now == before) return "";
  if constexpr (std::is_same_v<Number, float>)
    return fmt::format("\n  \"float {}\" [{}]", name, now);
  else
    return now ? fmt::format("\n  \"float {}\" [{}]", name, *now) : "";
}
std::string colour(const char* name, const SpectrumValue& now, const SpectrumValue& before) {
  const auto* rgb = std::get_if<RgbSpectrum>(&now);
  const auto* old = std::get_if<RgbSpectrum>(&before);
  if (rgb == nullptr || (old != nullptr && old->rgb == rgb->rgb)) return "";
  return fmt::format("\n  \"rgb {}\" [{} {} {}]", name, rgb->rgb.r, rgb->rgb.g, rgb->rgb.b);
}

std::string parameters_of(const Light& light, const Light& original) {
  return std::visit(
      [&]<class L>(const L& l) -> std::string {
        const L& o = std::get<L>(original.node);  // edits do not change the kind
        std::string text;
        if constexpr (requires { l.radiance; })
          text =
              colour("L", l.radiance.spectrum, o.radiance.spectrum) + real("scale", l.radiance.scale, o.radiance.scale);
        else if constexpr (requires { l.intensity; })
          text = colour("I", l.intensity.spectrum, o.intensity.spectrum) +
                 real("scale", l.intensity.scale, o.intensity.scale);
        else
          text = real("scale", l.scale, o.scale);
        if constexpr (requires { l.power; })
          return text + real("power", l.power, o.power);
        else
          return text + real("illuminance", l.illuminance, o.illuminance);
      },
      light.node);
}

std::string parameters_of(const AreaLight& light, const AreaLight& original) {
  return colour("L", light.radiance.value, original.radiance.value) + real("scale", light.scale, original.scale) +
         real("power", light.power, original.power);
}

class TextEditor {
 public:
  TextEditor(std::string_view text, const SceneDescription& scene) : text_(text), file_(scene.filename) {}

  void before(const SourceLocation& at, const std::string& added) { added_[offset(at)] += added; }
  void after(const SourceLocation& at, const std::string& added) {
    added_[end_of_directive(text_, offset(at))] += added;
  }
  std::string text() const {
    std::string result;
    std::size_t done = 0;
    for (const auto& [place, added] : added_) {
      result += text_.substr(done, place - done);
      result += added;
      done = place;
    }
    return result + std::string(text_.substr(done));
  }

 private:
  std::size_t offset(const SourceLocation& at) const {
    if (at.line == 0 || at.file != file_)
      throw Error(at, "what was edited is not described in the scene's main file: only edits of that can be saved");
    return offset_of(text_, at);
  }

  std::string_view text_;
  std::string file_;
  std::map<std::size_t, std::string> added_;
};

}  // namespace

std::string edited_pbrt(std::string_view text, const SceneDescription& scene, const CameraPose& camera,
                        const SceneDescription& edited) {
  TextEditor editor(text, scene);
  const Transform to_file = translate(scene.origin);
  editor.before(scene.view.camera.location, transform_text((to_file * camera.camera_to_world).inverted()) + "\n");
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light &light = edited.lights.at(i), &original = scene.lights[i];
    if (light == original) continue;
    const bool has_moved = !(light.light_to_world == original.light_to_world);
    if (has_moved)
      editor.before(light.location, "AttributeBegin\n  " + transform_text(to_file * light.light_to_world) + "\n");
    editor.after(light.location, parameters_of(light, original) + (has_moved ? "\nAttributeEnd" : ""));
  }
  std::map<std::pair<int, int>, bool> done;  // shapes of one directive share their light's place
  for (std::size_t i = 0; i < scene.area_lights.size(); ++i) {
    const AreaLight &light = edited.area_lights.at(i), &original = scene.area_lights[i];
    if (!(light == original) && !std::exchange(done[{light.location.line, light.location.column}], true))
      editor.after(light.location, parameters_of(light, original));
  }
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const AnimatedTransform& place = edited.instances.at(i).object_to_world;
    if (place == scene.instances[i].object_to_world) continue;
    const SourceLocation& at = scene.instances[i].location;
    editor.before(at, "AttributeBegin\n  " + transform_text(to_file * place.start) + "\n");
    editor.after(at, "\nAttributeEnd");
  }
  return editor.text();
}

}  // namespace lanthorn
