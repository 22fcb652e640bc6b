// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lanthorn {

/// CMake, the packages and the Python module read the version from here. docs/releases.md says what it promises.
inline constexpr const char* version = "0.9.0";

}  // namespace lanthorn
