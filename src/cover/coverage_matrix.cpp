// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <numeric>
#include <string>

#include "core/parse.hpp"
#include "cover/partial_cover.hpp"
#include "vantage/cover.hpp"
#include "vantage/error.hpp"

namespace vantage {

CoverageMatrix::CoverageMatrix(std::vector<std::uint32_t> weights, double goal)
    : weights_(std::move(weights)), total_weight_(std::accumulate(weights_.begin(), weights_.end(), 0.0)), goal_(goal) {
  check_number(goal, "coverage matrix: the goal", kPositive);
}

void CoverageMatrix::set_goals(std::span<const double> goals) {
  if (goals.size() != elements() || !std::ranges::all_of(goals, [](double goal) { return goal >= 0; }))
    throw Error(Errc::invalid_argument, "coverage matrix: " + std::to_string(goals.size()) + " goals for " +
                                            std::to_string(elements()) + " elements; give one for each, none below 0");
  goals_.assign(goals.begin(), goals.end());
  shares_.resize(goals.size());
  total_weight_ = 0;
  for (std::size_t e = 0; e < goals_.size(); ++e) {
    total_weight_ += shares_[e] = weights_[e] * (goals_[e] / goal_);
    if (goals_[e] == 0) goals_[e] = goal_;  // nothing is divided by it; its weight is 0
  }
}

void CoverageMatrix::add(std::span<const std::uint32_t> amounts) {
  assert(amounts.size() == elements());
  for (std::uint32_t e = 0; e < amounts.size(); ++e)
    if (amounts[e] > 0) entries_.push_back({e, amounts[e]});
  offsets_.push_back(entries_.size());
}

void CoverageMatrix::add(std::span<const Entry> column) {
  entries_.insert(entries_.end(), column.begin(), column.end());
  offsets_.push_back(entries_.size());
}

void CoverageMatrix::append(const CoverageMatrix& other, std::size_t most) {
  if (other.weights_ != weights_ || other.goal_ != goal_ || other.goals_ != goals_ || other.shares_ != shares_)
    throw Error(Errc::invalid_argument, "coverage matrix: candidates over other elements cannot be appended");
  const std::size_t before = entries_.size(), count = std::min(most, other.candidates());
  entries_.insert(entries_.end(), other.entries_.begin(),
                  other.entries_.begin() + static_cast<std::ptrdiff_t>(other.offsets_[count]));
  for (std::size_t k = 1; k <= count; ++k) offsets_.push_back(before + other.offsets_[k]);
}

double CoverageMatrix::coverage(std::span<const std::size_t> chosen) const {
  return PartialCover(*this, chosen).value();
}

}  // namespace vantage
