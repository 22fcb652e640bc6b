// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "plain/special.h"

#include <cstring>
#include <glm/matrix.hpp>
#include <string>
#include <utility>
#include <variant>

#include "plain/type.h"

namespace lanthorn::plain {

using description::BlackbodySpectrum;
using description::NamedSpectrum;
using description::RgbSpectrum;
using description::SampledSpectrum;
using description::SolidMapping;
using description::SphericalTexels;
using description::TextureMapping;

namespace {

// Plain data has matrices row by row, glm column by column.
template <class Matrix>
Matrix matrix_of(Reader& reader, const Value& data) {
  using Number = typename Matrix::value_type;
  constexpr auto n = static_cast<std::size_t>(Matrix::length());
  const std::string expected = "a " + std::to_string(n) + " x " + std::to_string(n) + " matrix";
  const NumberArray<Number> rows = number_array<Number>(reader, data, expected);
  if (rows.shape != Shape{n, n}) reader.fail(expected, data);
  reader.mix(rows.values.data(), n * n * sizeof(Number));
  Matrix matrix;
  std::memcpy(static_cast<void*>(&matrix), rows.values.data(), n * n * sizeof(Number));
  return glm::transpose(matrix);
}
template <class Matrix>
Value write_matrix(const Matrix& matrix) {
  constexpr auto n = static_cast<std::size_t>(Matrix::length());
  const Matrix rows = glm::transpose(matrix);
  return array_of(scalar_of<typename Matrix::value_type>(), {n, n}, &rows);
}

template <class Parameter>
void read_parameter(Reader& reader, const Value& data, const char* table, Parameter& out) {
  const auto* dict = data.as<Dict>();
  const Value* texture = dict != nullptr ? dict->find("texture") : nullptr;
  if (texture == nullptr) {
    out.texture.reset();
    return read(reader, data, out.value);
  }
  reader.at(".texture", [&] { read_reference(reader, *texture, table, out.texture.emplace()); });
  if (const Value* value = dict->find("value")) reader.at(".value", [&] { read(reader, *value, out.value); });
  refuse_other_keys(reader, *dict, {"texture", "value"});
}
template <class Parameter>
Value write_parameter(const Parameter& parameter) {
  if (!parameter.texture) return write(parameter.value);
  Dict data;
  data.set("texture", write(*parameter.texture));
  data.set("value", write(parameter.value));
  return data;
}

SampledSpectrum read_samples(Reader& reader, const Value& data) {
  SampledSpectrum sampled;
  read(reader, data, sampled);
  if (sampled.nm.empty() || sampled.nm.size() != sampled.values.size())
    reader.fail("as many 'values' as 'nm', and at least one", data);
  return sampled;
}

// The first key tells kinds of spectra apart.
void read_spectrum(Reader& reader, const Dict& dict, const Value& data, description::SpectrumValue& out) {
  if (dict.contains("rgb"))
    read(reader, data, out.emplace<RgbSpectrum>());
  else if (dict.contains("blackbody"))
    read(reader, data, out.emplace<BlackbodySpectrum>());
  else if (dict.contains("named"))
    read(reader, data, out.emplace<NamedSpectrum>());
  else if (dict.contains("nm"))
    out = read_samples(reader, data);
  else
    reader.fail("a spectrum with 'rgb', 'blackbody', 'named', or 'nm' and 'values'", data);
}

}  // namespace

void read_special(Reader& reader, const Value& data, Transform& out) {
  out = Transform(matrix_of<DMat4>(reader, data));
  if (out.is_singular()) reader.fail("a matrix that can be inverted", data);
}
Value write_special(const Transform& map) { return write_matrix(map.matrix); }

void read_special(Reader& reader, const Value& data, AnimatedTransform& out) {
  const auto* dict = data.as<Dict>();
  if (dict == nullptr) {
    Transform fixed;
    read(reader, data, fixed);
    out = AnimatedTransform(fixed);
    return;
  }
  const auto read_key = [&](const char* name, auto& part) {
    if (const Value* value = dict->find(name)) reader.at("." + std::string(name), [&] { read(reader, *value, part); });
  };
  read_key("start", out.start);
  read_key("end", out.end);
  read_key("start_time", out.start_time);
  read_key("end_time", out.end_time);
  refuse_other_keys(reader, *dict, {"start", "end", "start_time", "end_time"});
}
Value write_special(const AnimatedTransform& map) {
  if (!map.is_moving()) return write(map.start);
  Dict data;
  data.set("start", write(map.start));
  data.set("end", write(map.end));
  data.set("start_time", write(map.start_time));
  data.set("end_time", write(map.end_time));
  return data;
}

void read_special(Reader& reader, const Value& data, Mat2& out) { out = matrix_of<Mat2>(reader, data); }
Value write_special(const Mat2& map) { return write_matrix(map); }

void read_special(Reader& reader, const Value& data, description::SpectrumValue& out) {
  if (const auto* dict = data.as<Dict>())
    read_spectrum(reader, *dict, data, out);
  else if (data.as<List>() != nullptr || data.as<Array>() != nullptr)
    read(reader, data, out.emplace<RgbSpectrum>().rgb);
  else
    read(reader, data, out.emplace<float>());
}
Value write_special(const description::SpectrumValue& value) {
  const auto* colour = std::get_if<RgbSpectrum>(&value);
  if (colour != nullptr && colour->space == ColorSpace::srgb) return write(colour->rgb);
  return std::visit([](const auto& spectrum) { return write(spectrum); }, value);
}

void read_special(Reader& reader, const Value& data, description::FloatParameter& out) {
  read_parameter(reader, data, "float_textures", out);
}
Value write_special(const description::FloatParameter& value) { return write_parameter(value); }
void read_special(Reader& reader, const Value& data, description::SpectrumParameter& out) {
  read_parameter(reader, data, "spectrum_textures", out);
}
Value write_special(const description::SpectrumParameter& value) { return write_parameter(value); }

void read_special(Reader& reader, const Value& data, AnyMapping& out) {
  const Value* type = dict_of(reader, data).find("type");
  if (type == nullptr || type->as<std::string>() == nullptr || *type->as<std::string>() != "solid")
    return read(reader, data, out.emplace<TextureMapping>());
  std::variant<SolidMapping> solid;
  read(reader, data, solid);
  out = std::get<SolidMapping>(solid);
}
Value write_special(const AnyMapping& mapping) {
  if (const auto* surface = std::get_if<TextureMapping>(&mapping)) return write(*surface);
  return write(std::variant<SolidMapping>(std::get<SolidMapping>(mapping)));
}

void read_special(Reader& reader, const Value& data, SharedTexels& out) {
  if (data.is_none()) return out.reset();
  const std::string expected = "numbers of shape (height, width, 3)";
  const NumberArray<float> array = number_array<float>(reader, data, expected);
  if (array.shape.size() != 3 || array.shape[2] != 3 || array.values.empty()) reader.fail(expected, data);
  SphericalTexels texels{static_cast<int>(array.shape[1]), static_cast<int>(array.shape[0]), {}};
  texels.rows.resize(array.values.size() / 3);
  std::memcpy(static_cast<void*>(texels.rows.data()), array.values.data(), texels.rows.size() * sizeof(Rgb));
  reader.mix(texels.rows.data(), texels.rows.size() * sizeof(Rgb));
  out = std::make_shared<const SphericalTexels>(std::move(texels));
}
Value write_special(const SharedTexels& texels) {
  if (!texels) return {};
  const Shape shape{static_cast<std::size_t>(texels->height), static_cast<std::size_t>(texels->width), 3};
  return array_of(Scalar::float32, shape, texels->rows.data());
}

}  // namespace lanthorn::plain
