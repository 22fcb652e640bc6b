// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scenes and references that are not part of the repository lie in ../shared beside it.
#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>

namespace lanthorn::test {

/// The folder ../shared/NAME beside the source tree. If ../shared is missing, prints a conspicuous line and returns
/// nothing, and the caller should GTEST_SKIP. If only NAME is missing, returns the path, and using it fails.
inline std::optional<std::filesystem::path> shared_dir(const char* name) {
  const auto shared = std::filesystem::path(LANTHORN_SOURCE_DIR).parent_path() / "shared";
  if (std::filesystem::is_directory(shared)) return shared / name;
  std::fprintf(stderr, "*** SKIPPED: there is no %s; tests on its files DO NOT RUN ***\n", shared.string().c_str());
  return {};
}

}  // namespace lanthorn::test
