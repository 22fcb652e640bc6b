// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/program.h"

namespace lanthorn {

/// All shaders of src/realtime by file name, as they were when the library was built.
const gl::ShaderFiles& shader_files();

}  // namespace lanthorn
