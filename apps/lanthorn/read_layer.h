// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "lanthorn/image.h"
#include "options.h"

namespace lanthorn::program {

/// Reads a layer of a picture file. Throws Error as `read_image` does, and, naming the existing layers, if the file
/// lacks this one.
Image read_layer(const std::string& file, const std::string& layer, std::uint64_t max_pixels);

/// --layer. `what`: for the help.
Option layer_option(std::string& layer, const std::string& what);

}  // namespace lanthorn::program
