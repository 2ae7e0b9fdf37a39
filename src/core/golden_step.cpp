// SPDX-License-Identifier: Apache-2.0
#include "core/golden_step.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace vantage {
namespace {

// Returns the largest quotient of the continued fraction of step / population; 0 if they have a common divisor. The
// smaller it is, the more even the walk is at its worst size; the golden section has only ones.
std::uint64_t largest_quotient(std::uint64_t step, std::uint64_t population) {
  std::uint64_t largest = 0;
  while (step > 0) {
    largest = std::max(largest, population / step);
    population = std::exchange(step, population % step);
  }
  return population == 1 ? largest : 0;
}

}  // namespace

std::uint64_t golden_step(std::uint64_t population) {
  constexpr std::uint64_t kFarthest = 1000;
  const auto nearest = static_cast<std::uint64_t>(std::llround(static_cast<double>(population) / std::numbers::phi));
  std::uint64_t best = 1, best_quotient = population;  // a step of 1 always walks, though not evenly
  const auto consider = [&](std::uint64_t step) {
    const std::uint64_t quotient = largest_quotient(step, population);
    if (quotient > 0 && quotient < best_quotient) {
      best = step;
      best_quotient = quotient;
    }
  };
  for (std::uint64_t away = 0; away <= kFarthest; ++away) {
    if (nearest + away < population) consider(nearest + away);
    if (away < nearest) consider(nearest - away);
  }
  return best;
}

}  // namespace vantage
