// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "image/fallback_libraries.h"

#include <dlfcn.h>

#include <system_error>
#include <vector>

namespace lanthorn {

namespace fs = std::filesystem;

void load_fallback_libraries(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    if (dlopen(entry.path().filename().c_str(), RTLD_LAZY | RTLD_LOCAL) == nullptr) missing.push_back(entry.path());
  // All libraries that the system provides are loaded by now, including for those that need each other.
  for (const fs::path& library : missing) dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL);
}

fs::path folder_of_fallback_libraries() {
  Dl_info own{};
  if (dladdr(reinterpret_cast<const void*>(&folder_of_fallback_libraries), &own) == 0) return {};
  const fs::path beside = fs::path(own.dli_fname).parent_path();
  std::error_code ignored;
  // The second path is for a library in glibc-hwcaps/x86-64-v3.
  for (const char* modules : {"lanthorn", "../../lanthorn"})
    if (fs::path folder = beside / modules / "fallback"; fs::is_directory(folder, ignored)) return folder;
  return {};
}

}  // namespace lanthorn
