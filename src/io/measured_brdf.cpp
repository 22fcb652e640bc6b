// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Dupuy & Jakob 2018, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering".
#include "io/measured_brdf.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include "io/tensor_file.h"
#include "lanthorn/text.h"
#include "math/vec.h"

namespace lanthorn {

namespace {

constexpr float angle_tolerance = 0.02f;  // radians
constexpr std::size_t most_incidences = std::size_t{1} << 24;

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : file_(bytes, name) {}

  MeasuredData read() {
    data_.phi = ascending("phi_i");
    data_.theta = ascending("theta_i");
    check_angles();
    data_.ndf = grids("ndf", {});
    data_.sigma = grids("sigma", {});
    data_.vndf = grids("vndf", {data_.phi.size(), data_.theta.size()});
    make_densities(data_.vndf);
    data_.luminance = grids("luminance", {data_.phi.size(), data_.theta.size()});
    data_.weighted = file_.byte("jacobian") != 0;
    const bool is_spectral = file_.has("spectra");
    if (!is_spectral && !file_.has("rgb")) file_.fail("has neither a field \"spectra\" nor \"rgb\"");
    if (is_spectral) data_.wavelengths = ascending("wavelengths");
    data_.reflectance =
        grids(is_spectral ? "spectra" : "rgb", {data_.phi.size(), data_.theta.size(), data_.channel_count()});
    return std::move(data_);
  }

 private:
  std::vector<float> ascending(const std::string& field) const {
    std::vector<float> values = file_.floats(field, 1);
    if (std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) != values.end())
      file_.fail("the values of " + in_quotes(field) + " are not ascending");
    return values;
  }

  void check_angles() {
    if (data_.theta.front() < 0 || data_.theta.back() > pi / 2 + angle_tolerance)
      file_.fail("\"theta_i\" is not between 0 and pi / 2");
    if (data_.theta.size() > most_incidences / data_.phi.size()) file_.fail("has too many incident directions");
    if (data_.is_isotropic()) return;
    const float range = data_.phi.back() - data_.phi.front();
    const auto spans = [&](int symmetry) {
      return std::fabs(range - 2 * pi / static_cast<float>(symmetry)) <= angle_tolerance;
    };
    for (const int symmetry : {1, 2, 4})
      if (spans(symmetry)) data_.symmetry = symmetry;
    if (!spans(data_.symmetry)) file_.fail("\"phi_i\" spans neither a full, a half nor a quarter turn");
    if (data_.symmetry > 1 && std::fabs(data_.phi.front() + pi) > angle_tolerance)
      file_.fail("\"phi_i\" must begin at -pi if it spans less than a full turn");
  }

  // The last two dimensions are the grid; the outer ones must equal `outer`.
  NodeGrids grids(const std::string& field, const std::vector<std::size_t>& outer) const {
    const std::size_t dimensions = outer.size() + 2;
    const std::vector<std::size_t>& shape = file_.shape(field, dimensions);
    if (!std::equal(outer.begin(), outer.end(), shape.begin()))
      file_.fail("the size of " + in_quotes(field) + " does not fit the numbers of directions and wavelengths");
    NodeGrids result{shape[dimensions - 1], shape[dimensions - 2], {}};
    if (result.width < 2 || result.height < 2) file_.fail("the grid of " + in_quotes(field) + " is too small");
    result.values = file_.floats(field, dimensions);
    return result;
  }

  void make_densities(NodeGrids& vndf) const {
    for (float& value : vndf.values) value = std::max(value, 0.0f);
    const auto size = static_cast<std::ptrdiff_t>(vndf.size_of_grid());
    for (auto it = vndf.values.begin(); it != vndf.values.end(); it += size)
      if (std::all_of(it, it + size, [](float x) { return x == 0; }))
        file_.fail("\"vndf\" has no visible normal for some incident direction");
  }

  TensorFile file_;
  MeasuredData data_;
};

}  // namespace

MeasuredData parse_measured_brdf(std::string_view bytes, const std::string& name) { return Reader(bytes, name).read(); }

}  // namespace lanthorn
