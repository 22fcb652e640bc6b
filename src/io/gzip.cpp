// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/gzip.h"

#include <zlib.h>

#include <algorithm>

#include "base/memory.h"
#include "lanthorn/error.h"

namespace lanthorn {

namespace {

// Owns zlib's inflate state for gzip streams.
class Inflater {
 public:
  Inflater(std::string_view input, const std::string& name) : name_(name) {
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(input.data()));
    remaining_ = input.size();
    if (inflateInit2(&stream_, 16 + MAX_WBITS) != Z_OK) fail("cannot start zlib");
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&stream_); }

  // Fills `output` as far as the input allows. Returns the number of bytes written, 0 at the end.
  std::size_t read(char* output, std::size_t size) {
    stream_.next_out = reinterpret_cast<Bytef*>(output);
    stream_.avail_out = static_cast<uInt>(size);
    while (stream_.avail_out > 0 && !done_) step();
    return size - stream_.avail_out;
  }

 private:
  void step() {
    if (stream_.avail_in == 0) {
      constexpr std::size_t largest = std::size_t{1} << 30;
      stream_.avail_in = static_cast<uInt>(std::min(remaining_, largest));
      remaining_ -= stream_.avail_in;
    }
    const bool starved = stream_.avail_in == 0;
    const int result = inflate(&stream_, Z_NO_FLUSH);
    if (result == Z_STREAM_END) {
      if (stream_.avail_in == 0 && remaining_ == 0)
        done_ = true;
      else if (inflateReset(&stream_) != Z_OK)
        fail("damaged gzip data");
    } else if (starved) {
      fail("gzip data ends early");
    } else if (result != Z_OK) {
      fail("damaged gzip data");
    }
  }

  [[noreturn]] void fail(const char* message) const { throw Error(SourceLocation{name_}, message); }

  const std::string& name_;
  z_stream stream_{};
  std::size_t remaining_ = 0;
  bool done_ = false;
};

}  // namespace

bool is_gzip(std::string_view bytes) { return bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b'; }

std::string gunzip(std::string_view bytes, const std::string& name, std::size_t limit) {
  if (const auto available = available_memory()) limit = std::min<std::size_t>(limit, *available / 2);
  Inflater inflater(bytes, name);
  std::string result;
  std::size_t used = 0;
  while (true) {
    const std::size_t chunk = std::max<std::size_t>(64 * 1024, std::min<std::size_t>(used, 64 * 1024 * 1024));
    result.resize(used + chunk);
    const std::size_t got = inflater.read(result.data() + used, chunk);
    used += got;
    if (used > limit)
      throw Error(SourceLocation{name}, "decompressed data is larger than " + memory_text(static_cast<double>(limit)) +
                                            ", the most that is read: 4 GiB, or half of the memory there is");
    if (got < chunk) break;
  }
  result.resize(used);
  return result;
}

std::string decompressed(std::string bytes, const std::string& name) {
  if (is_gzip(bytes)) return gunzip(bytes, name);
  return bytes;
}

}  // namespace lanthorn
