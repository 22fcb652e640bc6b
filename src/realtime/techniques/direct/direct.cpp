// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Direct light alone: adds nothing to the frame.
#include "realtime/techniques/frame_context.h"

namespace lanthorn {

namespace {

class Direct final : public Technique {
 public:
  void draw(const FrameContext& /*frame*/) override {}
};

}  // namespace

TechniqueInfo direct_technique() {
  return {.description = {.name = "direct",
                          .title = "Direct light",
                          .summary = "direct light alone",
                          .offline_method = "path",
                          .offline_depth = 1},
          .make = [](const TechniqueShaders&) -> std::unique_ptr<Technique> { return std::make_unique<Direct>(); }};
}

}  // namespace lanthorn
