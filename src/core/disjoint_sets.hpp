// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/first_numbers.hpp"

namespace vantage {

// Union–find over the numbers from 0, by halving of paths (Tarjan and van Leeuwen: Worst-Case Analysis of Set Union
// Algorithms, 1984). Each set is named by its smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t members) : parent_(first_numbers<std::uint32_t>(members)) {}
  std::size_t size() const { return parent_.size(); }
  std::uint32_t find(std::size_t member) {
    auto at = static_cast<std::uint32_t>(member);
    while (parent_[at] != at) at = parent_[at] = parent_[parent_[at]];
    return at;
  }
  // Joins two sets; returns false if they were one already.
  bool join(std::size_t a, std::size_t b) {
    const auto [low, high] = std::minmax({find(a), find(b)});
    parent_[high] = low;
    return low != high;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace vantage
