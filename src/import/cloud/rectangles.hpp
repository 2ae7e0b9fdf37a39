// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace vantage::importer {

using Square = std::array<std::int32_t, 2>;

struct Rectangle {
  Square low{}, high{};  // of whole squares; `high` is beyond
};

// Fills gaps of at most `most` squares in rows and columns. Squares come back sorted, each once.
std::vector<Square> close_gaps(std::vector<Square> squares, std::int32_t most);

// Few rectangles over exactly these squares: runs in rows, joined where they are alike. REQUIRES: as from close_gaps().
std::vector<Rectangle> rectangles(const std::vector<Square>& squares);

}  // namespace vantage::importer
