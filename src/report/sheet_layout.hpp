// SPDX-License-Identifier: Apache-2.0
// Paper, ratio and number of sheets for the map of a storey.
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
  Rect map = {};          // place on the paper
  std::size_t sheet = 0;  // of the layout, from 0
  // In a grid, column and row from the north-west: "B2". In strips, the number from the west or the north. Empty if
  // there is one tile.
  std::string name = {};
};

struct SheetLayout {
  Paper paper;
  Rect map = {};                    // room for maps on the paper
  int ratio = 0;                    // 1:ratio
  std::vector<MapTile> tiles = {};  // by sheet
  bool strips = false;              // a long site is cut into strips, several on a sheet
  double points_per_metre() const { return kPointsPerMetre / ratio; }
  std::size_t sheets() const { return tiles.empty() ? 0 : tiles.back().sheet + 1; }
};

// Lays out a map of `storey` as large as fits: on A4, or on A3 if that makes it no coarser than half of `coarsest`.
// Else it is at no coarser ratio than that, on A4, on A3, or on several A3 sheets. On each paper a long storey that
// does not fit is cut into strips beside each other. Tiles overlap by a tenth; each shows a station that no other does.
// `spots`: the stations; a quarter of them at most stand closer together than their marks. No ratio is finer than 1:20.
// `panel`: free width beside the map, in points.
SheetLayout lay_out(const Box& storey, const std::vector<Vec3>& spots, int coarsest, double panel);
// Lays out the same on one A4 sheet, at any ratio.
SheetLayout lay_out_overview(const Box& storey, double panel);

}  // namespace vantage
