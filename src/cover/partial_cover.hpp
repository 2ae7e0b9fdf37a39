// SPDX-License-Identifier: Apache-2.0
// Coverage of a set of candidates, updated as candidates come and go.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vantage/cover.hpp"

namespace vantage {

// The amounts of a set S of candidates; a candidate may be in it more than once.
class PartialCover {
 public:
  // Keeps a reference to `matrix`.
  explicit PartialCover(const CoverageMatrix& matrix, std::span<const std::size_t> chosen = {});
  void add(std::size_t candidate);
  void remove(std::size_t candidate);        // REQUIRES: in S
  double gain(std::size_t candidate) const;  // F(S + candidate) − F(S)
  // The same for S with `added`, amounts by rising element.
  double gain(std::size_t candidate, std::span<const CoverageMatrix::Entry> added) const;
  double loss(std::size_t candidate) const;  // F(S) − F(S − candidate). REQUIRES: in S
  double value() const;                      // F(S), summed anew
  // How much of an element so much covers: min(amount / goal, 1).
  double covered(std::size_t element, std::uint64_t amount) const;
  std::uint64_t amount(std::size_t element) const { return amounts_[element]; }

 private:
  const CoverageMatrix& matrix_;
  std::vector<std::uint64_t> amounts_;
};

// Candidates of each element: the transposed matrix.
class ColumnIndex {
 public:
  struct Column {
    std::uint32_t candidate, amount;
  };
  // Keeps a reference to `matrix`.
  explicit ColumnIndex(const CoverageMatrix& matrix);
  // Candidates of an element, rising.
  std::span<const Column> of(std::size_t element) const {
    return std::span(columns_).subspan(offsets_[element], offsets_[element + 1] - offsets_[element]);
  }

 private:
  const CoverageMatrix& matrix_;
  std::vector<std::size_t> offsets_;
  std::vector<Column> columns_;
};

// A set S with the gains of all candidates to it. A change computes those anew that have an element whose coverage
// changed.
class CoverGains {
 public:
  // Keeps references.
  CoverGains(const CoverageMatrix& matrix, const ColumnIndex& columns, std::span<const std::size_t> chosen);
  void add(std::size_t candidate) { change({}, candidate); }
  void replace(std::size_t leaving, std::size_t joining) { change(leaving, joining); }  // REQUIRES: leaving in S

  const PartialCover& cover() const { return cover_; }
  double operator[](std::size_t candidate) const { return gains_[candidate]; }
  // Calls gained(k, d) for candidates k whose gain grows by d once `leaving` is not in S, in parts.
  template <class Gained>
  void for_gains_without(std::size_t leaving, const Gained& gained) const {
    if (matrix_.total_weight() <= 0) return;
    for (const CoverageMatrix::Entry& one : matrix_.column(leaving)) {
      const std::uint64_t has = cover_.amount(one.element), left = has - one.amount;
      if (static_cast<double>(left) >= matrix_.goal(one.element)) continue;  // covered without it, too
      const double share = matrix_.weight(one.element) / matrix_.total_weight();
      const double lost = cover_.covered(one.element, has) - cover_.covered(one.element, left);
      for (const ColumnIndex::Column& other : columns_.of(one.element))
        gained(other.candidate, share * (lost - (cover_.covered(one.element, has + other.amount) -
                                                 cover_.covered(one.element, left + other.amount))));
    }
  }

 private:
  void change(std::optional<std::size_t> leaving, std::size_t joining);

  const CoverageMatrix& matrix_;
  const ColumnIndex& columns_;
  PartialCover cover_;
  std::vector<double> gains_;
};

}  // namespace vantage
