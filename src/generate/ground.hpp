// SPDX-License-Identifier: Apache-2.0
// Ground of the industrial site: 40 × 40 m, a flat pad in the middle, an embankment 2.3 m high to the north and east,
// and a slope between them.
#pragma once

#include <cstddef>
#include <vector>

#include "generate/structure.hpp"

namespace vantage::built_in {

// The ground as about `triangles` triangles, at least 1250.
Mesh ground_mesh(std::size_t triangles);

// The search area: 1250 triangles of ground, whose plan fills [0, 1]² of (u, v), and the decks beside it, at the scale
// that preserves the ratio of areas. Decks get `cells` columns and rows each.
struct DeckChart {
  Deck deck;
  int columns = 1, rows = 1;
  double u = 0, v = 0;  // origin of its chart
};
Mesh search_mesh(const std::vector<DeckChart>& decks);

}  // namespace vantage::built_in
