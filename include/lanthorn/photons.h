// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lanthorn/color.h"
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

  std::size_t size() const { return positions.size(); }
};

/// Traces the photons of a pass; the result does not depend on the number of threads. `direct`: includes photons that
/// come straight from a light. Throws Error as `Session` does.
Photons trace_photons(const Scene& scene, const ViewDescription& view, const RenderOptions& options, std::uint32_t pass,
                      bool direct);

/// The photons as a binary, little-endian PLY file whose header names the properties.
std::string encode_ply(const Photons& photons);

}  // namespace lanthorn
