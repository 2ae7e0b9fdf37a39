// SPDX-License-Identifier: Apache-2.0
#include "scan/voxel_sample.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "core/golden_step.hpp"
#include "core/philox.hpp"

namespace vantage {
namespace {

constexpr std::uint64_t sample_stream = 0x766f78656cull;

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
