// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "api/plain/description_fields.h"

namespace lanthorn::plain {

using description::BlackbodySpectrum;
using description::NamedSpectrum;
using description::RgbSpectrum;
using description::SampledSpectrum;
using description::SpectrumValue;

namespace {

constexpr auto rgb_members = std::tuple(field("rgb", &RgbSpectrum::rgb), field("space", &RgbSpectrum::space));
constexpr auto blackbody_members = std::tuple(field("blackbody", &BlackbodySpectrum::kelvin));
constexpr auto named_members = std::tuple(field("named", &NamedSpectrum::name));
constexpr auto sampled_members =
    std::tuple(field("nm", &SampledSpectrum::nm), field("values", &SampledSpectrum::values));

template <class T, class Members>
T read_whole(Reader& reader, const Dict& data, const Members& members) {
  T out;
  Keys known;
  std::apply([&](const auto&... member) { (read_member(reader, data, out, member, known), ...); }, members);
  refuse_other_keys(reader, data, known);
  return out;
}
template <class T, class Members>
Value write_whole(const T& value, const Members& members) {
  Dict data;
  std::apply([&](const auto&... member) { (write_member(data, value, member), ...); }, members);
  return data;
}

SpectrumValue read_dict(Reader& reader, const Dict& data) {
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
  Value operator()(float number) const { return static_cast<double>(number); }
  Value operator()(const RgbSpectrum& s) const {
    return s.space == ColorSpace::srgb ? write(s.rgb) : write_whole(s, rgb_members);
  }
  Value operator()(const BlackbodySpectrum& s) const { return write_whole(s, blackbody_members); }
  Value operator()(const NamedSpectrum& s) const { return write_whole(s, named_members); }
  Value operator()(const SampledSpectrum& s) const { return write_whole(s, sampled_members); }
};

}  // namespace

void Convert<SpectrumValue>::read(Reader& reader, const Value& data, SpectrumValue& out) {
  if (const auto* dict = data.as<Dict>()) {
    out = read_dict(reader, *dict);
  } else if (data.as<List>() != nullptr || data.as<Array>() != nullptr) {
    plain::read(reader, data, out.emplace<RgbSpectrum>().rgb);
  } else {
    plain::read(reader, data, out.emplace<float>());
  }
}
Value Convert<SpectrumValue>::write(const SpectrumValue& value) { return std::visit(Writer(), value); }

}  // namespace lanthorn::plain
