// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// An offline render that runs beside the window.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "lanthorn/session.h"

namespace lanthorn {

class Refinement {
 public:
  Refinement() = default;
  Refinement(const Refinement&) = delete;
  Refinement& operator=(const Refinement&) = delete;
  ~Refinement() { stop(); }

  /// Renders from the beginning, in a thread of its own, until it is stopped or the passes of the options are done.
  /// Throws Error for what `Session` refuses.
  void start(const SharedScene& scene, const ViewDescription& view, const RenderOptions& options);
  /// Gives up the running pass; takes milliseconds.
  void stop();
  bool is_running() const { return thread_.joinable(); }

  /// The latest picture, if it was not taken before.
  std::optional<Image> take_picture();
  std::uint64_t passes() const;
  /// What ended the render, if it was an error.
  std::string failure() const;

 private:
  void run();

  std::unique_ptr<Session> session_;
  std::thread thread_;
  mutable std::mutex mutex_;  // of what follows
  std::optional<Image> picture_;
  std::uint64_t passes_ = 0;
  bool stopped_ = false;
  std::string failure_;
};

}  // namespace lanthorn
