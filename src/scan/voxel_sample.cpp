// SPDX-License-Identifier: Apache-2.0
#include "scan/voxel_sample.hpp"

#include <algorithm>
#include <cassert>

#include "core/first_numbers.hpp"
#include "core/golden_step.hpp"
#include "core/parallel.hpp"
#include "core/philox.hpp"

namespace vantage {
namespace {

constexpr std::uint64_t kSampleStream = 0x766f78656cull;

}  // namespace

std::vector<std::uint32_t> voxel_sample(std::uint64_t population, std::uint64_t size, std::uint64_t seed,
                                        std::uint64_t from) {
  assert(population < (std::uint64_t{1} << 32));
  if (size >= population) return first_numbers<std::uint32_t>(population);
  std::vector<std::uint32_t> voxel_indices(size);
  const std::uint64_t step = golden_step(population);
  auto voxel_index =
      static_cast<std::uint64_t>(RandomStream(seed, kSampleStream).uniform() * static_cast<double>(population));
  voxel_index = (voxel_index + from % population * step) % population;
  for (std::uint32_t& r : voxel_indices) {
    r = static_cast<std::uint32_t>(voxel_index);
    voxel_index = (voxel_index + step) % population;
  }
  parallel::sort(voxel_indices.begin(), voxel_indices.end());
  return voxel_indices;
}

}  // namespace vantage
