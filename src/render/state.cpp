// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// File format, all integers little-endian:
//   "LANTHORN"  u32 version  u32 header bytes  header (JSON text)
//   per film plane, then for the integrator's state:  u64 compressed bytes, zlib stream
//   u32 CRC-32 of everything before it
// Planes are 64-bit sums with their bytes transposed (all lowest bytes first), which halves the compressed size.
#include "render/state.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "base/bytes.h"
#include "base/parallel.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/text.h"

namespace lanthorn {

namespace {

using nlohmann::json;
using Bytes = std::vector<std::byte>;
using ByteSpan = std::span<const std::byte>;

static_assert(std::endian::native == std::endian::little, "state files are little-endian");

constexpr char magic[8] = {'L', 'A', 'N', 'T', 'H', 'O', 'R', 'N'};
constexpr std::uint32_t format_version = 6;
constexpr std::size_t crc_bytes = sizeof(std::uint32_t);
constexpr int max_header_depth = 64;
// Deflate compresses by no more than this factor: a small file cannot claim a large size.
constexpr std::uint64_t max_compression = 1032;
constexpr std::int64_t max_extent = 1 << 20;
constexpr std::int64_t max_pixels = std::int64_t{1} << 31;
constexpr double max_seconds = 1e12;
constexpr std::int64_t most_buckets = 65536;
constexpr std::size_t longest_layer_name = 64;
constexpr float max_wavelength = 1e6f;  // nm

void append(Bytes& out, ByteSpan bytes) {
  for (const std::byte byte : bytes) out.push_back(byte);
}

std::uint32_t checksum(ByteSpan bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

Bytes deflated(ByteSpan raw) {
  uLongf size = compressBound(raw.size());
  Bytes out(size);
  [[maybe_unused]] const int code = compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                                              reinterpret_cast<const Bytef*>(raw.data()), raw.size(), Z_BEST_SPEED);
  assert(code == Z_OK);
  out.resize(size);
  return out;
}

std::optional<Bytes> inflated(ByteSpan compressed, std::size_t raw_size) {
  // zlib needs an output buffer even for no data.
  Bytes out(std::max<std::size_t>(raw_size, 1));
  uLongf size = out.size();
  const int code = uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                              reinterpret_cast<const Bytef*>(compressed.data()), compressed.size());
  if (code != Z_OK || size != raw_size) return std::nullopt;
  out.resize(raw_size);
  return out;
}

Bytes transposed(std::span<const std::int64_t> values) {
  const ByteSpan in = std::as_bytes(values);
  Bytes out(in.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t b = 0; b < 8; ++b) out[b * values.size() + i] = in[i * 8 + b];
  return out;
}

std::vector<std::int64_t> untransposed(ByteSpan in) {
  std::vector<std::int64_t> values(in.size() / 8);
  const std::span<std::byte> out = std::as_writable_bytes(std::span(values));
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t b = 0; b < 8; ++b) out[i * 8 + b] = in[b * values.size() + i];
  return values;
}

json problem_json(std::uint64_t count, const std::optional<FilmPlace>& first) {
  if (!first) return {{"count", count}};
  return {{"count", count}, {"pass", first->pass}, {"pixel", first->pixel}};
}

json layers_json(const FilmContents& contents) {
  const Decomposition& d = contents.decomposition;
  json layers{{"light", contents.light}, {"parts", d.parts}, {"splat_part", d.splats}, {"splats", contents.splats}};
  if (contents.bias) layers["bias"] = true;
  if (!contents.repeated.empty()) layers["repeated"] = contents.repeated;
  if (d.shares) layers["shares"] = {{"name", d.shares->name}, {"groups", d.shares->groups}};
  return layers;
}

json ends_json(const PathEnds& ends) { return {{"paths", ends.paths}, {"cut", ends.cut}}; }

json header_of(const RenderState& state, const SaveOptions& options) {
  json passes = json::array();
  for (const PassRange& range : state.passes) passes.push_back({range.begin, range.end});
  const FilmReport report = state.film.report();
  json film = {{"width", state.film.width()},
               {"height", state.film.height()},
               {"step_exponent", state.film.step_exponent()},
               {"layers", layers_json(state.film.contents())},
               {"non_finite", problem_json(report.non_finite, report.first_non_finite)},
               {"too_large", problem_json(report.too_large, report.first_too_large)}};
  if (const auto& b = state.film.buckets()) film["buckets"] = {{"count", b->count}, {"low", b->low}, {"high", b->high}};
  return {{"film", film},
          {"passes", passes},
          {"integrator", state.integrator},
          {"integrator_state_bytes", state.integrator_state.size()},
          {"settings", json::parse(state.settings)},
          {"shardable", state.shardable},
          {"eye_paths", ends_json(state.eye)},
          {"light_paths", ends_json(state.light)},
          {"seconds", options.times ? state.seconds : 0.0}};
}

json identity_of(const json& settings) {
  const auto found = settings.find("identity");
  return found == settings.end() ? json::object() : *found;
}

/// Reads one file; every failure is an Error at that file.
class Decoder {
 public:
  Decoder(ByteSpan bytes, const std::string& file) : rest_(bytes), file_(file) {}

  RenderState decode() {
    check_envelope();
    const json header = read_header();
    try {
      return decode_body(header);
    } catch (const json::exception&) {  // a member that is missing or of the wrong type
      fail("damaged: its header is not one of a state file");
    }
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw Error({file_}, message); }

  void check_envelope() {
    if (rest_.size() < sizeof(magic) || std::memcmp(rest_.data(), magic, sizeof(magic)) != 0)
      fail("not a Lanthorn state file");
    const ByteSpan whole = rest_;
    rest_ = rest_.subspan(sizeof(magic));
    const auto found = take<std::uint32_t>();
    if (found != format_version)
      fail(fmt::format("a state file of version {}; this program reads version {}", found, format_version));
    if (rest_.size() < crc_bytes) fail("truncated");
    std::uint32_t stored = 0;
    std::memcpy(&stored, &whole[whole.size() - crc_bytes], crc_bytes);
    if (stored != checksum(whole.first(whole.size() - crc_bytes)))
      fail("damaged or truncated: its checksum does not match");
    rest_ = rest_.first(rest_.size() - crc_bytes);
  }

  template <class T>
  T take() {
    T value{};
    if (rest_.size() < sizeof(T)) fail("truncated");
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_ = rest_.subspan(sizeof(T));
    return value;
  }

  ByteSpan take_bytes(std::uint64_t count) {
    if (count > rest_.size()) fail("truncated");
    const ByteSpan bytes = rest_.first(static_cast<std::size_t>(count));
    rest_ = rest_.subspan(bytes.size());
    return bytes;
  }

  json read_header() {
    const ByteSpan bytes = take_bytes(take<std::uint32_t>());
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    const auto limit_depth = [this](int depth, json::parse_event_t, const json&) {
      if (depth > max_header_depth) fail("damaged: its header is nested too deeply");
      return true;
    };
    const json header = json::parse(text, text + bytes.size(), limit_depth, /*allow_exceptions=*/false);
    if (!header.is_object()) fail("damaged: its header cannot be read");
    return header;
  }

  std::int64_t integer(const json& value, std::int64_t low, std::int64_t high) const {
    if (!value.is_number_integer()) fail("damaged: its header holds a number that is no integer");
    const bool above = value.is_number_unsigned() && value.get<std::uint64_t>() > static_cast<std::uint64_t>(high);
    const auto number = above ? high : value.get<std::int64_t>();
    if (above || number < low || number > high) fail("damaged: its header holds a number out of range");
    return number;
  }
  // Any 64-bit count is valid: merged states hold sums of counts.
  std::uint64_t count(const json& value) const {
    if (!value.is_number_unsigned()) fail("damaged: its header holds a number that is no count");
    return value.get<std::uint64_t>();
  }

  struct Problem {
    std::uint64_t count = 0;
    std::optional<FilmPlace> first;
  };
  Problem decode_problem(const json& value, std::int64_t pixels) const {
    Problem problem{count(value.at("count")), {}};
    if (problem.count > 0)
      problem.first = {count(value.at("pass")), static_cast<std::uint32_t>(integer(value.at("pixel"), 0, pixels - 1))};
    return problem;
  }

  std::optional<SpectralBuckets> decode_buckets(const json& film) const {
    const auto found = film.find("buckets");
    if (found == film.end()) return std::nullopt;
    const SpectralBuckets buckets{static_cast<std::size_t>(integer(found->at("count"), 1, most_buckets)),
                                  found->at("low").get<float>(), found->at("high").get<float>()};
    if (!(buckets.low >= 0 && buckets.high > buckets.low && buckets.high < max_wavelength))
      fail("damaged: its buckets are no wavelengths");
    return buckets;
  }

  static bool is_layer_name(const std::string& name) {
    return !name.empty() && name.size() <= longest_layer_name &&
           std::all_of(name.begin(), name.end(), [](char c) { return (c >= '!' && c <= '~') && c != ',' && c != '"'; });
  }
  std::vector<std::string> decode_names(const json& names, std::size_t fewest) const {
    if (!names.is_array() || names.size() < fewest || names.size() > most_light_layers)
      fail("damaged: its layers are too few or too many");
    return names.get<std::vector<std::string>>();
  }
  std::optional<Decomposition::Shares> decode_shares(const json& layers, std::size_t parts) const {
    const auto found = layers.find("shares");
    if (found == layers.end()) return std::nullopt;
    Decomposition::Shares shares{found->at("name").get<std::string>(), {}};
    const json& groups = found->at("groups");
    if (!groups.is_array() || groups.size() != shares.groups.size())
      fail("damaged: its shares are not of three groups");
    for (std::size_t g = 0; g < shares.groups.size(); ++g)
      for (const json& part : groups[g])
        shares.groups[g].push_back(static_cast<std::size_t>(integer(part, 0, static_cast<std::int64_t>(parts))));
    return shares;
  }
  FilmContents decode_contents(const json& film) const {
    const json& layers = film.at("layers");
    FilmContents contents;
    contents.light = decode_names(layers.at("light"), 1);
    contents.repeated = decode_names(layers.value("repeated", json::array()), 0);
    Decomposition& d = contents.decomposition;
    d.parts = decode_names(layers.at("parts"), 0);
    d.splats = layers.at("splat_part").get<std::string>();
    d.shares = decode_shares(layers, d.parts.size());
    contents.splats = layers.at("splats").get<bool>();
    contents.bias = layers.value("bias", false);
    contents.buckets = decode_buckets(film);
    std::vector<std::string> names = contents.light;
    if (contents.layer_count() > most_light_layers) fail("damaged: it has too many layers");
    names.insert(names.end(), contents.repeated.begin(), contents.repeated.end());
    names.insert(names.end(), d.parts.begin(), d.parts.end());
    if (!d.splats.empty()) names.push_back(d.splats);
    if (d.shares) names.push_back(d.shares->name);
    if (!std::all_of(names.begin(), names.end(), is_layer_name) ||
        std::set<std::string>(names.begin(), names.end()).size() != names.size())
      fail("damaged: its layers have no proper names");
    return contents;
  }

  Film decode_film(const json& header) {
    const auto width = integer(header.at("width"), 1, max_extent), height = integer(header.at("height"), 1, max_extent);
    const std::int64_t pixels = width * height;
    const FilmContents contents = decode_contents(header);
    const auto raw_bytes = static_cast<std::uint64_t>(pixels) * Film::stride(contents) * sizeof(std::int64_t);
    if (pixels > max_pixels || raw_bytes / max_compression > rest_.size()) fail("truncated, or its size is damaged");
    const auto exponent = static_cast<int>(integer(header.at("step_exponent"), -256, 256));
    Film film = Film::with_exponent(static_cast<int>(width), static_cast<int>(height), exponent, contents);
    const Problem non_finite = decode_problem(header.at("non_finite"), pixels);
    const Problem too_large = decode_problem(header.at("too_large"), pixels);
    film.set_report({.non_finite = non_finite.count,
                     .too_large = too_large.count,
                     .saturated = 0,
                     .first_non_finite = non_finite.first,
                     .first_too_large = too_large.first});
    decode_planes(film);
    return film;
  }

  void decode_planes(Film& film) {
    std::vector<ByteSpan> compressed(film.plane_count());
    for (ByteSpan& plane : compressed) plane = take_bytes(take<std::uint64_t>());
    std::vector<std::uint8_t> good(compressed.size());
    parallel_for(std::size_t{0}, compressed.size(), [&](std::size_t i) {
      const auto raw = inflated(compressed[i], std::size_t{film.pixel_count()} * sizeof(std::int64_t));
      if (!raw) return;
      film.set_plane(i, untransposed(*raw));
      good[i] = 1;
    });
    if (std::find(good.begin(), good.end(), 0) != good.end()) fail("damaged: a layer cannot be unpacked");
  }

  std::vector<PassRange> decode_passes(const json& ranges) const {
    std::vector<PassRange> passes;
    for (const json& range : ranges.get_ref<const json::array_t&>()) {
      const PassRange next{count(range.at(0)), count(range.at(1))};
      if (next.begin >= next.end || (!passes.empty() && next.begin <= passes.back().end))
        fail("damaged: its pass ranges are out of order");
      passes.push_back(next);
    }
    return passes;
  }

  // Files of before 2026-11-27 have no such counts.
  PathEnds decode_ends(const json& header, const char* name) const {
    const auto found = header.find(name);
    if (found == header.end()) return {};
    return {count(found->at("paths")), count(found->at("cut"))};
  }

  RenderState decode_body(const json& header) {
    RenderState state;
    state.film = decode_film(header.at("film"));
    state.passes = decode_passes(header.at("passes"));
    state.integrator = header.at("integrator").get<std::string>();
    const json& settings = header.at("settings");
    if (!settings.is_object() || !identity_of(settings).is_object()) fail("damaged: its settings are no object");
    state.settings = settings.dump();
    state.shardable = header.at("shardable").get<bool>();
    state.seconds = header.at("seconds").get<double>();
    if (!(state.seconds >= 0 && state.seconds <= max_seconds)) fail("damaged: its time is not one");
    state.eye = decode_ends(header, "eye_paths");
    state.light = decode_ends(header, "light_paths");
    const std::uint64_t raw_size = count(header.at("integrator_state_bytes"));
    const ByteSpan compressed = take_bytes(take<std::uint64_t>());
    if (raw_size / max_compression > compressed.size()) fail("damaged: its integrator's state is too large");
    auto raw = inflated(compressed, static_cast<std::size_t>(raw_size));
    if (!raw || !rest_.empty()) fail("damaged: its integrator's state cannot be unpacked");
    state.integrator_state = std::move(*raw);
    return state;
  }

  ByteSpan rest_;
  const std::string& file_;
};

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
const std::vector<std::string> causes{"version", "scene_hash", "files", "integrator", "resolution", "crop"};

// The option as the user typed it, or would type it.
std::string field_name(const std::vector<std::string>& path) {
  const std::string& field = path.front();
  if (field == "version") return "the program's version";
  if (field == "scene_hash") return "the content of the scene file";
  if (field == "files" && path.size() == 2) return "the content of " + printable(path[1]);
  if (field == "parameters" && path.size() == 2) return "--set " + excerpt(path[1]);
  if (field == "filter") return excerpt(fmt::format("the scene's {}", fmt::join(path, ".")));
  if (field == "max_depth") return "--max-depth";
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

// The first difference between the identities of two renders, as the option (or file) and both values, such as
// "--seed (0 and 7)". Empty if they are equal.
std::optional<std::string> identity_difference(const std::string& a, const std::string& b) {
  const json one = identity_of(json::parse(a)), other = identity_of(json::parse(b));
  const auto difference = find_difference(one, other, causes);
  if (!difference) return std::nullopt;
  return fmt::format("{} ({} and {})", field_name(difference->path), value_text(difference->path, difference->a),
                     value_text(difference->path, difference->b));
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

void require_same_identity(const RenderState& state, const std::string& settings, const std::string& file) {
  const auto difference = identity_difference(state.settings, settings);
  if (difference)
    throw Error({file},
                fmt::format("belongs to another render: it differs in {}; give the scene and settings it was made "
                            "with, or another file",
                            *difference));
}

std::vector<std::byte> encode_state(const RenderState& state, const SaveOptions& options) {
  const std::string header = header_of(state, options).dump(-1, ' ', false, json::error_handler_t::replace);
  std::vector<Bytes> planes(state.film.plane_count());
  parallel_for(std::size_t{0}, planes.size(),
               [&](std::size_t i) { planes[i] = deflated(transposed(state.film.plane(i))); });
  planes.push_back(deflated(state.integrator_state));

  Bytes out;
  std::size_t size = header.size() + 64;
  for (const Bytes& plane : planes) size += plane.size() + sizeof(std::uint64_t);
  out.reserve(size);
  append(out, std::as_bytes(std::span(magic)));
  append_number(out, format_version);
  append_number(out, static_cast<std::uint32_t>(header.size()));
  append(out, std::as_bytes(std::span(header)));
  for (const Bytes& plane : planes) {
    append_number(out, std::uint64_t{plane.size()});
    append(out, ByteSpan(plane));
  }
  append_number(out, checksum(out));
  return out;
}

RenderState decode_state(std::span<const std::byte> bytes, const std::string& file) {
  return Decoder(bytes, file).decode();
}

void save_state(const RenderState& state, const std::filesystem::path& path, const SaveOptions& options) {
  write_file(path, encode_state(state, options));
}

RenderState load_state(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  return decode_state(std::as_bytes(std::span(bytes)), path.string());
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
  if (!a.film.compatible(b.film)) throw Error("cannot merge: the films differ in size, scale or contents");
}

}  // namespace

void add_state(RenderState& sum, const RenderState& more) {
  require_mergeable(sum, more);
  std::vector<PassRange> ranges = sum.passes;
  ranges.insert(ranges.end(), more.passes.begin(), more.passes.end());
  auto passes = joined(std::move(ranges));
  if (!passes) throw Error("cannot merge: some passes are in both; make shards with disjoint --pass-range");

  sum.film.merge(more.film);
  sum.integrator_state = std::max(sum.integrator_state, more.integrator_state);  // any that is not empty serves
  sum.passes = std::move(*passes);
  sum.seconds = coarse(sum.seconds) + coarse(more.seconds);
  sum.eye += more.eye;
  sum.light += more.light;
  sum.settings = common_members(sum.settings, more.settings);  // what differs does not hold for the sum
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
