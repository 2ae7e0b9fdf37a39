// SPDX-License-Identifier: Apache-2.0
#include "objective/sparse_covariance.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>

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

// Operations of a sparse factor that take as long as one of a dense one, in one thread.
constexpr double kSparseOperation = 10;
constexpr Eigen::Index kMostDenseRows = 16'000;  // 2 GB; more are left sparse
constexpr Eigen::Index kTile = 96;               // rows and columns of a dense matrix that one task works on

class SparseFactor : public Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> {
 public:
  // True if so many of its columns fill up that a dense factor takes less time. REQUIRES: analyzePattern() was called.
  bool fills_up() const {
    const auto rows = static_cast<double>(m_nonZerosPerCol.size());
    const double operations = m_nonZerosPerCol.cast<double>().squaredNorm();
    return m_nonZerosPerCol.size() <= kMostDenseRows && kSparseOperation * operations > rows * rows * rows / 3;
  }
};

// Calls each(begin, size) for the tiles of rows from `first` on, in parallel.
template <class Each>
void for_tiles(Eigen::Index first, Eigen::Index rows, const Each& each) {
  if (first >= rows) return;
  parallel::for_all(std::size_t{0}, static_cast<std::size_t>((rows - first + kTile - 1) / kTile), [&](std::size_t t) {
    const Eigen::Index begin = first + static_cast<Eigen::Index>(t) * kTile;
    each(begin, std::min(kTile, rows - begin));
  });
}

// L of A = L Lᵀ, tile by tile: the same bits on any number of threads. What is above the diagonal means nothing.
Eigen::MatrixXd dense_factor(const Eigen::SparseMatrix<double>& lower) {
  Eigen::MatrixXd a(lower);
  const Eigen::Index n = a.rows();
  for (Eigen::Index k = 0; k < n; k += kTile) {
    const Eigen::Index width = std::min(kTile, n - k), next = k + width;
    auto own = a.block(k, k, width, width);
    const Eigen::MatrixXd factor = own.llt().matrixL();
    own = factor;
    for_tiles(next, n, [&](Eigen::Index i, Eigen::Index size) {
      auto tile = a.block(i, k, size, width);
      factor.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(tile);
    });
    for_tiles(next, n, [&](Eigen::Index i, Eigen::Index size) {
      for (Eigen::Index j = next; j <= i; j += kTile) {
        const Eigen::Index wide = std::min(kTile, n - j);
        a.block(i, j, size, wide).noalias() -= a.block(i, k, size, width) * a.block(j, k, wide, width).transpose();
      }
    });
  }
  return a;
}

// Blocks of A⁻¹ = L⁻ᵀ L⁻¹ from columns of L⁻¹, which begin at the diagonal.
PartialInverse dense_inverse(const Eigen::SparseMatrix<double>& lower, Eigen::Index block,
                             const Eigen::MatrixXd& right) {
  const Eigen::MatrixXd factor = dense_factor(lower);
  const Eigen::Index n = factor.rows(), together = std::max(kTile / block, Eigen::Index{1}) * block;
  const auto l = [&](Eigen::Index from) {
    return factor.bottomRightCorner(n - from, n - from).triangularView<Eigen::Lower>();
  };
  PartialInverse found{.blocks = std::vector<Eigen::MatrixXd>(static_cast<std::size_t>(n / block)), .times = right};
  parallel::for_all(Eigen::Index{0}, right.cols(), [&](Eigen::Index k) {
    auto column = found.times.col(k);
    l(0).solveInPlace(column);
    factor.transpose().triangularView<Eigen::Upper>().solveInPlace(column);
  });
  parallel::for_all(Eigen::Index{0}, (n + together - 1) / together, [&](Eigen::Index t) {
    const Eigen::Index from = t * together, width = std::min(together, n - from);
    Eigen::MatrixXd columns = Eigen::MatrixXd::Identity(n - from, width);
    l(from).solveInPlace(columns);
    for (Eigen::Index at = 0; at < width; at += block) {
      const auto own = columns.block(at, at, n - from - at, block);
      found.blocks[static_cast<std::size_t>((from + at) / block)] = own.transpose() * own;
    }
  });
  return found;
}

}  // namespace

PartialInverse partial_inverse(const Eigen::SparseMatrix<double>& lower, Eigen::Index block,
                               const Eigen::MatrixXd& right) {
  SparseFactor factor;
  factor.analyzePattern(lower);
  if (factor.fills_up()) return dense_inverse(lower, block, right);
  factor.factorize(lower);
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
