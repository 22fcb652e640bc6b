// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The format: Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022), §3.6 (buffers), §4 (container);
// EXT_meshopt_compression, KHR_meshopt_compression.
#include "io/gltf/document.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "io/missing_files.h"
#include "lanthorn/text.h"

namespace lanthorn::gltf {

namespace {

using nlohmann::json;

constexpr int deepest_nesting = 200;
constexpr std::size_t most_image_bytes = std::size_t{4} << 30;
constexpr std::string_view binary_magic = "glTF";

struct Chunks {
  std::string_view text;
  std::optional<std::string_view> binary;
};

std::uint32_t little_endian_32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return value;
}

// glTF 2.0 §4.4.
Chunks split_container(std::string_view bytes, const std::string& name) {
  const auto fail = [&](const std::string& message) { return Error(SourceLocation{name}, message); };
  if (bytes.size() < 12) throw fail("the file ends inside its header");
  if (const std::uint32_t version = little_endian_32(bytes, 4); version != 2)
    throw fail("is version " + std::to_string(version) + " of glTF's binary container: only version 2 is supported");
  if (const std::uint32_t length = little_endian_32(bytes, 8); length > bytes.size())
    throw fail("the file has " + std::to_string(bytes.size()) + " bytes, but its header says " +
               std::to_string(length));
  else
    bytes = bytes.substr(0, length);
  Chunks chunks;
  bool has_text = false;
  for (std::size_t at = 12; at < bytes.size();) {
    if (bytes.size() - at < 8) throw fail("the file ends inside a chunk's header");
    const std::uint32_t length = little_endian_32(bytes, at), type = little_endian_32(bytes, at + 4);
    at += 8;
    if (length > bytes.size() - at) throw fail("the file ends inside a chunk");
    constexpr std::uint32_t json_type = 0x4E4F534A, binary_type = 0x004E4942;
    if (type == json_type && !std::exchange(has_text, true)) chunks.text = bytes.substr(at, length);
    if (type == binary_type && !chunks.binary) chunks.binary = bytes.substr(at, length);
    at += length;
  }
  if (!has_text) throw fail("the file has no JSON chunk");
  return chunks;
}

SourceLocation place_of_byte(std::string_view text, std::size_t byte, const std::string& name) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const auto lines = std::count(before.begin(), before.end(), '\n');
  const std::size_t line_start = before.rfind('\n') == before.npos ? 0 : before.rfind('\n') + 1;
  return {name, static_cast<int>(lines) + 1, static_cast<int>(before.size() - line_start) + 1};
}

// Shortens nlohmann's "[json.exception.parse_error.101] parse error at line 1, column 3: syntax error while ... -
// invalid literal; last read: 'what'; expected ...": returns the text from "syntax error" on, quoting at most one token
// of the input.
std::string plain_message(const std::string& message) {
  const std::size_t at = message.find("column ");
  const std::size_t colon = at == message.npos ? at : message.find(": ", at);
  if (colon == message.npos) return message;
  std::string text = message.substr(colon + 2);
  constexpr std::string_view marker = "last read: '";
  const std::size_t begin = text.find(marker), end = text.rfind('\'');
  if (begin != text.npos && end >= begin + marker.size()) {
    const std::size_t first = begin + marker.size();
    text.replace(first - 1, end + 2 - first, in_quotes(std::string_view(text).substr(first, end - first)));
  }
  return text;
}

// Checks the nesting before parsing. nlohmann's parser callback could do it, but with a callback the parser visits all
// elements of an array again at the array's end.
void check_nesting(std::string_view text, const std::string& name) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string && c == '\\')
      ++i;
    else if (c == '"')
      in_string = !in_string;
    else if (!in_string && (c == '[' || c == '{'))
      ++depth;
    else if (!in_string && (c == ']' || c == '}'))
      --depth;
    if (depth > deepest_nesting)
      throw Error(place_of_byte(text, i, name),
                  "the JSON is nested more than " + std::to_string(deepest_nesting) + " levels deep");
  }
}

json parse_json(std::string_view text, const std::string& name) {
  check_nesting(text, name);
  try {
    return json::parse(text.begin(), text.end());
  } catch (const json::parse_error& error) {
    throw Error(place_of_byte(text, error.byte > 0 ? error.byte - 1 : 0, name), plain_message(error.what()));
  } catch (const json::exception& error) {
    throw Error(SourceLocation{name}, plain_message(error.what()));
  }
}

std::optional<int> hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return {};
}

// RFC 3986, §2.1.
std::string percent_decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size()) {
      const auto high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
      if (high && low) {
        result += static_cast<char>(*high * 16 + *low);
        i += 2;
        continue;
      }
    }
    result += text[i];
  }
  return result;
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

// RFC 4648, §4 and §5; padding is optional.
std::optional<std::string> base64_decoded(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::string result;
  result.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) return {};
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count >= 8) {
      count -= 8;
      result += static_cast<char>(bits >> count & 0xffu);
    }
  }
  if (count == 6) return {};
  return result;
}

// The range [offset, offset + length) of `bytes`. Error messages call their owner `what`.
std::string_view part(std::string_view bytes, std::uint64_t offset, std::uint64_t length, const Value& place,
                      const char* what) {
  if (offset > bytes.size() || length > bytes.size() - offset)
    throw place.error("bytes " + std::to_string(offset) + " to " + std::to_string(offset + length) +
                      " lie outside the " + what + ", which has " + std::to_string(bytes.size()));
  return bytes.substr(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

void apply_filter(const std::string& filter, std::string& bytes, std::size_t count, std::size_t stride,
                  const Value& place) {
  if (filter == "NONE") return;
  const bool four_or_eight = stride == 4 || stride == 8;
  if (filter == "OCTAHEDRAL" && four_or_eight)
    meshopt_decodeFilterOct(bytes.data(), count, stride);
  else if (filter == "QUATERNION" && stride == 8)
    meshopt_decodeFilterQuat(bytes.data(), count, stride);
  else if (filter == "EXPONENTIAL" && stride % 4 == 0)
    meshopt_decodeFilterExp(bytes.data(), count, stride);
  else
    throw place.error("filter " + in_quotes(filter) + " is not supported for a byteStride of " +
                      std::to_string(stride));
}

}  // namespace

Document::Document(std::string_view bytes, std::filesystem::path folder, std::string name, FileReader read_file,
                   const FileAccess* access)
    : source_{std::move(name),
              [this](const Value& place, const std::string& key, const std::string& message) {
                if (replaced_.insert(place.pointer()).second) warn("value " + key, place, message);
              }},
      folder_(std::move(folder)),
      read_file_(std::move(read_file)),
      access_(access) {
  if (bytes.starts_with(binary_magic)) {
    const Chunks chunks = split_container(bytes, source_.name);
    json_ = parse_json(chunks.text, source_.name);
    binary_ = chunks.binary;
  } else {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (bytes.starts_with(byte_order_mark)) bytes.remove_prefix(byte_order_mark.size());
    json_ = parse_json(bytes, source_.name);
  }
  if (!json_.is_object()) throw Error(SourceLocation{source_.name}, "the file's JSON must be an object");
  scene.filename = source_.name;
}

void Document::start_again() {
  scene = {};
  scene.filename = source_.name;
  warnings_ = {};
  replaced_.clear();
  embedded_.clear();
  embedded_bytes_ = 0;
  for (const Value& image : std::exchange(embedded_images_, {})) embedded_image(image);
}

std::size_t Document::count(std::string_view array) const {
  const auto values = root().find_array(array);
  return values ? values->size() : 0;
}

Value Document::element(std::string_view array, std::size_t i) const { return root().at(array).element(i); }

std::size_t Document::index(std::string_view array, const Value& reference) const {
  const std::uint64_t i = reference.integer();
  if (i >= count(array))
    throw reference.error("is " + std::to_string(i) + ", but there are " + std::to_string(count(array)) + " " +
                          std::string(array));
  return static_cast<std::size_t>(i);
}

void Document::warn(const std::string& key, const Value& place, const std::string& message) {
  warnings_.add(scene.warnings, key, place.location(), message);
}

std::optional<std::string> Document::data_uri(const Value& uri) {
  std::string_view text = uri.text();
  if (!text.starts_with("data:")) return {};
  constexpr std::string_view marker = ";base64,";
  const std::size_t comma = text.find(',');
  if (comma == text.npos || comma + 1 < marker.size() ||
      text.substr(comma + 1 - marker.size(), marker.size()) != marker)
    throw uri.error("a data URI must be in base64");
  auto bytes = base64_decoded(text.substr(comma + 1));
  if (!bytes) throw uri.error("the data URI is not valid base64");
  return bytes;
}

namespace {

// The last component of a name with slashes of either kind.
std::string last_part(const std::string& name) {
  const std::size_t slash = name.find_last_of("/\\");
  return slash == name.npos ? name : name.substr(slash + 1);
}

// Treats backslashes as slashes, as the search for files does.
bool leaves_folder(const std::filesystem::path& name) {
  std::string text = name.string();
  std::replace(text.begin(), text.end(), '\\', '/');
  const std::filesystem::path normal = std::filesystem::path(text).lexically_normal();
  return normal.is_absolute() || (!normal.empty() && *normal.begin() == "..");
}

}  // namespace

std::filesystem::path Document::add_file(const Value& uri) {
  const std::string& text = uri.text();
  const std::size_t colon = text.find(':');
  std::filesystem::path decoded = std::filesystem::path(percent_decoded(text)).lexically_normal();
  if (leaves_folder(decoded) || (colon != text.npos && text.find('/') > colon)) {
    decoded = last_part(decoded.string());
    if (access_ == nullptr || access_->is_missing(access_->find(folder_, decoded)))
      throw uri.error("only data URIs and relative URIs that stay in the file's folder are supported, not " +
                      in_quotes(text));
  }
  const auto warn_of = [&](const std::string& message) { warn("elsewhere", uri, message); };
  std::filesystem::path path = find_file(folder_, decoded.string(), access_, warn_of);
  // Some model hosting sites escape the names of the files themselves.
  if (const std::filesystem::path literal = folder_ / text;
      access_ != nullptr && access_->is_missing(path) && !access_->is_missing(literal))
    path = literal;
  scene.files.try_emplace(text, description::File{path, {}, uri.location()});
  return path;
}

description::Index Document::embedded_image(const Value& image) {
  if (const auto known = embedded_.find(image.pointer()); known != embedded_.end()) return known->second;
  const auto uri = image.find("uri");
  auto bytes = uri ? data_uri(*uri) : std::string(buffer_view(image.at("bufferView")).bytes);
  if (!bytes) throw uri->error("must be a data URI");
  embedded_bytes_ += bytes->size();
  if (embedded_bytes_ > most_image_bytes)
    throw image.error("the images are larger than " + std::to_string(most_image_bytes) + " bytes together");
  const auto index = static_cast<description::Index>(scene.embedded_images.size());
  embedded_images_.push_back(image);
  scene.embedded_images.push_back({image.location().file, std::move(*bytes)});
  return embedded_.emplace(image.pointer(), index).first->second;
}

// Adds the document's other files, so that a missing file is reported together with them.
void Document::add_all_files() {
  for (const std::string_view array : {"buffers", "images"})
    for (std::size_t i = 0; i < count(array); ++i)
      if (const auto uri = element(array, i).find("uri"); uri && !uri->text().starts_with("data:")) add_file(*uri);
}

std::string Document::read_buffer(const Value& uri) {
  const std::filesystem::path path = add_file(uri);
  try {
    return read_file_(path);
  } catch (const Error& problem) {
    if (access_ != nullptr && access_->is_missing(path)) {
      if (access_->skip_missing) throw MissingFile();
      add_all_files();
      report_missing_files(scene, *access_);
    }
    throw uri.error(problem.what());
  }
}

std::string_view Document::buffer(const Value& reference) {
  const std::size_t i = index("buffers", reference);
  const Value value = element("buffers", i);
  const std::uint64_t length = value.at("byteLength").integer();
  const auto uri = value.find("uri");
  std::string_view bytes;
  if (!uri && i == 0 && binary_) {
    bytes = *binary_;
  } else if (!uri) {
    throw value.error(binary_ ? "needs the member \"uri\"" : "needs the member \"uri\": the file has no binary chunk");
  } else {
    auto found = buffers_.find(i);
    if (found == buffers_.end()) {
      auto embedded = data_uri(*uri);
      found = buffers_.emplace(i, embedded ? std::move(*embedded) : read_buffer(*uri)).first;
    }
    bytes = found->second;
  }
  if (length > bytes.size())
    throw value.error("byteLength is " + std::to_string(length) + ", but there are only " +
                      std::to_string(bytes.size()) + " bytes");
  return bytes.substr(0, static_cast<std::size_t>(length));
}

std::string Document::decompressed(const Value& view, const Value& compression) {
  constexpr std::uint64_t most = std::uint64_t{1} << 32;
  const std::string_view source = part(buffer(compression.at("buffer")), compression.integer("byteOffset", 0),
                                       compression.at("byteLength").integer(), compression, "buffer");
  const auto stride = static_cast<std::size_t>(compression.at("byteStride").integer(256));
  const std::uint64_t count = compression.at("count").integer(most);
  const std::string mode = compression.at("mode").text();
  // In either encoding, one byte decodes to fewer than 256 bytes, which bounds the count.
  if (stride == 0 || count * stride > 256 * (source.size() + 256))
    throw compression.error("the compressed data is too short for " + std::to_string(count) + " elements of " +
                            std::to_string(stride) + " bytes");
  std::string result(static_cast<std::size_t>(count) * stride, '\0');
  const auto* data = reinterpret_cast<const unsigned char*>(source.data());
  const auto elements = static_cast<std::size_t>(count);
  int status = -1;
  if (mode == "ATTRIBUTES" && stride % 4 == 0)
    status = meshopt_decodeVertexBuffer(result.data(), elements, stride, data, source.size());
  else if (mode == "TRIANGLES" && count % 3 == 0 && (stride == 2 || stride == 4))
    status = meshopt_decodeIndexBuffer(result.data(), elements, stride, data, source.size());
  else if (mode == "INDICES" && (stride == 2 || stride == 4))
    status = meshopt_decodeIndexSequence(result.data(), elements, stride, data, source.size());
  else
    throw compression.error("there is no mode " + in_quotes(mode) + " for " + std::to_string(count) + " elements of " +
                            std::to_string(stride) + " bytes");
  if (status != 0 && mode == "ATTRIBUTES" && data[0] == 0xa1)
    throw compression.error("the compressed data is of version 1 of the format, of which only version 0 can be read");
  if (status != 0) throw compression.error("the compressed data is damaged");
  apply_filter(compression.text("filter", "NONE"), result, elements, stride, compression);
  if (view.at("byteLength").integer() > result.size())
    throw view.error("byteLength is larger than the decompressed data, " + std::to_string(result.size()) + " bytes");
  return result;
}

Document::View Document::buffer_view(const Value& reference) {
  const std::size_t i = index("bufferViews", reference);
  const Value view = element("bufferViews", i);
  const auto stride = static_cast<std::size_t>(view.find("byteStride") ? view.at("byteStride").integer(256) : 0);
  auto compression = view.extension("EXT_meshopt_compression");
  if (!compression) compression = view.extension("KHR_meshopt_compression");
  if (compression) {
    auto found = decompressed_.find(i);
    if (found == decompressed_.end()) found = decompressed_.emplace(i, decompressed(view, *compression)).first;
    return {found->second, stride};
  }
  return {
      part(buffer(view.at("buffer")), view.integer("byteOffset", 0), view.at("byteLength").integer(), view, "buffer"),
      stride};
}

}  // namespace lanthorn::gltf
