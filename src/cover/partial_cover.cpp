// SPDX-License-Identifier: Apache-2.0
#include "cover/partial_cover.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/parallel.hpp"

namespace vantage {
namespace {

// Units for a coverage of 1: as many as leave room in 64 bits for sums and their changes.
constexpr double kCoverUnits = 0x1p60;
// Blocks of elements that are looked at side by side.
constexpr std::size_t kBlocks = 64;

}  // namespace

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

ColumnIndex::ColumnIndex(const CoverageMatrix& matrix) : offsets_(matrix.elements() + 1, 0) {
  // Each task looks at all candidates' entries in a block of elements, which no other task writes to.
  const auto each = [&](const auto& visit) {
    parallel::for_all(std::size_t{0}, kBlocks, [&](std::size_t block) {
      const std::size_t first = block * matrix.elements() / kBlocks, end = (block + 1) * matrix.elements() / kBlocks;
      if (first == end) return;
      for (std::size_t k = 0; k < matrix.candidates(); ++k) {
        const std::span<const CoverageMatrix::Entry> column = matrix.column(k);
        auto one = std::ranges::lower_bound(column, first, {}, &CoverageMatrix::Entry::element);
        for (; one != column.end() && one->element < end; ++one) visit(k, *one);
      }
    });
  };
  each([&](std::size_t, const CoverageMatrix::Entry& one) { ++offsets_[one.element + 1]; });
  std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
  columns_.resize(offsets_.back());
  std::vector<std::size_t> next(offsets_.begin(), offsets_.end() - 1);
  each([&](std::size_t k, const CoverageMatrix::Entry& one) {
    columns_[next[one.element]++] = {static_cast<std::uint32_t>(k), one.amount};
  });
  const double scale = matrix.total_weight() > 0 ? kCoverUnits / matrix.total_weight() : 0;
  elements_.reserve(matrix.elements());
  CoverUnits whole = 0;
  for (std::size_t e = 0; e < matrix.elements(); ++e) {
    const double weight = std::max(matrix.weight(e), 0.0) * scale;
    Element element;
    // Rounded up, so that an amount of `enough` covers the whole element.
    if (weight > 0)
      element = {.whole = std::llround(weight),
                 .each = static_cast<CoverUnits>(std::ceil(weight / std::max(matrix.goal(e), 1.0))),
                 .enough = static_cast<std::uint64_t>(std::ceil(matrix.goal(e)))};
    elements_.push_back(element);
    whole += element.whole;
  }
  whole_ = static_cast<double>(whole);
}

CoverGains::CoverGains(const CoverageMatrix& matrix, const ColumnIndex& columns, std::span<const std::size_t> chosen)
    : matrix_(matrix), columns_(columns), cover_(matrix, chosen), gains_(matrix.candidates()) {
  for (std::size_t e = 0; e < matrix.elements(); ++e) {
    const ColumnIndex::Element element = columns.element(e);
    value_ += element.whole - element.missing(cover_.amount(e));
  }
  parallel::for_all(std::size_t{0}, gains_.size(), [&](std::size_t k) {
    for (const CoverageMatrix::Entry& one : matrix.column(k)) {
      const ColumnIndex::Element element = columns.element(one.element);
      gains_[k] += std::min(element.by(one.amount), element.missing(cover_.amount(one.element)));
    }
  });
}

CoverUnits CoverGains::loss(std::size_t member) const {
  CoverUnits sum = 0;
  for (const CoverageMatrix::Entry& one : matrix_.column(member)) {
    const std::uint64_t has = cover_.amount(one.element);
    const ColumnIndex::Element element = columns_.element(one.element);
    sum += element.missing(has - one.amount) - element.missing(has);
  }
  return sum;
}

void CoverGains::change_gains(std::size_t at, std::uint64_t had, std::uint64_t has) {
  const ColumnIndex::Element element = columns_.element(at);
  const CoverUnits before = element.missing(had), now = element.missing(has);
  if (before == now) return;
  value_ += before - now;
  for (const ColumnIndex::Column& other : columns_.of(at)) {
    const CoverUnits gives = element.by(other.amount);
    gains_[other.candidate] += std::min(gives, now) - std::min(gives, before);
  }
}

void CoverGains::add(std::size_t candidate) {
  for (const CoverageMatrix::Entry& one : matrix_.column(candidate)) {
    const std::uint64_t had = cover_.amount(one.element);
    change_gains(one.element, had, had + one.amount);
  }
  cover_.add(candidate);
}

std::span<const CoverGains::Change> CoverGains::replace(std::size_t leaving, std::size_t joining) {
  changes_.clear();
  const auto change = [&](std::uint32_t element, std::uint32_t less, std::uint32_t more) {
    const std::uint64_t had = cover_.amount(element);
    if (less != more && columns_.element(element).whole > 0) changes_.push_back({element, had, had - less + more});
  };
  const std::span<const CoverageMatrix::Entry> left = matrix_.column(leaving);
  auto out = left.begin();
  for (const CoverageMatrix::Entry& in : matrix_.column(joining)) {
    for (; out != left.end() && out->element < in.element; ++out) change(out->element, out->amount, 0);
    const bool both = out != left.end() && out->element == in.element;
    change(in.element, both ? out->amount : 0, in.amount);
    if (both) ++out;
  }
  for (; out != left.end(); ++out) change(out->element, out->amount, 0);
  for (const Change& one : changes_) change_gains(one.element, one.had, one.has);
  cover_.remove(leaving), cover_.add(joining);
  return changes_;
}

}  // namespace vantage
