// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Techniques as methods of `render`: every pass is a frame with its own photons, views of lights and turns, and the
// image is the mean of the frames.
#pragma once

#include "integrators/integrator.h"
#include "realtime/techniques/technique.h"

namespace lanthorn {

/// The method that renders by frames of this technique.
IntegratorInfo frame_method(const TechniqueInfo& technique);

}  // namespace lanthorn
