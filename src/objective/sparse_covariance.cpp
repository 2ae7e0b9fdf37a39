// SPDX-License-Identifier: Apache-2.0
#include "objective/sparse_covariance.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <utility>

#include "core/parallel.hpp"

namespace vantage {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// Operations of a dense factor, which many threads share, that cost as much as one of a sparse factor, which one thread
// makes.
constexpr double kSparseOperation = 2;
constexpr Index kMostDenseRows = 16'000;  // 2 GB; more are left sparse
// Least share of the rows of a supernode's last column that its first column needs.
constexpr double kAlike = 0.75;
constexpr Index kTile = 96;  // rows and columns of a dense matrix that one task works on

// Block columns of a factor that are eliminated together, since they have almost the same nonzero rows.
struct Supernode {
  std::size_t first, columns;       // in the order of elimination
  std::vector<std::size_t> places;  // of the nonzero rows, ascending: those of its own columns first
};

struct Elimination {
  std::vector<std::size_t> place;      // of each block of the matrix in the order of elimination
  std::vector<Supernode> supernodes;   // one after the other
  std::vector<std::size_t> supernode;  // of each place

  // Returns the number of products of blocks that the factor takes.
  double products() const {
    double sum = 0;
    for (const Supernode& some : supernodes)
      sum += 0.5 * static_cast<double>(some.columns * some.places.size() * some.places.size());
    return sum;
  }
};

std::vector<std::size_t> fill_reducing_order(const SparseBlocks& matrix) {
  std::vector<Eigen::Triplet<double>> ties;
  const auto add = [&](std::size_t row, std::size_t column) {
    ties.emplace_back(static_cast<int>(row), static_cast<int>(column), 1);
  };
  // Eigen takes a column without a diagonal for one that is tied to all others, and orders nothing.
  for (std::size_t k = 0; k < matrix.diagonal.size(); ++k) add(k, k);
  for (const SparseBlocks::Pair& pair : matrix.pairs) add(pair.row, pair.column), add(pair.column, pair.row);
  const auto n = static_cast<Index>(matrix.diagonal.size());
  Eigen::SparseMatrix<double> graph(n, n);
  graph.setFromTriplets(ties.begin(), ties.end());
  Eigen::AMDOrdering<int>::PermutationType order;
  Eigen::AMDOrdering<int>()(graph, order);
  return {order.indices().begin(), order.indices().end()};
}

Elimination eliminate(const SparseBlocks& matrix) {
  const std::vector<std::size_t> order = fill_reducing_order(matrix);
  const std::size_t n = order.size();
  Elimination found{.place = std::vector<std::size_t>(n), .supernodes = {}, .supernode = std::vector<std::size_t>(n)};
  for (std::size_t k = 0; k < n; ++k) found.place[order[k]] = k;
  std::vector<std::vector<std::size_t>> below(n);  // the diagonal of each column
  for (const SparseBlocks::Pair& pair : matrix.pairs) {
    const auto [first, last] = std::minmax(found.place[pair.row], found.place[pair.column]);
    below[first].push_back(last);
  }
  for (std::vector<std::size_t>& rows : below) {
    std::ranges::sort(rows);
    rows.erase(std::ranges::unique(rows).begin(), rows.end());
    // A column, once eliminated, passes its rows on to the first of them.
    if (rows.size() > 1) below[rows.front()].insert(below[rows.front()].end(), rows.begin() + 1, rows.end());
  }
  for (std::size_t first = 0, end; first < n; first = end) {
    const auto alike = [&](std::size_t next) {
      const double own = static_cast<double>(below[first].size()) - static_cast<double>(next - first);
      return below[next - 1].size() > 0 && below[next - 1].front() == next &&
             own >= kAlike * static_cast<double>(below[next].size());
    };
    for (end = first + 1; end < n && alike(end);) ++end;
    Supernode& own = found.supernodes.emplace_back(first, end - first, std::vector<std::size_t>());
    for (std::size_t k = first; k < end; ++k) {
      own.places.push_back(k);
      found.supernode[k] = found.supernodes.size() - 1;
    }
    own.places.insert(own.places.end(), below[end - 1].begin(), below[end - 1].end());
  }
  return found;
}

// L of P A Pᵀ = L Lᵀ by supernodes (George and Liu: Computer Solution of Large Sparse Positive Definite Systems, 1981).
class SparseFactor {
 public:
  SparseFactor(const SparseBlocks& matrix, const Elimination& elimination)
      : elimination_(elimination), size_(matrix.diagonal.front().rows()) {
    for (const Supernode& some : elimination.supernodes)
      columns_.emplace_back(MatrixXd::Zero(rows(some.places.size()), rows(some.columns)));
    for (std::size_t k = 0; k < matrix.diagonal.size(); ++k)
      block(columns_, elimination.place[k], elimination.place[k]) = matrix.diagonal[k];
    for (const SparseBlocks::Pair& pair : matrix.pairs) {
      const std::size_t row = elimination.place[pair.row], column = elimination.place[pair.column];
      if (row > column)
        block(columns_, row, column) += pair.block;
      else
        block(columns_, column, row) += pair.block.transpose();
    }
    for (std::size_t k = 0; k < columns_.size(); ++k) factorise(k);
  }

  PartialInverse partial_inverse(const MatrixXd& right) const {
    std::vector<MatrixXd> inverse = this->inverse();
    PartialInverse found{.blocks = {}, .times = MatrixXd(right.rows(), right.cols())};
    MatrixXd in_order(right.rows(), right.cols());
    const auto n = elimination_.place.size();
    for (std::size_t k = 0; k < n; ++k)
      in_order.middleRows(rows(elimination_.place[k]), size_) = right.middleRows(rows(k), size_);
    solve(in_order);
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t place = elimination_.place[k];
      found.times.middleRows(rows(k), size_) = in_order.middleRows(rows(place), size_);
      found.blocks.emplace_back(block(inverse, place, place));
    }
    return found;
  }

 private:
  Index rows(std::size_t blocks) const { return static_cast<Index>(blocks) * size_; }

  // Returns a block of columns stored by supernodes. REQUIRES: column <= row, not 0 in the factor.
  Eigen::Block<MatrixXd> block(std::vector<MatrixXd>& columns, std::size_t row, std::size_t column) const {
    const std::size_t k = elimination_.supernode[column];
    const Supernode& own = elimination_.supernodes[k];
    const auto at = std::ranges::lower_bound(own.places, row) - own.places.begin();
    return columns[k].block(rows(static_cast<std::size_t>(at)), rows(column - own.first), size_, size_);
  }

  // Calls each(later, c, count, at) for each later supernode of which supernode k has rows. `count` of its columns are
  // at the places of k from c on; it stores the row of place c + r at at[r].
  template <class Each>
  void for_later(std::size_t k, const Each& each) const {
    const std::vector<std::size_t>& places = elimination_.supernodes[k].places;
    std::vector<std::size_t> at;
    for (std::size_t c = elimination_.supernodes[k].columns, end; c < places.size(); c = end) {
      const std::size_t later = elimination_.supernode[places[c]];
      const Supernode& other = elimination_.supernodes[later];
      for (end = c; end < places.size() && places[end] < other.first + other.columns;) ++end;
      at.clear();
      for (std::size_t r = c, place = 0; r < places.size(); ++r) {
        while (other.places[place] != places[r]) ++place;
        at.push_back(place);
      }
      each(later, c, end - c, at);
    }
  }

  void factorise(std::size_t k) {
    const Supernode& own = elimination_.supernodes[k];
    MatrixXd& column = columns_[k];
    const Index width = column.cols(), rest = column.rows() - width;
    const MatrixXd diagonal = column.topRows(width).llt().matrixL();
    column.topRows(width) = diagonal;
    if (rest == 0) return;
    auto below = column.bottomRows(rest);
    diagonal.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(below);
    MatrixXd change;
    for_later(k, [&](std::size_t later, std::size_t c, std::size_t count, const std::vector<std::size_t>& at) {
      const Index from = rows(c - own.columns);
      change.noalias() = below.bottomRows(rest - from) * below.middleRows(from, rows(count)).transpose();
      for (std::size_t j = 0; j < count; ++j)
        for (std::size_t r = j; r < at.size(); ++r)
          columns_[later].block(rows(at[r]), rows(at[j]), size_, size_) -= change.block(rows(r), rows(j), size_, size_);
    });
  }

  // Solves A⁻¹ right, with rows in the order of elimination.
  void solve(MatrixXd& right) const {
    const auto for_below = [&](const Supernode& own, const auto& each) {
      for (std::size_t r = own.columns; r < own.places.size(); ++r)
        each(rows(r - own.columns), right.middleRows(rows(own.places[r]), size_));
    };
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const Supernode& some = elimination_.supernodes[k];
      const Index width = columns_[k].cols();
      auto own = right.middleRows(rows(some.first), width);
      columns_[k].topRows(width).triangularView<Eigen::Lower>().solveInPlace(own);
      const MatrixXd change = columns_[k].bottomRows(columns_[k].rows() - width) * own;
      for_below(some, [&](Index at, auto below) { below -= change.middleRows(at, size_); });
    }
    for (std::size_t k = columns_.size(); k-- > 0;) {
      const Supernode& some = elimination_.supernodes[k];
      const Index width = columns_[k].cols(), rest = columns_[k].rows() - width;
      MatrixXd known(rest, right.cols());
      for_below(some, [&](Index at, auto below) { known.middleRows(at, size_) = below; });
      auto own = right.middleRows(rows(some.first), width);
      own.noalias() -= columns_[k].bottomRows(rest).transpose() * known;
      columns_[k].topRows(width).transpose().triangularView<Eigen::Upper>().solveInPlace(own);
    }
  }

  // Returns the blocks of A⁻¹ at the nonzero blocks of L, from the last column on (Takahashi, Fagan and Chin: Formation
  // of a sparse bus impedance matrix, 1973). With U = L below the diagonal · its inverse: Z below = −Z U, and Z on the
  // diagonal = (L Lᵀ)⁻¹ − Uᵀ Z below.
  std::vector<MatrixXd> inverse() const {
    std::vector<MatrixXd> found(columns_.size());
    for (std::size_t k = columns_.size(); k-- > 0;) {
      const Index width = columns_[k].cols(), rest = columns_[k].rows() - width;
      MatrixXd among(rest, rest);  // the inverse at the rows below, its lower triangle
      for_later(k, [&](std::size_t later, std::size_t c, std::size_t count, const std::vector<std::size_t>& at) {
        const std::size_t from = c - elimination_.supernodes[k].columns;
        for (std::size_t j = 0; j < count; ++j)
          for (std::size_t r = j; r < at.size(); ++r)
            among.block(rows(from + r), rows(from + j), size_, size_) =
                found[later].block(rows(at[r]), rows(at[j]), size_, size_);
      });
      const auto diagonal = columns_[k].topRows(width).triangularView<Eigen::Lower>();
      MatrixXd own = MatrixXd::Identity(width, width);
      diagonal.solveInPlace(own);
      found[k].resize(width + rest, width);
      found[k].topRows(width).noalias() = own.transpose() * own;
      if (rest == 0) continue;
      const MatrixXd unit = columns_[k].bottomRows(rest) * own;
      found[k].bottomRows(rest).noalias() = among.selfadjointView<Eigen::Lower>() * -unit;
      found[k].topRows(width).noalias() -= unit.transpose() * found[k].bottomRows(rest);
    }
    return found;
  }

  const Elimination& elimination_;
  Index size_;
  std::vector<MatrixXd> columns_;  // of each supernode, the rows of its places
};

// Calls each(begin, size) for the tiles of rows from `first` on, in parallel.
template <class Each>
void for_tiles(Index first, Index rows, const Each& each) {
  if (first >= rows) return;
  parallel::for_all(std::size_t{0}, static_cast<std::size_t>((rows - first + kTile - 1) / kTile), [&](std::size_t t) {
    const Index begin = first + static_cast<Index>(t) * kTile;
    each(begin, std::min(kTile, rows - begin));
  });
}

// Returns L of A = L Lᵀ, computed by tiles, with equal bits for any number of threads. Ignore its upper triangle.
MatrixXd dense_factor(MatrixXd a) {
  const Index n = a.rows();
  for (Index k = 0; k < n; k += kTile) {
    const Index width = std::min(kTile, n - k), next = k + width;
    auto own = a.block(k, k, width, width);
    const MatrixXd factor = own.llt().matrixL();
    own = factor;
    for_tiles(next, n, [&](Index i, Index size) {
      auto tile = a.block(i, k, size, width);
      factor.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(tile);
    });
    for_tiles(next, n, [&](Index i, Index size) {
      for (Index j = next; j <= i; j += kTile) {
        const Index wide = std::min(kTile, n - j);
        a.block(i, j, size, wide).noalias() -= a.block(i, k, size, width) * a.block(j, k, wide, width).transpose();
      }
    });
  }
  return a;
}

// Returns blocks of A⁻¹ = L⁻ᵀ L⁻¹ from columns of L⁻¹, which begin at the diagonal.
PartialInverse dense_inverse(const SparseBlocks& matrix, const MatrixXd& right) {
  const MatrixXd factor = dense_factor(matrix.dense());
  const Index block = matrix.diagonal.front().rows(), n = factor.rows();
  const Index together = std::max(kTile / block, Index{1}) * block;
  const auto l = [&](Index from) {
    return factor.bottomRightCorner(n - from, n - from).triangularView<Eigen::Lower>();
  };
  PartialInverse found{.blocks = std::vector<MatrixXd>(matrix.diagonal.size()), .times = right};
  parallel::for_all(Index{0}, right.cols(), [&](Index k) {
    auto column = found.times.col(k);
    l(0).solveInPlace(column);
    factor.transpose().triangularView<Eigen::Upper>().solveInPlace(column);
  });
  parallel::for_all(Index{0}, (n + together - 1) / together, [&](Index t) {
    const Index from = t * together, width = std::min(together, n - from);
    MatrixXd columns = MatrixXd::Identity(n - from, width);
    l(from).solveInPlace(columns);
    for (Index at = 0; at < width; at += block) {
      const auto own = columns.block(at, at, n - from - at, block);
      found.blocks[static_cast<std::size_t>((from + at) / block)] = own.transpose() * own;
    }
  });
  return found;
}

}  // namespace

MatrixXd SparseBlocks::dense() const {
  const Index size = diagonal.front().rows(), n = static_cast<Index>(diagonal.size()) * size;
  MatrixXd all = MatrixXd::Zero(n, n);
  const auto block = [&](std::size_t row, std::size_t column) {
    return all.block(static_cast<Index>(row) * size, static_cast<Index>(column) * size, size, size);
  };
  for (std::size_t k = 0; k < diagonal.size(); ++k) block(k, k) = diagonal[k];
  for (const Pair& pair : pairs) {
    block(pair.row, pair.column) += pair.block;
    block(pair.column, pair.row) += pair.block.transpose();
  }
  return all;
}

PartialInverse partial_inverse(const SparseBlocks& matrix, const MatrixXd& right) {
  const Elimination elimination = eliminate(matrix);
  const auto n = static_cast<double>(matrix.diagonal.size());
  if (right.rows() <= kMostDenseRows && kSparseOperation * elimination.products() > n * n * n / 6)
    return dense_inverse(matrix, right);
  return SparseFactor(matrix, elimination).partial_inverse(right);
}

}  // namespace vantage
