// SPDX-License-Identifier: Apache-2.0
#include "export/voxel_map.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "export/chart.hpp"

namespace vantage {
namespace {

constexpr std::size_t kFine = 2;  // pixels a unit of the canvas
constexpr double kPanel = 264;    // the longest line of any legend, and a margin
constexpr Colour kHead{0.10, 0.22, 0.45};

std::uint32_t opaque(const Colour& colour) {
  const auto [r, g, b] = to_bytes(colour);
  return 0xFF000000u | std::uint32_t{r} << 16 | std::uint32_t{g} << 8 | b;
}

}  // namespace

void draw_voxel_map(const std::filesystem::path& file, const Simulator& simulator,
                    std::span<const ColouredVoxel> voxels, std::span<const PlacedStation> stations,
                    const std::string& title, const std::string& subtitle,
                    const std::function<Point(Canvas& canvas, Point at)>& legend) {
  Box box;
  for (const ColouredVoxel& voxel : voxels) box.extend(simulator.voxel_centre(voxel.rank));
  for (const PlacedStation& station : stations)
    if (station.status == StationStatus::ok) box.extend(station.position);
  const double share = static_cast<double>(voxels.size()) / static_cast<double>(simulator.voxel_count());
  const double half = 0.5 * simulator.voxel_size_m() / std::sqrt(share);
  const double margin = half + 0.03 * std::max(box.size().x, box.size().y);
  const double width = box.size().x + 2 * margin, height = box.size().y + 2 * margin;
  const double west = box.min.x - margin, north = box.max.y + margin;
  const double metre = std::min(700 / width, 640 / height);  // canvas units
  const Rect map{86, 68, std::ceil(width * metre), std::ceil(height * metre)};
  Canvas canvas(map.right() + 26 + kPanel, std::max(map.bottom() + 64, map.y + 260));
  const Chart chart(canvas, map, {.label = "x (m)", .low = west, .high = west + map.width / metre, .wanted_ticks = 7},
                    {.label = "y (m)", .low = north - map.height / metre, .high = north, .wanted_ticks = 7}, title,
                    subtitle);

  const auto columns = static_cast<std::size_t>(map.width) * kFine, rows = static_cast<std::size_t>(map.height) * kFine;
  std::vector<std::uint32_t> pixels(columns * rows);
  const auto pixel = [&](double metres, std::size_t size) {
    return static_cast<std::size_t>(
        std::clamp(metres * metre * static_cast<double>(kFine), 0.0, static_cast<double>(size - 1)));
  };
  for (const ColouredVoxel& voxel : voxels) {
    const Vec3 centre = simulator.voxel_centre(voxel.rank);
    const std::size_t x0 = pixel(centre.x - half - west, columns), x1 = pixel(centre.x + half - west, columns);
    const std::size_t y0 = pixel(north - centre.y - half, rows), y1 = pixel(north - centre.y + half, rows);
    for (std::size_t y = y0; y <= y1; ++y)
      std::fill_n(pixels.begin() + static_cast<std::ptrdiff_t>(y * columns + x0), x1 - x0 + 1, opaque(voxel.colour));
  }
  canvas.image(map, pixels, columns);
  canvas.rectangle(map, {.colour = style::faint, .width = 1});
  for (const PlacedStation& station : stations) {
    if (station.status != StationStatus::ok) continue;
    const Point at = chart.at(station.position.x, station.position.y);
    canvas.disc(at, 6, {1, 1, 1});
    canvas.disc(at, 4.5, kHead);
  }
  const Point end = legend(canvas, {map.right() + 24, map.y + 8});
  canvas.disc({end.x + 12, end.y}, 4.5, kHead);
  canvas.text({end.x + 34, end.y}, "station", {.size = 12.5});
  canvas.save(file);
}

}  // namespace vantage
