// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

namespace vantage {

// At most 6 × 6.
using SmallBlock = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

// A symmetric matrix of square blocks of one size, most of them 0.
struct SparseBlocks {
  struct Pair {
    std::size_t row, column;  // row > column; blocks of the same place add up
    SmallBlock block;
  };
  std::vector<SmallBlock> diagonal;
  std::vector<Pair> pairs;

  Eigen::MatrixXd dense() const;
};

// Parts of the inverse of a symmetric positive definite matrix, computed without the rest.
struct PartialInverse {
  std::vector<Eigen::MatrixXd> blocks;  // on its diagonal
  Eigen::MatrixXd times;                // inverse · right
};
// Returns these parts. A sparse factor takes one thread; a matrix that would fill up gets a dense factor, in parallel.
// Equal bits for any number of threads. REQUIRES: at least one block.
PartialInverse partial_inverse(const SparseBlocks& matrix, const Eigen::MatrixXd& right);

}  // namespace vantage
