// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lanthorn/color.h"
#include "lanthorn/rays.h"
#include "lanthorn/render_options.h"
#include "lanthorn/scene.h"
#include "lanthorn/vec.h"

namespace lanthorn {

/// Scattering events between the light and the photon.
enum class PhotonClass : std::uint8_t {
  direct,   ///< none
  caustic,  ///< specular reflection and refraction only
  indirect  ///< at least one at a surface or medium that scatters widely
};

/// Photons of one pass, as parallel arrays.
struct Photons {
  std::uint64_t light_paths = 0;
  std::uint32_t pass = 0;
  std::vector<Point> positions{};       ///< metres, in the coordinates of the file
  std::vector<Normal> normals{};        ///< of the surface; 0 in media
  std::vector<Direction> directions{};  ///< unit vectors towards where the photon came from
  std::vector<Rgb> powers{};            ///< watts, linear Rec.709; negative for wavelengths outside the gamut
  std::vector<std::int32_t> depths{};   ///< number of the photon's scattering event along its light path; direct: 1
  std::vector<PhotonClass> classes{};
  std::vector<std::uint32_t> starts{};  ///< number of the PhotonStart; empty if lights emitted the photons

  std::size_t size() const { return positions.size(); }
};

/// Traces the photons of a pass; the result does not depend on the number of threads. `direct`: includes photons that
/// come straight from a light. Throws Error as `Session` does.
Photons trace_photons(const Scene& scene, const ViewDescription& view, const RenderOptions& options, std::uint32_t pass,
                      bool direct);

/// The start of a light path that the caller chooses instead of a light.
struct PhotonStart {
  SceneRay ray{};
  Rgb power{1, 1, 1};  ///< watts, linear Rec.709
};
/// Traces one light path from each start; the lights of the scene emit nothing. `pass` selects the random numbers, the
/// part of the shutter interval and, with spectral colours, the wavelengths. Only the options `seed`, `max_depth` and
/// `color` matter. A path starts in the medium that encloses its start, else in vacuum. The result does not depend on
/// the number of threads. Throws Error as `intersect` does, and for powers that are negative or not finite.
Photons trace_photons(const Scene& scene, const ViewDescription& view, const RenderOptions& options,
                      std::span<const PhotonStart> starts, std::uint32_t pass, bool direct);

/// A binary, little-endian PLY file: its header names the properties.
std::string encode_ply(const Photons& photons);

}  // namespace lanthorn
