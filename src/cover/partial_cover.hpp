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

// A set S with the gains of all candidates to it, and the losses without each member. A change costs what the elements
// of one column touch: the rows of those whose coverage changes, and the members that have one of them.
class CoverGains {
 public:
  // Keeps references. REQUIRES: no candidate twice.
  CoverGains(const CoverageMatrix& matrix, const ColumnIndex& columns, std::span<const std::size_t> chosen = {});
  void add(std::size_t candidate);  // REQUIRES: not in S
  // Sets `more`, by candidate, to what each would gain more without a member; then the member leaves.
  void gains_without(std::size_t member, std::vector<double>& more) const;  // REQUIRES: in S
  void remove(std::size_t member, std::span<const double> more);

  const PartialCover& cover() const { return cover_; }
  double value() const { return value_; }  // F(S) as changes add up; cover().value() sums it anew
  double operator[](std::size_t candidate) const { return gains_[candidate]; }
  double loss(std::size_t member) const { return losses_[member]; }  // REQUIRES: in S

 private:
  // The change in the members' losses once an element has another amount.
  void change_losses(std::size_t element, double had, double has);
  double each(std::size_t element) const {
    return matrix_.weight(element) / matrix_.goal(element) / matrix_.total_weight();
  }

  const CoverageMatrix& matrix_;
  const ColumnIndex& columns_;
  PartialCover cover_;
  double value_ = 0;
  std::vector<double> gains_, losses_;                     // by candidate
  std::vector<std::vector<ColumnIndex::Column>> members_;  // by element
};

}  // namespace vantage
