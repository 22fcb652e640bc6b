// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "path/path_context.h"
#include "path/vertex.h"

namespace lanthorn {

/// True if the disc of this radius (m) around a vertex of an eye path lies on surfaces of its plane, and if nothing
/// stands on its visible side, as far as rays to eight points of its edge can tell.
bool is_flat_and_clear(const PathContext& path, const SurfaceVertex& vertex, float radius);

}  // namespace lanthorn
