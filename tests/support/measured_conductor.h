// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A synthetic measurement: the tables of a rough conductor with GGX microfacets in the format of the database of
// measured materials, and the bytes of such a file.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "lanthorn/measured_data.h"
#include "math/bilinear_distribution.h"
#include "surface/fresnel.h"
#include "surface/microfacet.h"

namespace lanthorn::test {

/// The index of refraction of one channel.
struct MetalIndex {
  float eta = 0, k = 0;
};

struct MeasuredConductor {
  float alpha_x = 0.3f, alpha_y = 0.3f;
  std::vector<MetalIndex> indices{};  ///< by channel
  std::vector<float> wavelengths{};   ///< nm; none: the channels are RGB
  std::size_t azimuths = 17;          ///< of incident directions, if the widths differ
  std::size_t elevations = 12;
  std::size_t normals = 64, warped = 24;  ///< nodes along each side
  int symmetry = 1;                       ///< of the azimuths that are stored: 1 or 4
};

namespace detail {

inline Vec3 at_radians(float theta, float phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}
inline Vec3 normal_at(const Vec2& u, float phi) { return at_radians(sqr(u.x) * (pi / 2), (2 * u.y - 1) * pi + phi); }

template <class Value>
NodeGrids tabulate(std::size_t side, Value&& value) {
  NodeGrids grid{side, side, {}};
  const auto last = static_cast<float>(side - 1);
  for (std::size_t i = 0; i < side * side; ++i)
    grid.values.push_back(value(Vec2(static_cast<float>(i % side) / last, static_cast<float>(i / side) / last)));
  return grid;
}
inline void append(NodeGrids& to, const NodeGrids& from) {
  to.width = from.width;
  to.height = from.height;
  to.values.insert(to.values.end(), from.values.begin(), from.values.end());
}

}  // namespace detail

inline MeasuredData measure(const MeasuredConductor& c) {
  const TrowbridgeReitz microfacets(c.alpha_x, c.alpha_y);
  const auto sigma = [&](const Vec3& w) { return 0.5f * (w.z + microfacets.stretched_length(w)); };
  const bool isotropic = c.alpha_x == c.alpha_y;
  MeasuredData data;
  data.symmetry = isotropic ? 1 : c.symmetry;
  const float last = -pi + 2 * pi / static_cast<float>(c.symmetry);
  for (std::size_t i = 0; i < (isotropic ? 1 : c.azimuths); ++i)
    data.phi.push_back(isotropic ? 0 : lerp(static_cast<float>(i) / static_cast<float>(c.azimuths - 1), -pi, last));
  for (std::size_t i = 0; i < c.elevations; ++i)
    data.theta.push_back(static_cast<float>(i) / static_cast<float>(c.elevations - 1) * 1.5f);
  data.wavelengths = c.wavelengths;
  data.ndf = detail::tabulate(c.normals, [&](const Vec2& u) { return microfacets.d(detail::normal_at(u, 0)); });
  data.sigma = detail::tabulate(c.normals, [&](const Vec2& u) { return sigma(detail::normal_at(u, 0)); });
  for (const float phi : data.phi)
    for (const float theta : data.theta) {
      const Vec3 view = detail::at_radians(theta, phi);
      const NodeGrids vndf = detail::tabulate(c.normals, [&](const Vec2& u) {
        const Vec3 m = detail::normal_at(u, isotropic ? phi : 0);
        return std::max(0.0f, dot(m, view)) * microfacets.d(m) * u.x * std::hypot(m.x, m.y);
      });
      const BilinearDistributions warp(vndf.values, vndf.width, vndf.height);
      const auto weight = [&](const Vec2& at, const MetalIndex& n) {
        const Vec3 m = detail::normal_at(warp.sample(at, {}).at, isotropic ? phi : 0);
        const float cosine = dot(m, view);
        const Vec3 light = 2 * cosine * m - view;
        if (!(cosine > 0 && light.z > 0)) return 0.0f;
        return fresnel_conductor(cosine, Spectrum(n.eta), Spectrum(n.k))[0] * microfacets.g_over_g1(view, light);
      };
      detail::append(data.vndf, vndf);
      detail::append(data.luminance, detail::tabulate(c.warped, [&](const Vec2& u) {
                       return weight(u, c.indices[c.indices.size() / 2]);
                     }));
      for (const MetalIndex& n : c.indices)
        detail::append(data.reflectance, detail::tabulate(c.warped, [&](const Vec2& u) { return weight(u, n); }));
    }
  return data;
}

/// A tensor file: name, code of the type, sizes and bytes of each field.
class TensorFileWriter {
 public:
  void add(const std::string& name, std::uint8_t type, std::vector<std::uint64_t> shape, std::string bytes) {
    fields_.push_back({name, type, std::move(shape), std::move(bytes)});
  }
  void add(const std::string& name, std::vector<std::uint64_t> shape, const std::vector<float>& values) {
    std::string bytes(values.size() * sizeof(float), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    add(name, 10, std::move(shape), std::move(bytes));
  }
  std::string bytes() const {
    std::size_t offset = 18;
    for (const Field& f : fields_) offset += 13 + f.name.size() + 8 * f.shape.size();
    std::string header("tensor_file\0\1\0", 14), body;
    put(header, static_cast<std::uint32_t>(fields_.size()));
    for (const Field& f : fields_) {
      put(header, static_cast<std::uint16_t>(f.name.size()));
      header += f.name;
      put(header, static_cast<std::uint16_t>(f.shape.size()));
      put(header, f.type);
      put(header, std::uint64_t{offset + body.size()});
      for (const std::uint64_t extent : f.shape) put(header, extent);
      body += f.bytes;
    }
    return header + body;
  }

 private:
  struct Field {
    std::string name;
    std::uint8_t type;
    std::vector<std::uint64_t> shape;
    std::string bytes;
  };
  template <class T>
  static void put(std::string& out, T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    out.append(bytes, sizeof(T));
  }
  std::vector<Field> fields_;
};

inline std::string bsdf_file(const MeasuredData& data) {
  const std::uint64_t phi = data.phi.size(), theta = data.theta.size(), channels = data.channel_count();
  const auto grid = [](const NodeGrids& g, std::vector<std::uint64_t> outer) {
    outer.push_back(g.height);
    outer.push_back(g.width);
    return outer;
  };
  TensorFileWriter file;
  file.add("description", 1, {4}, "test");
  file.add("phi_i", {phi}, data.phi);
  file.add("theta_i", {theta}, data.theta);
  file.add("ndf", grid(data.ndf, {}), data.ndf.values);
  file.add("sigma", grid(data.sigma, {}), data.sigma.values);
  file.add("vndf", grid(data.vndf, {phi, theta}), data.vndf.values);
  file.add("luminance", grid(data.luminance, {phi, theta}), data.luminance.values);
  if (!data.wavelengths.empty()) file.add("wavelengths", {channels}, data.wavelengths);
  file.add(data.wavelengths.empty() ? "rgb" : "spectra", grid(data.reflectance, {phi, theta, channels}),
           data.reflectance.values);
  file.add("jacobian", 1, {1}, data.weighted ? "\1" : std::string(1, '\0'));
  return file.bytes();
}

}  // namespace lanthorn::test
