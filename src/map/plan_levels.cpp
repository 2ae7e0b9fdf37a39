// SPDX-License-Identifier: Apache-2.0
#include "map/plan_levels.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/first_numbers.hpp"
#include "map/buildings.hpp"
#include "map/covered_floor.hpp"
#include "map/relief.hpp"

namespace vantage {
namespace {

constexpr std::size_t kCells = 200;   // along the longer side
constexpr double kAbove = 0.05;       // share of the ground that must lie over other ground
constexpr double kOfLargest = 0.2;    // least ground of a floor over others, as a share of the largest's
constexpr double kStep = 0.25;        // metres between heights that are told apart
constexpr double kReach = 2 * kStep;  // depth of a floor's ground below its middle, at most
constexpr double kLanding_m = 2.2;    // a landing half way up a storey's stairs is no higher, and no floor of its own

constexpr double kCutHeight = 1.2, kCutShare = 1.2 / 1.85;
constexpr double kRoofed = 0.1;  // share of stations under a roof, outside buildings, from which a site is cut

// Heights of the ground under the centre of each cell of a map, lowest first.
struct GroundHeights {
  MapWindow window;
  std::vector<std::vector<double>> cells;

  const std::vector<double>& at(const Vec3& p) const {
    static const std::vector<double> none;
    const MapPoint m = window.at(p);
    if (!(m.x >= 0 && m.y >= 0 && m.x < static_cast<double>(window.columns) && m.y < static_cast<double>(window.rows)))
      return none;
    return cells[static_cast<std::size_t>(m.y) * window.columns + static_cast<std::size_t>(m.x)];
  }
};

GroundHeights heights_of(const SearchMesh& mesh) {
  Box box;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) box.extend(mesh.positions[v]);
  const double cell = std::max(box.size().x, box.size().y) / kCells;
  if (box.empty() || !(cell > 0)) return {};
  GroundHeights ground{.window = {.x_min = box.min.x,
                                  .y_max = box.max.y,
                                  .pixel_m = cell,
                                  .columns = static_cast<std::size_t>(box.size().x / cell) + 1,
                                  .rows = static_cast<std::size_t>(box.size().y / cell) + 1},
                       .cells = {}};
  ground.cells.resize(ground.window.columns * ground.window.rows);
  for (const auto& t : mesh.triangles)
    for_each_pixel(ground.window, mesh, t, 0, [&](std::size_t pixel, double z) { ground.cells[pixel].push_back(z); });
  for (auto& heights : ground.cells) std::sort(heights.begin(), heights.end());
  return ground;
}

double middle_of(std::vector<double> values, double otherwise) {
  if (values.empty()) return otherwise;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median_of(const std::vector<std::vector<double>>& cells) {
  std::vector<double> all;
  for (const auto& heights : cells) all.insert(all.end(), heights.begin(), heights.end());
  return middle_of(std::move(all), 0);
}

double cut_above(std::span<const PlacedStation> stations) {
  std::vector<double> heights;
  for (const PlacedStation& s : stations)
    if (s.status != StationStatus::hole && s.position.z > s.ground.z)
      heights.push_back(kCutShare * (s.position.z - s.ground.z));
  return middle_of(std::move(heights), kCutHeight);
}

// The floor that a single level is cut above, if it is.
std::optional<double> roofed_floor(const Scene& scene, const SearchMesh& mesh,
                                   std::span<const PlacedStation> stations) {
  std::vector<double> roofed;
  std::size_t placed = 0;
  const std::vector<bool> under = under_roof(scene, stations);
  for (std::size_t k = 0; k < stations.size(); ++k) {
    if (stations[k].status == StationStatus::hole) continue;
    ++placed;
    if (under[k]) roofed.push_back(stations[k].ground.z);
  }
  if (placed > 0) {
    if (roofed.empty()) return std::nullopt;
    if (static_cast<double>(roofed.size()) >= kRoofed * static_cast<double>(placed))
      return middle_of(std::move(roofed), 0);
    // A few in a house on a large lawn are not to be drawn on its roof.
    const BuildingMap buildings = buildings_of(scene, mesh);
    roofed.clear();
    for (std::size_t k = 0; k < stations.size(); ++k)
      if (under[k] && stations[k].status != StationStatus::hole && buildings.at(stations[k].ground) > 0)
        roofed.push_back(stations[k].ground.z);
    if (roofed.empty()) return std::nullopt;
    return middle_of(std::move(roofed), 0);
  }
  Box box;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) box.extend(mesh.positions[v]);
  if (box.empty()) return std::nullopt;
  const MapWindow window{.x_min = box.min.x,
                         .y_max = box.max.y,
                         .pixel_m = std::max({box.size().x, box.size().y, 1e-3}) / kAcross,
                         .columns = kAcross,
                         .rows = kAcross};
  return covered_floor(mesh, look_from_above(scene.data(), window, std::numeric_limits<double>::infinity()),
                       scene.data());
}

}  // namespace

std::vector<PlanLevel> plan_levels(const SearchMesh& mesh, std::span<const PlacedStation> stations, double apart_m) {
  const GroundHeights ground = heights_of(mesh);
  const auto is_stacked = [&](const std::vector<double>& heights) {
    return !heights.empty() && heights.back() - heights.front() >= apart_m;
  };
  std::vector<double> stacked;
  std::size_t cells_above = 0, cells = 0;
  for (const auto& heights : ground.cells) {
    if (!heights.empty()) ++cells;
    if (!is_stacked(heights)) continue;
    ++cells_above;
    stacked.insert(stacked.end(), heights.begin(), heights.end());
  }
  std::vector<double> stand;  // grounds of stations above or below other ground
  for (const PlacedStation& s : stations)
    if (s.status != StationStatus::hole && is_stacked(ground.at(s.ground))) stand.push_back(s.ground.z);
  const bool enough = static_cast<double>(cells_above) >= kAbove * static_cast<double>(cells);
  if (cells_above == 0 || (!enough && stand.empty())) return {{.floor = median_of(ground.cells)}};

  std::map<long, std::vector<double>> steps;
  for (const double z : stacked) steps[std::lround(std::floor(z / kStep))].push_back(z);
  std::vector<const std::vector<double>*> by_size;
  for (const auto& [step, heights] : steps) by_size.push_back(&heights);
  std::ranges::stable_sort(by_size, std::ranges::greater{}, [](const auto* heights) { return heights->size(); });
  std::vector<PlanLevel> levels;
  const auto add = [&](double floor, double from_others_m) {
    if (std::ranges::none_of(levels, [&](const PlanLevel& l) { return std::abs(l.floor - floor) < from_others_m; }))
      levels.push_back({.floor = floor});
  };
  for (const auto* heights : by_size) {
    if (static_cast<double>(heights->size()) < kOfLargest * static_cast<double>(by_size.front()->size())) break;
    add(middle_of(*heights, 0), apart_m);
  }
  std::ranges::sort(stand);
  for (const double z : stand) add(z, std::max(apart_m, kLanding_m));
  std::ranges::sort(levels, {}, &PlanLevel::floor);
  for (std::size_t k = 1; k < levels.size(); ++k) levels[k - 1].high = levels[k].low = levels[k].floor - kReach;
  return levels;
}

std::vector<PlanLevel> cut_levels(const Scene& scene, const SearchMesh& mesh, std::span<const PlacedStation> stations) {
  std::vector<PlanLevel> levels = plan_levels(mesh, stations);
  const double above = cut_above(stations);
  if (levels.size() > 1) {
    for (PlanLevel& level : levels) level.cut = level.floor + above;
  } else if (const auto floor = roofed_floor(scene, mesh, stations)) {
    levels.front().floor = *floor, levels.front().cut = *floor + above;
  }
  return levels;
}

std::vector<bool> under_roof(const Scene& scene, std::span<const PlacedStation> stations) {
  const SceneData& data = scene.data();
  std::vector<bool> under(stations.size(), false);
  std::vector<std::size_t> by_x = first_numbers(stations.size());
  std::ranges::sort(by_x, {}, [&](std::size_t k) { return stations[k].position.x; });
  for (std::uint32_t t = 0; t < data.triangle_count(); ++t) {
    const auto c = data.corners(t);
    const std::array<Vec3, 3> p{widen(c[0]) + data.origin, widen(c[1]) + data.origin, widen(c[2]) + data.origin};
    const auto [low, high] = std::minmax({p[0].x, p[1].x, p[2].x});
    const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
    if (area == 0) continue;
    auto at = std::ranges::lower_bound(by_x, low, {}, [&](std::size_t k) { return stations[k].position.x; });
    for (; at != by_x.end() && stations[*at].position.x <= high; ++at) {
      const Vec3& head = stations[*at].position;
      const double b = ((head.x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (head.y - p[0].y)) / area;
      const double c = ((p[1].x - p[0].x) * (head.y - p[0].y) - (head.x - p[0].x) * (p[1].y - p[0].y)) / area;
      if (b < 0 || c < 0 || b + c > 1) continue;
      if (p[0].z + b * (p[1].z - p[0].z) + c * (p[2].z - p[0].z) > head.z) under[*at] = true;
    }
  }
  return under;
}

}  // namespace vantage
