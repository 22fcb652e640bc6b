// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace lanthorn {

/// A parameter of a method, set by `RenderOptions::set`.
struct ParameterInfo {
  std::string name;
  std::string default_value;
  std::string help;  ///< meaning, unit, range
};

/// A rendering method.
struct MethodInfo {
  std::string name;
  std::string summary;  ///< in one line
  std::string paper;
  std::vector<ParameterInfo> parameters;
};

/// All methods, in the order of `lanthorn list`.
std::vector<MethodInfo> methods();
/// Adds to `methods` those of the viewer's techniques that render frame by frame (`ispm` and `voxelcones`), if the
/// library was built with LANTHORN_BUILD_VIEWER. Does not use OpenGL itself. Not thread-safe: call it once, before any
/// render.
void add_realtime_methods();
/// Throws Error, naming the known methods, if none has this name.
const MethodInfo& find_method(const std::string& name);
/// Throws an Error that begins with `option` if passes of this method depend on earlier ones, so that a render cannot
/// be split into ranges of passes.
void require_independent_passes(const std::string& option, const std::string& method);

/// The method of renders whose options do not name one.
struct DefaultMethod {
  std::string name;
  std::string notice;  ///< for the user, if `auto` replaces the integrator that the file names; else empty
};
/// `integrator`: the method that the scene's file names (`RenderHints::integrator`), or empty. Methods that only
/// Lanthorn has are used as named; all other names become `auto`.
DefaultMethod default_method(const std::string& integrator);

}  // namespace lanthorn
