// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "io/gltf/deform.h"
#include "io/gltf/document.h"
#include "io/gltf/materials.h"
#include "io/gltf/strokes.h"

namespace lanthorn::gltf {

/// The triangles of a primitive with the vertices that they use; or, without triangles, its points and lines.
struct Primitive {
  description::TriangleMesh mesh;
  Strokes strokes;
};

/// A deformed primitive with the attributes that its material needs: texture coordinates as (u, 1 - v), tangents.
/// nullopt, with a warning, if it has nothing to render. Throws Error.
std::optional<Primitive> read_primitive(Document& document, const Value& primitive, const Surface& surface,
                                        const Deformation& deformation);

}  // namespace lanthorn::gltf
