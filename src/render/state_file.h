// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reads saved states in blocks of pixels, so that sums are added to a film without a second film in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "render/state.h"

namespace lanthorn {

/// The bytes of a state, in a file or in memory.
struct ByteSource {
  std::uint64_t size = 0;
  /// Fills `out` with the bytes from `offset` on, which the source has. Several threads may call it.
  std::function<void(std::uint64_t offset, std::span<std::byte> out)> read;
};

/// The header of a state file.
struct StateHeader {
  RenderState state;  ///< all but the film, which is empty, and the integrator's state
  int width = 0, height = 0, step_exponent = 0;
  FilmContents contents;
  FilmReport report;  ///< of the film
  std::uint64_t integrator_state_bytes = 0;

  std::size_t planes() const { return Film::stride(contents); }
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

class StateReader {
 public:
  /// Reads all but the sums. Throws Error at `file` unless the checksum is right and the header belongs to a version of
  /// states that this program reads.
  StateReader(ByteSource source, std::string file);

  /// All but the film, which is empty.
  const RenderState& head() const { return header_.state; }
  /// True if the sums can be added to this film.
  bool fits(const Film& film) const;
  /// The whole state. Throws Error at `file` if its sums are damaged or there is not enough memory for them.
  RenderState load() const;
  /// Adds the sums and counts. Throws Error at `file` if they are damaged; the film's sums are then of no more use.
  void add_to(Film& film) const;

 private:
  /// A part of the sums: a block of pixels with all planes or, in version 6, a plane of all pixels.
  struct Piece {
    std::uint64_t offset, bytes;  ///< in the file, compressed
  };
  [[noreturn]] void fail(const std::string& message) const;
  void check_envelope();
  template <class T>
  T take();
  Piece take_piece();
  Film empty_film() const;
  void take_pieces();
  void take_integrator_state();
  void unpack(const Piece& piece, std::span<std::byte> raw, const char* what) const;
  void add_piece(Film& film, std::size_t piece) const;
  bool has_blocks() const;

  ByteSource source_;
  std::string file_;
  std::uint64_t at_ = 0, end_ = 0;  // the part that is not read yet, without the checksum
  std::uint32_t version_ = 0;
  StateHeader header_;
  std::vector<Piece> pieces_;
};

/// A reader of bytes, which must outlive it. `name`: of the file, in messages.
StateReader read_state(std::span<const std::byte> bytes, const std::string& name);

/// A reader of a file. Throws Error also if the file cannot be read.
StateReader open_state_reader(const std::filesystem::path& path);

}  // namespace lanthorn
