// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The files that a render leaves: the same for `render` and `serve`.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "output.h"

namespace lanthorn::program {

/// What the command line says about files.
struct RenderFiles {
  std::vector<std::string> outputs;  ///< -o
  std::string json, resume;
  std::optional<double> checkpoint_seconds;
  OutputSettings output;
  bool quiet = false, verbose = false;
};

/// The files asked for: those of -o, or else the scene's own name with .exr, in the working folder.
std::vector<std::filesystem::path> choose_outputs(const RenderFiles& files, const std::string& scene_file,
                                                  const SceneDescription& scene);

/// Refuses (`Error`) before the render what could not be written after it, and what would be lost by it.
void check_files(const RenderFiles& files, const std::string& scene_file, const SceneDescription& scene,
                 const std::vector<std::filesystem::path>& outputs);
/// Refuses to replace states that hold passes which `session` is not going to render.
void check_states(const RenderFiles& files, const std::vector<std::filesystem::path>& outputs, const Session& session);

/// What the pictures of one command have said: no line is said twice.
class SaidLines {
 public:
  bool is_new(const std::string& line) { return said_.insert(line).second; }

 private:
  std::set<std::string> said_;
};
/// A message to standard error.
void say_once(const std::string& line, SaidLines& said);
/// Says which method takes the place of the one that the scene's file names, if the options name none.
void announce_method(const Scene& scene, const RenderOptions& options, SaidLines& said);
/// Warnings of the scene and of the method, to standard error.
void report_warnings(const std::vector<description::Warning>& warnings, SaidLines& said);

/// Writes pictures, states and the report; says what it wrote. Throws Error if something could not be written.
void save_render(const RenderFiles& files, const RenderOptions& options,
                 const std::vector<std::filesystem::path>& outputs, const Scene& scene, const RenderState& state,
                 const RenderStatistics& statistics);

}  // namespace lanthorn::program
