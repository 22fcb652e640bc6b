// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What the fuzzers run on one input, apart from libFuzzer so that an ordinary test can replay the corpus. A target
// returns if the input was read, or refused with lanthorn::Error; it aborts if what was read is inconsistent.
#pragma once

#include <string_view>

namespace lanthorn::fuzz {

/// The text is a pbrt-v4 scene. The files that it names are a few small ones kept in memory.
void read_pbrt(std::string_view text);
/// The text is a spectrum file and a lens file, read through scenes that name it.
void read_tables(std::string_view text);
/// The bytes are a PLY file.
void read_ply(std::string_view bytes);
void read_gltf(std::string_view bytes);
/// The bytes are a measured BRDF, which is then evaluated and sampled.
void read_measured(std::string_view bytes);
void read_obj(std::string_view text);
/// The bytes are a Radiance picture; others are not read.
void read_hdr(std::string_view bytes);
/// The bytes are a render state, read as they are and once more with their header's size and their checksum made right.
void read_state(std::string_view bytes);

/// The bytes are the head of a request to `lanthorn serve`.
void read_request(std::string_view bytes);

}  // namespace lanthorn::fuzz
