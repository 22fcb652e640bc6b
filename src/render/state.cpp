// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "lanthorn/error.h"
#include "lanthorn/text.h"
#include "render/state_file.h"

namespace lanthorn {

namespace {

using nlohmann::json;

json identity_of(const json& settings) {
  const auto found = settings.find("identity");
  return found == settings.end() ? json::object() : *found;
}

/// The ranges, sorted, and joined where they touch. Empty if two overlap.
std::optional<std::vector<PassRange>> joined(std::vector<PassRange> ranges) {
  std::sort(ranges.begin(), ranges.end(), [](const PassRange& a, const PassRange& b) { return a.begin < b.begin; });
  std::vector<PassRange> result;
  for (const PassRange& range : ranges) {
    if (!result.empty() && range.begin < result.back().end) return std::nullopt;
    if (!result.empty() && range.begin == result.back().end)
      result.back().end = range.end;
    else
      result.push_back(range);
  }
  return result;
}

/// The first difference of two JSON values in the order of their keys. A value is null if its side has no such member.
struct Difference {
  std::vector<std::string> path;
  const json *a = nullptr, *b = nullptr;
};

std::optional<Difference> find_difference(const json& a, const json& b, const std::vector<std::string>& first = {}) {
  if (a == b) return std::nullopt;
  if (!a.is_object() || !b.is_object()) return Difference{{}, &a, &b};
  std::set<std::string> members;
  for (const json* object : {&a, &b})
    for (const auto& member : object->items()) members.insert(member.key());
  std::vector<std::string> keys = first;
  for (const std::string& key : first) members.erase(key);
  keys.insert(keys.end(), members.begin(), members.end());
  for (const std::string& key : keys) {
    if (!a.contains(key) && !b.contains(key)) continue;
    const auto in_a = a.find(key), in_b = b.find(key);
    if (in_a == a.end()) return Difference{{key}, nullptr, &*in_b};
    if (in_b == b.end()) return Difference{{key}, &*in_a, nullptr};
    auto inner = find_difference(*in_a, *in_b);
    if (!inner) continue;
    inner->path.insert(inner->path.begin(), key);
    return inner;
  }
  return std::nullopt;
}

// In order of cause and effect: another resolution also changes the window and the number of photons.
const std::vector<std::string> causes{"version", "scene_hash", "files", "integrator", "resolution", "crop", "margin"};

// The option as the user typed it, or would type it.
std::string field_name(const std::vector<std::string>& path) {
  const std::string& field = path.front();
  if (field == "version") return "the program's version";
  if (field == "scene_hash") return "the content of the scene file";
  if (field == "files" && path.size() == 2) return "the content of " + printable(path[1]);
  if (field == "parameters" && path.size() == 2) return "--set " + excerpt(path[1]);
  if (field == "margin") return "the margin that --denoise adds to --crop";
  if (field == "filter") return excerpt(fmt::format("the scene's {}", fmt::join(path, ".")));
  if (field == "max_depth") return "--max-depth";
  if (field == "coarse") return "the pixels of a coarse picture, for whose passes there was no time";
  for (const char* option : {"integrator", "resolution", "crop", "seed", "color", "photons"})
    if (field == option && path.size() == 1) return "--" + field;
  return excerpt(fmt::format("{}", fmt::join(path, ".")));
}

std::string value_text(const std::vector<std::string>& path, const json* value) {
  if (!value) return "not set";
  const bool is_text = value->is_string() && path.front() != "scene_hash" && path.front() != "files";
  const std::string text =
      excerpt(is_text ? value->get<std::string>() : value->dump(-1, ' ', false, json::error_handler_t::replace));
  if (!value->is_array() || (path.front() != "resolution" && path.front() != "crop")) return text;
  std::string numbers = text.substr(1, text.size() - 2);  // as the options take them
  if (path.front() == "resolution") std::replace(numbers.begin(), numbers.end(), ',', 'x');
  return numbers;
}

/// Whole microseconds or so: such numbers add exactly, in any order.
double coarse(double seconds) { return std::round(seconds * 0x1p20) * 0x1p-20; }

std::string common_members(const std::string& a, const std::string& b) {
  json common = json::parse(a);
  const json other = json::parse(b);
  for (auto member = common.begin(); member != common.end();) {
    const auto found = other.find(member.key());
    member = found != other.end() && *found == *member ? std::next(member) : common.erase(member);
  }
  return common.dump();
}

// The first difference, as the option (or file) and both values, such as "--seed (0 and 7)". Empty if they are equal.
std::optional<std::string> difference_of(const json& one, const json& other) {
  const auto difference = find_difference(one, other, causes);
  if (!difference) return std::nullopt;
  return fmt::format("{} ({} and {})", field_name(difference->path), value_text(difference->path, difference->a),
                     value_text(difference->path, difference->b));
}
std::optional<std::string> identity_difference(const std::string& a, const std::string& b) {
  return difference_of(identity_of(json::parse(a)), identity_of(json::parse(b)));
}

}  // namespace

std::uint64_t RenderState::pass_count() const {
  std::uint64_t count = 0;
  for (const PassRange& range : passes) count += range.end - range.begin;
  return count;
}

bool RenderState::has_pass(std::uint64_t pass) const {
  return std::any_of(passes.begin(), passes.end(),
                     [&](const PassRange& range) { return range.begin <= pass && pass < range.end; });
}

void RenderState::add_pass(std::uint64_t pass) {
  assert(!has_pass(pass));
  passes.push_back({pass, pass + 1});
  if (auto sorted = joined(passes)) passes = std::move(*sorted);
}

std::optional<std::string> identity_difference(const RenderState& a, const RenderState& b) {
  return identity_difference(a.settings, b.settings);
}

std::optional<std::string> difference_to_replaced(const RenderState& there, const RenderState& state) {
  json one = identity_of(json::parse(there.settings)), other = identity_of(json::parse(state.settings));
  for (json* identity : {&one, &other}) identity->erase("coarse");
  return difference_of(one, other);
}

void require_same_identity(const RenderState& state, const std::string& settings, const std::string& file) {
  const auto difference = identity_difference(state.settings, settings);
  if (difference)
    throw Error({file}, fmt::format("belongs to another render: it differs in {}; give the scene and settings it was "
                                    "made with, or another file",
                                    *difference));
}

namespace {

void require_mergeable(const RenderState& a, const RenderState& b) {
  if (a.integrator != b.integrator)
    throw Error(fmt::format("cannot merge: integrators differ ({} and {})", std::min(a.integrator, b.integrator),
                            std::max(a.integrator, b.integrator)));
  if (!a.shardable || !b.shardable)
    throw Error(
        fmt::format("cannot merge: each pass of {} depends on the passes before it, so that its renders can be resumed "
                    "but not put together from shards",
                    a.integrator));
  if (const auto difference = identity_difference(a.settings, b.settings))
    throw Error(fmt::format("cannot merge: the renders differ in {}", *difference));
}

void require_films_fit(bool they_do) {
  if (!they_do) throw Error("cannot merge: the films differ in size, scale or contents");
}

std::vector<PassRange> passes_of_both(const RenderState& a, const RenderState& b) {
  std::vector<PassRange> ranges = a.passes;
  ranges.insert(ranges.end(), b.passes.begin(), b.passes.end());
  auto passes = joined(std::move(ranges));
  if (!passes) throw Error("cannot merge: some passes are in both; make shards with disjoint --pass-range");
  return *std::move(passes);
}

// All but the films.
void add_head(RenderState& sum, const RenderState& more, std::vector<PassRange> passes) {
  sum.integrator_state = std::max(sum.integrator_state, more.integrator_state);  // any that is not empty serves
  sum.passes = std::move(passes);
  sum.seconds = coarse(sum.seconds) + coarse(more.seconds);
  sum.eye += more.eye;
  sum.light += more.light;
  sum.settings = common_members(sum.settings, more.settings);  // what differs does not hold for the sum
}

}  // namespace

void add_state(RenderState& sum, const RenderState& more) {
  require_mergeable(sum, more);
  require_films_fit(sum.film.compatible(more.film));
  std::vector<PassRange> passes = passes_of_both(sum, more);
  sum.film.merge(more.film);
  add_head(sum, more, std::move(passes));
}

void add_state(RenderState& sum, const StateReader& more) {
  require_mergeable(sum, more.head());
  require_films_fit(more.fits(sum.film));
  std::vector<PassRange> passes = passes_of_both(sum, more.head());
  more.add_to(sum.film);
  add_head(sum, more.head(), std::move(passes));
}

RenderState merge_states(const RenderState& a, const RenderState& b) {
  RenderState merged = a;
  add_state(merged, b);
  return merged;
}

RenderState empty_like(const RenderState& state) {
  RenderState empty;
  const Film& film = state.film;
  empty.film = Film::with_exponent(film.width(), film.height(), film.step_exponent(), film.contents());
  empty.integrator = state.integrator;
  empty.settings = state.settings;
  empty.shardable = state.shardable;
  return empty;
}

}  // namespace lanthorn
