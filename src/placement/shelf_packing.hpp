// SPDX-License-Identifier: Apache-2.0
// Packs rectangles side by side on shelves.
#pragma once

#include <vector>

#include "vantage/types.hpp"

namespace vantage {

struct Packing {
  std::vector<Uv> corner;  // lower left of each rectangle, in the given order
  Uv size;                 // of the rectangle around all
};

// Packs rectangles, which keep their orientation and stay `gap` apart. Takes the shelf width with the least waste;
// among equals the shape nearest to a square. A single rectangle fills the whole.
Packing pack_shelves(const std::vector<Uv>& sizes, double gap);

}  // namespace vantage
