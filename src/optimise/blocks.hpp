// SPDX-License-Identifier: Apache-2.0
// Interchangeable groups of coordinates, such as the stations of a network (OptimiserConfig::blocks).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "optimise/box_constraints.hpp"
#include "optimise/state_file.hpp"

namespace vantage::optimise {

using Blocks = std::vector<std::vector<std::size_t>>;

// Throws Error invalid_argument unless they are as OptimiserConfig requires.
void require_blocks(const Blocks& blocks, const BoxConstraints& box, std::size_t dimension);

// Matches each block of `first` with one of `second`: the nearest pair first, then the nearest of the rest. Unit
// coordinates.
std::vector<std::size_t> match_blocks(std::span<const double> first, std::span<const double> second,
                                      const Blocks& blocks);

// Moves the blocks of `second` to the places of the blocks of `first` that they match, and those of `along` likewise.
void align_blocks(std::span<const double> first, std::span<double> second, std::span<double> along,
                  const Blocks& blocks);

// Part of a saved state, which can only continue with the same blocks.
void save_blocks(StateWriter& w, const Blocks& blocks);
void expect_blocks(StateReader& r, const Blocks& blocks);

}  // namespace vantage::optimise
