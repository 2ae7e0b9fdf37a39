// SPDX-License-Identifier: Apache-2.0
// Groups of coordinates that mean the same in any order, as the stations of a network do (OptimiserConfig::blocks).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "optimise/box_constraints.hpp"
#include "optimise/state_file.hpp"

namespace vantage::optimise {

using Blocks = std::vector<std::vector<std::size_t>>;

// Throws Error invalid_argument where they are not what OptimiserConfig says.
void require_blocks(const Blocks& blocks, const BoxConstraints& box, std::size_t dimension);

// For each block of `first` one of `second`, each once: the nearest pair first, then the nearest of those left. Unit
// coordinates.
std::vector<std::size_t> match_blocks(std::span<const double> first, std::span<const double> second,
                                      const Blocks& blocks);

// Puts the blocks of `second` into the places of those of `first` that they match, and so those of `along`.
void align_blocks(std::span<const double> first, std::span<double> second, std::span<double> along,
                  const Blocks& blocks);

// As part of a saved state, which must go on with the same blocks.
void save_blocks(StateWriter& w, const Blocks& blocks);
void expect_blocks(StateReader& r, const Blocks& blocks);

}  // namespace vantage::optimise
