// SPDX-License-Identifier: Apache-2.0
#include "scan/voxel_sample.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/philox.hpp"

namespace vantage {
namespace {

constexpr std::uint64_t sample_stream = 0x766f78656cull;

// Largest quotient of the continued fraction of step / population, 0 where they have a common divisor. The smaller it
// is, the more even the walk at its worst size; the golden section itself has only ones.
std::uint64_t largest_quotient(std::uint64_t step, std::uint64_t population) {
  std::uint64_t largest = 0;
  while (step > 0) {
    largest = std::max(largest, population / step);
    population = std::exchange(step, population % step);
  }
  return population == 1 ? largest : 0;
}

// Near population / φ, the step that visits every rank once and does so most evenly. The integer nearest to it may do
// badly: it is golden only up to about √population ranks.
std::uint64_t golden_step(std::uint64_t population) {
  constexpr std::uint64_t search = 1000;
  const auto nearest = static_cast<std::uint64_t>(std::llround(static_cast<double>(population) / std::numbers::phi));
  std::uint64_t best = 1, best_quotient = population;  // a step of 1 is a walk, if no even one
  const auto consider = [&](std::uint64_t step) {
    const std::uint64_t quotient = largest_quotient(step, population);
    if (quotient > 0 && quotient < best_quotient) {
      best = step;
      best_quotient = quotient;
    }
  };
  for (std::uint64_t away = 0; away <= search; ++away) {
    if (nearest + away < population) consider(nearest + away);
    if (away < nearest) consider(nearest - away);
  }
  return best;
}

}  // namespace

std::vector<std::uint32_t> voxel_sample(std::uint64_t population, std::uint64_t size, std::uint64_t seed,
                                        std::uint64_t from) {
  assert(population < (std::uint64_t{1} << 32));
  std::vector<std::uint32_t> ranks(std::min(size, population));
  if (size >= population) {
    std::iota(ranks.begin(), ranks.end(), std::uint32_t{0});
    return ranks;
  }
  const std::uint64_t step = golden_step(population);
  auto rank = static_cast<std::uint64_t>(RandomStream(seed, sample_stream).uniform() * static_cast<double>(population));
  rank = (rank + from % population * step) % population;
  for (std::uint32_t& r : ranks) {
    r = static_cast<std::uint32_t>(rank);
    rank = (rank + step) % population;
  }
  std::sort(ranks.begin(), ranks.end());
  return ranks;
}

}  // namespace vantage
