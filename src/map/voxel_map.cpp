// SPDX-License-Identifier: Apache-2.0
#include "map/voxel_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/text.hpp"
#include "map/chart.hpp"
#include "map/map_grid.hpp"
#include "map/plan_levels.hpp"
#include "map/section.hpp"

namespace vantage {
namespace {

constexpr std::size_t kFine = 2;  // pixels a unit of the canvas
constexpr Colour kHead{0.10, 0.22, 0.45};
// Up to which height over the floor what is cut shows, in heights of the cut: over the heads, below most ceilings.
constexpr double kBelowCeiling = 1.7;

std::uint32_t opaque(const Colour& colour) {
  const auto [r, g, b] = to_bytes(colour);
  return 0xFF000000u | std::uint32_t{r} << 16 | std::uint32_t{g} << 8 | b;
}

}  // namespace

void draw_voxel_map(const std::filesystem::path& file, Site& site, std::span<const ColouredVoxel> voxels,
                    std::span<const PlacedStation> stations, const std::string& title, const std::string& subtitle,
                    double legend_width, const std::function<Point(Canvas& canvas, Point at)>& legend) {
  const Simulator& simulator = site.simulator();
  const std::vector<PlanLevel> levels = cut_levels(simulator.scene(), site.area().mesh(), stations);
  Box box;
  for (const ColouredVoxel& voxel : voxels) box.extend(simulator.voxel_centre(voxel.index));
  for (const PlacedStation& station : stations)
    if (station.status == StationStatus::ok) box.extend(station.position);
  const double share = static_cast<double>(voxels.size()) / static_cast<double>(simulator.voxel_count());
  const double half = 0.5 * simulator.voxel_size_m() / std::sqrt(share);
  const double margin = half + 0.03 * std::max(box.size().x, box.size().y);
  const double width = box.size().x + 2 * margin, height = box.size().y + 2 * margin;
  const double west = box.min.x - margin, north = box.max.y + margin;
  const bool several = levels.size() > 1;
  const MapGrid grid(levels.size());
  const double metre = std::min(grid.width / width, grid.height / height);  // canvas units
  constexpr double kTop = 68, kBottom = 64;
  const double across = std::ceil(width * metre), down = std::ceil(height * metre);
  const auto ticks = [](double length) { return std::max(2, static_cast<int>(length / 95)); };
  const Axis y_axis{.label = "y (m)", .low = north - down / metre, .high = north, .wanted_ticks = ticks(down)};
  const double left = room_left_of(Canvas(1, 1), y_axis);
  const auto map_of = [&](std::size_t k) {
    return Rect{left + static_cast<double>(k % grid.columns) * (across + left + 10),
                kTop + static_cast<double>(k / grid.columns) * (down + kBottom + 30), across, down};
  };
  const Rect last{map_of(grid.columns - 1).x, kTop, across, down};  // of the first row
  Canvas canvas(last.right() + 24 + legend_width + 26,
                std::max(map_of(levels.size() - 1).bottom() + kBottom, last.y + 260));
  const auto columns = static_cast<std::size_t>(last.width) * kFine,
             rows = static_cast<std::size_t>(last.height) * kFine;
  const auto pixel = [&](double metres, std::size_t size) {
    return static_cast<std::size_t>(
        std::clamp(metres * metre * static_cast<double>(kFine), 0.0, static_cast<double>(size - 1)));
  };
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const PlanLevel& level = levels[k];
    const Rect map = map_of(k);
    std::string words = subtitle;
    if (several)
      words = "Level " + std::to_string(k + 1) +
              (grid.contact() ? ", z = " : " of " + std::to_string(levels.size()) + ", floor at z = ") +
              fixed(level.floor, 2) + " m";
    else
      words += level.cut ? ", without what lies over the heads" : ", through whatever lies over them";
    const Chart chart(
        canvas, map,
        {.label = "x (m)", .low = west, .high = west + map.width / metre, .wanted_ticks = ticks(map.width)}, y_axis,
        k == 0 ? title : "", words);
    std::vector<std::uint32_t> pixels(columns * rows);
    const double top =
        level.cut ? level.floor + kBelowCeiling * (*level.cut - level.floor) : std::numeric_limits<double>::infinity();
    // Voxels below a floor that is cut above are drawn from the lowest up, all others in their order.
    std::vector<std::pair<long, const ColouredVoxel*>> shown;
    for (const ColouredVoxel& voxel : voxels) {
      const double z = simulator.voxel_centre(voxel.index).z;
      if (z < level.low || z > top) continue;
      const double down = level.cut ? std::min(0.0, z - (level.floor - simulator.voxel_size_m())) : 0;
      shown.emplace_back(std::lround(std::floor(down / simulator.voxel_size_m())), &voxel);
    }
    std::ranges::stable_sort(shown, {}, [](const auto& one) { return one.first; });
    for (const auto& [layer, voxel] : shown) {
      const Vec3 centre = simulator.voxel_centre(voxel->index);
      const std::size_t x0 = pixel(centre.x - half - west, columns), x1 = pixel(centre.x + half - west, columns);
      const std::size_t y0 = pixel(north - centre.y - half, rows), y1 = pixel(north - centre.y + half, rows);
      for (std::size_t y = y0; y <= y1; ++y)
        std::fill_n(pixels.begin() + static_cast<std::ptrdiff_t>(y * columns + x0), x1 - x0 + 1, opaque(voxel->colour));
    }
    canvas.image(map, pixels, columns);
    canvas.clip(map);
    if (level.cut)
      for (const auto& [a, b] : section_lines(simulator.scene().data(), *level.cut))
        canvas.line(chart.at(a.x, a.y), chart.at(b.x, b.y), {.colour = style::kInk, .width = 0.8});
    for (const PlacedStation& station : stations) {
      if (station.status != StationStatus::ok || !level.holds(station.ground.z)) continue;
      const Point at = chart.at(station.position.x, station.position.y);
      canvas.disc(at, 6, {1, 1, 1});
      canvas.disc(at, 4.5, kHead);
    }
    canvas.unclip();
    canvas.rectangle(map, {.colour = style::kFaint, .width = 1});
  }
  const Point end = legend(canvas, {last.right() + 24, last.y + 8});
  canvas.disc({end.x + 12, end.y}, 4.5, kHead);
  canvas.text({end.x + 34, end.y}, "station", {.size = 12.5});
  canvas.save(file);
}

}  // namespace vantage
