// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace vantage {

// `size` ranks of [0, population), ascending; all of them where size >= population. Fixed by the seed, nested (a larger
// sample contains every smaller one), and systematic: a walk by the golden section, so that at every size the ranks lie
// evenly along the Morton order, with gaps of at most three lengths. `from` walks so many steps first: samples from 0,
// n, 2n, … of n have none in common until all were drawn. REQUIRES: population < 2^32.
std::vector<std::uint32_t> voxel_sample(std::uint64_t population, std::uint64_t size, std::uint64_t seed,
                                        std::uint64_t from = 0);

}  // namespace vantage
