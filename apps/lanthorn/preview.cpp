// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "preview.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <utility>

#include "console.h"

namespace lanthorn::program {

namespace fs = std::filesystem;

Previews::Previews(std::vector<fs::path> pictures, const OutputSettings& settings, double interval,
                   const StopRule& plan, ProgressDisplay& progress)
    : pictures_(std::move(pictures)),
      settings_(settings),
      interval_(interval),
      last_pass_(plan.passes.end - plan.passes.begin),
      stops_denoised_(plan.noise && settings.denoise),
      progress_(progress) {
  std::erase_if(pictures_, [](const fs::path& path) { return path.extension() == ".state"; });
}

void Previews::write_if_due(const RenderState& state, const RenderStatistics& statistics) try {
  if (statistics.seconds < next_ || statistics.passes >= last_pass_) return;
  StatePicture picture(state, pictures_, stops_denoised_ ? RenderStatistics() : statistics);
  for (const fs::path& path : pictures_) write_preview(path, picture, settings_);
  next_ = std::max(2 * statistics.seconds, statistics.seconds + interval_);
} catch (const std::exception& problem) {  // the final write may still succeed
  next_ = std::numeric_limits<double>::infinity();
  progress_.finish();
  warn("no more previews: {}", problem.what());
}

}  // namespace lanthorn::program
