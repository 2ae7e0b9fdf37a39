// SPDX-License-Identifier: Apache-2.0
#include "plan/sample_memory.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vantage {

std::vector<LookError> look_errors(std::span<const std::vector<double>> looked,
                                   std::span<const std::vector<double>> measured) {
  std::vector<LookError> errors(looked.empty() ? 0 : looked.front().size());
  const auto count = static_cast<double>(looked.size());
  for (std::size_t m = 0; m < errors.size(); ++m) {
    LookError& error = errors[m];
    for (std::size_t k = 0; k < looked.size(); ++k) error.mean += (measured[k][m] - looked[k][m]) / count;
    double squares = 0;
    for (std::size_t k = 0; k < looked.size(); ++k) {
      const double off = measured[k][m] - looked[k][m] - error.mean;
      squares += off * off;
    }
    error.deviation = count > 1 ? std::sqrt(squares / (count - 1)) : 0;
  }
  return errors;
}

void SampleMemory::correct(std::vector<double>& values) const {
  for (std::size_t m = 0; m < values.size(); ++m) values[m] += state_.shift[m];
}

void SampleMemory::correct(std::vector<double>& values, std::size_t look) const {
  for (std::size_t m = 0; m < values.size(); ++m) values[m] += state_.looks[look][m].mean + state_.shift[m];
}

void SampleMemory::keep_only(std::span<const ParetoPoint> population) {
  std::map<std::vector<double>, Measurements> kept;
  for (const ParetoPoint& point : population)
    if (const auto found = state_.known.find(point.x); found != state_.known.end()) kept.insert(*found);
  state_.known = std::move(kept);
}

void SampleMemory::average(std::span<const ParetoPoint> population, std::vector<std::vector<double>>& values,
                           std::uint64_t from) {
  const bool others = from != std::exchange(from_, from);  // else a larger sample, which holds the one before
  const std::map<std::vector<double>, Measurements> before = std::exchange(state_.known, {});
  std::vector<double>& shift = state_.shift;
  std::ranges::fill(shift, 0.0);
  double longer_known = 0;
  for (std::size_t k = 0; k < population.size(); ++k) {
    const auto [place, first] = state_.known.try_emplace(population[k].x);
    Measurements& own = place->second;
    if (first) {  // the population may have the same network twice
      const auto found = before.find(population[k].x);
      own = others && found != before.end() ? found->second : Measurements{std::vector<double>(shift.size()), 0};
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

std::vector<std::vector<Estimate>> SampleMemory::pooled(std::span<const ParetoPoint> population,
                                                        std::vector<std::vector<Estimate>> last,
                                                        double times_as_large) const {
  std::vector<double> off(state_.shift.size(), 0);
  double known = 0;
  for (std::size_t k = 0; k < population.size(); ++k) {
    const auto found = state_.known.find(population[k].x);
    if (found == state_.known.end()) continue;
    for (std::size_t m = 0; m < off.size(); ++m)
      off[m] += last[k][m].value - found->second.sum[m] / static_cast<double>(found->second.count);
    ++known;
  }
  for (double& one : off) one /= std::max(known, 1.0);
  for (std::size_t k = 0; k < population.size(); ++k) {
    const auto found = state_.known.find(population[k].x);
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
