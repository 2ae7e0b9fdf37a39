// SPDX-License-Identifier: Apache-2.0
#include "search/sample_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vantage {

void SampleStatistics::correct(std::vector<double>& values) const {
  for (std::size_t m = 0; m < values.size(); ++m) values[m] += state_.shift[m];
}

void SampleStatistics::keep_only(std::span<const ParetoPoint> archive) {
  std::map<std::vector<double>, Sums> left;
  for (const ParetoPoint& point : archive)
    if (const auto found = state_.known.find(point.x); found != state_.known.end()) left.insert(*found);
  state_.known = std::move(left);
}

void SampleStatistics::average(std::span<const ParetoPoint> archive, std::vector<std::vector<double>>& values) {
  const std::map<std::vector<double>, Sums> before = std::exchange(state_.known, {});
  std::vector<double>& shift = state_.shift;
  std::ranges::fill(shift, 0.0);
  double longer_known = 0;
  for (std::size_t k = 0; k < archive.size(); ++k) {
    const auto [place, first] = state_.known.try_emplace(archive[k].x);
    Sums& own = place->second;
    if (first) {  // the archive may hold the same network twice
      const auto found = before.find(archive[k].x);
      own = found != before.end() ? found->second : Sums{std::vector<double>(shift.size()), 0};
      ++own.count;
      for (std::size_t m = 0; m < shift.size(); ++m) own.sum[m] += values[k][m];
    }
    for (std::size_t m = 0; m < shift.size(); ++m) {
      const double mean = own.sum[m] / static_cast<double>(own.count);
      if (own.count > 1) shift[m] += mean - values[k][m];
      values[k][m] = mean;
    }
    longer_known += own.count > 1;
  }
  for (double& one : shift) one /= std::max(longer_known, 1.0);
}

std::vector<std::vector<Estimate>> SampleStatistics::pooled(std::span<const ParetoPoint> archive,
                                                            std::vector<std::vector<Estimate>> last,
                                                            double times_as_large) const {
  std::vector<double> off(state_.shift.size(), 0);
  double known = 0;
  for (std::size_t k = 0; k < archive.size(); ++k) {
    const auto found = state_.known.find(archive[k].x);
    if (found == state_.known.end()) continue;
    for (std::size_t m = 0; m < off.size(); ++m)
      off[m] += last[k][m].value - found->second.sum[m] / static_cast<double>(found->second.count);
    ++known;
  }
  for (double& one : off) one /= std::max(known, 1.0);
  for (std::size_t k = 0; k < archive.size(); ++k) {
    const auto found = state_.known.find(archive[k].x);
    if (found == state_.known.end()) continue;
    const auto count = static_cast<double>(found->second.count);
    for (std::size_t m = 0; m < off.size(); ++m) {
      double& value = last[k][m].value;
      const double all = (found->second.sum[m] + count * off[m] + times_as_large * value) / (count + times_as_large);
      if (std::isfinite(all)) value = all;
    }
  }
  return last;
}

}  // namespace vantage
