// SPDX-License-Identifier: Apache-2.0
#include "cover/partial_cover.hpp"

#include <numeric>

namespace vantage {

PartialCover::PartialCover(const CoverageMatrix& matrix, std::span<const std::size_t> chosen)
    : matrix_(matrix), amounts_(matrix.elements()) {
  for (const std::size_t candidate : chosen) add(candidate);
}

double PartialCover::covered(std::size_t element, std::uint64_t amount) const {
  const double share = static_cast<double>(amount) / matrix_.goal(element);
  return share < 1 ? share : 1;
}

void PartialCover::add(std::size_t candidate) {
  for (const CoverageMatrix::Entry& one : matrix_.column(candidate)) amounts_[one.element] += one.amount;
}

void PartialCover::remove(std::size_t candidate) {
  for (const CoverageMatrix::Entry& one : matrix_.column(candidate)) amounts_[one.element] -= one.amount;
}

double PartialCover::gain(std::size_t candidate) const {
  double sum = 0;
  for (const CoverageMatrix::Entry& one : matrix_.column(candidate)) {
    const std::uint64_t has = amounts_[one.element];
    if (static_cast<double>(has) >= matrix_.goal(one.element)) continue;
    sum += matrix_.weight(one.element) * (covered(one.element, has + one.amount) - covered(one.element, has));
  }
  return matrix_.total_weight() > 0 ? sum / matrix_.total_weight() : 0;
}

double PartialCover::loss(std::size_t candidate) const {
  double sum = 0;
  for (const CoverageMatrix::Entry& one : matrix_.column(candidate)) {
    const std::uint64_t has = amounts_[one.element];
    sum += matrix_.weight(one.element) * (covered(one.element, has) - covered(one.element, has - one.amount));
  }
  return matrix_.total_weight() > 0 ? sum / matrix_.total_weight() : 0;
}

double PartialCover::value() const {
  double sum = 0;
  for (std::size_t e = 0; e < amounts_.size(); ++e) sum += matrix_.weight(e) * covered(e, amounts_[e]);
  return matrix_.total_weight() > 0 ? sum / matrix_.total_weight() : 0;
}

ColumnIndex::ColumnIndex(const CoverageMatrix& matrix) : matrix_(matrix), offsets_(matrix.elements() + 1, 0) {
  for (std::size_t k = 0; k < matrix.candidates(); ++k)
    for (const CoverageMatrix::Entry& one : matrix.column(k)) ++offsets_[one.element + 1];
  std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
  columns_.resize(offsets_.back());
  std::vector<std::size_t> next(offsets_.begin(), offsets_.end() - 1);
  for (std::size_t k = 0; k < matrix.candidates(); ++k)
    for (const CoverageMatrix::Entry& one : matrix.column(k))
      columns_[next[one.element]++] = {static_cast<std::uint32_t>(k), one.amount};
}

void ColumnIndex::add_gains_without(std::size_t leaving, const PartialCover& cover, std::span<double> gains) const {
  if (matrix_.total_weight() <= 0) return;
  for (const CoverageMatrix::Entry& one : matrix_.column(leaving)) {
    const std::uint64_t has = cover.amount(one.element), left = has - one.amount;
    if (static_cast<double>(left) >= matrix_.goal(one.element)) continue;  // covered without it, too
    const double share = matrix_.weight(one.element) / matrix_.total_weight();
    const double lost = cover.covered(one.element, has) - cover.covered(one.element, left);
    for (std::size_t k = offsets_[one.element]; k < offsets_[one.element + 1]; ++k) {
      const Column& other = columns_[k];
      gains[other.candidate] +=
          share *
          (lost - (cover.covered(one.element, has + other.amount) - cover.covered(one.element, left + other.amount)));
    }
  }
}

}  // namespace vantage
