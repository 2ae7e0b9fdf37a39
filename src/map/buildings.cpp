// SPDX-License-Identifier: Apache-2.0
#include "map/buildings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace vantage {
namespace {

constexpr double kRoof_m = 1.5;     // a roof is at least so high over the ground
constexpr double kBridged_m = 0.5;  // ground on both sides of a wall is one building: half of what may lie between
constexpr double kLeastBuilding_m2 = 15;
constexpr double kWalled = 0.55;  // share of a building's border where ground ends: less than half under eaves alone
constexpr double kAmid = 0.2;     // share of its cells amid others: along a block runs a seam that its roof covers

}  // namespace

BuildingMap buildings_of(const Scene& scene, const SearchMesh& mesh) {
  Box box;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) box.extend(mesh.positions[v]);
  if (box.empty()) return {};
  const double pixel = std::max(0.25, std::max(box.size().x, box.size().y) / kAcross);
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(kBridged_m / pixel));
  // A rim wide enough for what is bridged.
  const auto rim = static_cast<double>(reach + 1);
  BuildingMap map{.window = {.x_min = box.min.x - rim * pixel,
                             .y_max = box.max.y + rim * pixel,
                             .pixel_m = pixel,
                             .columns = static_cast<std::size_t>(box.size().x / pixel + 2 * rim) + 1,
                             .rows = static_cast<std::size_t>(box.size().y / pixel + 2 * rim) + 1},
                  .building = {}};
  const auto columns = static_cast<std::ptrdiff_t>(map.window.columns),
             rows = static_cast<std::ptrdiff_t>(map.window.rows);
  map.building.assign(map.window.columns * map.window.rows, 0);
  const HeightBuffer top = look_from_above(scene.data(), map.window, std::numeric_limits<double>::infinity());
  const double origin_z = scene.data().origin.z;
  enum : char { none, open, covered };
  std::vector<char> ground(map.building.size(), none);
  for (const auto& t : mesh.triangles)
    for_each_pixel(map.window, mesh, t, 0, [&](std::size_t pixel_index, double z) {
      const bool roofed = static_cast<double>(top.z[pixel_index]) + origin_z > z + kRoof_m;
      ground[pixel_index] = std::max(ground[pixel_index], static_cast<char>(roofed ? covered : open));
    });
  // Covered ground and what is near to it, without open ground.
  std::vector<bool> near(ground.size(), false);
  for (std::ptrdiff_t y = 0; y < rows; ++y)
    for (std::ptrdiff_t x = 0; x < columns; ++x) {
      if (ground[static_cast<std::size_t>(y * columns + x)] != covered) continue;
      for (std::ptrdiff_t dy = -reach; dy <= reach; ++dy)
        for (std::ptrdiff_t dx = -reach; dx <= reach; ++dx) {
          if (x + dx < 0 || y + dy < 0 || x + dx >= columns || y + dy >= rows) continue;
          const auto at = static_cast<std::size_t>((y + dy) * columns + x + dx);
          if (ground[at] != open) near[at] = true;
        }
    }
  struct Found {
    std::vector<std::size_t> cells;
    std::size_t covered = 0, amid = 0;  // amid others
  };
  std::vector<Found> found;
  std::vector<bool> seen(ground.size(), false);
  for (std::size_t start = 0; start < ground.size(); ++start) {
    if (!near[start] || seen[start]) continue;
    Found one;
    std::size_t border = 0, walled = 0;
    one.cells.push_back(start), seen[start] = true;
    for (std::size_t head = 0; head < one.cells.size(); ++head) {
      const std::size_t cell = one.cells[head];
      one.covered += ground[cell] == covered;
      bool amid = ground[cell] == covered;
      const auto x = static_cast<std::ptrdiff_t>(cell) % columns, y = static_cast<std::ptrdiff_t>(cell) / columns;
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= columns || y + dy >= rows) continue;
        const auto to = static_cast<std::size_t>((y + dy) * columns + x + dx);
        amid = amid && ground[to] == covered;
        // The border is that of the covered ground. No ground below the same roof: a wall, or what stands along it.
        if (ground[cell] == covered && ground[to] != covered)
          ++border, walled += ground[to] == none && top.z[to] > top.z[cell] - static_cast<float>(kRoof_m);
        if (near[to] && !seen[to]) seen[to] = true, one.cells.push_back(to);
      }
      one.amid += amid;
    }
    if (static_cast<double>(one.covered) * pixel * pixel >= kLeastBuilding_m2 &&
        static_cast<double>(one.amid) >= kAmid * static_cast<double>(one.covered) &&
        static_cast<double>(walled) >= kWalled * static_cast<double>(border))
      found.push_back(std::move(one));
  }
  std::ranges::stable_sort(found, std::ranges::greater{}, &Found::covered);
  for (const Found& one : found) {
    ++map.count;
    for (const std::size_t cell : one.cells) map.building[cell] = map.count;
  }
  return map;
}

}  // namespace vantage
