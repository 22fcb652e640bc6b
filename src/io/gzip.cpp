// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

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
        fail("the gzip data is damaged");
    } else if (starved) {
      fail("the gzip data is truncated");
    } else if (result != Z_OK) {
      fail("the gzip data is damaged");
    }
  }

  [[noreturn]] void fail(const char* message) const { throw Error(SourceLocation{name_}, message); }

  const std::string& name_;
  z_stream stream_{};
  std::size_t remaining_ = 0;
  bool done_ = false;
};

// A part of the decompressed data. A single growing string would be copied and take up to three times its size.
struct Piece {
  std::unique_ptr<char[]> bytes;
  std::size_t size = 0, used = 0;

  explicit Piece(std::size_t size_) : bytes(std::make_unique_for_overwrite<char[]>(size_)), size(size_) {}
};

// Size of the next piece, given the number of bytes before it. Freed pieces of the largest size go back to the system.
std::size_t piece_size(std::size_t before) {
  return std::clamp<std::size_t>(before, std::size_t{64} << 10, std::size_t{64} << 20);
}

// Frees each piece once it is copied, so that only one piece is in memory twice.
std::string joined(std::vector<Piece> pieces, std::size_t size) {
  std::string result;
  result.reserve(size);
  for (Piece& piece : pieces) {
    result.append(piece.bytes.get(), piece.used);
    piece.bytes.reset();
  }
  return result;
}

}  // namespace

bool is_gzip(std::string_view bytes) { return bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b'; }

std::string gunzip(std::string_view bytes, const std::string& name, std::size_t limit) {
  if (const auto available = available_memory()) limit = std::min<std::size_t>(limit, *available / 2);
  Inflater inflater(bytes, name);
  std::vector<Piece> pieces;
  std::size_t used = 0;
  for (bool more = true; more;) {
    Piece& piece = pieces.emplace_back(std::min(piece_size(used), limit + 1 - used));
    piece.used = inflater.read(piece.bytes.get(), piece.size);
    used += piece.used;
    if (used > limit)
      throw Error(SourceLocation{name}, "decompressed data is larger than " + memory_text(static_cast<double>(limit)) +
                                            ", the limit: 4 GiB, or half of the memory");
    more = piece.used == piece.size;
  }
  return joined(std::move(pieces), used);
}

std::string decompressed(std::string bytes, const std::string& name) {
  if (is_gzip(bytes)) return gunzip(bytes, name);
  return bytes;
}

}  // namespace lanthorn
