// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lanthorn {

inline constexpr const char* version = "0.1.0";

}  // namespace lanthorn
