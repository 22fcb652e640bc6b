// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "io/gltf/document.h"

namespace lanthorn::gltf {

/// The triangles of a primitive and the vertices that they use, with the texture coordinates TEXCOORD_`uv_set` as
/// (u, 1 - v). Empty if it has no triangles (warning). Throws Error.
std::optional<description::TriangleMesh> read_primitive(Document& document, const Value& primitive, std::size_t uv_set);

}  // namespace lanthorn::gltf
