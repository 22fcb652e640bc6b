// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Registers the methods that draw with OpenGL.
#pragma once

namespace lanthorn {

/// Adds to `methods` those of the viewer's techniques that render frame by frame (`ispm` and `voxelcones`), if the
/// library was built with LANTHORN_BUILD_VIEWER. Does not use OpenGL itself. Not thread-safe: call it once, before any
/// render.
void add_realtime_methods();

}  // namespace lanthorn
