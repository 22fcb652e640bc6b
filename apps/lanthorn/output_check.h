// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Checks outputs before a command does anything else: they must be writable, and writing them must lose nothing. Files
// are compared by device and inode (new files by folder and name), so that another spelling, a symbolic or a hard link
// still counts as the same file.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/scene_description.h"
#include "lanthorn/state.h"

namespace lanthorn::program {

struct InputFile {
  std::filesystem::path path;
  std::string role;  ///< for messages, such as "the scene file"
};

struct OutputFile {
  std::filesystem::path path;
  std::string option;                        ///< the option that named it, such as "-o"
  std::vector<std::string> extensions = {};  ///< allowed; empty: all except those of other kinds of files (for JSON)
  bool may_be_input = false;                 ///< it may be the state that is resumed
  bool may_repeat = false;                   ///< a checkpoint may also be an output
};

/// The scene file and the files that were read for it.
std::vector<InputFile> files_of(const std::map<std::string, description::File>& read,
                                const std::filesystem::path& scene_file);

/// Throws `lanthorn::Error` for an output that has the wrong extension, is a folder, is in a folder that does not exist
/// or is not writable, is write-protected (no write permission for anybody; unless `force`), is one of the inputs, or
/// is given twice. Devices (/dev/null) may be given any number of times.
void check_outputs(const std::vector<InputFile>& inputs, const std::vector<OutputFile>& outputs, bool force = false);

/// Throws `lanthorn::Error` if a file at `path` would be lost: anything but a state of the same render as `state` whose
/// passes are all among `passes`, the passes to be written. `how_to_keep`: advice for the message.
void check_replaced_state(const std::filesystem::path& path, const RenderState& state,
                          const std::vector<PassRange>& passes, const char* how_to_keep);

/// True if both names refer to the same file; false if either is a device.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace lanthorn::program
