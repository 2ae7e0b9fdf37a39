// SPDX-License-Identifier: Apache-2.0
// An ordered set of the integers 0 … n − 1 as a tree of 64-bit words: insert, erase and both neighbours in O(log64 n).
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vantage::optimise {

class IndexSet {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  explicit IndexSet(std::size_t size) {
    do {
      size = (size + 63) / 64;
      levels_.emplace_back(size, 0);
    } while (size > 1);
  }

  void insert(std::size_t i) {
    for (auto& level : levels_) {
      level[i >> 6] |= std::uint64_t{1} << (i & 63);
      i >>= 6;
    }
  }

  void erase(std::size_t i) {
    for (auto& level : levels_) {
      if ((level[i >> 6] &= ~(std::uint64_t{1} << (i & 63))) != 0) return;
      i >>= 6;
    }
  }

  // Largest member below i, or kNone.
  std::size_t previous(std::size_t i) const {
    for (std::size_t k = 0; k < levels_.size(); ++k, i >>= 6) {
      const std::uint64_t below = levels_[k][i >> 6] & ((std::uint64_t{1} << (i & 63)) - 1);
      if (below == 0) continue;
      i = (i & ~std::size_t{63}) | static_cast<std::size_t>(63 - std::countl_zero(below));
      for (; k > 0; --k) i = (i << 6) | static_cast<std::size_t>(63 - std::countl_zero(levels_[k - 1][i]));
      return i;
    }
    return kNone;
  }

  // Smallest member above i, or kNone.
  std::size_t next(std::size_t i) const {
    for (std::size_t k = 0; k < levels_.size(); ++k, i >>= 6) {
      const std::uint64_t above = levels_[k][i >> 6] & ~((std::uint64_t{2} << (i & 63)) - 1);
      if (above == 0) continue;
      i = (i & ~std::size_t{63}) | static_cast<std::size_t>(std::countr_zero(above));
      for (; k > 0; --k) i = (i << 6) | static_cast<std::size_t>(std::countr_zero(levels_[k - 1][i]));
      return i;
    }
    return kNone;
  }

 private:
  std::vector<std::vector<std::uint64_t>> levels_;
};

}  // namespace vantage::optimise
