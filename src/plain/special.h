// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Values whose plain data are neither those of a struct nor those of a variant.
#pragma once

#include <memory>
#include <variant>

#include "lanthorn/plain_data.h"
#include "lanthorn/scene_description.h"

namespace lanthorn::plain {

/// A 4 x 4 matrix that multiplies column vectors.
void read_special(Reader& reader, const Value& data, Transform& out);
Value write_special(const Transform& map);

/// A matrix, or a dict of `start`, `end`, `start_time` and `end_time`.
void read_special(Reader& reader, const Value& data, AnimatedTransform& out);
Value write_special(const AnimatedTransform& map);

void read_special(Reader& reader, const Value& data, Mat2& out);
Value write_special(const Mat2& map);

/// A number; three numbers, which are R, G, B; or a dict: {"rgb": ..., "space": ...}, {"blackbody": kelvin},
/// {"named": name}, {"nm": ..., "values": ...}.
void read_special(Reader& reader, const Value& data, description::SpectrumValue& out);
Value write_special(const description::SpectrumValue& value);

/// The value, or {"texture": index or name, "value": ...}.
void read_special(Reader& reader, const Value& data, description::FloatParameter& out);
Value write_special(const description::FloatParameter& value);
void read_special(Reader& reader, const Value& data, description::SpectrumParameter& out);
Value write_special(const description::SpectrumParameter& value);

/// A surface mapping, or a solid texture's mapping.
using AnyMapping = std::variant<description::TextureMapping, description::SolidMapping>;
void read_special(Reader& reader, const Value& data, AnyMapping& out);
Value write_special(const AnyMapping& mapping);

/// An environment's colours as an array (height, width, 3).
using SharedTexels = std::shared_ptr<const description::SphericalTexels>;
void read_special(Reader& reader, const Value& data, SharedTexels& out);
Value write_special(const SharedTexels& texels);

}  // namespace lanthorn::plain
