// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "plain_data.h"

#include <algorithm>

#include "lanthorn/error.h"
#include "lanthorn/text.h"

namespace lanthorn::python {

namespace {

template <class Parameter>
void read_parameter(Reader& reader, py::handle data, const char* table, Parameter& out) {
  if (!py::isinstance<py::dict>(data) || !data.contains("texture")) {
    out.texture.reset();
    return read(reader, data, out.value);
  }
  const auto dict = py::reinterpret_borrow<py::dict>(data);
  reader.at(".texture", [&] { read_reference(reader, dict["texture"], table, out.texture.emplace()); });
  if (dict.contains("value")) reader.at(".value", [&] { read(reader, dict["value"], out.value); });
  refuse_other_keys(reader, dict, {"texture", "value"});
}
template <class Parameter>
py::object write_parameter(const Parameter& parameter) {
  if (!parameter.texture) return write(parameter.value);
  py::dict data;
  data["texture"] = *parameter.texture;
  data["value"] = write(parameter.value);
  return data;
}

}  // namespace

void Reader::fail(const std::string& expected, py::handle got) const {
  std::string shown = excerpt(py::repr(got).cast<std::string>());
  fail("expected " + expected + ", got " + shown);
}
void Reader::fail(const std::string& message) const {
  const std::size_t start = path_.starts_with('.') ? 1 : 0;
  throw Error(path_.empty() ? message : path_.substr(start) + ": " + message);
}

void require_dict(Reader& reader, py::handle data) {
  if (!py::isinstance<py::dict>(data)) reader.fail("a dict", data);
}

void refuse_other_keys(Reader& reader, const py::dict& data, const Keys& known) {
  for (const auto& [key, value] : data) {
    if (!py::isinstance<py::str>(key)) reader.fail("keys that are text", key);
    const auto name = key.cast<std::string>();
    if (std::find(known.begin(), known.end(), name) == known.end())
      reader.fail("unknown key " + in_quotes(name) + did_you_mean(name, known));
  }
}

void read_reference(Reader& reader, py::handle data, const char* table, Index& out) {
  if (!py::isinstance<py::str>(data)) return read(reader, data, out);
  const auto name = data.cast<std::string>();
  const std::map<std::string, Index>& known = reader.names[table];
  if (const auto found = known.find(name); found != known.end()) {
    out = found->second;
    return reader.mix(&out, sizeof(out));
  }
  Keys all;
  for (const auto& [other, index] : known) all.push_back(other);
  reader.fail("there is no entry named " + in_quotes(name) + " in \"" + table + "\"" + did_you_mean(name, all));
}

void Convert<Transform>::read(Reader& reader, py::handle data, Transform& out) {
  const py::array_t<double> m = number_array<double>(reader, data, "a 4 x 4 matrix");
  if (m.ndim() != 2 || m.shape(0) != 4 || m.shape(1) != 4) reader.fail("a 4 x 4 matrix", data);
  DMat4 matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix[column][row] = m.at(row, column);
  out = Transform(matrix);
  if (out.is_singular()) reader.fail("a matrix that can be inverted", data);
  reader.mix(m.data(), 16 * sizeof(double));
}
py::object Convert<Transform>::write(const Transform& map) {
  py::array_t<double> m({4, 4});
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) m.mutable_at(row, column) = map.matrix[column][row];
  return m;
}

void Convert<AnimatedTransform>::read(Reader& reader, py::handle data, AnimatedTransform& out) {
  if (!py::isinstance<py::dict>(data)) {
    Transform fixed;
    python::read(reader, data, fixed);
    out = AnimatedTransform(fixed);
    return;
  }
  const auto dict = py::reinterpret_borrow<py::dict>(data);
  constexpr auto members =
      std::tuple(field("start", &AnimatedTransform::start), field("end", &AnimatedTransform::end),
                 field("start_time", &AnimatedTransform::start_time), field("end_time", &AnimatedTransform::end_time));
  Keys known;
  std::apply([&](const auto&... member) { (read_member(reader, dict, out, member, known), ...); }, members);
  refuse_other_keys(reader, dict, known);
}
py::object Convert<AnimatedTransform>::write(const AnimatedTransform& map) {
  if (!map.is_moving()) return python::write(map.start);
  py::dict data;
  data["start"] = python::write(map.start);
  data["end"] = python::write(map.end);
  data["start_time"] = map.start_time;
  data["end_time"] = map.end_time;
  return data;
}

void Convert<Mat2>::read(Reader& reader, py::handle data, Mat2& out) {
  const py::array_t<float> m = number_array<float>(reader, data, "a 2 x 2 matrix");
  if (m.ndim() != 2 || m.shape(0) != 2 || m.shape(1) != 2) reader.fail("a 2 x 2 matrix", data);
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 2; ++column) out[column][row] = m.at(row, column);
  reader.mix(m.data(), 4 * sizeof(float));
}
py::object Convert<Mat2>::write(const Mat2& map) {
  py::array_t<float> m({2, 2});
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 2; ++column) m.mutable_at(row, column) = map[column][row];
  return m;
}

void Convert<description::FloatParameter>::read(Reader& reader, py::handle data, description::FloatParameter& out) {
  read_parameter(reader, data, "float_textures", out);
}
py::object Convert<description::FloatParameter>::write(const description::FloatParameter& value) {
  return write_parameter(value);
}
void Convert<description::SpectrumParameter>::read(Reader& reader, py::handle data,
                                                   description::SpectrumParameter& out) {
  read_parameter(reader, data, "spectrum_textures", out);
}
py::object Convert<description::SpectrumParameter>::write(const description::SpectrumParameter& value) {
  return write_parameter(value);
}

void Convert<std::shared_ptr<const description::SphericalTexels>>::read(Reader& reader, py::handle data, Texels& out) {
  if (data.is_none()) return out.reset();
  const std::string expected = "numbers of shape (height, width, 3)";
  const py::array_t<float> array = number_array<float>(reader, data, expected);
  if (array.ndim() != 3 || array.shape(2) != 3 || array.size() == 0) reader.fail(expected, data);
  description::SphericalTexels texels{static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)), {}};
  texels.rows.resize(static_cast<std::size_t>(array.size() / 3));
  std::memcpy(static_cast<void*>(texels.rows.data()), array.data(), texels.rows.size() * sizeof(Rgb));
  reader.mix(texels.rows.data(), texels.rows.size() * sizeof(Rgb));
  out = std::make_shared<const description::SphericalTexels>(std::move(texels));
}
py::object Convert<std::shared_ptr<const description::SphericalTexels>>::write(const Texels& texels) {
  if (!texels) return py::none();
  py::array_t<float> array({texels->height, texels->width, 3});
  std::memcpy(array.mutable_data(), texels->rows.data(), texels->rows.size() * sizeof(Rgb));
  return array;
}

}  // namespace lanthorn::python
