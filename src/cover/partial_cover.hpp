// SPDX-License-Identifier: Apache-2.0
// Coverage of a set of candidates, updated as candidates come and go.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
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

// Coverage in whole numbers, so that sums of changes are exact: F is units / ColumnIndex::whole().
using CoverUnits = std::int64_t;

// Candidates of each element: the transposed matrix, with the coverage that an element's amounts give.
class ColumnIndex {
 public:
  struct Column {
    std::uint32_t candidate, amount;
  };
  struct Element {
    CoverUnits whole = 0, each = 0;  // when covered; per unit of amount
    std::uint64_t enough = 0;        // amount that covers it
    // Units that an amount covers by itself, and units that are still missing with it.
    CoverUnits by(std::uint64_t amount) const { return each * static_cast<CoverUnits>(std::min(amount, enough)); }
    CoverUnits missing(std::uint64_t amount) const { return std::max(whole - by(amount), CoverUnits{0}); }
  };
  explicit ColumnIndex(const CoverageMatrix& matrix);
  // Candidates of an element, rising.
  std::span<const Column> of(std::size_t element) const {
    return std::span(columns_).subspan(offsets_[element], offsets_[element + 1] - offsets_[element]);
  }
  Element element(std::size_t element) const { return elements_[element]; }
  double whole() const { return whole_; }

 private:
  std::vector<std::size_t> offsets_;
  std::vector<Column> columns_;
  std::vector<Element> elements_;
  double whole_ = 0;
};

// A set S, and the gain of each candidate to it. A change costs time in proportion to the matrix entries of the
// elements whose coverage it changes.
class CoverGains {
 public:
  // An element whose amount in S has changed.
  struct Change {
    std::uint32_t element;
    std::uint64_t had, has;
  };

  // Keeps references.
  CoverGains(const CoverageMatrix& matrix, const ColumnIndex& columns, std::span<const std::size_t> chosen);
  void add(std::size_t candidate);
  // Returns the changed elements that count; valid until the next call. REQUIRES: leaving in S
  std::span<const Change> replace(std::size_t leaving, std::size_t joining);

  const PartialCover& cover() const { return cover_; }
  CoverUnits value() const { return value_; }  // F(S)
  CoverUnits operator[](std::size_t candidate) const { return gains_[candidate]; }
  CoverUnits loss(std::size_t member) const;  // F(S) − F(S − member). REQUIRES: in S
  double share(CoverUnits units) const {
    return columns_.whole() > 0 ? static_cast<double>(units) / columns_.whole() : 0;
  }

  // Calls gained(k, d), perhaps several times for one k: its gain grows by the sum of d if `leaving` leaves S.
  template <class Gained>
  void for_gains_without(std::size_t leaving, const Gained& gained) const {
    for (const CoverageMatrix::Entry& one : matrix_.column(leaving)) {
      const std::uint64_t has = cover_.amount(one.element);
      const ColumnIndex::Element element = columns_.element(one.element);
      const CoverUnits then = element.missing(has - one.amount), now = element.missing(has);
      if (then == now) continue;  // covered without it, too
      for (const ColumnIndex::Column& other : columns_.of(one.element)) {
        const CoverUnits gives = element.by(other.amount);
        gained(other.candidate, std::min(gives, then) - std::min(gives, now));
      }
    }
  }

 private:
  void change_gains(std::size_t at, std::uint64_t had, std::uint64_t has);

  const CoverageMatrix& matrix_;
  const ColumnIndex& columns_;
  PartialCover cover_;
  CoverUnits value_ = 0;
  std::vector<CoverUnits> gains_;
  std::vector<Change> changes_;
};

}  // namespace vantage
