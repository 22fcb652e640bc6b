// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/technique.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "lanthorn/error.h"
#include "lanthorn/text.h"

namespace lanthorn {

namespace {

// A deque: references to entries must stay valid when further entries are added.
std::deque<TechniqueInfo>& registry() {
  static std::deque<TechniqueInfo> all = [] {
    std::vector<TechniqueInfo> built_in = built_in_techniques();
    return std::deque<TechniqueInfo>(built_in.begin(), built_in.end());
  }();
  return all;
}

std::string expectation(const TechniqueParameter& p) {
  std::vector<std::string> parts = p.words;
  if (p.numbers) {
    const auto [least, most, kind] = *p.numbers;
    const char* what = kind == NumberRange::Kind::power_of_two ? "a power of two" : "a number";
    parts.push_back(kind == NumberRange::Kind::above_least && most == std::numeric_limits<double>::infinity()
                        ? fmt::format("{} above {}", what, least)
                        : fmt::format("{} from {} to {}", what, least, most));
  }
  const std::string last = parts.back();
  parts.pop_back();
  return parts.empty() ? last : fmt::format("{} or {}", fmt::join(parts, ", "), last);
}

bool is_in(const NumberRange& range, double x) {
  using Kind = NumberRange::Kind;
  if (!std::isfinite(x) || x < range.least || x > range.most) return false;
  if (range.kind == Kind::above_least) return x > range.least;
  const bool is_whole = std::floor(x) == x;
  if (range.kind == Kind::whole) return is_whole;
  return range.kind == Kind::real || (is_whole && std::has_single_bit(static_cast<std::uint64_t>(x)));
}

std::optional<double> number_in(const std::string& text) {
  double x = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(x) : std::nullopt;
}

void check(const TechniqueParameter& p, const std::string& text) {
  if (std::find(p.words.begin(), p.words.end(), text) != p.words.end()) return;
  const std::optional<double> number = number_in(text);
  if (p.numbers && number && is_in(*p.numbers, *number)) return;
  throw Error(
      fmt::format("--set {}={}: expected {}{}", p.info.name, text, expectation(p), did_you_mean(text, p.words)));
}

}  // namespace

const std::vector<TechniqueParameter>& light_parameters() {
  static const std::vector<TechniqueParameter> parameters{
      {.info = {"shadows", "traced", "of direct light: traced (rays of the CPU), maps (shadow maps) or none"},
       .viewer_default = "maps",
       .words = {"none", "maps", "traced"},
       .control = PanelControl{.label = "Shadows", .words = {"None", "Shadow maps", "Traced"}}},
      {.info = {"map", "256", "texels along the side of a light's map"},
       .numbers = NumberRange{16, 4096, NumberRange::Kind::whole}},
      {.info = {"sky", "4", "directions from which each infinite light lights a frame"},
       .numbers = NumberRange{1, 16, NumberRange::Kind::whole}}};
  return parameters;
}

std::vector<TechniqueParameter> all_parameters(const TechniqueDescription& technique) {
  std::vector<TechniqueParameter> all = technique.parameters;
  if (technique.has_light_views) all.insert(all.end(), light_parameters().begin(), light_parameters().end());
  return all;
}

std::vector<const TechniqueInfo*> technique_registry() {
  std::vector<const TechniqueInfo*> all;
  for (const TechniqueInfo& info : registry()) all.push_back(&info);
  return all;
}

void add_technique(TechniqueInfo info) {
  if (find_technique(info.description.name) != nullptr)
    throw Error(fmt::format("a technique named '{}' exists already", info.description.name));
  registry().push_back(std::move(info));
}

const TechniqueInfo* find_technique(const std::string& name) {
  for (const TechniqueInfo& info : registry())
    if (info.description.name == name) return &info;
  return nullptr;
}

TechniqueChoice::TechniqueChoice(const std::string& name, const ParameterValues& set) : info_(find_technique(name)) {
  if (info_ == nullptr) throw Error(fmt::format("there is no technique named '{}'", name));
  for (const TechniqueParameter& p : all_parameters(info_->description)) {
    const auto found = set.find(p.info.name);
    values_[p.info.name] = found == set.end() ? p.info.default_value : found->second;
  }
  for (const auto& [parameter_name, text] : set) {
    if (!values_.contains(parameter_name))
      throw Error(fmt::format("--set {}={}: '{}' has no such parameter", parameter_name, text, name));
    check(parameter(parameter_name), text);
  }
}

const TechniqueParameter& TechniqueChoice::parameter(const std::string& name) const {
  for (const std::vector<TechniqueParameter>* list : {&info_->description.parameters, &light_parameters()})
    for (const TechniqueParameter& p : *list)
      if (p.info.name == name) return p;
  throw std::out_of_range(name);
}

double TechniqueChoice::number(const std::string& parameter_name) const {
  return number_in(text(parameter_name)).value();
}

std::size_t TechniqueChoice::word(const std::string& parameter_name) const {
  const std::vector<std::string>& words = parameter(parameter_name).words;
  return static_cast<std::size_t>(std::find(words.begin(), words.end(), text(parameter_name)) - words.begin());
}

}  // namespace lanthorn
