// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/furniture.hpp"

#include <map>
#include <set>

#include "import/floor_plan/grid.hpp"

namespace vantage::floor_plan {
namespace {

constexpr double kLargest_m = 4.5, kSmallest_m = 0.15;

// Returns the outermost block of furniture that contains a block; -1: none.
int piece_of(const Drawing& drawing, int symbol) {
  int out = -1;
  for (; symbol >= 0; symbol = drawing.symbols[static_cast<std::size_t>(symbol)].parent)
    if (drawing.symbols[static_cast<std::size_t>(symbol)].kind == Kind::furniture) out = symbol;
  return out;
}

}  // namespace

std::vector<Furniture> find_furniture(const Drawing& drawing, const Rooms& rooms) {
  Grid grid(4.0);
  for (std::size_t r = 0; r < rooms.rooms.size(); ++r) {
    const Bounds box = bounds(rooms.rooms[r].area);
    grid.add(r, box.low, box.high);
  }
  // Groups points by outermost block, and by innermost one in case the outermost is a whole room's furniture.
  std::map<int, std::map<int, std::vector<Point>>> pieces;
  const auto take = [&](const Origin& from, const std::vector<Point>& points) {
    if (from.kind != Kind::furniture) return;
    const int piece = piece_of(drawing, from.symbol);
    if (piece < 0) return;
    auto& all = pieces[piece][from.symbol];
    all.insert(all.end(), points.begin(), points.end());
  };
  for (const Line& line : drawing.lines) take(line.from, {line.a, line.b});
  for (const Arc& arc : drawing.arcs) take(arc.from, chain(arc, 0.02));
  std::vector<Furniture> out;
  const auto add = [&](int symbol, const std::vector<Point>& points) {
    const Shape box = around(points);
    const auto corners = outer_ring(box);
    if (corners.size() != 4) return false;
    const double wide = distance(corners[0], corners[1]), deep = distance(corners[1], corners[2]);
    if (std::max(wide, deep) > kLargest_m || std::min(wide, deep) < kSmallest_m) return false;
    std::set<std::size_t> near;
    grid.visit(bounds(box).low, bounds(box).high, [&](std::size_t r) { near.insert(r); });
    std::vector<Shape> parts;
    for (const std::size_t r : near) parts.push_back(common(box, rooms.rooms[r].area));
    Shape area = areas(united(std::move(parts)));
    if (!is_empty(area)) out.push_back({drawing.symbols[static_cast<std::size_t>(symbol)].name, std::move(area)});
    return true;
  };
  for (const auto& [piece, parts] : pieces) {
    std::vector<Point> all;
    for (const auto& [symbol, points] : parts) all.insert(all.end(), points.begin(), points.end());
    if (add(piece, all)) continue;
    for (const auto& [symbol, points] : parts) add(symbol, points);
  }
  return out;
}

}  // namespace vantage::floor_plan
