// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The integrator that a name in a scene file stands for: pbrt's name, or our own.
#pragma once

#include <optional>
#include <string>

#include "io/known_method.h"

namespace lanthorn {

/// The default method, and the method that it is without its pilot.
inline constexpr const char *automatic_method = "auto", *method_without_pilot = "vcm";

/// Our integrator's name, e.g. "light" for "lightpath"; empty for names that are not known. The file's parameters are
/// checked against it, whether or not it renders the scene (`default_method`).
std::string integrator_of_file(const std::string& name);

/// The same integrator, for readers.
std::optional<KnownMethod> method_of_file(const std::string& name);

}  // namespace lanthorn
