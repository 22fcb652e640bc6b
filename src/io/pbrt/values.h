// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Parameters that are spectra or may be textured.
#pragma once

#include <optional>
#include <string_view>

#include "io/pbrt/context.h"

namespace lanthorn::pbrt {

/// A spectrum in any form: "rgb", "blackbody", "spectrum" (a name, a file, or wavelength-value pairs) and, except for
/// lights, "float". nullopt if the parameter is missing. Throws Error if it is malformed, negative, or names an unknown
/// spectrum.
std::optional<description::SpectrumValue> find_spectrum(const ParameterList& list, std::string_view name,
                                                        description::SpectrumRole role, Context& context);

/// Like `find_spectrum`, but also accepts a "texture". A skipped texture (see Context) is replaced by grey for
/// reflectances, 0 for lights, else nullopt. Throws Error if no spectrum texture of that name is defined.
std::optional<description::SpectrumParameter> find_spectrum_or_texture(const ParameterList& list, std::string_view name,
                                                                       description::SpectrumRole role,
                                                                       Context& context);

/// A "float" or a float "texture"; nullopt if the texture is skipped (see Context).
std::optional<description::FloatParameter> find_float_or_texture(const ParameterList& list, std::string_view name,
                                                                 Context& context);
description::FloatParameter float_or_texture(const ParameterList& list, std::string_view name, float otherwise,
                                             Context& context);

/// A "float". Throws Error unless it is above 0.
float positive(const ParameterList& list, std::string_view name, float otherwise);

/// True if the parameter names a skipped texture (see Context).
bool names_lost_float_texture(const ParameterList& list, std::string_view name, const Context& context);
bool names_lost_spectrum_texture(const ParameterList& list, std::string_view name, const Context& context);

/// The name in a "texture" parameter; nullopt if the parameter is missing or of another type.
std::optional<std::string> texture_name(const ParameterList& list, std::string_view name);

}  // namespace lanthorn::pbrt
