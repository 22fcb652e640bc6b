// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/obj/materials.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "lanthorn/file.h"

namespace lanthorn::obj {

namespace fs = std::filesystem;

namespace {

// Suffixes of the model's name, the most likely first.
constexpr std::array<std::string_view, 12> endings{"_diffuse", "_basecolor", "_base_color", "_albedo",
                                                   "_color",   "_diff",      "_col",        "_d",
                                                   "_texture", "_tex",       "-diffuse",    ""};
constexpr std::array<std::string_view, 8> kinds{".png", ".jpg", ".jpeg", ".tga", ".bmp", ".tif", ".tiff", ".webp"};

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace

std::optional<std::string> texture_beside(const fs::path& model) {
  const bool is_zipped = lower_extension(model) == ".gz";
  const std::string stem = lower((is_zipped ? model.stem().stem() : model.stem()).string());
  std::optional<std::pair<std::ptrdiff_t, std::string>> best;
  std::error_code code;
  const fs::path folder = model.has_parent_path() ? model.parent_path() : fs::path(".");
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    const fs::path& file = entry->path();
    const std::string name = lower(file.stem().string());
    if (!name.starts_with(stem) || std::find(kinds.begin(), kinds.end(), lower_extension(file)) == kinds.end())
      continue;
    const auto* ending = std::find(endings.begin(), endings.end(), std::string_view(name).substr(stem.size()));
    if (ending == endings.end()) continue;
    const std::pair found(ending - endings.begin(), file.filename().string());
    if (!best || found < *best) best = found;
  }
  return best ? std::optional(best->second) : std::nullopt;
}

}  // namespace lanthorn::obj
