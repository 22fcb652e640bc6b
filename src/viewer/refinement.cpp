// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/refinement.h"

#include <utility>

namespace lanthorn {

void Refinement::start(const SharedScene& scene, const ViewDescription& view, const RenderOptions& options) {
  stop();
  session_ = std::make_unique<Session>(scene, view, options);
  picture_.reset();
  passes_ = 0;
  stopped_ = false;
  failure_.clear();
  thread_ = std::thread([this] { run(); });
}

void Refinement::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  session_->stop();
  thread_.join();
}

void Refinement::run() {
  const std::uint64_t wanted = session_->plan().passes.end;
  try {
    while (session_->pass_count() < wanted) {
      {
        const std::lock_guard lock(mutex_);
        if (stopped_) return;
      }
      if (!session_->render_pass()) return;
      Image picture = session_->picture();
      const std::lock_guard lock(mutex_);
      picture_ = std::move(picture);
      passes_ = session_->pass_count();
    }
  } catch (const std::exception& e) {
    const std::lock_guard lock(mutex_);
    failure_ = e.what();
  }
}

std::optional<Image> Refinement::take_picture() {
  const std::lock_guard lock(mutex_);
  return std::exchange(picture_, std::nullopt);
}

std::uint64_t Refinement::passes() const {
  const std::lock_guard lock(mutex_);
  return passes_;
}

std::string Refinement::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

}  // namespace lanthorn
