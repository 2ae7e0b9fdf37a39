// SPDX-License-Identifier: Apache-2.0
// One map of a plan view: a floor, or the whole site in plan view, with its stations and links.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "map/canvas.hpp"
#include "map/plan_levels.hpp"
#include "map/relief.hpp"
#include "vantage/evaluation.hpp"
#include "vantage/placement.hpp"
#include "vantage/scene.hpp"

namespace vantage {

// Content of all maps of a plan view. Borrows scene, area and stations.
struct PlanView {
  const Scene& scene;  // names of its rooms stand in them
  const SearchArea& area;
  std::span<const PlacedStation> stations;
  std::vector<std::string> names;  // one for each station
  StationLinks links = {};         // values for all stations, or none
  std::string title;
  std::span<const StationError> errors = {};  // one for each station, or none; drawn as standard ellipses
  std::span<const Target> targets = {};

  // Canvas units per metre of an ellipse, so that the widest is kWidestEllipse wide; 0 without ellipses.
  double ellipse_scale() const;
};
inline constexpr double kWidestEllipse = 30;  // semi-axis, canvas units

// Elements on a map, for its legend.
struct PlanMapContent {
  bool cut = false;              // cut at a height, with solid parts filled
  bool left_out = false;         // ground that is no part of the search area
  bool elsewhere = false;        // stations of other floors
  bool moved = false;            // discs beside their spots
  bool bridge = false;           // links that connect two components
  bool heights = false;          // labels with heights of the ground
  double largest = 0;            // overlap of a link; 0: there is none
  std::size_t hidden_links = 0;  // omitted because they would make a tangle
  PlanMapContent operator|(const PlanMapContent& o) const {
    return {cut || o.cut,       left_out || o.left_out, elsewhere || o.elsewhere,     moved || o.moved,
            bridge || o.bridge, heights || o.heights,   std::max(largest, o.largest), hidden_links + o.hidden_links};
  }
};

// Returns the extent of surveyed meshes, search area and stations, with a margin. Ground that reaches further is cut
// off. Throws Error invalid_argument if there is nothing.
Box plan_window(const PlanView& view);

// A site's picture in a map, under the marks.
struct SiteMap {
  std::vector<std::uint32_t> pixels;  // of the window, as `shade()` makes them
  bool left_out = false;              // true if ground outside the search area shows
};
// Draws the site in shaded relief with its search area, cut at the level's height. Solids that the cut passes through
// are filled, and outlined by `line` pixels. A surface around a station, or around ground that a person reaches, is not
// filled. `paper` fades everything else into white, from 0 to 1, for maps that are written on. `surfaces` is
// `surfaces_of()` the scene, if it is known.
SiteMap map_site(const Scene& scene, const SearchArea& area, const MapWindow& window, const PlanLevel& level,
                 std::span<const PlacedStation> stations, double line, double paper = 0,
                 std::span<const std::uint32_t> surfaces = {});

// Draws the window into `map`, which has its proportions. A title and a subtitle stand above it. With `brief` the
// subtitle is short enough for a small map.
PlanMapContent draw_plan_map(Canvas& canvas, const Rect& map, const PlanView& view, const Box& window,
                             const PlanLevel& level, const std::string& title, std::string subtitle,
                             bool brief = false);

inline constexpr double kDisc = 10.5;  // radius of a station's mark

// Marks of the legend, as on the map.
void draw_station(Canvas& canvas, Point at, const std::string& text, const PlacedStation& station,
                  double radius = kDisc);
// True if a name is short enough to stand in a station's mark.
bool fits_disc(const std::string& name);
void draw_elsewhere(Canvas& canvas, Point at, const std::string& text, double radius = kDisc);
// A checkered disc; a triangle around that of a control point.
inline constexpr double kTargetRadius = 5;
void draw_target(Canvas& canvas, Point at, bool control, double radius = kTargetRadius);
bool stands_on(const Target& target, const PlanLevel& level);
// True if a person on the floor of the level is in the room's height.
bool lies_on(const Room& room, const PlanLevel& level);
void draw_link(Canvas& canvas, Point a, Point b, double overlap, bool bridge, bool between_floors);

// Overlaps in the legend. The scale of widths is the same on every picture and ends with the last.
inline constexpr double kLinkSamples[] = {0.05, 0.1, 0.2, 0.5};
inline constexpr Colour kCutTint{0.27, 0.28, 0.31}, kGlassTint{0.36, 0.66, 0.86}, kFoundTint{0.90, 0.36, 0.08},
    kUnknownTint{0.13, 0.55, 0.60};

}  // namespace vantage
