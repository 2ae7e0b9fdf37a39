// SPDX-License-Identifier: Apache-2.0
// How maps of the levels of a site share a page.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vantage {

// Up to three side by side; more as a contact sheet of smaller ones in rows, which is no larger for eighty than for
// eight. Canvas units.
struct MapGrid {
  explicit MapGrid(std::size_t maps)
      : columns(maps <= 3 ? maps : columns_of(maps)), rows((maps + columns - 1) / columns) {
    if (maps == 1) return;
    width = 460, height = 520;
    if (maps > 3) width = std::max(120.0, 1300 / static_cast<double>(columns) - 100), height = 1.1 * width;
  }
  bool contact() const { return rows > 1; }

  std::size_t columns, rows;
  double width = 700, height = 640;  // room of one map

 private:
  static std::size_t columns_of(std::size_t maps) {
    return static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(maps))));
  }
};

}  // namespace vantage
