// SPDX-License-Identifier: Apache-2.0
#include "objective/sparse_covariance.hpp"

#include <Eigen/SparseCholesky>

#include "core/parallel.hpp"

namespace vantage {
namespace {

// The block of the inverse of A = Pᵀ L D Lᵀ P at `rows`, the places of its rows in P A Pᵀ: E A⁻¹ Eᵀ = Y D⁻¹ Yᵀ with
// Y = E Pᵀ L⁻ᵀ. Column by column of L from the first of the rows on; all columns before it are 0.
template <int Rows>
Eigen::MatrixXd inverse_block(const Eigen::SparseMatrix<double>& lower, const Eigen::VectorXd& pivots,
                              const Eigen::Ref<const Eigen::VectorXi>& rows) {
  using Columns = Eigen::Matrix<double, Rows, Eigen::Dynamic>;
  Columns y = Columns::Zero(rows.size(), lower.rows());
  for (Eigen::Index i = 0; i < rows.size(); ++i) y(i, rows[i]) = 1;
  Eigen::Matrix<double, Rows, Rows> inverse = Eigen::Matrix<double, Rows, Rows>::Zero(rows.size(), rows.size());
  for (Eigen::Index j = rows.minCoeff(); j < lower.rows(); ++j) {
    const Eigen::Matrix<double, Rows, 1> own = y.col(j);
    if ((own.array() == 0).all()) continue;
    inverse.noalias() += own * (own / pivots[j]).transpose();
    for (Eigen::SparseMatrix<double>::InnerIterator below(lower, j); below; ++below)
      y.col(below.row()) -= below.value() * own;
  }
  return inverse;
}

}  // namespace

PartialInverse partial_inverse(const Eigen::SparseMatrix<double>& lower, Eigen::Index block,
                               const Eigen::MatrixXd& right) {
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(lower);
  PartialInverse found{.blocks = {}, .times = factor.solve(right)};
  const Eigen::SparseMatrix<double> l = factor.matrixL().nestedExpression();  // below its diagonal of ones
  const Eigen::VectorXd pivots = factor.vectorD();
  const auto& places = factor.permutationP().indices();
  found.blocks.resize(static_cast<std::size_t>(lower.rows() / block));
  parallel::for_all(std::size_t{0}, found.blocks.size(), [&](std::size_t k) {
    const Eigen::VectorXi rows = places.segment(static_cast<Eigen::Index>(k) * block, block);
    found.blocks[k] = block == 6   ? inverse_block<6>(l, pivots, rows)
                      : block == 4 ? inverse_block<4>(l, pivots, rows)
                                   : inverse_block<Eigen::Dynamic>(l, pivots, rows);
  });
  return found;
}

}  // namespace vantage
