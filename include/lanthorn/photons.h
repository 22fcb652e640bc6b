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

/// What lies between the light and a photon.
enum class PhotonClass : std::uint8_t {
  direct,   ///< nothing
  caustic,  ///< mirrors and clear glass alone
  indirect  ///< a surface or medium that scatters widely
};

/// Photons of one pass, by index.
struct Photons {
  std::uint64_t light_paths = 0;
  std::uint32_t pass = 0;
  std::vector<Point> positions{};       ///< metres, in the coordinates of the file
  std::vector<Normal> normals{};        ///< of the surface; 0 in media
  std::vector<Direction> directions{};  ///< towards where the photon came from
  std::vector<Rgb> powers{};            ///< watts, linear Rec.709; negative where a wavelength's colour is
  std::vector<std::int32_t> depths{};   ///< scattering events of the light path up to the photon's own; direct: 1
  std::vector<PhotonClass> classes{};

  std::size_t size() const { return positions.size(); }
};

/// Traces the photons of a pass; the same for any number of threads. `direct`: includes those that come straight from
/// a light. Throws Error as `Session` does.
Photons trace_photons(const Scene& scene, const ViewDescription& view, const RenderOptions& options, std::uint32_t pass,
                      bool direct);

/// A binary, little-endian PLY file: its header names the properties.
std::string encode_ply(const Photons& photons);

}  // namespace lanthorn
