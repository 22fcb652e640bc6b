// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The files that a render writes, for both `render` and `serve`.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lanthorn/denoise.h"
#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "output.h"

namespace lanthorn::program {

/// Options about files.
struct RenderFiles {
  std::vector<std::string> outputs;  ///< -o
  std::string json, resume;
  std::optional<double> checkpoint_seconds;
  OutputSettings output;
  bool quiet = false, verbose = false;
};

/// The requested files: those of -o, or else the scene's own name with .exr, in the working folder.
std::vector<std::filesystem::path> choose_outputs(const RenderFiles& files, const std::string& scene_file,
                                                  const SceneDescription& scene);

/// Throws Error before the render for files that could not be written after it, or that would be lost by it.
void check_files(const RenderFiles& files, const std::string& scene_file, const SceneDescription& scene,
                 const std::vector<std::filesystem::path>& outputs);
/// Throws Error if a state to be replaced holds passes that `session` will not render.
void check_states(const RenderFiles& files, const std::vector<std::filesystem::path>& outputs, const Session& session);

/// Lines that a command has already printed, so that it prints none twice.
class SaidLines {
 public:
  bool is_new(const std::string& line) { return said_.insert(line).second; }

 private:
  std::set<std::string> said_;
};
/// Writes a message to standard error, unless `said` contains it.
void say_once(const std::string& line, SaidLines& said);
/// If the options name no method, reports which method replaces the one that the scene's file names.
void announce_method(const Scene& scene, const RenderOptions& options, SaidLines& said);
/// Writes warnings of the scene and of the method to standard error.
void report_warnings(const std::vector<description::Warning>& warnings, SaidLines& said);

/// Writes pictures, states and the report, and lists them. `found`: as for StatePicture. Throws Error if something
/// could not be written.
void save_render(const RenderFiles& files, const RenderOptions& options,
                 const std::vector<std::filesystem::path>& outputs, const Scene& scene, const RenderState& state,
                 const RenderStatistics& statistics, std::optional<DenoisedLooks::Found> found = {});

}  // namespace lanthorn::program
