// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/frame_context.h"

#include <utility>

namespace lanthorn {

FrameSettings::FrameSettings(TechniqueChoice choice) : technique(std::move(choice)) {
  if (!technique.info().description.has_light_views) return;
  shadows = static_cast<ShadowKind>(technique.word("shadows"));
  views.map_size = technique.whole("map");
  views.sky_views = technique.whole("sky");
}

}  // namespace lanthorn
