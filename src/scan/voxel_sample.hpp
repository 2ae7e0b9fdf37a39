// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace vantage {

// Returns `size` indices of [0, population), ascending; all of them if size >= population. The sample is fixed by the
// seed, nested (a larger one contains every smaller one), and systematic, by a walk of golden-section steps. At every
// size, indices thus lie evenly along the Morton order, with gaps of at most three lengths. `from` skips that many
// steps: samples of n from 0, n, 2n, … are disjoint until all indices were drawn. REQUIRES: population < 2^32.
std::vector<std::uint32_t> voxel_sample(std::uint64_t population, std::uint64_t size, std::uint64_t seed,
                                        std::uint64_t from = 0);

}  // namespace vantage
