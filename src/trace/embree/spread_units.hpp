// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include "trace/rays_of_box.hpp"

namespace vantage {

// The rays of a window in units of up to `kUnit` neighbours in a row. The middle unit comes first, since an occluder of
// its ray may hide all. Spread units: any number of consecutive ones covers the window evenly, so that they sample all
// its rays in proportion. Otherwise units go row by row, cyclically.
class SpreadUnits {
 public:
  static constexpr std::uint32_t kUnit = 8;
  struct Unit {
    std::uint32_t row, column, rays;
  };

  SpreadUnits(const RayRanges& window, bool spread) : window_(window) {
    for (std::size_t k = 0; k < 2; ++k)
      if (!window.columns[k].empty())
        blocks_[k] = (window.columns[k].end - window.columns[k].begin + kUnit - 1) / kUnit;
    const std::uint32_t rows = window.rows.end - window.rows.begin;
    size_ = rows * of_row();
    start_ = rows / 2 * of_row() + of_row() / 2;
    constexpr std::uint32_t kFew = 8;
    if (!spread || size_ <= kFew) return;
    constexpr double kGolden = 0.6180339887498949;  // spreads any number of steps around a circle most evenly
    step_ = static_cast<std::uint32_t>(kGolden * size_);
    while (std::gcd(step_, size_) != 1) ++step_;  // so that each unit has its turn
  }
  std::uint32_t size() const { return size_; }
  std::uint32_t of_row() const { return blocks_[0] + blocks_[1]; }
  // Returns the index of the unit at this turn, for at() and next().
  std::uint32_t index(std::uint32_t turn) const {
    return static_cast<std::uint32_t>((start_ + std::uint64_t{turn} * step_) % size_);
  }
  std::uint32_t next(std::uint32_t index) const {
    const std::uint64_t next = std::uint64_t{index} + step_;
    return static_cast<std::uint32_t>(next < size_ ? next : next - size_);
  }
  Unit at(std::uint32_t index) const {
    const std::uint32_t row = index / of_row(), block = index - row * of_row();
    const std::size_t k = block < blocks_[0] ? 0 : 1;
    const std::uint32_t column = window_.columns[k].begin + (block - (k == 0 ? 0 : blocks_[0])) * kUnit;
    return {window_.rows.begin + row, column, std::min(kUnit, window_.columns[k].end - column)};
  }

 private:
  const RayRanges& window_;
  std::array<std::uint32_t, 2> blocks_{};
  std::uint32_t size_ = 0, step_ = 1, start_ = 0;
};

}  // namespace vantage
