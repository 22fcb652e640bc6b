// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/missing_files.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "lanthorn/text.h"

namespace lanthorn {

std::string file_in_quotes(const std::string& name) {
  constexpr std::size_t most = 32, dots = 3;
  if (name.size() <= most) return in_quotes(name);
  const std::size_t from = name.size() - most + dots, slash = name.find('/', from);
  return in_quotes("..." + name.substr(slash == name.npos ? from : slash));
}

std::filesystem::path find_file(const std::filesystem::path& folder, const std::string& name, const FileAccess* access,
                                const std::function<void(std::string)>& warn) {
  if (access == nullptr) return folder / name;
  const std::filesystem::path found = access->find(folder, name);
  if (found != folder / name)
    warn("there is no file " + file_in_quotes(name) + ": " + file_in_quotes(found.string()) + " is read");
  return found;
}

namespace {

struct MissingFile {
  std::string name;
  SourceLocation location;
  std::string problem;
  bool is_pointer = false;  ///< a Git LFS pointer
};

std::vector<MissingFile> missing_files(const SceneDescription& scene, const FileAccess& access) {
  std::vector<MissingFile> missing;
  for (const auto& [name, file] : scene.files) try {
      access.checked(file.path);
    } catch (const Error& problem) {
      missing.push_back({name, file.location, problem.what(), is_lfs_pointer(file.path)});
    }
  return missing;
}

void sort_by_line(std::vector<MissingFile>& missing) {
  std::sort(missing.begin(), missing.end(), [](const auto& a, const auto& b) {
    return std::tie(a.location.line, a.name) < std::tie(b.location.line, b.name);
  });
}

std::string names_of(const std::vector<MissingFile>& missing) {
  constexpr std::size_t most_named = 20;
  std::string names;
  for (std::size_t i = 0; i < std::min(missing.size(), most_named); ++i)
    names += (i == 0 ? "" : ", ") + file_in_quotes(missing[i].name);
  return names + (missing.size() > most_named ? ", ..." : "");
}

std::string advice_on_pointers(const std::vector<MissingFile>& missing) {
  const auto pointers = std::count_if(missing.begin(), missing.end(), [](const auto& file) { return file.is_pointer; });
  return pointers > 0 ? ", git lfs pull fetches " + std::to_string(pointers) + " of them" : "";
}

}  // namespace

void warn_of_missing_files(SceneDescription& scene, const FileAccess& access) {
  std::vector<MissingFile> missing = missing_files(scene, access);
  if (missing.empty()) return;
  sort_by_line(missing);
  const std::string which =
      missing.size() == 1
          ? "the file " + names_of(missing) + " is missing"
          : std::to_string(missing.size()) + " files are missing, the first of them here: " + names_of(missing);
  scene.warnings.push_back(
      {missing.front().location,
       which + advice_on_pointers(missing) +
           ": a mesh or medium is left out, a texture has the neutral value of its use (a grey colour, no emission, no "
           "relief), a measured material is grey, a spectrum 1, an included file empty, a lens one of 50 mm"});
}

void report_missing_files(SceneDescription& scene, const FileAccess& access, const Error* problem) {
  if (access.skip_missing) return warn_of_missing_files(scene, access);
  std::vector<MissingFile> missing = missing_files(scene, access);
  if (missing.empty()) return;
  if (missing.size() == 1)
    throw Error(
        problem != nullptr ? problem->where : missing.front().location,
        (problem != nullptr ? problem->message : missing.front().problem) + "; --missing skip renders without it");
  sort_by_line(missing);
  throw Error(missing.front().location, std::to_string(missing.size()) +
                                            " files are missing, the first of them here: " + names_of(missing) +
                                            "; --missing skip renders without them" + advice_on_pointers(missing));
}

}  // namespace lanthorn
