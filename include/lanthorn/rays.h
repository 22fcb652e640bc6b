// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Ray queries against a scene (hits, radiance, BSDFs), for measurements, light bakers and teaching. Positions are
// metres in the coordinates of the scene's file.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lanthorn/color.h"
#include "lanthorn/scene.h"
#include "lanthorn/vec.h"

namespace lanthorn {

struct SceneRay {
  Point origin{0};
  Direction direction{0, 0, 1};  ///< of any length but 0
};

/// The nearest surface along a ray.
struct RayHit {
  float distance = infinity;  ///< metres; infinity: no hit, and the other members are meaningless
  Point position{0};
  Normal normal{0};          ///< geometric, unit length, on the surface's outside
  Normal shading_normal{0};  ///< interpolated, unit length
  Vec2 uv{0};
  bool emits = false;
};
/// One hit for each ray, at the time when the shutter opens. Rays pass through interfaces between media. Throws Error,
/// naming the ray, unless all its numbers are finite and its direction is not 0.
std::vector<RayHit> intersect(const Scene& scene, std::span<const SceneRay> rays);

struct RayLightSettings {
  std::uint32_t samples = 64;  ///< paths per ray
  std::uint64_t seed = 0;
  int max_depth = 64;  ///< maximum number of scattering events of a path
};
/// Radiance that arrives at the origin of each ray from its direction, in the unit of pictures, linear Rec.709: the
/// mean over independent paths (path tracing with next-event estimation). Each ray starts in the medium that the shapes
/// around its origin bound, or in vacuum. The result depends only on scene, rays and settings, not on the number of
/// threads. Throws Error as `intersect` does, and for settings below 1.
std::vector<Rgb> radiance_along(const Scene& scene, std::span<const SceneRay> rays,
                                const RayLightSettings& settings = {});

/// The BSDF of a surface at one point, in RGB. Directions are unit vectors in the shading frame, whose z is the shading
/// normal; all point away from the surface. `wi` is the direction towards the eye, or towards the previous vertex of
/// the path.
class SurfaceBsdf {
 public:
  struct Sample {
    Direction wo{0};         ///< 0: the path is absorbed, and the other members are meaningless
    Rgb weight;              ///< f times |cosine of wo| over `pdf`
    float pdf = 0;           ///< per solid angle; for a delta lobe, its probability
    bool is_delta = false;   ///< ideal specular reflection or refraction, which `eval` and `pdf` exclude
    bool transmits = false;  ///< wo lies on the other side
  };

  /// f(wi, wo) in 1/sr, without the cosine; excludes delta lobes.
  Rgb eval(const Direction& wi, const Direction& wo) const;
  /// Density with which `sample` chooses wo, per solid angle; excludes delta lobes.
  float pdf(const Direction& wi, const Direction& wo) const;
  /// `u`: three uniform numbers in [0,1); the first chooses the lobe.
  Sample sample(const Direction& wi, const Vec3& u) const;

 private:
  struct At;
  explicit SurfaceBsdf(std::shared_ptr<const At> at);
  friend std::optional<SurfaceBsdf> bsdf_at(SharedScene scene, const SceneRay& ray);
  std::shared_ptr<const At> at_;
};
/// The BSDF of the nearest surface along the ray; nullopt if there is none. Throws Error as `intersect` does.
std::optional<SurfaceBsdf> bsdf_at(SharedScene scene, const SceneRay& ray);

}  // namespace lanthorn
