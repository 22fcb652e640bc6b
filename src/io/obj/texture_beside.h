// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace lanthorn::obj {

/// Finds a picture in the model's folder whose name marks it as the model's colours, such as MODEL_diffuse.png beside
/// MODEL.obj: many collections ship such pictures without an MTL file that names them.
std::optional<std::string> texture_beside(const std::filesystem::path& model);

}  // namespace lanthorn::obj
