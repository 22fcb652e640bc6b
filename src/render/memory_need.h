// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "film/film.h"
#include "integrators/integrator.h"
#include "scene/scene.h"

namespace lanthorn {

/// Refuses a render that does not fit into memory before anything of it is allocated: the film's sums and the picture
/// made of them, what the method keeps of pixels, and the photons or light vertices of a pass, as many for each light
/// path as a few thousand leave that are traced for this. Scene and textures, which are there by now, do not count.
/// `limit`: bytes that all may take together; else what the machine has left decides. Sets `settings.memory` for
/// methods that work in blocks. Throws Error that says what it would take, and which options lessen it.
void plan_memory(const Scene& scene, const View& view, const Integrator& integrator, const FilmContents& contents,
                 std::optional<std::uint64_t> limit, RenderSettings& settings);

}  // namespace lanthorn
