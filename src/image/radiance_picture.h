// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Radiance pictures (.hdr), as most environments are: read without the libraries that read all other kinds, which take
// longer to load than the picture.
#pragma once

#include <string_view>

#include "image/image_codec.h"

namespace lanthorn {

/// Reads the header; `OpenImage::read` gives float32 only. `bytes` must outlive what is returned. Throws
/// std::runtime_error that says why, here or when read.
OpenImage open_radiance_picture(std::string_view bytes);

}  // namespace lanthorn
