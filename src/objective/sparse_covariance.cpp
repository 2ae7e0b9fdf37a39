// SPDX-License-Identifier: Apache-2.0
#include "objective/sparse_covariance.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cassert>

namespace vantage {
namespace {

// Inverse of P A Pᵀ = L D Lᵀ on the pattern of L, column by column from the last.
class InverseOnPattern {
 public:
  template <class Factor>
  explicit InverseOnPattern(const Factor& factor) : lower_(factor.matrixL().nestedExpression()) {
    const Eigen::VectorXd pivots = factor.vectorD();
    values_.resize(static_cast<std::size_t>(lower_.nonZeros()));
    diagonal_.resize(pivots.size());
    std::vector<Eigen::Index> place(static_cast<std::size_t>(lower_.rows()), -1);  // of each row in the column at hand
    std::vector<double> sums;
    for (Eigen::Index j = lower_.cols(); j-- > 0;) {
      const Eigen::Index first = begin(j), count = end(j) - first;
      for (Eigen::Index a = 0; a < count; ++a) place[at(row(first + a))] = a;
      sums.assign(at(count), 0);
      // Column k of the inverse holds what rows below k share with it.
      for (Eigen::Index b = 0; b < count; ++b) {
        const Eigen::Index k = row(first + b);
        const double factor_kj = lower_.valuePtr()[first + b];
        sums[at(b)] += diagonal_[k] * factor_kj;
        for (Eigen::Index e = begin(k); e < end(k); ++e) {
          const Eigen::Index a = place[at(row(e))];
          if (a < 0) continue;
          sums[at(a)] += values_[at(e)] * factor_kj;
          sums[at(b)] += values_[at(e)] * lower_.valuePtr()[first + a];
        }
      }
      double own = 1 / pivots[j];
      for (Eigen::Index a = 0; a < count; ++a) {
        values_[at(first + a)] = -sums[at(a)];
        own += lower_.valuePtr()[first + a] * sums[at(a)];
        place[at(row(first + a))] = -1;
      }
      diagonal_[j] = own;
    }
  }

  // REQUIRES: on the pattern.
  double operator()(Eigen::Index i, Eigen::Index j) const {
    if (i == j) return diagonal_[i];
    if (i < j) std::swap(i, j);
    const auto* rows = lower_.innerIndexPtr();
    const auto* found = std::lower_bound(rows + begin(j), rows + end(j), i);
    assert(found != rows + end(j) && *found == i);
    return values_[at(found - rows)];
  }

 private:
  static std::size_t at(Eigen::Index index) { return static_cast<std::size_t>(index); }
  Eigen::Index begin(Eigen::Index column) const { return lower_.outerIndexPtr()[column]; }
  Eigen::Index end(Eigen::Index column) const { return lower_.outerIndexPtr()[column + 1]; }
  Eigen::Index row(Eigen::Index entry) const { return lower_.innerIndexPtr()[entry]; }

  Eigen::SparseMatrix<double> lower_;  // L below its diagonal of ones, rows rising
  std::vector<double> values_;         // of the inverse, by entry of L
  Eigen::VectorXd diagonal_;
};

}  // namespace

PartialInverse partial_inverse(const Eigen::SparseMatrix<double>& lower, Eigen::Index block,
                               const Eigen::MatrixXd& right) {
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(lower);
  PartialInverse found{.blocks = {}, .times = factor.solve(right)};
  const InverseOnPattern inverse(factor);
  const auto& places = factor.permutationP().indices();
  for (Eigen::Index first = 0; first < lower.rows(); first += block) {
    Eigen::MatrixXd& own = found.blocks.emplace_back(block, block);
    for (Eigen::Index i = 0; i < block; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) own(i, j) = own(j, i) = inverse(places[first + i], places[first + j]);
  }
  return found;
}

}  // namespace vantage
