// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace lanthorn {

/// Functions on a common grid of nodes over the unit square, interpolated bilinearly; the outermost nodes lie on the
/// square's edges.
struct NodeGrids {
  std::size_t width = 0, height = 0;  ///< nodes, at least 2
  std::vector<float> values;          ///< one grid after the other, row by row, x running fastest

  std::size_t size_of_grid() const { return width * height; }
  std::size_t count() const { return values.size() / size_of_grid(); }
};

/// A measured BRDF in the adaptive parameterization of Dupuy & Jakob 2018, "An Adaptive Parameterization for Efficient
/// Material Acquisition and Rendering". All values are finite.
///
/// Incident directions lie on a grid of azimuths phi and elevations theta. For each of them, the square of outgoing
/// directions is warped by the distribution of normals visible from there (`vndf`), so that the reflectance is smooth
/// in the square. A normal has the position (sqrt(2 theta / pi), (phi + pi) / 2 pi) in the square, x first; for
/// isotropic surfaces phi is relative to the incident direction. Grids per incident direction are stored with theta
/// running faster than phi.
struct MeasuredData {
  std::vector<float> phi, theta;   ///< radians, ascending
  NodeGrids ndf;                   ///< density of normals per solid angle; >= 0
  NodeGrids sigma;                 ///< projected area of the microsurface, by viewing direction; > 0
  NodeGrids vndf;                  ///< by incident direction: density over the square of normals, up to a factor
  NodeGrids luminance;             ///< by incident direction: density over the warped square, up to a factor
  std::vector<float> wavelengths;  ///< nm, ascending; empty: three channels, linear Rec.709
  /// f cos(theta_o), times 4 sigma / ndf if `weighted`, over the warped square; by incident direction and, running
  /// faster, by wavelength or channel.
  NodeGrids reflectance;
  bool weighted = true;
  int symmetry = 1;  ///< 2: symmetric under half a turn, phi in [-pi, 0]; 4: mirror-symmetric, phi in [-pi, -pi/2]

  bool is_isotropic() const { return phi.size() <= 2; }
  std::size_t incidence_count() const { return phi.size() * theta.size(); }
  std::size_t channel_count() const { return wavelengths.empty() ? 3 : wavelengths.size(); }
};

}  // namespace lanthorn
