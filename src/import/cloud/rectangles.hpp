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

// Outlines that meet those of their neighbours corner to corner, so that no neighbour has a corner within an edge.
class Outlines {
 public:
  explicit Outlines(const std::vector<Rectangle>& all);
  // Corners of one of them, and those of others along its edges, anticlockwise from `low`.
  std::vector<Square> of(const Rectangle& rectangle) const;

 private:
  std::array<std::vector<Square>, 2> corners_;  // line by line: by the second number and by the first
};

}  // namespace vantage::importer
