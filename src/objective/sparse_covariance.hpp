// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

namespace vantage {

// At most 6 × 6.
using SmallBlock = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

// A symmetric matrix of square blocks of one size, of which most are 0.
struct SparseBlocks {
  struct Pair {
    std::size_t row, column;  // row > column; blocks of the same place add up
    SmallBlock block;
  };
  std::vector<SmallBlock> diagonal;
  std::vector<Pair> pairs;

  Eigen::MatrixXd dense() const;
};

// Parts of the inverse of a symmetric positive definite matrix, without the rest of it.
struct PartialInverse {
  std::vector<Eigen::MatrixXd> blocks;  // on its diagonal
  Eigen::MatrixXd times;                // inverse · right
};
// A sparse factor takes one thread; a matrix that would fill up is factorised as a dense one, in parallel. The same
// bits on any number of threads. REQUIRES: at least one block.
PartialInverse partial_inverse(const SparseBlocks& matrix, const Eigen::MatrixXd& right);

}  // namespace vantage
