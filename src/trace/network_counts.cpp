// SPDX-License-Identifier: Apache-2.0
#include <cassert>
#include <utility>

#include "vantage/trace.hpp"

namespace vantage {

std::uint64_t NetworkCounts::shared_by(std::size_t i, std::size_t j) const {
  assert(i != j && i < stations && j < stations);
  if (i > j) std::swap(i, j);
  const std::size_t before = i * (2 * std::size_t{stations} - i - 1) / 2;  // pairs whose first station is below i
  return shared[before + (j - i - 1)];
}

}  // namespace vantage
