// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Builders that turn one directive with its parameters into plain data, with pbrt-v4's names, defaults and meaning. All
// throw Error for invalid directives or parameters, warn through the context about features that they replace or omit,
// and report unused parameters.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "io/pbrt/context.h"

namespace lanthorn::pbrt {

/// `Material` and `MakeNamedMaterial`. Textures and the parts of a mix must already exist. The name is left empty.
description::Material make_material(const std::string& kind, const ParameterList& list, Context& context);

/// `MakeNamedMedium`, of the kind that its "type" names. The name is left empty.
description::Medium make_medium(const std::string& kind, const ParameterList& list, const Transform& medium_to_world,
                                Context& context);

/// The interior medium of a `subsurface` material, given by "sigma_a" and "sigma_s", a "name", or "reflectance" and
/// "mfp". `eta`: of the material's interface.
description::Medium make_subsurface_medium(const ParameterList& list, const description::SpectrumValue& eta,
                                           Context& context);

/// `Texture`: appends to the scene's textures and defines the name.
void add_float_texture(const std::string& name, const std::string& kind, const ParameterList& list,
                       const Transform& texture_to_world, Context& context);
void add_spectrum_texture(const std::string& name, const std::string& kind, const ParameterList& list,
                          const Transform& texture_to_world, Context& context);

/// `LightSource`.
description::Light make_light(const std::string& kind, const ParameterList& list, const Transform& light_to_world,
                              Context& context);
/// `AreaLightSource`.
description::AreaLight make_area_light(const std::string& kind, const ParameterList& list, Context& context);

/// A PLY file that is read later, so that files can be read in parallel.
struct PlyRequest {
  std::filesystem::path path;
};
using Geometry = decltype(description::Shape::geometry);
/// The geometry and textures that a `Shape` directive gives.
struct ShapeParts {
  std::variant<Geometry, PlyRequest> geometry;
  description::FloatParameter alpha{1, {}};  ///< if there is no texture
  std::optional<std::string> alpha_texture;
  std::optional<std::string> displacement_texture;
  float edge_length = 1;  ///< of the displaced mesh
};
/// `Shape`.
ShapeParts make_shape(const std::string& kind, const ParameterList& list, Context& context);

/// `Camera`. The caller sets the transform.
description::Camera make_camera(const std::string& kind, const ParameterList& list, Context& context);
/// `Film`. `exposure_time`: seconds that the shutter is open.
description::Film make_film(const std::string& kind, const ParameterList& list, float exposure_time, Context& context);
/// `PixelFilter`.
description::Filter make_filter(const std::string& kind, const ParameterList& list, Context& context);
/// `Integrator` and `Sampler`; their results go into the scene's hints.
void read_integrator(const std::string& kind, const ParameterList& list, Context& context);
void read_sampler(const std::string& kind, const ParameterList& list, Context& context);

}  // namespace lanthorn::pbrt
