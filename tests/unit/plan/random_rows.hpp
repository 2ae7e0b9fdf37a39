// SPDX-License-Identifier: Apache-2.0
// Capture rows of no scene: small random tables for which everything can be tried.
#pragma once

#include <cstdint>
#include <vector>

#include "core/philox.hpp"
#include "vantage/candidates.hpp"

namespace vantage::test {

inline CaptureRows random_rows(std::size_t rows, std::size_t voxels, std::uint64_t seed, double density = 0.3,
                               std::uint32_t heaviest = 1) {
  RandomStream random(seed);
  std::vector<std::uint32_t> weights(voxels);
  for (std::uint32_t& w : weights) w = 1 + static_cast<std::uint32_t>(random.uniform() * heaviest);
  CaptureRows made(weights, 10);
  std::vector<std::uint32_t> points(voxels);
  for (std::size_t k = 0; k < rows; ++k) {
    for (std::uint32_t& p : points)
      p = random.uniform() < density ? static_cast<std::uint32_t>(random.uniform() * 15) : 0;
    made.add(points);
  }
  return made;
}

}  // namespace vantage::test
