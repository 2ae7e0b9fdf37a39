// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace vantage::importer {

using Square = std::array<std::int32_t, 2>;

struct Rectangle {
  Square low{}, high{};  // in whole squares; `high` is exclusive
};

// Fills gaps of at most `most` squares in rows and columns. Returns the squares sorted, without duplicates.
std::vector<Square> close_gaps(std::vector<Square> squares, std::int32_t most);

// Covers exactly these squares with few rectangles: joins equal runs of adjacent rows. REQUIRES: as from close_gaps().
std::vector<Rectangle> rectangles(const std::vector<Square>& squares);

// Outlines without T-junctions: each has a corner wherever a neighbour has one along its edges.
class Outlines {
 public:
  explicit Outlines(const std::vector<Rectangle>& all);
  // Returns the rectangle's corners and the corners of others along its edges, anticlockwise from `low`.
  std::vector<Square> of(const Rectangle& rectangle) const;

 private:
  std::array<std::vector<Square>, 2> corners_;  // sorted by rows, and transposed by columns
};

}  // namespace vantage::importer
