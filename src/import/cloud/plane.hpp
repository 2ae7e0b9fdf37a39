// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "import/cloud/cell_grid.hpp"

namespace vantage::importer {

// The plane normal · x = offset, and the thickness and smaller width of its points: standard deviations in cells.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0, thickness = 0, width = 0;
};

// REQUIRES: moments of at least one point.
inline Plane plane_of(const Moments& moments) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments.covariance());
  Plane plane;
  plane.normal = solver.eigenvectors().col(0);
  if (!plane.normal.allFinite() || plane.normal.norm() < 0.5) plane.normal = Eigen::Vector3d::UnitZ();
  plane.offset = plane.normal.dot(moments.mean());
  plane.thickness = std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
  plane.width = std::sqrt(std::max(0.0, solver.eigenvalues()[1]));
  return plane;
}

}  // namespace vantage::importer
