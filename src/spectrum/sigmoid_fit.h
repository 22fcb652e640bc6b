// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Smooth spectra of RGB colours: their fit, and the table of fits that is made at build time.
#pragma once

#include <array>
#include <cstddef>

#include "spectrum/cie.h"

namespace lanthorn {

/// Coefficients a of the reflectance sigmoid(a[0] t^2 + a[1] t + a[2]), t = (lambda - 360 nm) / 470 nm.
using UnitSigmoid = std::array<double, 3>;

/// Fits smooth reflectances that have a given colour under a colour space's own illuminant: Jakob & Hanika 2019, "A
/// low-dimensional function space for efficient spectral upsampling", section 3.
class SigmoidFit {
 public:
  explicit SigmoidFit(ColorSpace space);

  /// Minimises the CIELAB distance to a linear RGB colour in [0,1]^3 of the space by damped Gauss-Newton steps from
  /// `start`. A colour that no reflectance of this shape has gets the nearest one.
  UnitSigmoid fit(const Tristimulus& rgb, const UnitSigmoid& start = {0, 0, 0}) const;
  /// Linear RGB, in the space, of the reflectance under the space's illuminant.
  Tristimulus rgb_of(const UnitSigmoid& a) const;

 private:
  struct Colour {
    Tristimulus xyz;
    std::array<Tristimulus, 3> derivative;  ///< of xyz with respect to each coefficient
  };
  Colour colour(const UnitSigmoid& a) const;

  Matrix3 to_xyz_;
  Tristimulus white_;
  // Observer times illuminant, resampled to nodes every 5 nm with tent weights. Exact for reflectances that are linear
  // between nodes.
  std::array<std::array<double, five_nm_samples>, 3> weight_{};
};

/// The same curve as a quadratic in the wavelength in nm.
std::array<float, 3> in_nanometres(const UnitSigmoid& a);

/// Nodes of the table along each axis. Odd, so that a largest component of 1/2 (every light, every unbounded colour) is
/// a node itself.
inline constexpr std::size_t sigmoid_nodes = 33;

using SigmoidNode = std::array<float, 3>;

/// Coefficients of sRGB colours, for wavelengths in nm. Indices: which component is the largest (0 red, 1 green, 2
/// blue), the node of its value, then the nodes of the ratios of the next component but one and of the next component
/// to the largest. After Jakob & Hanika 2019, section 4; unlike there, the nodes of the ratios are also dense near 0
/// and 1, for saturated colours and whites. Written by `make_sigmoid_table` at build time.
extern const std::array<SigmoidNode, 3 * sigmoid_nodes * sigmoid_nodes * sigmoid_nodes> sigmoid_table;

constexpr std::size_t sigmoid_index(std::size_t largest, std::size_t value, std::size_t next_but_one,
                                    std::size_t next) {
  return ((largest * sigmoid_nodes + value) * sigmoid_nodes + next_but_one) * sigmoid_nodes + next;
}

constexpr double smooth_step(double x) { return x * x * (3 - 2 * x); }

/// Ratio of a component to the largest at node i.
constexpr double sigmoid_node_ratio(std::size_t i) { return smooth_step(static_cast<double>(i) / (sigmoid_nodes - 1)); }
/// Value of the largest component at node i. Not 0 at the first node, because the coefficients of black are infinite.
constexpr double sigmoid_node_value(std::size_t i) { return i == 0 ? 1e-5 : smooth_step(sigmoid_node_ratio(i)); }

}  // namespace lanthorn
