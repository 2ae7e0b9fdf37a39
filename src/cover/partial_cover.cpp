// SPDX-License-Identifier: Apache-2.0
#include "cover/partial_cover.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/parallel.hpp"

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

double PartialCover::gain(std::size_t candidate) const { return gain(candidate, {}); }

double PartialCover::gain(std::size_t candidate, std::span<const CoverageMatrix::Entry> added) const {
  double sum = 0;
  auto next = added.begin();
  for (const CoverageMatrix::Entry& one : matrix_.column(candidate)) {
    std::uint64_t has = amounts_[one.element];
    while (next != added.end() && next->element < one.element) ++next;
    if (next != added.end() && next->element == one.element) has += next->amount;
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

CoverGains::CoverGains(const CoverageMatrix& matrix, const ColumnIndex& columns, std::span<const std::size_t> chosen)
    : matrix_(matrix), columns_(columns), cover_(matrix, chosen), gains_(matrix.candidates()) {
  parallel::for_all(std::size_t{0}, gains_.size(), [&](std::size_t k) { gains_[k] = cover_.gain(k); });
}

void CoverGains::change(std::optional<std::size_t> leaving, std::size_t joining) {
  std::vector<std::pair<std::uint32_t, std::uint64_t>> before;  // amounts of elements
  const auto remember = [&](std::size_t candidate) {
    for (const CoverageMatrix::Entry& one : matrix_.column(candidate))
      before.emplace_back(one.element, cover_.amount(one.element));
  };
  if (leaving) remember(*leaving);
  remember(joining);
  if (leaving) cover_.remove(*leaving);
  cover_.add(joining);
  std::vector<char> changed(gains_.size(), 0);
  for (const auto& [element, had] : before) {
    const std::uint64_t has = cover_.amount(element);
    if (has == had || static_cast<double>(std::min(has, had)) >= matrix_.goal(element)) continue;
    for (const ColumnIndex::Column& one : columns_.of(element)) changed[one.candidate] = 1;
  }
  parallel::for_all(std::size_t{0}, gains_.size(), [&](std::size_t k) {
    if (changed[k]) gains_[k] = cover_.gain(k);
  });
}

}  // namespace vantage
