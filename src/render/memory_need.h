// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "film/film.h"
#include "integrators/integrator.h"
#include "scene/scene.h"

namespace lanthorn {

/// Refuses a render that does not fit into memory before any of it is allocated. Counts the film's sums and the picture
/// made from them, the method's own data for each pixel, and the photons or light vertices of a pass; their number for
/// each light path is measured on a few thousand paths. Scene and textures are in memory already and do not count.
/// `limit`: bytes for all of these together; by default the free memory of the machine. Sets `settings.memory` for
/// methods that work in blocks. Returns how many passes fit at once: into the limit, or into half of the free memory.
/// Throws Error with the memory needed and the options that reduce it.
std::size_t plan_memory(const Scene& scene, const View& view, const Integrator& integrator,
                        const FilmContents& contents, std::optional<std::uint64_t> limit, RenderSettings& settings);

}  // namespace lanthorn
