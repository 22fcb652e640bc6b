// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "api/plain/description_fields.h"

namespace lanthorn::plain {

namespace {

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

}  // namespace

void Convert<Transform>::read(Reader& reader, const Value& data, Transform& out) {
  const NumberArray<double> m = number_array<double>(reader, data, "a 4 x 4 matrix");
  if (m.shape != Shape{4, 4}) reader.fail("a 4 x 4 matrix", data);
  DMat4 matrix;
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      matrix[static_cast<int>(column)][static_cast<int>(row)] = m.values[row * 4 + column];
  out = Transform(matrix);
  if (out.is_singular()) reader.fail("a matrix that can be inverted", data);
  reader.mix(m.values.data(), 16 * sizeof(double));
}
Value Convert<Transform>::write(const Transform& map) {
  std::vector<double> m;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) m.push_back(map.matrix[column][row]);
  return array_of(std::move(m), {4, 4});
}

void Convert<AnimatedTransform>::read(Reader& reader, const Value& data, AnimatedTransform& out) {
  const auto* dict = data.as<Dict>();
  if (dict == nullptr) {
    Transform fixed;
    plain::read(reader, data, fixed);
    out = AnimatedTransform(fixed);
    return;
  }
  constexpr auto members =
      std::tuple(field("start", &AnimatedTransform::start), field("end", &AnimatedTransform::end),
                 field("start_time", &AnimatedTransform::start_time), field("end_time", &AnimatedTransform::end_time));
  Keys known;
  std::apply([&](const auto&... member) { (read_member(reader, *dict, out, member, known), ...); }, members);
  refuse_other_keys(reader, *dict, known);
}
Value Convert<AnimatedTransform>::write(const AnimatedTransform& map) {
  if (!map.is_moving()) return plain::write(map.start);
  Dict data;
  data.set("start", plain::write(map.start));
  data.set("end", plain::write(map.end));
  data.set("start_time", plain::write(map.start_time));
  data.set("end_time", plain::write(map.end_time));
  return data;
}

void Convert<Mat2>::read(Reader& reader, const Value& data, Mat2& out) {
  const NumberArray<float> m = number_array<float>(reader, data, "a 2 x 2 matrix");
  if (m.shape != Shape{2, 2}) reader.fail("a 2 x 2 matrix", data);
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t column = 0; column < 2; ++column)
      out[static_cast<int>(column)][static_cast<int>(row)] = m.values[row * 2 + column];
  reader.mix(m.values.data(), 4 * sizeof(float));
}
Value Convert<Mat2>::write(const Mat2& map) {
  std::vector<float> m;
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 2; ++column) m.push_back(map[column][row]);
  return array_of(std::move(m), {2, 2});
}

void Convert<description::FloatParameter>::read(Reader& reader, const Value& data, description::FloatParameter& out) {
  read_parameter(reader, data, "float_textures", out);
}
Value Convert<description::FloatParameter>::write(const description::FloatParameter& value) {
  return write_parameter(value);
}
void Convert<description::SpectrumParameter>::read(Reader& reader, const Value& data,
                                                   description::SpectrumParameter& out) {
  read_parameter(reader, data, "spectrum_textures", out);
}
Value Convert<description::SpectrumParameter>::write(const description::SpectrumParameter& value) {
  return write_parameter(value);
}

void Convert<std::shared_ptr<const description::SphericalTexels>>::read(Reader& reader, const Value& data,
                                                                        Texels& out) {
  if (data.is_none()) return out.reset();
  const std::string expected = "numbers of shape (height, width, 3)";
  const NumberArray<float> array = number_array<float>(reader, data, expected);
  if (array.shape.size() != 3 || array.shape[2] != 3 || array.values.empty()) reader.fail(expected, data);
  description::SphericalTexels texels{static_cast<int>(array.shape[1]), static_cast<int>(array.shape[0]), {}};
  texels.rows.resize(array.values.size() / 3);
  std::memcpy(static_cast<void*>(texels.rows.data()), array.values.data(), texels.rows.size() * sizeof(Rgb));
  reader.mix(texels.rows.data(), texels.rows.size() * sizeof(Rgb));
  out = std::make_shared<const description::SphericalTexels>(std::move(texels));
}
Value Convert<std::shared_ptr<const description::SphericalTexels>>::write(const Texels& texels) {
  if (!texels) return {};
  return array_of(texels->rows, {static_cast<std::size_t>(texels->height), static_cast<std::size_t>(texels->width), 3});
}

}  // namespace lanthorn::plain
