// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The panel beside the picture, by Dear ImGui.
#pragma once

#include "viewer/panel.h"

namespace lanthorn {

inline constexpr float panel_width = 330;  // at a scale of 1

/// Fonts and colours of the current ImGui context. `scale`: of the screen; 1 at 96 dots per inch.
void set_style(float scale);
/// Draws the panel at the right edge of the window.
void draw_panel(Panel& panel, float scale);
/// Draws the panel's notice over the picture. `corner`, `size`: of the picture in the window.
void draw_notice(const Panel& panel, const Vec2& corner, const Vec2& size, float scale);
/// Draws the marks of the lights over the picture. `corner`, `pixel_size`: of the picture in the window.
void draw_marks(const Panel& panel, const Vec2& corner, float pixel_size, float scale);

}  // namespace lanthorn
