// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/methods.h"

namespace lanthorn {

/// The facts about a rendering method that a reader needs to check the method's parameters in a scene file. Readers
/// themselves do not depend on any method.
struct KnownMethod {
  std::vector<ParameterInfo> parameters;
  /// Throws Error for values that the method does not accept.
  std::function<void(const std::map<std::string, std::string>& set)> check;
};
/// Finds a method by the name of an integrator in a scene file, pbrt's or our own; nullopt for other names.
using FindMethod = std::function<std::optional<KnownMethod>(const std::string& name)>;

}  // namespace lanthorn
