// SPDX-License-Identifier: Apache-2.0
// One map of a plan view: a floor, or the whole site from above, with its stations and links.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "export/canvas.hpp"
#include "export/plan_levels.hpp"
#include "vantage/evaluation.hpp"
#include "vantage/placement.hpp"
#include "vantage/scene.hpp"

namespace vantage {

// What all maps of a plan view show. Borrows scene, area and stations.
struct PlanView {
  const Scene& scene;
  const SearchArea& area;
  std::span<const PlacedStation> stations;
  std::vector<std::string> names;  // one a station
  StationLinks links = {};         // values of all stations, or of none
  std::string title;
  std::span<const StationError> errors = {};  // of the stations, or of none: their standard ellipses are drawn

  // Canvas units a metre of such an ellipse; 0 where there is none. The widest is as wide as kWidestEllipse.
  double ellipse_scale() const;
};
inline constexpr double kWidestEllipse = 30;  // semi-axis, canvas units

// What a map came to show, for its legend.
struct PlanMapContent {
  bool cut = false;              // at a height, with what is solid there filled
  bool left_out = false;         // ground that is no part of the search area
  bool elsewhere = false;        // stations of other floors
  bool moved = false;            // discs beside their spots
  bool bridge = false;           // links that hold two parts together
  double largest = 0;            // overlap of a link; 0: there is none
  std::size_t hidden_links = 0;  // that would make a tangle
  PlanMapContent operator|(const PlanMapContent& o) const {
    return {cut || o.cut,       left_out || o.left_out,       elsewhere || o.elsewhere,     moved || o.moved,
            bridge || o.bridge, std::max(largest, o.largest), hidden_links + o.hidden_links};
  }
};

// What the maps must show: surveyed meshes, search area and stations, with a margin; ground that reaches further is cut
// off. Throws Error invalid_argument where there is nothing.
Box plan_window(const PlanView& view);

// Draws the window into `map`, which has its proportions. `level`: the floor, where the site has several; null: all of
// it, cut only where most of the ground lies under something. The map's title and what it is of stand above it.
PlanMapContent draw_plan_map(Canvas& canvas, const Rect& map, const PlanView& view, const Box& window,
                             const PlanLevel* level, const std::string& title, std::string subtitle);

// Marks of the legend, as on the map.
void draw_station(Canvas& canvas, Point at, const std::string& text, const PlacedStation& station);
void draw_elsewhere(Canvas& canvas, Point at, const std::string& text);
void draw_link(Canvas& canvas, Point a, Point b, double overlap, bool bridge, bool between_floors);

// Overlaps of links that the legend shows: the scale of widths is the same on every picture, and ends with the last.
inline constexpr double kLinkSamples[] = {0.05, 0.1, 0.2, 0.5};
inline constexpr double kDisc = 10.5;  // radius of a station's mark
inline constexpr Colour kCutTint{0.27, 0.28, 0.31};

}  // namespace vantage
