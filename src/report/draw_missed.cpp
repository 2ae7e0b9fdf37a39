// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "report/chart.hpp"
#include "report/missed_colours.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {
namespace {

constexpr std::size_t kFine = 2;  // pixels a unit of the canvas
constexpr double kPanel = 230;

std::uint32_t opaque(const Colour& colour) {
  const auto [r, g, b] = to_bytes(colour);
  return 0xFF000000u | std::uint32_t{r} << 16 | std::uint32_t{g} << 8 | b;
}

}  // namespace

void draw_missed(const std::filesystem::path& file, const Simulator& simulator, std::span<const std::uint32_t> ranks,
                 std::span<const WhyMissed> why, std::span<const PlacedStation> stations, const std::string& title) {
  if (ranks.size() != why.size() || ranks.empty())
    throw Error(Errc::invalid_argument, "draw_missed: " + std::to_string(ranks.size()) + " voxels and " +
                                            std::to_string(why.size()) + " reasons");
  Box box;
  for (const std::uint32_t rank : ranks) box.extend(simulator.voxel_centre(rank));
  for (const PlacedStation& station : stations)
    if (station.status == StationStatus::ok) box.extend(station.position);
  // Voxels of a sample stand for their neighbours too.
  const double share = static_cast<double>(ranks.size()) / static_cast<double>(simulator.voxel_count());
  const double half = 0.5 * simulator.voxel_size_m() / std::sqrt(share);
  const double margin = half + 0.03 * std::max(box.size().x, box.size().y);
  const double width = box.size().x + 2 * margin, height = box.size().y + 2 * margin;
  const double west = box.min.x - margin, north = box.max.y + margin;
  const double metre = std::min(700 / width, 640 / height);  // canvas units
  const Rect map{86, 68, std::ceil(width * metre), std::ceil(height * metre)};
  Canvas canvas(map.right() + 26 + kPanel, std::max(map.bottom() + 64, map.y + 260));
  const Chart chart(canvas, map, {.label = "x (m)", .low = west, .high = west + map.width / metre, .wanted_ticks = 7},
                    {.label = "y (m)", .low = north - map.height / metre, .high = north, .wanted_ticks = 7}, title,
                    "Surveyed surfaces from above, whatever lies over them");

  const auto columns = static_cast<std::size_t>(map.width) * kFine, rows = static_cast<std::size_t>(map.height) * kFine;
  std::vector<std::uint32_t> pixels(columns * rows);
  std::array<std::size_t, why_missed_count> count{};
  for (const MissedStyle& style : kMissedStyles) {
    for (std::size_t i = 0; i < ranks.size(); ++i) {
      if (why[i] != style.why) continue;
      ++count[static_cast<std::size_t>(style.why)];
      const Vec3 centre = simulator.voxel_centre(ranks[i]);
      const auto pixel = [&](double metres, std::size_t size) {
        return static_cast<std::size_t>(
            std::clamp(metres * metre * static_cast<double>(kFine), 0.0, static_cast<double>(size - 1)));
      };
      const std::size_t x0 = pixel(centre.x - half - west, columns), x1 = pixel(centre.x + half - west, columns);
      const std::size_t y0 = pixel(north - centre.y - half, rows), y1 = pixel(north - centre.y + half, rows);
      for (std::size_t y = y0; y <= y1; ++y)
        std::fill_n(pixels.begin() + static_cast<std::ptrdiff_t>(y * columns + x0), x1 - x0 + 1, opaque(style.colour));
    }
  }
  canvas.image(map, pixels, columns);
  canvas.rectangle(map, {.colour = style::faint, .width = 1});
  for (const PlacedStation& station : stations) {
    if (station.status != StationStatus::ok) continue;
    const Point at = chart.at(station.position.x, station.position.y);
    canvas.disc(at, 6, {1, 1, 1});
    canvas.disc(at, 4.5, {0.10, 0.22, 0.45});
  }

  Point at{map.right() + 24, map.y + 8};
  for (const MissedStyle& style : kMissedStyles) {
    canvas.fill({at.x, at.y - 7, 24, 14}, style.colour);
    const double percent =
        100 * static_cast<double>(count[static_cast<std::size_t>(style.why)]) / static_cast<double>(ranks.size());
    canvas.text({at.x + 34, at.y}, std::string(style.words) + ", " + fixed(percent, 1) + " %", {.size = 12.5});
    at.y += 24;
  }
  canvas.disc({at.x + 12, at.y}, 4.5, {0.10, 0.22, 0.45});
  canvas.text({at.x + 34, at.y}, "station", {.size = 12.5});
  canvas.save(file);
}

}  // namespace vantage
