// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A pass of `render` that is a frame.
#pragma once

#include <cstdint>
#include <string>

#include "film/film.h"
#include "gl/context.h"
#include "integrators/integrator.h"
#include "path/render_job.h"
#include "realtime/frame/renderer.h"

namespace lanthorn {

/// Points of the film, the lens and the lights of a pass, which all its pixels share. Returns the weight of its
/// samples.
float place_frame(const RenderJob& job, std::uint32_t pass, FrameSettings& settings);

/// Adds the last frame to the film: light, albedo, normal and depth.
void add_frame(const Renderer& renderer, const RenderJob& job, const FrameSettings& settings, float weight, Film& film);

/// Rays of the frame, by whom it was drawn, and what it took.
PassReport report_of(const FrameReport& frame);

/// Of a method, for the user: by what it draws.
std::string driver_remark(const std::string& method, const gl::Driver& driver);

/// Parameters that all methods of frames have.
ShadowKind shadow_kind(const Parameters& parameters);
ParameterInfo shadow_info();
ParameterInfo map_info();
ParameterInfo sky_info();
/// "map" and "sky".
LightViewSettings light_view_settings(const Parameters& parameters);

}  // namespace lanthorn
