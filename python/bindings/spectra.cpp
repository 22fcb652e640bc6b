// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "description_fields.h"

namespace lanthorn::python {

using namespace description;

namespace {

constexpr auto rgb_members = std::tuple(field("rgb", &RgbSpectrum::rgb), field("space", &RgbSpectrum::space));
constexpr auto blackbody_members = std::tuple(field("blackbody", &BlackbodySpectrum::kelvin));
constexpr auto named_members = std::tuple(field("named", &NamedSpectrum::name));
constexpr auto sampled_members =
    std::tuple(field("nm", &SampledSpectrum::nm), field("values", &SampledSpectrum::values));

template <class T, class Members>
T read_whole(Reader& reader, const py::dict& data, const Members& members) {
  T out;
  Keys known;
  std::apply([&](const auto&... member) { (read_member(reader, data, out, member, known), ...); }, members);
  refuse_other_keys(reader, data, known);
  return out;
}
template <class T, class Members>
py::object write_whole(const T& value, const Members& members) {
  py::dict data;
  std::apply([&](const auto&... member) { (write_member(data, value, member), ...); }, members);
  return data;
}

SpectrumValue read_dict(Reader& reader, const py::dict& data) {
  if (data.contains("rgb")) return read_whole<RgbSpectrum>(reader, data, rgb_members);
  if (data.contains("blackbody")) return read_whole<BlackbodySpectrum>(reader, data, blackbody_members);
  if (data.contains("named")) return read_whole<NamedSpectrum>(reader, data, named_members);
  if (!data.contains("nm")) reader.fail("a spectrum with 'rgb', 'blackbody', 'named', or 'nm' and 'values'", data);
  SampledSpectrum sampled = read_whole<SampledSpectrum>(reader, data, sampled_members);
  if (sampled.nm.empty() || sampled.nm.size() != sampled.values.size())
    reader.fail("as many 'values' as 'nm', and at least one", data);
  return sampled;
}

struct Writer {
  py::object operator()(float number) const { return py::float_(number); }
  py::object operator()(const RgbSpectrum& s) const {
    return s.space == ColorSpace::srgb ? write(s.rgb) : write_whole(s, rgb_members);
  }
  py::object operator()(const BlackbodySpectrum& s) const { return write_whole(s, blackbody_members); }
  py::object operator()(const NamedSpectrum& s) const { return write_whole(s, named_members); }
  py::object operator()(const SampledSpectrum& s) const { return write_whole(s, sampled_members); }
};

}  // namespace

void Convert<SpectrumValue>::read(Reader& reader, py::handle data, SpectrumValue& out) {
  if (py::isinstance<py::dict>(data)) {
    out = read_dict(reader, py::reinterpret_borrow<py::dict>(data));
  } else if (py::isinstance<py::sequence>(data) && !py::isinstance<py::str>(data)) {
    python::read(reader, data, out.emplace<RgbSpectrum>().rgb);
  } else if (py::isinstance<py::array>(data) && py::reinterpret_borrow<py::array>(data).ndim() > 0) {
    python::read(reader, data, out.emplace<RgbSpectrum>().rgb);
  } else {
    python::read(reader, data, out.emplace<float>());
  }
}
py::object Convert<SpectrumValue>::write(const SpectrumValue& value) { return std::visit(Writer(), value); }

}  // namespace lanthorn::python
