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
    : matrix_(matrix),
      columns_(columns),
      cover_(matrix, chosen),
      value_(cover_.value()),
      gains_(matrix.candidates()),
      losses_(matrix.candidates(), 0),
      members_(matrix.elements()) {
  for (const std::size_t k : chosen) {
    losses_[k] = cover_.loss(k);
    for (const CoverageMatrix::Entry& one : matrix.column(k))
      members_[one.element].push_back({static_cast<std::uint32_t>(k), one.amount});
  }
  parallel::for_all(std::size_t{0}, gains_.size(), [&](std::size_t k) { gains_[k] = cover_.gain(k); });
}

void CoverGains::change_losses(std::size_t element, double had, double has) {
  const double goal = matrix_.goal(element), each = this->each(element);
  for (const ColumnIndex::Column& member : members_[element]) {
    // A member is missed as far as the others leave its amount open.
    const double amount = member.amount;
    const auto missed = [&](double all) { return std::clamp(goal - (all - amount), 0.0, amount); };
    losses_[member.candidate] += each * (missed(has) - missed(had));
  }
}

void CoverGains::add(std::size_t candidate) {
  value_ += losses_[candidate] = gains_[candidate];
  for (const CoverageMatrix::Entry& one : matrix_.column(candidate)) {
    const double goal = matrix_.goal(one.element), had = static_cast<double>(cover_.amount(one.element)),
                 has = had + one.amount;
    if (matrix_.weight(one.element) <= 0) continue;
    change_losses(one.element, had, has);
    members_[one.element].push_back({static_cast<std::uint32_t>(candidate), one.amount});
    if (had >= goal) continue;
    const double before = goal - had, now = std::max(goal - has, 0.0), each = this->each(one.element);
    for (const ColumnIndex::Column& other : columns_.of(one.element)) {
      const double amount = other.amount;
      gains_[other.candidate] += each * (std::min(amount, now) - std::min(amount, before));
    }
  }
  cover_.add(candidate);
}

void CoverGains::gains_without(std::size_t member, std::vector<double>& more) const {
  more.assign(gains_.size(), 0);
  for (const CoverageMatrix::Entry& one : matrix_.column(member)) {
    const double goal = matrix_.goal(one.element), has = static_cast<double>(cover_.amount(one.element)),
                 left = has - one.amount;
    if (left >= goal || matrix_.weight(one.element) <= 0) continue;
    const double now = std::max(goal - has, 0.0), then = goal - left, each = this->each(one.element);
    for (const ColumnIndex::Column& other : columns_.of(one.element)) {
      const double amount = other.amount;
      more[other.candidate] += each * (std::min(amount, then) - std::min(amount, now));
    }
  }
}

void CoverGains::remove(std::size_t member, std::span<const double> more) {
  value_ -= losses_[member];
  for (std::size_t k = 0; k < gains_.size(); ++k) gains_[k] += more[k];
  for (const CoverageMatrix::Entry& one : matrix_.column(member)) {
    if (matrix_.weight(one.element) <= 0) continue;
    std::vector<ColumnIndex::Column>& members = members_[one.element];
    *std::ranges::find(members, member, &ColumnIndex::Column::candidate) = members.back();
    members.pop_back();
    const auto had = static_cast<double>(cover_.amount(one.element));
    change_losses(one.element, had, had - one.amount);
  }
  cover_.remove(member);
}

}  // namespace vantage
