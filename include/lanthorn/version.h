// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lanthorn {

/// The build, packages and the Python module read it here. docs/releases.md says what it promises.
inline constexpr const char* version = "0.9.0";

}  // namespace lanthorn
