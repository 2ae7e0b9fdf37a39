// SPDX-License-Identifier: Apache-2.0
// Redraws some coordinates of a normal vector, given the others.
#pragma once

#include <Eigen/Dense>

#include "optimise/normal_stream.hpp"

namespace vantage::optimise {

// For N(0, C) with whitening matrix W (Wᵀ W = C⁻¹): `columns` are the columns of W for the coordinates, `rest` is W
// times the vector with those coordinates set to 0. The precision of the coordinates is columnsᵀ columns, and their
// mean given the others minus its inverse times columnsᵀ rest.
inline Eigen::VectorXd draw_conditional(const Eigen::MatrixXd& columns, const Eigen::VectorXd& rest,
                                        NormalStream& random) {
  Eigen::VectorXd normals(columns.cols());
  random.fill_normal({normals.data(), static_cast<std::size_t>(normals.size())});
  // Precision = Rᵀ R by QR of the columns, which does not square their condition number.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::VectorXd projected = (qr.householderQ().adjoint() * rest).head(columns.cols());
  return qr.matrixQR().topRows(columns.cols()).triangularView<Eigen::Upper>().solve(normals - projected);
}

}  // namespace vantage::optimise
