// SPDX-License-Identifier: Apache-2.0
// Coverage of a set of candidates, updated as candidates come and go.
#pragma once

#include <cstddef>
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
  double loss(std::size_t candidate) const;  // F(S) − F(S − candidate). REQUIRES: in S
  double value() const;                      // F(S), summed anew
  // How much of an element so much covers: min(amount / goal, 1).
  double covered(std::size_t element, std::uint64_t amount) const;
  std::uint64_t amount(std::size_t element) const { return amounts_[element]; }

 private:
  const CoverageMatrix& matrix_;
  std::vector<std::uint64_t> amounts_;
};

// Candidates of each element: the transposed matrix. A swap is evaluated over the elements that need the leaving
// candidate instead of over whole columns.
class ColumnIndex {
 public:
  // Keeps a reference to `matrix`.
  explicit ColumnIndex(const CoverageMatrix& matrix);
  // `gains` are F(S + k) − F(S) of all candidates k. Changes them to F(S − leaving + k) − F(S − leaving). REQUIRES: S
  // has `leaving`, gains.size() == candidates().
  void add_gains_without(std::size_t leaving, const PartialCover& cover, std::span<double> gains) const;

 private:
  struct Column {
    std::uint32_t candidate, amount;
  };
  const CoverageMatrix& matrix_;
  std::vector<std::size_t> offsets_;
  std::vector<Column> columns_;
};

}  // namespace vantage
