// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Connections of light vertices to the camera's lens, and the light that light paths add to the film.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "camera/view.h"
#include "film/film_pass.h"
#include "path/light_layers.h"
#include "path/path_context.h"
#include "path/vertex.h"

namespace lanthorn {

/// Light that a vertex of a light walk sends through the lens.
struct LensLight {
  Vec2 raster{0};  ///< film position, pixels
  Spectrum light;  ///< times the filter's value, the contribution to a pixel
  bool dispersed = false;
  Ray from_lens;            ///< from the lens to the vertex
  float distance = 0;       ///< from the lens to the vertex, metres
  float optical_depth = 0;  ///< of the way (`Passage`)
};

/// Film position at which the lens would see a light vertex, ignoring occlusion; empty on shapes that are hidden from
/// the camera. Draws from the visitor's dimensions.
template <class Vertex>
std::optional<CameraConnection> find_lens(const PathContext& path, const View& view, const Vertex& vertex);

/// Connects the vertex to the lens. Empty if no light arrives. Draws after `find_lens`.
template <class Vertex>
std::optional<LensLight> connect_to_lens(const PathContext& path, const View& view, const Vertex& vertex,
                                         const CameraConnection& lens);

/// Class of the light that a light walk in this state sends to the lens. Read from the eye, the walk's vertex is the D
/// of E D ... L.
inline PathClass class_of_splat(const WalkState& state) {
  if (state.depth == 1) return PathClass::direct;
  return state.non_delta == 0 ? PathClass::caustic : PathClass::indirect;
}

/// The layers that hold the light of a path.
struct PathLayers {
  PathClass path_class;
  bool from_medium;  ///< see media_layer
};
/// Layers of the light that a light walk's vertex sends to the lens.
inline PathLayers layers_of_splat(const SurfaceVertex& v) { return {class_of_splat(v.state), false}; }
inline PathLayers layers_of_splat(const MediumVertex& v) { return {class_of_splat(v.state), true}; }

/// Adds the light, times the factor of dispersion, to all pixels whose filter covers its film position. Obeys the
/// sensor's limit of a path.
inline void splat(const FilmPass& film, const View& view, const Wavelengths& w, const Vec2& raster,
                  const Spectrum& light, const PathLayers& layers) {
  Rgb rgb = w.to_rgb(light);
  const float factor = layers.path_class == PathClass::emission ? 1.0f : view.sensor.path_factor(rgb);
  rgb = factor * rgb;
  const PixelWindow& window = view.window;
  view.filter.for_each_pixel(raster - window.corner(), window.width(), window.height(),
                             [&](int x, int y, float filter) {
                               const auto pixel = static_cast<std::uint32_t>(y * window.width() + x);
                               film.splat(pixel, static_cast<std::size_t>(layers.path_class), filter * rgb);
                               if (layers.from_medium) film.splat(pixel, media_layer, filter * rgb);
                               if (film.contents().buckets)
                                 film.splat_spectrum(pixel, SpectralRadiance(light, w), factor * filter);
                             });
}

/// Adds `weight` times the light of a vertex that is connected to the lens.
inline void splat(const FilmPass& film, const View& view, const Wavelengths& w, const LensLight& seen,
                  const PathLayers& layers, float weight) {
  Spectrum light = seen.light * weight;
  if (seen.dispersed) light *= w.dispersed;
  splat(film, view, w, seen.raster, light, layers);
}

}  // namespace lanthorn
