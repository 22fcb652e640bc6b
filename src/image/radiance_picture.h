// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reads Radiance pictures (.hdr), the most common environments, without the libraries that read all other kinds, which
// take longer to load than the picture.
#pragma once

#include <string_view>

#include "image/image_codec.h"

namespace lanthorn {

/// Reads the header; `OpenImage::read` provides only float32. `bytes` must outlive the result. Throws
/// std::runtime_error that states the reason, here or when pixels are read.
OpenImage open_radiance_picture(std::string_view bytes);

}  // namespace lanthorn
