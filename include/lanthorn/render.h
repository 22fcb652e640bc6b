// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Lanthorn as a library: a scene file in, a picture out. What more the program `lanthorn` offers (shards,
// resuming) is in its command line.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "lanthorn/error.h"
#include "lanthorn/image.h"

namespace lanthorn {

/// What to render. Whatever is empty is taken from the scene file, or has the program's default.
struct RenderRequest {
  std::filesystem::path scene;  ///< a .pbrt, .gltf, .glb or .obj file
  std::string integrator;       ///< a name of `lanthorn list`
  std::optional<std::uint64_t> passes;
  std::optional<double> seconds;  ///< stop after the pass in which this much time is over
  std::optional<std::uint64_t> seed;
  std::optional<int> width, height;               ///< pixels; both or none
  unsigned threads = 0;                           ///< 0: all cores; the picture does not depend on it
  std::map<std::string, std::string> parameters;  ///< of the integrator, as `--set`

  /// For scenes from strangers: only files in the scene file's folder and those below it are read, whatever names and
  /// links say, and errors show nothing of what is in them.
  bool sandbox = false;
  std::uint64_t max_pixels = std::uint64_t{1} << 30;  ///< of each image that the scene names; larger ones are an Error
  std::optional<std::uint64_t> memory;                ///< bytes, as `--memory`; empty: what the machine has left

  /// Called after each pass with the passes done; false ends the render after it.
  std::function<bool(std::uint64_t passes)> progress;

  /// Once the flag is set, by any thread or signal handler, the running pass is given up and the picture of those
  /// before it is returned; Error if there is none. Costs a copy of the film.
  const std::atomic<bool>* stop = nullptr;

  /// Called with each warning, on the calling thread: before the first pass, what the scene asks for and Lanthorn reads
  /// over or replaces, with its place in the file; after the last, without a place, if values could not be added to the
  /// picture. Nothing is printed if it is not set.
  std::function<void(const SourceLocation& where, const std::string& message)> warning;
};

/// Renders; the picture has all layers (see `Film::resolve` for the channels). Throws Error for a scene or request that
/// is wrong, with its place in the file.
Image render(const RenderRequest& request);

/// Writes .exr (all layers) or .png (color, sRGB), whole or not at all. Throws Error.
void save(const Image& image, const std::filesystem::path& path);

}  // namespace lanthorn
