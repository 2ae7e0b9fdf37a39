// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <numeric>

#include "cover/partial_cover.hpp"
#include "vantage/cover.hpp"
#include "vantage/error.hpp"

namespace vantage {

CoverageMatrix::CoverageMatrix(std::vector<std::uint32_t> weights, double goal)
    : weights_(std::move(weights)),
      total_weight_(std::accumulate(weights_.begin(), weights_.end(), 0.0)),
      goal_(goal) {}

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
  if (other.weights_ != weights_ || other.goal_ != goal_)
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
