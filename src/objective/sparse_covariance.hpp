// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <vector>

namespace vantage {

// Parts of the inverse of a sparse symmetric positive definite matrix, without the rest of it.
struct PartialInverse {
  std::vector<Eigen::MatrixXd> blocks;  // the blocks of `block` rows on its diagonal
  Eigen::MatrixXd times;                // inverse · right
};
// `lower`: the matrix's lower triangle. Each block by a forward substitution of its own, in parallel; a matrix that
// would fill up is factorised as a dense one, in parallel too. REQUIRES: rows a multiple of `block`.
PartialInverse partial_inverse(const Eigen::SparseMatrix<double>& lower, Eigen::Index block,
                               const Eigen::MatrixXd& right);

}  // namespace vantage
