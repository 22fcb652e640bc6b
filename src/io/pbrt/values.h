// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Parameters that are spectra or that can be textured.
#pragma once

#include <optional>
#include <string_view>

#include "io/pbrt/context.h"

namespace lanthorn::pbrt {

/// A spectrum of any form: "rgb", "blackbody", "spectrum" (a name, a file, or wavelength-value pairs) and, except for
/// lights, "float". Empty if the parameter is missing. Error if it is malformed, negative, or names an unknown
/// spectrum.
std::optional<description::SpectrumValue> find_spectrum(const ParameterList& list, std::string_view name,
                                                        description::SpectrumRole role, Context& context);

/// As `find_spectrum`, or a "texture". One that is lost (see Context) is grey as a reflectance, 0 as light, else empty.
/// An Error if no spectrum texture of that name is defined.
std::optional<description::SpectrumParameter> find_spectrum_or_texture(const ParameterList& list, std::string_view name,
                                                                       description::SpectrumRole role,
                                                                       Context& context);

/// A "float" or a float "texture"; empty if that is lost.
std::optional<description::FloatParameter> find_float_or_texture(const ParameterList& list, std::string_view name,
                                                                 Context& context);
description::FloatParameter float_or_texture(const ParameterList& list, std::string_view name, float otherwise,
                                             Context& context);

/// A "float". An Error unless it is above 0.
float positive(const ParameterList& list, std::string_view name, float otherwise);

/// True if the parameter names a texture that is lost (see Context).
bool names_lost_float_texture(const ParameterList& list, std::string_view name, const Context& context);
bool names_lost_spectrum_texture(const ParameterList& list, std::string_view name, const Context& context);

/// The name in a "texture" parameter. Empty if the parameter is missing or of another type.
std::optional<std::string> texture_name(const ParameterList& list, std::string_view name);

}  // namespace lanthorn::pbrt
