// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Methods that draw by OpenGL.
#pragma once

namespace lanthorn {

/// Adds to `methods` the techniques of the viewer that render by frames (`ispm` and `voxelcones`), if the library was
/// built with them (LANTHORN_BUILD_VIEWER). Call it once,
/// before any render: not thread-safe. Needs no OpenGL itself.
void add_realtime_methods();

}  // namespace lanthorn
