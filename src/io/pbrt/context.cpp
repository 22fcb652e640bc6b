// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/context.h"

#include <algorithm>

#include "io/missing_files.h"

namespace lanthorn::pbrt {

void Context::warn(std::string_view key, const SourceLocation& place, const std::string& message) {
  warnings_.add(scene.warnings, key, place, message);
}

Error Context::unknown(std::string_view what, std::string_view directive, const std::string& kind, Place place) const {
  return {place.location(),
          "unknown " + std::string(what) + " " + in_quotes(kind) + version_hint(version, directive, kind)};
}

std::filesystem::path Context::add_file(const std::string& name, const SourceLocation& location) {
  const std::filesystem::path path =
      find_file(folder, name, access, [&](const std::string& message) { warn("elsewhere", location, message); });
  scene.files.try_emplace(name, description::File{path, {}, location});
  return path;
}

bool Context::defer_missing(const std::filesystem::path& path, const Error& problem) {
  if (access == nullptr || !access->is_missing(path)) return false;
  if (!first_missing_) first_missing_ = problem;
  return true;
}

void Context::report_missing() {
  report_missing_files(scene, *access, first_missing_ ? &*first_missing_ : nullptr);
  if (has_deferred()) throw Error(*first_missing_);
}

std::string Context::read(const std::filesystem::path& path, Place place) const {
  try {
    return read_file(path);
  } catch (const Error& problem) {
    throw Error(place.location(), problem.what());
  }
}

std::optional<std::string> Context::read_unless_missing(const std::filesystem::path& path, Place place) {
  try {
    return read(path, place);
  } catch (const Error& problem) {
    if (defer_missing(path, problem)) return {};
    throw;
  }
}

void report_unused(const ParameterList& list, Context& context) {
  for (const Parameter& p : list.own()) {
    const std::string what = "parameter " + in_quotes(p.name) + " of " + list.entity();
    if (!p.used && list.find(p.name) == &p)
      context.warn(what, p.place, what + " is not used by Lanthorn: ignored");
    else if (list.find(p.name) != &p)
      context.warn("twice " + what, p.place, what + " is given twice: the last value is used");
  }
}

}  // namespace lanthorn::pbrt
