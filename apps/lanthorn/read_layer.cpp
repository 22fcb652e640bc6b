// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "read_layer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <utility>

#include "lanthorn/error.h"
#include "lanthorn/image_file.h"
#include "lanthorn/text.h"

namespace lanthorn::program {

Image read_layer(const std::string& file, const std::string& layer, std::uint64_t max_pixels) {
  const Image image = read_image(file, ColorEncoding::automatic, max_pixels);
  std::optional<Image> selected = select_layer(image, layer);
  if (!selected)
    throw Error({file}, fmt::format("has no layer {}; it has {}", layer,
                                    printable(fmt::format("{}", fmt::join(layer_names(image), ", ")))));
  return std::move(*selected);
}

Option layer_option(std::string& layer, const std::string& what) {
  return {.names = "--layer",
          .value = into(layer, text_type("LAYER")),
          .brief = what + ": color, direct, indirect, caustic, albedo, normal, depth ...",
          .otherwise = layer};
}

}  // namespace lanthorn::program
