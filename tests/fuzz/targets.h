// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Runs the fuzz targets on one input; separate from libFuzzer so that an ordinary test can replay the corpus. A target
// returns if the input was read, or rejected with lanthorn::Error; it aborts if the result is inconsistent.
#pragma once

#include <string_view>

namespace lanthorn::fuzz {

/// The text is a pbrt-v4 scene. It may refer to a few small files kept in memory.
void read_pbrt(std::string_view text);
/// The text is used as a spectrum file and as a lens file, through scenes that refer to it.
void read_tables(std::string_view text);
/// The bytes are a PLY file.
void read_ply(std::string_view bytes);
void read_gltf(std::string_view bytes);
/// The bytes are a measured BRDF, which is then evaluated and sampled.
void read_measured(std::string_view bytes);
void read_obj(std::string_view text);
/// The bytes are a Radiance picture; other formats are skipped.
void read_hdr(std::string_view bytes);
/// The bytes are a render state, read unchanged and again with corrected header size and checksum.
void read_state(std::string_view bytes);

/// The bytes are the head of a request to `lanthorn serve`.
void read_request(std::string_view bytes);

}  // namespace lanthorn::fuzz
