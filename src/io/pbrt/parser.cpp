// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/parser.h"

#include <algorithm>
#include <utility>

#include "spectrum/cie.h"

namespace lanthorn::pbrt {

namespace {

constexpr std::size_t deepest_include = 64;
constexpr std::size_t page = 4096;
constexpr std::size_t most_parameters = 1000;

Error unexpected(const Token& found, const std::string& wanted) {
  return {found.place.location(), "expected " + wanted + ", found " + describe(found)};
}

Error unknown_directive(const Token& token, bool is_of_v2) {
  const std::string name = in_quotes(token.text);
  if (!is_of_v2) return {token.place.location(), "unknown directive " + name};
  return {token.place.location(),
          "directive " + name + " belongs to pbrt-v2: only pbrt-v3 and pbrt-v4 files are supported"};
}

bool bool_value(const Token& token) {
  if (token.text == "true") return true;
  if (token.text == "false") return false;
  throw unexpected(token, "true or false");
}

// Converts a parameter of type xyz.
void to_rgb(Parameter& parameter) {
  auto& v = std::get<std::vector<float>>(parameter.values);
  for (std::size_t i = 0; i + 2 < v.size(); i += 3) {
    const Tristimulus rgb = xyz_to_rec709 * Tristimulus{v[i], v[i + 1], v[i + 2]};
    v[i] = static_cast<float>(std::max(rgb.x, 0.0));
    v[i + 1] = static_cast<float>(std::max(rgb.y, 0.0));
    v[i + 2] = static_cast<float>(std::max(rgb.z, 0.0));
  }
}

}  // namespace

Parser::Parser(std::string_view text, const std::string& name, FileStack& files, const DirectiveSink& sink,
               Context& context)
    : name_(name), tokens_(text, &name_), ahead_(tokens_.next()), files_(files), sink_(sink), context_(context) {}

Place Parser::parse() {
  while (ahead_.kind != TokenKind::end) directive(next());
  return ahead_.place;
}

Token Parser::next() { return std::exchange(ahead_, ahead_.kind == TokenKind::end ? ahead_ : tokens_.next()); }

void Parser::directive(const Token& token) {
  if (token.kind != TokenKind::word) throw unexpected(token, "a directive");
  const DirectiveForm* form = find_form(token.text);
  const bool is_v3 = context_.version && context_.version->is_v3;
  if (form == nullptr || (form->is_of_v2 && !is_v3)) throw unknown_directive(token, form != nullptr);
  Directive result;
  result.name = form->name;
  result.place = token.place;
  expect_numbers(*form, result);
  for (const std::string_view what : form->strings)
    if (!what.empty()) result.strings.push_back(expect_string(what));
  expect_words(result);
  if (form->has_parameters) result.parameters = parameters();
  if (form->name == "Include" || form->name == import_begin)
    include(result);
  else
    sink_(std::move(result));
}

std::string Parser::expect_string(std::string_view what) {
  const Token token = next();
  if (token.kind != TokenKind::string) throw unexpected(token, std::string(what));
  return string_value(token);
}

void Parser::expect_numbers(const DirectiveForm& form, Directive& directive) {
  const bool is_matrix = form.numbers == 16;
  if (is_matrix)
    if (const Token open = next(); open.kind != TokenKind::open) throw unexpected(open, "\"[\" and 16 numbers");
  for (std::size_t i = 0; i < form.numbers; ++i) directive.numbers[i] = double_value(next());
  if (is_matrix)
    if (const Token close = next(); close.kind != TokenKind::close) throw unexpected(close, "\"]\" after 16 numbers");
}

// Parses the parts of three directives that do not have the common form.
void Parser::expect_words(Directive& directive) {
  if (directive.name == "ActiveTransform") {
    const Token token = next();
    if (token.text != "All" && token.text != "StartTime" && token.text != "EndTime")
      throw unexpected(token, "All, StartTime or EndTime");
    directive.strings.emplace_back(token.text);
  } else if (directive.name == "Option") {
    const Token value = next();
    if (value.kind != TokenKind::word && value.kind != TokenKind::string) throw unexpected(value, "the option's value");
    directive.strings.push_back(value.kind == TokenKind::string ? string_value(value) : std::string(value.text));
  } else if (directive.name == "MediumInterface") {
    directive.strings.push_back(ahead_.kind == TokenKind::string ? string_value(next()) : directive.strings.front());
  }
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
  const bool is_v3 = context_.version && context_.version->is_v3, is_xyz = is_v3 && type == "xyz";
  const auto known = is_xyz || (is_v3 && type == "color") ? ParameterType::rgb : parameter_type(type);
  if (!known) throw Error(declaration.place.location(), "unknown parameter type " + in_quotes(type));
  Parameter result;
  result.type = *known;
  result.name = text.substr(name_begin, text.find_last_not_of(blanks) + 1 - name_begin);
  result.place = declaration.place;
  result.color_space = context_.color_space;
  result.values = values(result);
  if (is_xyz) to_rgb(result);
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
      // All names or all numbers, as the first value decides.
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

// Empty if the file is missing and will be reported later.
std::string Parser::read_included(const std::filesystem::path& path, Place place) {
  return context_.read_unless_missing(path, place).value_or("");
}

void Parser::include(const Directive& directive) {
  const Place place = directive.place;
  const std::filesystem::path path = context_.add_file(directive.strings.front(), place).lexically_normal();
  if (std::find(files_.open.begin(), files_.open.end(), path) != files_.open.end())
    throw Error(place.location(), "file \"" + printable(path.string()) + "\" includes itself");
  if (files_.open.size() >= deepest_include)
    throw Error(place.location(),
                "files include each other more than " + std::to_string(deepest_include) + " levels deep");
  const bool is_import = directive.name == import_begin;
  if (is_import) sink_(directive);
  const std::string text = read_included(path, place);
  const std::size_t size = std::max(text.size(), page);  // small files cost time, too
  const auto [file, is_new] = files_.names.insert(printable(path.string()));
  if (size > files_.bytes_left) throw Error(place.location(), "the scene includes too many bytes of files");
  files_.bytes_left -= size;
  if (!is_new && size > files_.repeated_bytes_left)
    throw Error(place.location(), "files that were included before are included again, more than " +
                                      std::to_string(FileStack::most_repeated_bytes >> 20) + " MiB together");
  if (!is_new) files_.repeated_bytes_left -= size;
  files_.open.push_back(path);
  Parser(text, *file, files_, sink_, context_).parse();
  files_.open.pop_back();
  if (is_import) sink_({import_end, {}, {}, {}, place});
}

}  // namespace lanthorn::pbrt
