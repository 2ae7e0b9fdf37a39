// SPDX-License-Identifier: Apache-2.0
// On which paper, at what ratio and in how many sheets a storey is drawn.
#pragma once

#include <string>
#include <vector>

#include "export/canvas.hpp"
#include "vantage/types.hpp"

namespace vantage {

inline constexpr double kPointsPerMetre = 72 / 0.0254;  // of paper

struct Paper {
  std::string name;              // "A4", upright or lying
  double width = 0, height = 0;  // points
};
Paper a4();  // upright
Paper lying(Paper paper);

// What part of the site a map sheet shows; survey frame, metres.
struct MapTile {
  Box window;
  std::string name;  // "B2": its column and row, from the north-west; empty: there is one
};

struct SheetLayout {
  Paper paper;
  Rect map = {};  // of the paper: where the map stands
  int ratio = 0;  // 1:ratio
  std::vector<MapTile> tiles = {};
  double points_per_metre() const { return kPointsPerMetre / ratio; }
};

// A map of `storey`, as large as fits: on A4 or, where that makes it no coarser than half of `coarsest`, on A3; else,
// at no coarser ratio than that, on A4, on A3, or in several sheets A3 that overlap by a tenth, each with a station.
// `spots`: the stations, of which a quarter at most stand closer together than their marks take. No ratio is finer than
// 1:20. `panel`: width that is left free beside the map, in points.
SheetLayout lay_out(const Box& storey, const std::vector<Vec3>& spots, int coarsest, double panel);
// The same on one sheet A4 whatever the ratio.
SheetLayout lay_out_overview(const Box& storey, double panel);

}  // namespace vantage
