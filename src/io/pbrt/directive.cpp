// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/directive.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <type_traits>

#include "spectrum/curve.h"

namespace lanthorn::pbrt {

namespace {

constexpr std::string_view kind_or_name = "a kind or name in quotes";
constexpr std::string_view a_name = "a name in quotes";
constexpr std::string_view coordinates = "the name of a coordinate system";

constexpr std::array<DirectiveForm, 45> forms = {{
    {"Accelerator", 0, {"the kind of accelerator in quotes"}, true},
    {"ActiveTransform"},
    {"AreaLightSource", 0, {kind_or_name}, true},
    {"Attribute", 0, {kind_or_name}, true},
    {"AttributeBegin"},
    {"AttributeEnd"},
    {"Camera", 0, {kind_or_name}, true},
    {"ColorSpace", 0, {a_name}},
    {"ConcatTransform", 16},
    {"CoordSysTransform", 0, {coordinates}},
    {"CoordinateSystem", 0, {coordinates}},
    {"Film", 0, {kind_or_name}, true},
    {"Identity"},
    {"Import", 0, {"a file name in quotes"}},
    {"Include", 0, {"a file name in quotes"}},
    {"Integrator", 0, {kind_or_name}, true},
    {"LightSource", 0, {kind_or_name}, true},
    {"LookAt", 9},
    {"MakeNamedMaterial", 0, {kind_or_name}, true},
    {"MakeNamedMedium", 0, {kind_or_name}, true},
    {"Material", 0, {kind_or_name}, true},
    {"MediumInterface", 0, {"the name of a medium in quotes"}},
    {"NamedMaterial", 0, {a_name}},
    {"ObjectBegin", 0, {a_name}},
    {"ObjectEnd"},
    {"ObjectInstance", 0, {a_name}},
    {"Option", 0, {"the name of an option"}},
    {"PixelFilter", 0, {kind_or_name}, true},
    {"Renderer", 0, {kind_or_name}, true, true},
    {"ReverseOrientation"},
    {"Rotate", 4},
    {"Sampler", 0, {kind_or_name}, true},
    {"Scale", 3},
    {"Shape", 0, {kind_or_name}, true},
    {"SurfaceIntegrator", 0, {kind_or_name}, true, true},
    {"Texture",
     0,
     {"the texture's name in quotes", "the texture's type in quotes", "the kind of texture in quotes"},
     true},
    {"Transform", 16},
    {"TransformBegin"},
    {"TransformEnd"},
    {"TransformTimes", 2},
    {"Translate", 3},
    {"Volume", 0, {kind_or_name}, true, true},
    {"VolumeIntegrator", 0, {kind_or_name}, true, true},
    {"WorldBegin"},
    {"WorldEnd"},
}};

constexpr bool is_before(const DirectiveForm& form, std::string_view name) { return form.name < name; }
static_assert(std::is_sorted(forms.begin(), forms.end(),
                             [](const DirectiveForm& a, const DirectiveForm& b) { return is_before(a, b.name); }));

constexpr std::size_t line_width = 100;
constexpr std::size_t indentation = 2;

std::string string_token(std::string_view text) {
  constexpr std::string_view letters = "bfnrt\\\"", meanings = "\b\f\n\r\t\\\"";
  std::string result = "\"";
  for (const char c : text) {
    if (const std::size_t i = meanings.find(c); i != meanings.npos) {
      result += '\\';
      result += letters[i];
    } else {
      result += c;
    }
  }
  return result + '"';
}

template <class Number>
std::string text_of(Number value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

// True if the strings of the parameter name files that are read.
bool names_files(const Directive& d, const Parameter& p) {
  constexpr std::array<std::string_view, 3> names = {"filename", "lensfile", "normalmap"};
  if (p.type == ParameterType::spectrum) return true;
  return p.type == ParameterType::string && d.name != "Film" &&
         std::find(names.begin(), names.end(), p.name) != names.end();
}

}  // namespace

const DirectiveForm* find_form(std::string_view name) {
  const auto* it = std::lower_bound(forms.begin(), forms.end(), name, is_before);
  return it != forms.end() && it->name == name ? it : nullptr;
}

void Writer::begin_line(std::size_t extra_indent) {
  if (!text_.empty()) text_ += '\n';
  line_start_ = text_.size();
  text_.append(indent_ + extra_indent, ' ');
}

void Writer::write_word(std::string_view word) {
  if (text_.size() + word.size() > line_start_ + line_width) begin_line(2 * indentation);
  if (text_.size() > line_start_ && text_.back() != ' ') text_ += ' ';
  text_ += word;
}

void Writer::write_numbers(const Directive& d, std::size_t count) {
  if (count == 16) write_word("[");
  for (std::size_t i = 0; i < count; ++i) write_word(text_of(d.numbers[i]));
  if (count == 16) write_word("]");
}

std::string Writer::moved(const std::string& file) const {
  if (folder_ == target_ || file.empty() || std::filesystem::path(file).is_absolute()) return file;
  return (folder_ / file).lexically_normal().lexically_proximate(target_).string();
}

void Writer::write_parameter(const Directive& d, const Parameter& p) {
  begin_line(2 * indentation);
  write_word(string_token(std::string(name_of(p.type)) + " " + p.name));
  write_word("[");
  const bool is_file = names_files(d, p);
  const auto write_value = [&](const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, std::string>)
      write_word(string_token(is_file && named_spectrum(value.c_str()) == nullptr ? moved(value) : value));
    else if constexpr (std::is_same_v<Value, bool>)
      write_word(value ? "true" : "false");
    else
      write_word(text_of(value));
  };
  std::visit(
      [&](const auto& values) {
        for (const auto& value : values) write_value(value);
      },
      p.values);
  write_word("]");
}

void Writer::write(const Directive& d) {
  const bool is_end = d.name == "AttributeEnd" || d.name == "ObjectEnd";
  if (is_end && indent_ >= indentation) indent_ -= indentation;
  begin_line(0);
  write_word(d.name);
  write_numbers(d, find_form(d.name)->numbers);
  for (const std::string& s : d.strings) write_word(d.name == "ActiveTransform" ? s : string_token(s));
  for (const Parameter& p : d.parameters) write_parameter(d, p);
  if (d.name == "AttributeBegin" || d.name == "ObjectBegin") indent_ += indentation;
}

}  // namespace lanthorn::pbrt
