// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "io/gltf/deform.h"
#include "io/gltf/document.h"
#include "io/gltf/materials.h"

namespace lanthorn::gltf {

/// Decodes the mesh of a KHR_draco_mesh_compression extension, with the attributes that its surface needs: texture
/// coordinates as (u, 1 - v), tangents. Vertices are moved by the joints of a skin if there are any. Throws Error at
/// the extension.
description::TriangleMesh decode_draco(Document& document, const Value& extension, const Surface& surface,
                                       std::span<const glm::dmat4> joints);

}  // namespace lanthorn::gltf
