// SPDX-License-Identifier: Apache-2.0
// On which paper, at what ratio and in how many sheets a storey is drawn.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "map/canvas.hpp"
#include "vantage/types.hpp"

namespace vantage {

inline constexpr double kPointsPerMetre = 72 / 0.0254;  // of paper

struct Paper {
  std::string name;              // "A4", upright or lying
  double width = 0, height = 0;  // points
};
Paper a4();  // upright
Paper lying(Paper paper);

// A part of the site that is drawn on a sheet; survey frame, metres.
struct MapTile {
  Box window = {};
  Rect map = {};          // of the paper: where it stands
  std::size_t sheet = 0;  // of the layout, from 0
  // Of a grid its column and row, from the north-west: "B2"; of strips their number from the west or the north; empty:
  // there is one tile.
  std::string name = {};
};

struct SheetLayout {
  Paper paper;
  Rect map = {};                    // of the paper: what is left for maps
  int ratio = 0;                    // 1:ratio
  std::vector<MapTile> tiles = {};  // by sheet
  bool strips = false;              // a long site in strips, as many on a sheet as there is room for
  double points_per_metre() const { return kPointsPerMetre / ratio; }
  std::size_t sheets() const { return tiles.empty() ? 0 : tiles.back().sheet + 1; }
};

// A map of `storey`, as large as fits: on A4 or, where that makes it no coarser than half of `coarsest`, on A3; else,
// at no coarser ratio than that, on A4, on A3, or on several sheets A3. On each paper a long storey that does not fit
// is cut into strips, which lie beside each other. Tiles overlap by a tenth; each shows a station that no other does.
// `spots`: the stations, of which a quarter at most stand closer together than their marks take. No ratio is finer than
// 1:20. `panel`: width that is left free beside the map, in points.
SheetLayout lay_out(const Box& storey, const std::vector<Vec3>& spots, int coarsest, double panel);
// The same on one sheet A4 whatever the ratio.
SheetLayout lay_out_overview(const Box& storey, double panel);

}  // namespace vantage
