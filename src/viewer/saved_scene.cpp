// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/saved_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <type_traits>
#include <utility>
#include <variant>

#include "io/pbrt/tokenizer.h"
#include "lanthorn/error.h"

namespace lanthorn {

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
std::string colour(const char* name, const description::SpectrumValue& now, const description::SpectrumValue& before) {
  const auto* rgb = std::get_if<description::RgbSpectrum>(&now);
  const auto* old = std::get_if<description::RgbSpectrum>(&before);
  if (rgb == nullptr || (old != nullptr && old->rgb == rgb->rgb)) return "";
  return fmt::format("\n  \"rgb {}\" [{} {} {}]", name, rgb->rgb.r, rgb->rgb.g, rgb->rgb.b);
}

std::string parameters_of(const description::Light& light, const description::Light& original) {
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

std::string parameters_of(const description::AreaLight& light, const description::AreaLight& original) {
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
    const description::Light &light = edited.lights.at(i), &original = scene.lights[i];
    if (light == original) continue;
    const bool has_moved = !(light.light_to_world == original.light_to_world);
    if (has_moved)
      editor.before(light.location, "AttributeBegin\n  " + transform_text(to_file * light.light_to_world) + "\n");
    editor.after(light.location, parameters_of(light, original) + (has_moved ? "\nAttributeEnd" : ""));
  }
  std::map<std::pair<int, int>, bool> done;  // shapes of one directive share their light's place
  for (std::size_t i = 0; i < scene.area_lights.size(); ++i) {
    const description::AreaLight &light = edited.area_lights.at(i), &original = scene.area_lights[i];
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
