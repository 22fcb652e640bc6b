// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Light sources: a closed set of plain structs, joined into the variant `Light`: areas, media, portals, and places with
// a profile (profile.h). To add a light, write its file and add its type to the variant; all other code uses the
// functions and traits below. An emitting mesh is one AreaLight per triangle or patch. All functions are pure; lights
// are immutable once the scene is built.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <variant>

#include "light/area_light.h"
#include "light/brightness.h"
#include "light/far_light.h"
#include "light/image_profile.h"
#include "light/point_light.h"
#include "light/portal_light.h"
#include "light/profile.h"
#include "light/projection_profile.h"
#include "light/sample.h"
#include "light/spot_profile.h"
#include "light/volume_light.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Members that every light must have. For their meanings, units and conventions see the functions of the same names
/// below. If a light has a surface, its `pdf_direct` and `emitted` take the point that a ray has hit. If it is
/// infinite, they take the direction in which a ray has left the scene. If it is a medium, `pdf_direct` takes the
/// direction of a ray through it. Only lights that are not far have `bounds`.
template <class L>
concept LightSource = requires(const L l, const Point p, const Direction d, const Vec2 u, const EmitterHit hit,
                               const Wavelengths w) {
  { L::traits } -> std::convertible_to<LightTraits>;
  { l.sample_direct(p, u, w) } -> std::same_as<std::optional<LightSample>>;
  { l.sample_emission(u, u, w) } -> std::same_as<std::optional<EmissionSample>>;
  { l.pdf_emission(hit, d) } -> std::same_as<EmissionPdf>;
  { l.invert_emission(hit, d) } -> std::same_as<EmissionNumbers>;
  { l.power() } -> std::same_as<float>;
  { l.largest_radiance(1.0f) } -> std::same_as<float>;
}
&&(!L::traits.has_surface ||
   requires(const L l, const Point p, const Direction d, const EmitterHit hit, const Wavelengths w) {
     { l.pdf_direct(p, hit) } -> std::same_as<float>;
     { l.emitted(hit, d, w) } -> std::same_as<Spectrum>;
     { l.invisible } -> std::convertible_to<bool>;
   }) &&
    (!L::traits.is_infinite ||
     requires(const L l, const Point p, const Direction d, const Wavelengths w) {
       { l.pdf_direct(p, d) } -> std::same_as<float>;
       { l.emitted(p, d, w) } -> std::same_as<Spectrum>;
     }) &&
    (!L::traits.is_volume ||
     requires(const L l, const Point p, const Direction d) {
       { l.pdf_direct(p, d) } -> std::same_as<float>;
     }) &&
    (L::traits.is_far || requires(const L l) {
      { l.bounds() } -> std::same_as<EmissionBounds>;
    });

template <LightSource... Lights>
using LightVariant = std::variant<Lights...>;

using EvenPointLight = PointLight<EvenProfile>;
using SpotLight = PointLight<SpotProfile>;
using GoniometricLight = PointLight<GoniometricProfile>;
using ProjectionLight = PointLight<ProjectionProfile>;
using SunLight = FarLight<ConeProfile>;

using Light = LightVariant<AreaLight, EvenPointLight, SpotLight, GoniometricLight, ProjectionLight, DistantLight,
                           SunLight, EvenSky, ImageSky, PortalLight, VolumeLight>;

/// Samples a direction from `from` towards the light for next-event estimation. Returns nullopt if no light can arrive
/// (behind a one-sided emitter, outside a spot's cone, pdf 0). The caller tests visibility.
std::optional<LightSample> sample_direct(const Light& light, const Point& from, const Vec2& u, const Wavelengths& w);

/// Density, per solid angle at `from`, with which `sample_direct` samples the direction that hits the emitter's surface
/// at `hit`. 0 for lights that rays cannot hit.
float pdf_direct(const Light& light, const Point& from, const EmitterHit& hit);
/// Density of `sample_direct` for infinite lights, for a direction in which a ray from `from` left the scene, and for
/// media, for a ray through them.
float pdf_direct_towards(const Light& light, const Point& from, const Direction& towards);

/// Radiance emitted at `hit` in `direction`, which points away from the surface.
Spectrum emitted(const Light& light, const EmitterHit& hit, const Direction& direction, const Wavelengths& w);
/// Radiance of an infinite light seen from `from` in the direction `towards`.
Spectrum emitted_infinite(const Light& light, const Point& from, const Direction& towards, const Wavelengths& w);
/// Texels across a right angle of an image that shows an infinite light as sharply as it is; 0 if it is constant.
float texels_across_right_angle(const Light& light);

/// Samples a ray that carries one photon away. The sample includes the photon's flux (for one emitted photon of this
/// light).
std::optional<EmissionSample> sample_emission(const Light& light, const Vec2& u_position, const Vec2& u_direction,
                                              const Wavelengths& w);
/// Densities of `sample_emission` for a given ray (for MIS). `origin`: where the ray starts; lights without surface use
/// at most its position.
EmissionPdf pdf_emission(const Light& light, const EmitterHit& origin, const Direction& direction);
/// Inverse of `sample_emission`: the numbers from which it draws a given ray. `origin`: where the ray starts; for far
/// lights any point of the ray.
EmissionNumbers invert_emission(const Light& light, const EmitterHit& origin, const Direction& direction);

/// Total emitted power in watts, as luminance (luminance of the light's RGB-mode colour times the geometric factor).
/// Photons are distributed in proportion to it. Infinite and distant lights: power through the disk that covers the
/// scene's bounding sphere.
float power(const Light& light);
/// Largest radiance of the light, over the visible range or over the channels of RGB mode. For lights without extent:
/// the radiance of a white surface that they illuminate at `distance`, metres.
float largest_radiance(const Light& light, float distance);
/// Sets the scene that the light illuminates. Returns false if the light depends on the scene's bounds in other ways as
/// well and must be rebuilt.
bool set_scene_bounds(Light& light, const BoundingSphere& scene);
/// Bounds of the points where the light's emission starts; nullopt if it comes from infinitely far away.
std::optional<EmissionBounds> emission_bounds(const Light& light);

namespace light_detail {
template <class... Lights>
constexpr std::array<LightTraits, sizeof...(Lights)> traits_of(const std::variant<Lights...>*) {
  return {Lights::traits...};
}
inline constexpr auto all_traits = traits_of(static_cast<const Light*>(nullptr));
}  // namespace light_detail

/// Name of the light's kind in summaries of scenes.
inline const char* name_of(const Light& light) { return light_detail::all_traits[light.index()].name; }
/// True if rays can meet the light.
inline bool has_surface(const Light& light) { return light_detail::all_traits[light.index()].has_surface; }
/// True if rays that leave the scene see the light.
inline bool is_infinite(const Light& light) { return light_detail::all_traits[light.index()].is_infinite; }
/// True if camera rays that leave the scene do not see an infinite light.
inline bool is_hidden_from_camera(const Light& light) {
  return std::visit(
      [](const auto& l) {
        if constexpr (requires { l.visible_to_camera; }) return !l.visible_to_camera;
        return false;
      },
      light);
}
/// True if all its light comes from one point of the scene.
inline bool is_point(const Light& light) {
  const LightTraits& traits = light_detail::all_traits[light.index()];
  return !traits.has_surface && !traits.is_far && !traits.is_volume;
}
/// True if its light comes from infinitely far away: its photons start on a disk that covers the scene, or at a portal.
inline bool is_far(const Light& light) { return light_detail::all_traits[light.index()].is_far; }
/// True if the light is a medium: rays gather its emission along their way.
inline bool is_volume(const Light& light) { return light_detail::all_traits[light.index()].is_volume; }
/// True if MIS weights treat an emission sample of this light as a ray, with densities only for its direction and its
/// position across the ray, because the light comes from infinitely far away or from anywhere along the ray.
inline bool is_of_rays(const Light& light) { return is_far(light) || is_volume(light); }
/// True if rays can never hit the light, or its direction or position is a single one (point, spot, distant).
bool is_delta(const Light& light);

}  // namespace lanthorn
