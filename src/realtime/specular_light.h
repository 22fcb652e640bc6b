// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What mirrors and clear glass show: paths of the CPU from the eye through delta lobes, which a rasteriser cannot
// follow, to the first surface that scatters light otherwise. There the photons of the frame are gathered, as in
// photonmap.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "camera/view.h"
#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "index/hash_grid.h"
#include "path/light_layers.h"
#include "path/walk.h"
#include "realtime/gbuffer.h"
#include "realtime/gpu_scene.h"
#include "realtime/photon_tiles.h"
#include "realtime/photon_walk.h"
#include "scene/scene.h"

namespace lanthorn {

/// The eye paths of a frame.
struct SpecularPaths {
  std::uint64_t seed = 0;
  std::uint32_t frame = 0;
  int max_depth = 64;          ///< scattering events of a path from light to eye
  Vec2 offset{0}, lens{0.5f};  ///< as FrameSettings
  float time = 0;              ///< s
  SharedPhotons photons;       ///< null: no light but direct light
  PhotonVolume volume;         ///< of the photons
};

/// The photons of a frame, for gathering at points. The kernel is that of shaders/photon.glsl.
class NearPhotons {
 public:
  NearPhotons(SharedPhotons photons, const PhotonVolume& volume);

  bool holds(const SharedPhotons& photons, const PhotonVolume& volume) const {
    return photons_ == photons && volume_ == volume;
  }
  /// Adds the light that they scatter at the vertex.
  void gather(const SurfaceVertex& vertex, int max_depth, LightLayers& layers) const;

 private:
  Spectrum light_of(const GpuPhoton& photon, const SurfaceVertex& vertex) const;

  SharedPhotons photons_;
  PhotonVolume volume_;
  float reach_;
  IndexBuild<HashGrid> index_;
};

/// The light of these paths, in layers by PathClass.
class SpecularLight {
 public:
  SpecularLight() = default;
  explicit SpecularLight(const gl::ShaderFiles& files);

  /// Follows one path for each pixel whose material has delta lobes. The GPU draws the other lobes of a material that
  /// it knows; of a material that it does not know (GpuMaterial::none), the path brings the light of all lobes. Waits
  /// for the GPU. Returns the number of rays, 0 if there is no such pixel.
  std::uint64_t trace(const Scene& scene, const View& view, const GBuffer& seen,
                      const std::vector<GpuMaterial>& materials, const SpecularPaths& paths);
  /// Adds the light that was traced last to the layers that are drawn into, one for each PathClass in its order.
  void add_to(const gl::Framebuffer& layers) const;

 private:
  gl::Program add_;
  std::optional<NearPhotons> photons_;  // kept while the photons are
  gl::AlternatingBuffer light_;
  std::size_t pixels_ = 0;
  gl::BufferTexture texels_;
  gl::VertexArray no_vertices_;
};

}  // namespace lanthorn
