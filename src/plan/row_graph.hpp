// SPDX-License-Identifier: Apache-2.0
// Which rows may be neighbours in a network, which exclude each other, and whether a choice of them hangs together.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "vantage/candidates.hpp"

namespace vantage {

class RowGraph {
 public:
  // REQUIRES: no link beyond `size`.
  RowGraph(std::size_t size, std::span<const RowLink> links) : size_(size), linked_(size * size, 0) {
    for (const auto& [a, b] : links) linked_[a * size + b] = linked_[b * size + a] = 1;
  }
  std::size_t size() const { return size_; }
  bool linked(std::size_t a, std::size_t b) const { return linked_[a * size_ + b] != 0; }

  bool connected(std::span<const std::size_t> rows) const {
    if (rows.empty()) return true;
    std::vector<std::size_t> open{rows.front()}, left(rows.begin() + 1, rows.end());
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      for (std::size_t k = 0; k < left.size();) {
        if (!linked(at, left[k])) {
          ++k;
          continue;
        }
        open.push_back(left[k]);
        left[k] = left.back();
        left.pop_back();
      }
    }
    return left.empty();
  }

 private:
  std::size_t size_;
  std::vector<char> linked_;
};

// For each row those that no network has beside it.
class ExcludedRows {
 public:
  ExcludedRows() = default;
  // REQUIRES: no pair beyond `size`.
  ExcludedRows(std::size_t size, std::span<const RowLink> pairs) : beside_(size) {
    for (const auto& [a, b] : pairs)
      if (a != b) beside_[a].push_back(b), beside_[b].push_back(a);
  }
  bool empty() const {
    return std::ranges::all_of(beside_, [](const auto& rows) { return rows.empty(); });
  }
  std::span<const std::size_t> beside(std::size_t row) const { return beside_[row]; }
  bool exclude(std::size_t a, std::size_t b) const { return std::ranges::find(beside_[a], b) != beside_[a].end(); }

 private:
  std::vector<std::vector<std::size_t>> beside_;
};

}  // namespace vantage
