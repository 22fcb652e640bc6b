// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <epoxy/gl.h>

#include <memory>
#include <string>
#include <vector>

namespace lanthorn::gl {

/// Collects the errors and the undefined behaviour that OpenGL reports for the context that was current when the log
/// was created. Must live as long as the context is used.
class DebugLog {
 public:
  DebugLog();

  /// Messages so far, in order.
  const std::vector<std::string>& messages() const { return *messages_; }
  /// Throws Unavailable if the driver was reset and the context is lost, or Error with the first message, if there is
  /// one; this empties the log.
  void check() const;

 private:
  std::unique_ptr<std::vector<std::string>> messages_;  // OpenGL stores its address
};

}  // namespace lanthorn::gl
