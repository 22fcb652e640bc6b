// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/parser.h"
#include "math/vec.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace lanthorn::pbrt {

namespace {

constexpr std::size_t deepest_include = 64;
constexpr std::size_t most_files = 100'000;
constexpr std::size_t most_parameters = 1000;

Error unexpected(const Token& found, const std::string& wanted) {
  return {found.place.location(), "expected " + wanted + ", found " + describe(found)};
}

bool bool_value(const Token& token) {
  if (token.text == "true") return true;
  if (token.text == "false") return false;
  throw unexpected(token, "true or false");
}

}  // namespace

Parser::Parser(std::string_view text, const std::string& name, FileStack& files, Assembler& assembler, Context& context)
    : name_(name),
      tokens_(text, &name_),
      ahead_(tokens_.next()),
      files_(files),
      assembler_(assembler),
      context_(context) {}

Place Parser::parse() {
  while (ahead_.kind != TokenKind::end) directive(next());
  return ahead_.place;
}

Token Parser::next() { return std::exchange(ahead_, ahead_.kind == TokenKind::end ? ahead_ : tokens_.next()); }

void Parser::directive(const Token& token) {
  if (token.kind != TokenKind::word) throw unexpected(token, "a directive");
  const Handler handle = handler(token.text);
  if (!handle) throw Error(token.place.location(), "unknown directive " + in_quotes(token.text));
  (this->*handle)(token.place);
}

std::string Parser::expect_string(const char* what) {
  const Token token = next();
  if (token.kind != TokenKind::string) throw unexpected(token, what);
  return string_value(token);
}

float Parser::expect_number() { return float_value(next()); }

template <std::size_t N>
std::array<float, N> Parser::expect_numbers() {
  std::array<float, N> result{};
  for (float& value : result) value = expect_number();
  return result;
}

Mat4 Parser::expect_matrix() {
  if (const Token open = next(); open.kind != TokenKind::open) throw unexpected(open, "\"[\" and 16 numbers");
  const auto v = expect_numbers<16>();
  if (const Token close = next(); close.kind != TokenKind::close) throw unexpected(close, "\"]\" after 16 numbers");
  Mat4 m;
  for (std::size_t i = 0; i < 16; ++i) m[static_cast<glm::length_t>(i / 4)][static_cast<glm::length_t>(i % 4)] = v[i];
  return m;
}

Parameters Parser::parameters() {
  Parameters result;
  while (ahead_.kind == TokenKind::string) {
    if (result.size() >= most_parameters)
      throw Error(ahead_.place.location(),
                  "a directive has more than " + std::to_string(most_parameters) + " parameters");
    result.push_back(parameter());
  }
  return result;
}

Parameter Parser::parameter() {
  const Token declaration = next();
  const std::string text = string_value(declaration);
  constexpr const char* blanks = " \t";
  const std::size_t type_begin = text.find_first_not_of(blanks), type_end = text.find_first_of(blanks, type_begin);
  const std::size_t name_begin = text.find_first_not_of(blanks, type_end);
  if (type_begin == text.npos || type_end == text.npos || name_begin == text.npos)
    throw Error(declaration.place.location(), "expected a parameter \"type name\", found " + in_quotes(text));
  const std::string type = text.substr(type_begin, type_end - type_begin);
  const auto known = parameter_type(type);
  if (!known) throw Error(declaration.place.location(), "unknown parameter type " + in_quotes(type));
  Parameter result;
  result.type = *known;
  result.name = text.substr(name_begin, text.find_last_not_of(blanks) + 1 - name_begin);
  result.place = declaration.place;
  result.color_space = assembler_.current_color_space();
  result.values = values(result);
  return result;
}

template <class T, class Read>
std::vector<T> Parser::read_values(Read&& read) {
  std::vector<T> result;
  if (ahead_.kind != TokenKind::open) {
    result.push_back(read(next()));
    return result;
  }
  next();
  while (ahead_.kind != TokenKind::close) {
    if (ahead_.kind == TokenKind::end) throw unexpected(ahead_, "a value or \"]\"");
    result.push_back(read(next()));
  }
  next();
  return result;
}

Parameter::Values Parser::values(const Parameter& parameter) {
  const auto read_string = [](const Token& token) {
    if (token.kind != TokenKind::string) throw unexpected(token, "a string in quotes");
    return string_value(token);
  };
  switch (parameter.type) {
    case ParameterType::integer:
      return read_values<std::int32_t>(integer_value);
    case ParameterType::boolean:
      return read_values<bool>(bool_value);
    case ParameterType::string:
    case ParameterType::texture:
      return read_values<std::string>(read_string);
    case ParameterType::spectrum: {
      if (ahead_.kind == TokenKind::string) return read_values<std::string>(read_string);
      // Names or numbers, as the first value.
      std::vector<std::string> names;
      auto numbers = read_values<float>([&](const Token& token) {
        if (token.kind != TokenKind::string) return float_value(token);
        names.push_back(string_value(token));
        return 0.0f;
      });
      if (names.empty()) return numbers;
      if (names.size() != numbers.size())
        throw Error(parameter.place.location(), "spectrum " + in_quotes(parameter.name) + " mixes names and numbers");
      return names;
    }
    default:
      return read_values<float>(float_value);
  }
}

void Parser::look_at(Place place) {
  const auto v = expect_numbers<9>();
  const Point eye{v[0], v[1], v[2]}, target{v[3], v[4], v[5]};
  const Vec3 up{v[6], v[7], v[8]};
  if (eye == target || !(length_squared(cross(target - eye, up)) > 0))
    throw Error(place.location(), "LookAt needs a target apart from the eye, and an up vector not along the view");
  assembler_.change_transform([&](const Transform& t) { return t * lanthorn::look_at(eye, target, up); });
}

void Parser::translate(Place) {
  const auto v = expect_numbers<3>();
  assembler_.change_transform([&](const Transform& t) { return t * lanthorn::translate({v[0], v[1], v[2]}); });
}

void Parser::rotate_by(Place place) {
  const auto v = expect_numbers<4>();
  const Vec3 axis{v[1], v[2], v[3]};
  if (axis == Vec3(0)) throw Error(place.location(), "Rotate needs an axis that is not zero");
  assembler_.change_transform([&](const Transform& t) { return t * rotate(v[0], axis); });
}

void Parser::scale_by(Place) {
  const auto v = expect_numbers<3>();
  assembler_.change_transform([&](const Transform& t) { return t * scale({v[0], v[1], v[2]}); });
}

void Parser::transform(Place) {
  const Transform value(expect_matrix());
  assembler_.change_transform([&](const Transform&) { return value; });
}

void Parser::concat_transform(Place) {
  const Transform value(expect_matrix());
  assembler_.change_transform([&](const Transform& t) { return t * value; });
}

void Parser::identity(Place) {
  assembler_.change_transform([](const Transform&) { return Transform(); });
}

void Parser::coordinate_system(Place) {
  assembler_.coordinate_system(expect_string("the name of a coordinate system"));
}

void Parser::coord_sys_transform(Place place) {
  assembler_.coord_sys_transform(expect_string("the name of a coordinate system"), place);
}

void Parser::active_transform(Place) {
  const Token token = next();
  if (token.text == "All")
    assembler_.active_transform(true, true);
  else if (token.text == "StartTime")
    assembler_.active_transform(true, false);
  else if (token.text == "EndTime")
    assembler_.active_transform(false, true);
  else
    throw unexpected(token, "All, StartTime or EndTime");
}

void Parser::transform_times(Place place) {
  const auto v = expect_numbers<2>();
  assembler_.transform_times(v[0], v[1], place);
}

void Parser::transform_begin(Place place) {
  context_.warn("TransformBegin", place, "TransformBegin and TransformEnd are read as AttributeBegin and AttributeEnd");
  assembler_.attribute_begin(place);
}

void Parser::transform_end(Place place) { assembler_.attribute_end(place); }

void Parser::world_end(Place place) { context_.warn("WorldEnd", place, "WorldEnd has no meaning in pbrt-v4: ignored"); }

void Parser::option(Place place) {
  const std::string name = expect_string("the name of an option");
  const Token value = next();
  if (value.kind != TokenKind::word && value.kind != TokenKind::string) throw unexpected(value, "the option's value");
  assembler_.option(name, value.kind == TokenKind::string ? string_value(value) : std::string(value.text), place);
}

void Parser::texture(Place place) {
  const std::string name = expect_string("the texture's name in quotes");
  const std::string type = expect_string("the texture's type in quotes");
  const std::string kind = expect_string("the kind of texture in quotes");
  assembler_.texture(name, type, kind, parameters(), place);
}

void Parser::medium_interface(Place place) {
  const std::string inside = expect_string("the name of a medium in quotes");
  const std::string outside = ahead_.kind == TokenKind::string ? string_value(next()) : inside;
  assembler_.medium_interface(inside, outside, place);
}

void Parser::accelerator(Place place) {
  expect_string("the kind of accelerator in quotes");
  parameters();
  assembler_.accelerator(place);
}

void Parser::read_included(const std::string& name, Place place) {
  const std::filesystem::path path = context_.add_file(name, place).lexically_normal();
  if (std::find(files_.open.begin(), files_.open.end(), path) != files_.open.end())
    throw Error(place.location(), "file \"" + printable(path.string()) + "\" includes itself");
  if (files_.open.size() >= deepest_include)
    throw Error(place.location(), "files include each other more than " + std::to_string(deepest_include) + " deep");
  if (files_.names.size() >= most_files)
    throw Error(place.location(), "the scene includes more than " + std::to_string(most_files) + " files");
  const std::string text = context_.read(path, place);
  files_.open.push_back(path);
  Parser(text, files_.names.emplace_back(printable(path.string())), files_, assembler_, context_).parse();
  files_.open.pop_back();
}

void Parser::include(Place place) { read_included(expect_string("a file name in quotes"), place); }

void Parser::import(Place place) {
  const std::string name = expect_string("a file name in quotes");
  assembler_.import_begin(place);
  read_included(name, place);
  assembler_.import_end(place);
}

template <void (Assembler::*call)(const std::string&, Parameters, Place)>
void Parser::with_parameters(Place place) {
  const std::string kind = expect_string("a kind or name in quotes");
  (assembler_.*call)(kind, parameters(), place);
}

template <void (Assembler::*call)(const std::string&, Place)>
void Parser::with_name(Place place) {
  (assembler_.*call)(expect_string("a name in quotes"), place);
}

template <void (Assembler::*call)(Place)>
void Parser::alone(Place place) {
  (assembler_.*call)(place);
}

Parser::Handler Parser::handler(std::string_view directive) {
  using P = Parser;
  using A = Assembler;
  static const std::unordered_map<std::string_view, Handler> handlers = {
      {"Accelerator", &P::accelerator},
      {"ActiveTransform", &P::active_transform},
      {"AreaLightSource", &P::with_parameters<&A::area_light_source>},
      {"Attribute", &P::with_parameters<&A::attribute>},
      {"AttributeBegin", &P::alone<&A::attribute_begin>},
      {"AttributeEnd", &P::alone<&A::attribute_end>},
      {"Camera", &P::with_parameters<&A::camera>},
      {"ColorSpace", &P::with_name<&A::color_space>},
      {"ConcatTransform", &P::concat_transform},
      {"CoordSysTransform", &P::coord_sys_transform},
      {"CoordinateSystem", &P::coordinate_system},
      {"Film", &P::with_parameters<&A::film>},
      {"Identity", &P::identity},
      {"Import", &P::import},
      {"Include", &P::include},
      {"Integrator", &P::with_parameters<&A::integrator>},
      {"LightSource", &P::with_parameters<&A::light_source>},
      {"LookAt", &P::look_at},
      {"MakeNamedMaterial", &P::with_parameters<&A::make_named_material>},
      {"MakeNamedMedium", &P::with_parameters<&A::make_named_medium>},
      {"Material", &P::with_parameters<&A::material>},
      {"MediumInterface", &P::medium_interface},
      {"NamedMaterial", &P::with_name<&A::named_material>},
      {"ObjectBegin", &P::with_name<&A::object_begin>},
      {"ObjectEnd", &P::alone<&A::object_end>},
      {"ObjectInstance", &P::with_name<&A::object_instance>},
      {"Option", &P::option},
      {"PixelFilter", &P::with_parameters<&A::pixel_filter>},
      {"ReverseOrientation", &P::alone<&A::reverse_orientation>},
      {"Rotate", &P::rotate_by},
      {"Sampler", &P::with_parameters<&A::sampler>},
      {"Scale", &P::scale_by},
      {"Shape", &P::with_parameters<&A::shape>},
      {"Texture", &P::texture},
      {"Transform", &P::transform},
      {"TransformBegin", &P::transform_begin},
      {"TransformEnd", &P::transform_end},
      {"TransformTimes", &P::transform_times},
      {"Translate", &P::translate},
      {"WorldBegin", &P::alone<&A::world_begin>},
      {"WorldEnd", &P::world_end},
  };
  const auto it = handlers.find(directive);
  return it == handlers.end() ? nullptr : it->second;
}

}  // namespace lanthorn::pbrt
