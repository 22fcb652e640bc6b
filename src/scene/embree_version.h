// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace lanthorn {

/// Version of the loaded Embree, such as "3.13.5".
std::string version_of_embree();

}  // namespace lanthorn
