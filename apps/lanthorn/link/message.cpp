// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "message.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include "../report_json.h"
#include "lanthorn/error.h"
#include "lanthorn/text.h"

namespace lanthorn::program {

namespace {

static_assert(std::endian::native == std::endian::little, "the protocol's numbers are little-endian");

constexpr std::array<char, 4> magic{'L', 'N', 'T', 'H'};
constexpr std::uint32_t most_json_bytes = 1U << 28;
constexpr std::uint64_t most_data_bytes = std::uint64_t{1} << 36;
constexpr std::size_t chunk_bytes = std::size_t{1} << 24;  // limits what a header with a false size can allocate

struct Header {
  std::array<char, 4> magic{};
  std::uint32_t json_bytes = 0;
  std::uint64_t data_bytes = 0;
};
static_assert(sizeof(Header) == 16);

// Returns fewer bytes than requested only at the end of the stream.
std::size_t read_some(int file, std::byte* out, std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::read(file, out + done, count - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Error("cannot read the client's messages: " + std::generic_category().message(errno));
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::vector<std::byte> read_bytes(int file, std::uint64_t count) {
  std::vector<std::byte> bytes;
  while (bytes.size() < count) {
    const std::size_t begin = bytes.size();
    const std::size_t part = static_cast<std::size_t>(std::min<std::uint64_t>(chunk_bytes, count - begin));
    bytes.resize(begin + part);
    if (read_some(file, bytes.data() + begin, part) < part) throw Error("the client's last message is truncated");
  }
  return bytes;
}

void check_header(const Header& header) {
  if (header.magic != magic)
    throw Error("expected a message of lanthorn's protocol, which begins with the bytes LNTH (see docs/protocol.md)");
  if (header.json_bytes > most_json_bytes || header.data_bytes > most_data_bytes)
    throw Error("expected a message of at most " + std::to_string(most_json_bytes) + " bytes of JSON and " +
                std::to_string(most_data_bytes) + " bytes of arrays");
}

bool has_unread_bytes(int file) {
  int count = 0;
  return ::ioctl(file, FIONREAD, &count) == 0 && count > 0;
}

void write_all(int file, const void* bytes, std::size_t count) {
  const auto* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::write(file, next, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw Error("cannot write to the client: " + std::generic_category().message(errno));
    next += written;
    count -= static_cast<std::size_t>(written);
  }
}

using plain::Scalar;

constexpr int deepest = 64;  // levels of nested lists and objects
constexpr const char* array_key = "$array";
constexpr std::array<std::pair<const char*, Scalar>, 10> scalar_names{{{"int8", Scalar::int8},
                                                                       {"int16", Scalar::int16},
                                                                       {"int32", Scalar::int32},
                                                                       {"int64", Scalar::int64},
                                                                       {"uint8", Scalar::uint8},
                                                                       {"uint16", Scalar::uint16},
                                                                       {"uint32", Scalar::uint32},
                                                                       {"uint64", Scalar::uint64},
                                                                       {"float32", Scalar::float32},
                                                                       {"float64", Scalar::float64}}};

class JsonReader {
 public:
  explicit JsonReader(std::shared_ptr<const std::vector<std::byte>> data) : data_(std::move(data)) {}

  plain::Dict dict(const nlohmann::json& object, int depth) const {
    plain::Dict dict;
    for (const auto& [key, item] : object.items()) dict.set(key, value(item, depth + 1));
    return dict;
  }

 private:
  plain::Value value(const nlohmann::json& data, int depth) const {
    if (depth > deepest) throw Error("expected at most " + std::to_string(deepest) + " levels of lists and objects");
    switch (data.type()) {
      case nlohmann::json::value_t::boolean:
        return data.get<bool>();
      case nlohmann::json::value_t::number_integer:
        return data.get<std::int64_t>();
      case nlohmann::json::value_t::number_unsigned:
        return whole(data.get<std::uint64_t>());
      case nlohmann::json::value_t::number_float:
        return data.get<double>();
      case nlohmann::json::value_t::string:
        return data.get<std::string>();
      case nlohmann::json::value_t::array:
        return list(data, depth);
      case nlohmann::json::value_t::object:
        break;
      default:
        return {};
    }
    if (data.contains(array_key)) return array(data);
    return dict(data, depth);
  }

  static plain::Value whole(std::uint64_t number) {
    if (std::in_range<std::int64_t>(number)) return static_cast<std::int64_t>(number);
    return number;
  }

  plain::Value list(const nlohmann::json& data, int depth) const {
    plain::List list;
    list.reserve(data.size());
    for (const nlohmann::json& item : data) list.push_back(value(item, depth + 1));
    return list;
  }

  plain::Value array(const nlohmann::json& data) const {
    const std::optional<Scalar> type = scalar_of(data[array_key]);
    if (!type) throw Error("expected the type of an array, such as float32, got " + excerpt(data[array_key].dump()));
    const std::optional<std::uint64_t> offset = whole_of(data.value("offset", nlohmann::json(0)));
    const nlohmann::json shape = data.value("shape", nlohmann::json());
    if (!offset || !shape.is_array()) throw Error("an array has a type, a \"shape\" and an \"offset\" in bytes");
    plain::Array array{*type, {}, data_, nullptr};
    // Compares by division, because the product of forged extents may overflow.
    const std::uint64_t room = *offset <= data_->size() ? (data_->size() - *offset) / bytes_of(*type) : 0;
    std::uint64_t count = 1;
    for (const nlohmann::json& extent : shape) {
      const std::optional<std::uint64_t> size = whole_of(extent);
      if (!size || (*size > 0 && count > room / *size)) throw Error("an array extends beyond the end of its message");
      count *= *size;
      array.shape.push_back(static_cast<std::size_t>(*size));
    }
    if (*offset > data_->size() || count > room) throw Error("an array extends beyond the end of its message");
    array.data = data_->data() + *offset;
    return array;
  }

  static std::optional<Scalar> scalar_of(const nlohmann::json& name) {
    for (const auto& [known, scalar] : scalar_names)
      if (name == known) return scalar;
    return std::nullopt;
  }
  static std::optional<std::uint64_t> whole_of(const nlohmann::json& number) {
    if (!number.is_number_unsigned()) return std::nullopt;
    return number.get<std::uint64_t>();
  }

  std::shared_ptr<const std::vector<std::byte>> data_;
};

// nlohmann's parser does not limit depth, and copying deeply nested values recurses.
void check_depth(std::string_view text) {
  int depth = 0;
  bool is_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_text && c == '\\') ++i;
    if (c == '"') is_text = !is_text;
    if (is_text) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > deepest) throw Error("expected at most " + std::to_string(deepest) + " levels of lists and objects");
  }
}

// Parses a JSON object. {"$array": "float32", "shape": [n, 3], "offset": bytes} refers to an array in `data`. Throws
// Error for text that is not a JSON object, for excessive nesting, and for arrays that `data` does not contain.
plain::Dict dict_of_json(std::string_view text, const std::shared_ptr<const std::vector<std::byte>>& data) {
  check_depth(text);
  const nlohmann::json object = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!object.is_object()) throw Error("expected a JSON object, got " + excerpt(text));
  return JsonReader(data).dict(object, 0);
}

}  // namespace

std::optional<LinkRequest> read_request(int file) {
  Header header;
  const std::size_t got = read_some(file, reinterpret_cast<std::byte*>(&header), sizeof(header));
  if (got == 0) return std::nullopt;
  if (got < sizeof(header)) throw Error("the client's last message is truncated");
  check_header(header);
  const std::vector<std::byte> json = read_bytes(file, header.json_bytes);
  const auto data = std::make_shared<const std::vector<std::byte>>(read_bytes(file, header.data_bytes));
  try {
    return LinkRequest{dict_of_json({reinterpret_cast<const char*>(json.data()), json.size()}, data), {}};
  } catch (const Error& e) {
    return LinkRequest{{}, e.what()};
  }
}

void write_answer(int file, const nlohmann::json& body, std::span<const float> numbers) {
  const std::string json = json_text(body, one_line);
  const Header header{magic, static_cast<std::uint32_t>(json.size()), numbers.size_bytes()};
  write_all(file, &header, sizeof(header));
  write_all(file, json.data(), json.size());
  write_all(file, numbers.data(), numbers.size_bytes());
}

void wait_for_end_of_client(int input, int output, std::chrono::milliseconds patience) {
  std::array<pollfd, 2> ends{
      {{.fd = output, .events = 0, .revents = 0}, {.fd = input, .events = POLLRDHUP, .revents = 0}}};
  while (::poll(ends.data(), ends.size(), -1) <= 0) {
  }
  constexpr int step = 100;  // milliseconds
  std::chrono::milliseconds waited{0};
  while (ends[0].revents == 0 && waited < patience) {
    ::poll(ends.data(), 1, step);
    waited = has_unread_bytes(input) ? std::chrono::milliseconds(0) : waited + std::chrono::milliseconds(step);
  }
}

}  // namespace lanthorn::program
