// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Outputs are checked before a command does anything else: they must be writable, and writing them must lose nothing.
// Files are compared by device and inode (new ones by folder and name), so that another spelling, a symbolic or a hard
// link is still the same file.
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
  std::string option;                        ///< that named it, such as "-o"
  std::vector<std::string> extensions = {};  ///< allowed; empty: all but those of other kinds of files (for JSON)
  bool may_be_input = false;                 ///< it may be the state that is resumed
  bool may_repeat = false;                   ///< a checkpoint may be an output
};

/// The scene file and the files that were read for it.
std::vector<InputFile> files_of(const std::map<std::string, description::File>& read,
                                const std::filesystem::path& scene_file);

/// Refuses (`lanthorn::Error`) an output that has the wrong extension, is a folder, is in a folder that is missing or
/// cannot be written to, is write-protected (no permission to write for anybody; unless `force`), is one of the inputs,
/// or is given twice. Devices (/dev/null) may be given as often as one likes.
void check_outputs(const std::vector<InputFile>& inputs, const std::vector<OutputFile>& outputs, bool force = false);

/// Throws `lanthorn::Error` if there is a file at `path` that would be lost: anything but a state of the same render as
/// `state` whose passes are all among `passes`, those that will be written. `how_to_keep`: advice for the message.
void check_replaced_state(const std::filesystem::path& path, const RenderState& state,
                          const std::vector<PassRange>& passes, const char* how_to_keep);

/// True if both names lead to one file; false if either is a device.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace lanthorn::program
