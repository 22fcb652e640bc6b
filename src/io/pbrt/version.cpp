// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/context.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <utility>

#include "io/pbrt/directive.h"

namespace lanthorn::pbrt {

namespace {

constexpr int deepest_search = 16;

struct Kind {
  std::string_view directive, kind;
  bool is_v3;
};
// First strings of directives.
constexpr std::array<Kind, 45> kinds = {{{"AreaLightSource", "area", true},
                                         {"Camera", "environment", true},
                                         {"Camera", "spherical", false},
                                         {"Film", "image", true},
                                         {"Film", "rgb", false},
                                         {"Film", "gbuffer", false},
                                         {"Film", "spectral", false},
                                         {"Integrator", "directlighting", true},
                                         {"Integrator", "whitted", true},
                                         {"Integrator", "function", false},
                                         {"Integrator", "lightpath", false},
                                         {"Integrator", "randomwalk", false},
                                         {"Integrator", "simplepath", false},
                                         {"Integrator", "simplevolpath", false},
                                         {"Material", "disney", true},
                                         {"Material", "fourier", true},
                                         {"Material", "glass", true},
                                         {"Material", "kdsubsurface", true},
                                         {"Material", "matte", true},
                                         {"Material", "metal", true},
                                         {"Material", "mirror", true},
                                         {"Material", "plastic", true},
                                         {"Material", "substrate", true},
                                         {"Material", "translucent", true},
                                         {"Material", "uber", true},
                                         {"Material", "coatedconductor", false},
                                         {"Material", "coateddiffuse", false},
                                         {"Material", "conductor", false},
                                         {"Material", "dielectric", false},
                                         {"Material", "diffuse", false},
                                         {"Material", "diffusetransmission", false},
                                         {"Material", "interface", false},
                                         {"Material", "measured", false},
                                         {"Material", "thindielectric", false},
                                         {"Sampler", "02sequence", true},
                                         {"Sampler", "lowdiscrepancy", true},
                                         {"Sampler", "maxmindist", true},
                                         {"Sampler", "random", true},
                                         {"Sampler", "independent", false},
                                         {"Sampler", "paddedsobol", false},
                                         {"Sampler", "pmj02bn", false},
                                         {"Sampler", "zsobol", false},
                                         {"Shape", "bilinearmesh", false},
                                         {"Shape", "cone", true},
                                         {"Shape", "heightfield", true}}};

constexpr std::array<std::string_view, 4> directives_of_v4 = {"Attribute", "ColorSpace", "Import", "Option"};
// Beginnings of parameter declarations.
constexpr std::array<std::string_view, 8> declarations_of_v3 = {
    "color ", "xyz ", "float xwidth", "float ywidth", "string mapname", "rgb Kd", "rgb Ks", "texture Kd"};

// Included files that have been searched; each is searched once, however often it is included.
struct IncludedFiles {
  const FileReader& read;
  std::set<std::filesystem::path> searched{};
};

// Scans the tokens of a file and tracks which part of which directive each one is.
class Search {
 public:
  Search(std::string_view text, const std::string& file, IncludedFiles& included, int depth)
      : tokens_(text, &file), included_(included), depth_(depth) {}

  std::optional<VersionSign> run() {
    for (Token token = tokens_.next(); token.kind != TokenKind::end; token = tokens_.next())
      if (auto sign = sign_at(token)) return sign;
    return {};
  }

 private:
  std::optional<VersionSign> sign_at(const Token& token) {
    if (token.kind == TokenKind::word && !is_value_) return sign_of_directive(token);
    if (token.kind == TokenKind::open) {
      skip_list();
      return {};
    }
    const bool is_value = std::exchange(is_value_, false);
    if (token.kind != TokenKind::string) return {};
    if (is_value) return declaration_ == "string type" ? sign_of_kind("Material", token) : std::nullopt;
    const std::size_t index = strings_++;
    if (form_ != nullptr && index < form_->strings.size() && !form_->strings[index].empty())
      return sign_of_string(token, index);
    return sign_of_declaration(token);
  }

  std::optional<VersionSign> sign_of_directive(const Token& token) {
    form_ = find_form(token.text);
    strings_ = 0;
    declaration_ = {};
    if (token.text == "WorldEnd") return sign(true, token, std::string(token.text));
    if (std::find(directives_of_v4.begin(), directives_of_v4.end(), token.text) != directives_of_v4.end())
      return sign(false, token, std::string(token.text));
    return {};
  }

  std::optional<VersionSign> sign_of_string(const Token& token, std::size_t index) {
    if (form_->name == "Include") return sign_in_included(token);
    if (form_->name == "Texture" && index == 1 && token.text == "color") return sign(true, token, "Texture \"color\"");
    return index == 0 ? sign_of_kind(form_->name, token) : std::nullopt;
  }

  std::optional<VersionSign> sign_of_kind(std::string_view directive, const Token& token) {
    const auto it = std::find_if(kinds.begin(), kinds.end(),
                                 [&](const Kind& k) { return k.directive == directive && k.kind == token.text; });
    if (it == kinds.end()) return {};
    return sign(it->is_v3, token, std::string(directive) + " " + in_quotes(token.text));
  }

  std::optional<VersionSign> sign_of_declaration(const Token& token) {
    is_value_ = true;
    declaration_ = token.text;
    for (const std::string_view beginning : declarations_of_v3)
      if (token.text.starts_with(beginning)) return sign(true, token, in_quotes(token.text));
    return {};
  }

  std::optional<VersionSign> sign_in_included(const Token& token) {
    if (depth_ >= deepest_search) return {};
    try {
      const std::string name = string_value(token);
      if (!included_.searched.insert(std::filesystem::path(name).lexically_normal()).second) return {};
      return Search(included_.read(name), name, included_, depth_ + 1).run();
    } catch (const Error&) {
      return {};
    }
  }

  // Skips a parameter's bracketed values, except that it inspects the kind of a material.
  void skip_list() {
    is_value_ = declaration_ == "string type";
    if (is_value_) return;
    while (true) {
      const Token token = tokens_.next();
      if (token.kind == TokenKind::close || token.kind == TokenKind::end) return;
    }
  }

  static std::optional<VersionSign> sign(bool is_v3, const Token& token, std::string text) {
    return VersionSign{is_v3, std::move(text), token.place.location()};
  }

  Tokenizer tokens_;
  IncludedFiles& included_;
  int depth_;
  const DirectiveForm* form_ = nullptr;
  std::size_t strings_ = 0;  ///< of the directive so far
  bool is_value_ = false;    ///< the next token is the value of the declaration
  std::string_view declaration_;
};

std::string name_of_version(bool is_v3) { return is_v3 ? "pbrt-v3" : "pbrt-v4"; }

}  // namespace

std::optional<VersionSign> find_version_sign(std::string_view text, const std::string& name,
                                             const FileReader& read_included) {
  IncludedFiles included{read_included};
  try {
    return Search(text, name, included, 0).run();
  } catch (const Error&) {
    return {};
  }
}

std::string version_hint(const std::optional<VersionSign>& sign, std::string_view directive, std::string_view kind) {
  const bool is_directive = std::find(directives_of_v4.begin(), directives_of_v4.end(), kind) != directives_of_v4.end();
  const auto* it = std::find_if(kinds.begin(), kinds.end(),
                                [&](const Kind& k) { return k.directive == directive && k.kind == kind; });
  if (!sign || (it == kinds.end() && !is_directive)) return {};
  const bool is_v3 = !is_directive && it->is_v3;
  if (is_v3 == sign->is_v3) return {};
  return "; it is of " + name_of_version(is_v3) + ", but " + sign->text + " in line " +
         std::to_string(sign->location.line) + " is of " + name_of_version(sign->is_v3);
}

}  // namespace lanthorn::pbrt
