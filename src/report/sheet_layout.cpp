// SPDX-License-Identifier: Apache-2.0
#include "report/sheet_layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

// The finest ratio at which a box fits; the coarsest there is if none does.
int ratio_for(const Vec3& size, const Rect& map) {
  for (const int ratio : kRatios)
    if (size.x * kPointsPerMetre / ratio <= map.width && size.y * kPointsPerMetre / ratio <= map.height) return ratio;
  return std::end(kRatios)[-1];
}

// The way a sheet lies on which the box is drawn largest.
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

// How far apart stations are, but for a quarter of them; infinity for one.
double distance_apart(const std::vector<Vec3>& spots) {
  std::vector<double> apart;
  for (std::size_t i = 0; i < spots.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < spots.size(); ++j)
      if (j != i) least = std::min(least, std::hypot(spots[i].x - spots[j].x, spots[i].y - spots[j].y));
    apart.push_back(least);
  }
  if (apart.empty()) return std::numeric_limits<double>::infinity();
  const auto quarter = apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 4);
  std::nth_element(apart.begin(), quarter, apart.end());
  return *quarter;
}

Box around(double x, double y, const SheetLayout& layout) {
  const double width = layout.map.width / layout.points_per_metre(),
               height = layout.map.height / layout.points_per_metre();
  return {{x - width / 2, y - height / 2, 0}, {x + width / 2, y + height / 2, 0}};
}

void add_tiles(SheetLayout& layout, const Box& storey, const std::vector<Vec3>& spots) {
  const Box frame = around(0, 0, layout);
  const auto count = [](double all, double one) {
    return all <= one ? 1 : static_cast<int>(std::ceil((all - kOverlap * one) / ((1 - kOverlap) * one)));
  };
  const int columns = count(storey.size().x, frame.size().x), rows = count(storey.size().y, frame.size().y);
  const auto middle = [](double low, double high, double one, int k, int all) {
    return all == 1 ? (low + high) / 2 : low + one / 2 + k * (high - low - one) / (all - 1);
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const Box window = around(middle(storey.min.x, storey.max.x, frame.size().x, column, columns),
                                -middle(-storey.max.y, -storey.min.y, frame.size().y, row, rows), layout);
      const bool used = std::ranges::any_of(spots, [&](const Vec3& p) {
        return p.x >= window.min.x && p.x <= window.max.x && p.y >= window.min.y && p.y <= window.max.y;
      });
      if (!used && columns * rows > 1) continue;
      std::string name;
      if (columns * rows > 1) {
        for (int n = column; n >= 0; n = n / 26 - 1) name.insert(name.begin(), static_cast<char>('A' + n % 26));
        name += std::to_string(row + 1);
      }
      layout.tiles.push_back({window, name});
    }
}

}  // namespace

Paper a4() { return {"A4", 595.28, 841.89}; }
Paper lying(Paper paper) { return {paper.name, paper.height, paper.width}; }

SheetLayout lay_out(const Box& storey, const std::vector<Vec3>& spots, int coarsest, double panel) {
  const double clear = kPointsPerMetre * distance_apart(spots) / kMarkWidth;
  const auto limit = [&](int most) {
    int found = kRatios[0];
    for (const int ratio : kRatios)
      if (ratio <= most && ratio <= clear) found = ratio;
    return found;
  };
  const SheetLayout small = best_way(a4(), storey.size(), panel), large = best_way(a3(), storey.size(), panel);
  const int good = limit(coarsest / 2), readable = limit(coarsest);
  SheetLayout layout = small.ratio <= good       ? small
                       : large.ratio <= good     ? large
                       : small.ratio <= readable ? small
                                                 : large;
  layout.ratio = std::min(layout.ratio, readable);
  add_tiles(layout, storey, spots);
  return layout;
}

SheetLayout lay_out_overview(const Box& storey, double panel) {
  SheetLayout layout = best_way(a4(), storey.size(), panel);
  layout.tiles = {{around(storey.centre().x, storey.centre().y, layout), ""}};
  return layout;
}

}  // namespace vantage
