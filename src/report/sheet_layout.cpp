// SPDX-License-Identifier: Apache-2.0
#include "report/sheet_layout.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "map/distance_apart.hpp"

namespace vantage {
namespace {

constexpr double kBorder = 28, kHead = 52, kFoot = 44;  // around a map, in points; head and foot hold words
constexpr int kRatios[] = {20, 50, 100, 200, 250, 500, 1000, 2000, 2500, 5000, 10'000, 20'000, 50'000, 100'000};
constexpr double kOverlap = 0.1;
constexpr double kMarkWidth = 22;  // points: a mark and a gap

Paper a3() { return {"A3", 841.89, 1190.55}; }

Rect map_on(const Paper& paper, double panel) {
  return {kBorder, kHead, std::floor(paper.width - 2 * kBorder - panel), std::floor(paper.height - kHead - kFoot)};
}

// Returns the finest ratio at which a box fits, or the coarsest one if none does.
int ratio_for(const Vec3& size, const Rect& map) {
  for (const int ratio : kRatios)
    if (size.x * kPointsPerMetre / ratio <= map.width && size.y * kPointsPerMetre / ratio <= map.height) return ratio;
  return std::end(kRatios)[-1];
}

// Returns the orientation of a sheet that draws the box largest.
SheetLayout best_way(const Paper& paper, const Vec3& size, double panel) {
  const Paper ways[] = {lying(paper), paper};
  SheetLayout best;
  for (const Paper& way : ways) {
    const Rect map = map_on(way, panel);
    const int ratio = ratio_for(size, map);
    if (best.ratio == 0 || ratio < best.ratio) best = {.paper = way, .map = map, .ratio = ratio};
  }
  return best;
}

Box around(double x, double y, const SheetLayout& layout) {
  const double width = layout.map.width / layout.points_per_metre(),
               height = layout.map.height / layout.points_per_metre();
  return {{x - width / 2, y - height / 2, 0}, {x + width / 2, y + height / 2, 0}};
}

bool holds(const MapTile& tile, const Vec3& p) {
  const Box& window = tile.window;
  return p.x >= window.min.x && p.x <= window.max.x && p.y >= window.min.y && p.y <= window.max.y;
}

// Drops tiles whose stations all appear on others, those with fewest stations first.
void drop_repeating(std::vector<MapTile>& tiles, const std::vector<Vec3>& spots) {
  const auto count = [&](const MapTile& tile) {
    return std::ranges::count_if(spots, [&](const Vec3& p) { return holds(tile, p); });
  };
  std::vector<std::pair<std::ptrdiff_t, std::size_t>> order;
  for (std::size_t k = 0; k < tiles.size(); ++k) order.emplace_back(count(tiles[k]), k);
  std::ranges::sort(order);
  std::vector<bool> dropped(tiles.size(), false);
  for (const auto& [stations, k] : order)
    dropped[k] = std::ranges::all_of(spots, [&](const Vec3& p) {
      if (!holds(tiles[k], p)) return true;
      for (std::size_t other = 0; other < tiles.size(); ++other)
        if (other != k && !dropped[other] && holds(tiles[other], p)) return true;
      return false;
    });
  std::size_t k = 0;
  std::erase_if(tiles, [&](const MapTile&) { return static_cast<bool>(dropped[k++]); });
}

// Equal parts of a length that overlap, each no longer than `one`.
struct OverlappingParts {
  OverlappingParts(double low, double high, double one) : low_(low), high_(high), one_(one) {
    const double ones = (high - low) / one;  // each end part overlaps on one side only
    if (ones > 1) count = ones <= 2 - kOverlap ? 2 : static_cast<int>(std::ceil(ones / (1 - kOverlap)));
  }
  // A single part has length `one`, around the middle.
  std::pair<double, double> part(int k) const {
    if (count == 1) return {(low_ + high_ - one_) / 2, (low_ + high_ + one_) / 2};
    const double step = (high_ - low_) / count, more = kOverlap * one_ / 2;
    return {std::max(low_, low_ + k * step - more), std::min(high_, low_ + (k + 1) * step + more)};
  }

  int count = 1;

 private:
  double low_, high_, one_;
};

void add_tiles(SheetLayout& layout, const Box& storey, const std::vector<Vec3>& spots) {
  const double metre = layout.points_per_metre();
  const OverlappingParts columns(storey.min.x, storey.max.x, layout.map.width / metre);
  const OverlappingParts rows(-storey.max.y, -storey.min.y, layout.map.height / metre);  // from the north
  for (int row = 0; row < rows.count; ++row)
    for (int column = 0; column < columns.count; ++column) {
      const auto [west, east] = columns.part(column);
      const auto [north, south] = rows.part(row);
      std::string name;
      for (int n = column; n >= 0; n = n / 26 - 1) name.insert(name.begin(), static_cast<char>('A' + n % 26));
      layout.tiles.push_back({.window = {{west, -south, 0}, {east, -north, 0}},
                              .map = {layout.map.x, layout.map.y, (east - west) * metre, (south - north) * metre},
                              .name = name + std::to_string(row + 1)});
    }
  if (layout.tiles.size() > 1) drop_repeating(layout.tiles, spots);
  if (layout.tiles.size() == 1) layout.tiles.front().name.clear();
  for (std::size_t k = 0; k < layout.tiles.size(); ++k) layout.tiles[k].sheet = k;
}

// Cuts a storey that is long in x or in y into strips across its length. It has no tiles if fewer than two fit on a
// sheet of this paper, or if they take several sheets although `on_several` is false.
SheetLayout strips_on(const Paper& paper, const Box& storey, int ratio, double panel, bool on_several) {
  constexpr double kBetween = 26;  // points, for the coordinates of a strip
  SheetLayout layout{.paper = paper, .map = map_on(paper, panel), .ratio = ratio, .strips = true};
  const double metre = layout.points_per_metre();
  const Vec3 size = storey.size();
  const bool in_x = size.x >= size.y;
  const double across = (in_x ? size.y : size.x) * metre, room = in_x ? layout.map.height : layout.map.width,
               along = (in_x ? layout.map.width : layout.map.height) / metre;
  const int fitting = static_cast<int>((room + kBetween) / (across + kBetween));
  const OverlappingParts parts(in_x ? storey.min.x : -storey.max.y, in_x ? storey.max.x : -storey.min.y, along);
  if (fitting < 2 || parts.count < 2 || (parts.count > fitting && !on_several)) return layout;
  const int on_each = std::min(fitting, parts.count);
  const double thick = (room - (on_each - 1) * kBetween) / on_each;  // points
  const Vec3 middle = storey.centre();
  for (int k = 0; k < parts.count; ++k) {
    const auto [from, to] = parts.part(k);
    const double half = thick / metre / 2, shift = (k % on_each) * (thick + kBetween), length = (to - from) * metre;
    MapTile tile{.sheet = static_cast<std::size_t>(k / on_each), .name = std::to_string(k + 1)};
    if (in_x) {
      tile.window = {{from, middle.y - half, 0}, {to, middle.y + half, 0}};
      tile.map = {layout.map.x, layout.map.y + shift, length, thick};
    } else {
      tile.window = {{middle.x - half, -to, 0}, {middle.x + half, -from, 0}};
      tile.map = {layout.map.x + shift, layout.map.y, thick, length};
    }
    layout.tiles.push_back(std::move(tile));
  }
  return layout;
}

// Returns strips at the finest ratio up to `coarsest` at which one sheet holds them; no tiles if none does.
SheetLayout best_strips(const Paper& paper, const Box& storey, int coarsest, double panel) {
  for (const int ratio : kRatios)
    for (const Paper& way : {lying(paper), paper})
      if (ratio <= coarsest)
        if (SheetLayout layout = strips_on(way, storey, ratio, panel, false); !layout.tiles.empty()) return layout;
  return {};
}

}  // namespace

Paper a4() { return {"A4", 595.28, 841.89}; }
Paper lying(Paper paper) { return {paper.name, paper.height, paper.width}; }

SheetLayout lay_out(const Box& storey, const std::vector<Vec3>& spots, int coarsest, double panel) {
  const double clear = kPointsPerMetre * distance_apart(spots, 4) / kMarkWidth;
  const auto limit = [&](int most) {
    int found = kRatios[0];
    for (const int ratio : kRatios)
      if (ratio <= most && ratio <= clear) found = ratio;
    return found;
  };
  const int good = limit(coarsest / 2), readable = limit(coarsest);
  SheetLayout layout;
  for (const int most : {good, readable})
    for (const Paper& paper : {a4(), a3()}) {
      layout = best_way(paper, storey.size(), panel);
      if (layout.ratio <= most) {
        add_tiles(layout, storey, spots);
        return layout;
      }
      if (SheetLayout strips = best_strips(paper, storey, most, panel); !strips.tiles.empty()) return strips;
    }
  for (const Paper& way : {lying(a3()), a3()})
    if (SheetLayout strips = strips_on(way, storey, readable, panel, true); !strips.tiles.empty()) return strips;
  layout.ratio = std::min(layout.ratio, readable);
  add_tiles(layout, storey, spots);
  return layout;
}

SheetLayout lay_out_overview(const Box& storey, double panel) {
  SheetLayout layout = best_way(a4(), storey.size(), panel);
  layout.tiles = {{.window = around(storey.centre().x, storey.centre().y, layout), .map = layout.map}};
  return layout;
}

}  // namespace vantage
