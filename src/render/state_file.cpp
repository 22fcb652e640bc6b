// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// File format, version 7, all integers little-endian:
//   "LANTHORN"  u32 version  u32 header bytes  header (JSON text)
//   per block of pixels, then for the integrator's state:  u64 compressed bytes, Zstandard frame
//   u32 CRC-32 of everything before it
// A block has the planes of its pixels one after the other: 64-bit sums with their bytes transposed (all lowest bytes
// first), which halves the compressed size. Version 6 has planes of the whole film instead of blocks, and zlib
// streams.
#include "render/state_file.h"

#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "base/bytes.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "render/record.h"

namespace lanthorn {

namespace {

using nlohmann::json;
using Bytes = std::vector<std::byte>;
using ByteSpan = std::span<const std::byte>;

static_assert(std::endian::native == std::endian::little, "state files are little-endian");

constexpr char magic[8] = {'L', 'A', 'N', 'T', 'H', 'O', 'R', 'N'};
constexpr std::uint32_t format_version = 7, version_of_planes = 6;
constexpr std::size_t crc_bytes = sizeof(std::uint32_t);
constexpr int max_header_depth = 64;
// Bound of Zstandard's compression factor (four bytes for a run of 2^17): a small file cannot claim a large size.
constexpr std::uint64_t max_compression = 1 << 15;
constexpr std::size_t sums_of_block = std::size_t{1} << 18;
constexpr int compression_level = 1;
constexpr std::int64_t max_extent = 1 << 20;
constexpr std::int64_t max_pixels = std::int64_t{1} << 31;
constexpr double max_seconds = 1e12;
constexpr std::int64_t most_buckets = 65536;
constexpr std::size_t longest_layer_name = 64;
constexpr float max_wavelength = 1e6f;  // nm

void append(Bytes& out, ByteSpan bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); }

std::uint32_t checksum(ByteSpan bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

Bytes compressed(ByteSpan raw) {
  Bytes out(ZSTD_compressBound(raw.size()));
  const std::size_t size = ZSTD_compress(out.data(), out.size(), raw.data(), raw.size(), compression_level);
  if (ZSTD_isError(size) != 0) throw std::bad_alloc();  // nothing else can go wrong
  out.resize(size);
  return out;
}

bool decompress(ByteSpan packed, std::span<std::byte> raw) {
  return ZSTD_decompress(raw.data(), raw.size(), packed.data(), packed.size()) == raw.size();
}

bool inflate(ByteSpan packed, std::span<std::byte> raw) {
  std::byte none{};  // zlib needs an output buffer even for no data
  uLongf size = raw.size();
  const int code = uncompress(reinterpret_cast<Bytef*>(raw.empty() ? &none : raw.data()), &size,
                              reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  return code == Z_OK && size == raw.size();
}

void transpose(std::span<const std::int64_t> values, std::span<std::byte> out) {
  for (std::size_t b = 0; b < sizeof(std::int64_t); ++b)
    for (std::size_t i = 0; i < values.size(); ++i)
      out[b * values.size() + i] = static_cast<std::byte>(static_cast<std::uint64_t>(values[i]) >> (8 * b));
}

void untranspose(ByteSpan in, std::span<std::int64_t> values) {
  std::fill(values.begin(), values.end(), 0);
  for (std::size_t b = 0; b < sizeof(std::int64_t); ++b)
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] |= static_cast<std::int64_t>(static_cast<std::uint64_t>(in[b * values.size() + i]) << (8 * b));
}

// Depends only on the film's shape, so that the bytes of a state do, too.
std::size_t pixels_of_block(std::size_t planes) {
  return std::bit_floor(std::max<std::size_t>(1, sums_of_block / planes));
}
std::size_t block_count(std::size_t pixels, std::size_t planes) {
  return (pixels + pixels_of_block(planes) - 1) / pixels_of_block(planes);
}

Bytes encode_block(const Film& film, std::size_t block) {
  const std::size_t planes = film.plane_count(), first = block * pixels_of_block(planes),
                    count = std::min<std::size_t>(pixels_of_block(planes), film.pixel_count() - first);
  std::vector<std::int64_t> values(count);
  Bytes raw(planes * count * sizeof(std::int64_t));
  for (std::size_t plane = 0; plane < planes; ++plane) {
    film.copy_sums(plane, first, values);
    transpose(values, std::span(raw).subspan(plane * count * sizeof(std::int64_t), count * sizeof(std::int64_t)));
  }
  return compressed(raw);
}

json problem_json(std::uint64_t count, const std::optional<FilmPlace>& first) {
  if (!first) return {{"count", count}};
  return {{"count", count}, {"pass", first->pass}, {"pixel", first->pixel}};
}

json layers_json(const FilmContents& contents) {
  const Decomposition& d = contents.decomposition;
  json layers{{"light", contents.light}, {"parts", d.parts}, {"splat_part", d.splats}, {"splats", contents.splats}};
  if (contents.bias) layers["bias"] = true;
  if (contents.negative_share != 0) layers["negative_share"] = contents.negative_share;
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
          {"settings", json_of(state.record)},
          {"shardable", state.shardable},
          {"eye_paths", ends_json(state.eye)},
          {"light_paths", ends_json(state.light)},
          {"seconds", options.times ? state.seconds : 0.0}};
}

/// Reads the header's JSON; every failure is an Error at the file.
class HeaderDecoder {
 public:
  explicit HeaderDecoder(const std::string& file) : file_(file) {}

  StateHeader decode(const std::string& text) const {
    const auto limit_depth = [this](int depth, json::parse_event_t, const json&) {
      if (depth > max_header_depth) fail("damaged: its header is nested too deeply");
      return true;
    };
    const json parsed = json::parse(text, limit_depth, /*allow_exceptions=*/false);
    if (!parsed.is_object()) fail("damaged: its header cannot be read");
    try {
      return decode(parsed);
    } catch (const json::exception&) {  // a member that is missing or of the wrong type
      fail("damaged: its header is not one of a state file");
    }
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw Error({file_}, message); }

  std::int64_t integer(const json& value, std::int64_t low, std::int64_t high) const {
    if (!value.is_number_integer()) fail("damaged: its header holds a number that is not an integer");
    const bool above = value.is_number_unsigned() && value.get<std::uint64_t>() > static_cast<std::uint64_t>(high);
    const auto number = above ? high : value.get<std::int64_t>();
    if (above || number < low || number > high) fail("damaged: its header holds a number out of range");
    return number;
  }
  // Any 64-bit count is valid: merged states hold sums of counts.
  std::uint64_t count(const json& value) const {
    if (!value.is_number_unsigned()) fail("damaged: its header holds a number that is not a count");
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
      fail("damaged: its buckets are not wavelengths");
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
    contents.negative_share = layers.value("negative_share", 0.0f);
    if (!(contents.negative_share >= 0) || !std::isfinite(contents.negative_share))
      fail("damaged: the share of its filter's negative lobes is not a number above 0");
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

  void decode_film(const json& film, StateHeader& header) const {
    header.width = static_cast<int>(integer(film.at("width"), 1, max_extent));
    header.height = static_cast<int>(integer(film.at("height"), 1, max_extent));
    const auto pixels = static_cast<std::int64_t>(header.pixels());
    if (pixels > max_pixels) fail("damaged: its film is too large");
    header.contents = decode_contents(film);
    header.step_exponent = static_cast<int>(integer(film.at("step_exponent"), -256, 256));
    const Problem non_finite = decode_problem(film.at("non_finite"), pixels);
    const Problem too_large = decode_problem(film.at("too_large"), pixels);
    header.report = {.non_finite = non_finite.count,
                     .too_large = too_large.count,
                     .saturated = 0,
                     .first_non_finite = non_finite.first,
                     .first_too_large = too_large.first};
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

  StateHeader decode(const json& parsed) const {
    StateHeader header;
    decode_film(parsed.at("film"), header);
    RenderState& state = header.state;
    state.passes = decode_passes(parsed.at("passes"));
    state.integrator = parsed.at("integrator").get<std::string>();
    state.record = read_record(parsed.at("settings"), file_);
    if (rendered_size(state.record.identity) != std::array{header.width, header.height})
      fail("damaged: its film is not that of its settings");
    state.shardable = parsed.at("shardable").get<bool>();
    state.seconds = parsed.at("seconds").get<double>();
    if (!(state.seconds >= 0 && state.seconds <= max_seconds)) fail("damaged: its time is not valid");
    state.eye = decode_ends(parsed, "eye_paths");
    state.light = decode_ends(parsed, "light_paths");
    header.integrator_state_bytes = count(parsed.at("integrator_state_bytes"));
    return header;
  }

  const std::string& file_;
};

ByteSource source_of(ByteSpan bytes) {
  return {bytes.size(), [bytes](std::uint64_t offset, std::span<std::byte> out) {
            if (!out.empty()) std::memcpy(out.data(), &bytes[offset], out.size());
          }};
}

ByteSource source_of(std::shared_ptr<const PartlyReadFile> file) {
  const std::uint64_t size = file->size();
  return {size, [file = std::move(file)](std::uint64_t offset, std::span<std::byte> out) { file->read(offset, out); }};
}

}  // namespace

StateReader::StateReader(ByteSource source, std::string file) : source_(std::move(source)), file_(std::move(file)) {
  check_envelope();
  std::string header(take<std::uint32_t>(), '\0');
  if (header.size() > end_ - at_) fail("truncated");
  source_.read(at_, std::as_writable_bytes(std::span(header)));
  at_ += header.size();
  header_ = HeaderDecoder(file_).decode(header);
  const std::uint64_t raw_bytes = header_.pixels() * header_.planes() * sizeof(std::int64_t);
  if (raw_bytes / max_compression > end_ - at_) fail("truncated, or its size is damaged");
  take_pieces();
  take_integrator_state();
}

void StateReader::fail(const std::string& message) const { throw Error({file_}, message); }

void StateReader::check_envelope() {
  constexpr std::size_t part = std::size_t{1} << 20;
  std::array<char, sizeof(magic)> beginning{};
  end_ = source_.size;
  if (end_ >= beginning.size()) source_.read(0, std::as_writable_bytes(std::span(beginning)));
  if (std::memcmp(beginning.data(), magic, sizeof(magic)) != 0) fail("not a Lanthorn state file");
  at_ = sizeof(magic);
  version_ = take<std::uint32_t>();
  if (version_ != format_version && version_ != version_of_planes)
    fail(fmt::format("a state file of version {}; this program reads versions {} and {}", version_, version_of_planes,
                     format_version));
  if (end_ - at_ < crc_bytes) fail("truncated");
  end_ -= crc_bytes;
  std::uint32_t stored = 0, found = 0;
  source_.read(end_, std::as_writable_bytes(std::span(&stored, 1)));
  Bytes bytes;
  for (std::uint64_t offset = 0; offset < end_; offset += bytes.size()) {
    bytes.resize(static_cast<std::size_t>(std::min<std::uint64_t>(part, end_ - offset)));
    source_.read(offset, bytes);
    found = checksum(bytes, found);
  }
  if (stored != found) fail("damaged or truncated: its checksum does not match");
}

template <class T>
T StateReader::take() {
  T value{};
  if (end_ - at_ < sizeof(T)) fail("truncated");
  source_.read(at_, std::as_writable_bytes(std::span(&value, 1)));
  at_ += sizeof(T);
  return value;
}

StateReader::Piece StateReader::take_piece() {
  const auto bytes = take<std::uint64_t>();
  if (bytes > end_ - at_) fail("truncated");
  return {std::exchange(at_, at_ + bytes), bytes};
}

bool StateReader::has_blocks() const { return version_ != version_of_planes; }

void StateReader::take_pieces() {
  const std::size_t planes = header_.planes(), count = has_blocks() ? block_count(header_.pixels(), planes) : planes;
  for (std::size_t i = 0; i < count; ++i) pieces_.push_back(take_piece());
}

void StateReader::take_integrator_state() {
  const Piece piece = take_piece();
  const std::uint64_t raw_bytes = header_.integrator_state_bytes;
  if (raw_bytes / max_compression > piece.bytes) fail("damaged: its integrator's state is too large");
  if (at_ != end_) fail("damaged: it has more than a state");
  header_.state.integrator_state.resize(static_cast<std::size_t>(raw_bytes));
  unpack(piece, header_.state.integrator_state, "its integrator's state");
}

void StateReader::unpack(const Piece& piece, std::span<std::byte> raw, const char* what) const {
  Bytes packed(static_cast<std::size_t>(piece.bytes));
  source_.read(piece.offset, packed);
  if (!(has_blocks() ? decompress(packed, raw) : inflate(packed, raw)))
    fail(fmt::format("damaged: {} cannot be unpacked", what));
}

bool StateReader::fits(const Film& film) const {
  return film.width() == header_.width && film.height() == header_.height &&
         film.step_exponent() == header_.step_exponent && film.contents() == header_.contents;
}

Film StateReader::empty_film() const {
  require_memory(static_cast<double>(header_.pixels() * header_.planes() * sizeof(std::int64_t)), {file_}, "its film");
  return Film::with_exponent(header_.width, header_.height, header_.step_exponent, header_.contents);
}

RenderState StateReader::load() const {
  RenderState state = head();
  state.film = empty_film();
  add_to(state.film);
  return state;
}

void StateReader::add_to(Film& film) const {
  parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t i) { add_piece(film, i); });
  film.add_report(header_.report);
}

// A block is small enough for the processor's caches: its part of the film is read and written once.
void StateReader::add_piece(Film& film, std::size_t piece) const {
  const std::size_t planes = has_blocks() ? header_.planes() : 1;
  const std::size_t first = has_blocks() ? piece * pixels_of_block(planes) : 0,
                    count =
                        has_blocks() ? std::min(pixels_of_block(planes), header_.pixels() - first) : header_.pixels();
  const std::size_t plane_bytes = count * sizeof(std::int64_t);
  Bytes raw(planes * plane_bytes);
  unpack(pieces_[piece], raw, "a layer");
  std::vector<std::int64_t> values(count);
  for (std::size_t plane = 0; plane < planes; ++plane) {
    untranspose(ByteSpan(raw).subspan(plane * plane_bytes, plane_bytes), values);
    film.add_sums(has_blocks() ? plane : piece, first, values);
  }
}

std::vector<std::byte> encode_state(const RenderState& state, const SaveOptions& options) {
  constexpr std::size_t at_once = 256;  // blocks that wait to be appended
  const std::string header = header_of(state, options).dump(-1, ' ', false, json::error_handler_t::replace);
  Bytes out;
  append(out, std::as_bytes(std::span(magic)));
  append_number(out, format_version);
  append_number(out, static_cast<std::uint32_t>(header.size()));
  append(out, std::as_bytes(std::span(header)));
  const auto append_piece = [&out](const Bytes& piece) {
    append_number(out, std::uint64_t{piece.size()});
    append(out, piece);
  };
  const std::size_t blocks = block_count(state.film.pixel_count(), state.film.plane_count());
  for (std::size_t first = 0; first < blocks; first += at_once) {
    std::vector<Bytes> pieces(std::min(at_once, blocks - first));
    parallel_for(std::size_t{0}, pieces.size(),
                 [&](std::size_t i) { pieces[i] = encode_block(state.film, first + i); });
    for (const Bytes& piece : pieces) append_piece(piece);
  }
  append_piece(compressed(state.integrator_state));
  append_number(out, checksum(out));
  return out;
}

RenderState decode_state(std::span<const std::byte> bytes, const std::string& file) {
  return read_state(bytes, file).load();
}

StateReader read_state(std::span<const std::byte> bytes, const std::string& name) { return {source_of(bytes), name}; }

void save_state(const RenderState& state, const std::filesystem::path& path, const SaveOptions& options) {
  write_file(path, encode_state(state, options));
}

RenderState load_state(const std::filesystem::path& path) { return open_state_reader(path).load(); }

StateReader open_state_reader(const std::filesystem::path& path) {
  return {source_of(std::make_shared<const PartlyReadFile>(path)), path.string()};
}

}  // namespace lanthorn
