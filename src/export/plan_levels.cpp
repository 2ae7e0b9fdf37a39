// SPDX-License-Identifier: Apache-2.0
#include "export/plan_levels.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "export/relief.hpp"

namespace vantage {
namespace {

constexpr std::size_t kCells = 200;   // along the longer side
constexpr double kAbove = 0.05;       // share of the ground that must lie over other ground
constexpr double kOfLargest = 0.2;    // a floor has at least so much ground over others as the largest
constexpr double kStep = 0.25;        // metres between heights that are told apart
constexpr double kReach = 2 * kStep;  // a floor's ground may lie so much lower than its middle

// Heights of the ground under each cell's centre, lowest first.
std::vector<std::vector<double>> heights_of(const SearchMesh& mesh) {
  Box box;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) box.extend(mesh.positions[v]);
  const double cell = std::max(box.size().x, box.size().y) / kCells;
  if (box.empty() || !(cell > 0)) return {};
  const MapWindow window{.x_min = box.min.x,
                         .y_max = box.max.y,
                         .pixel_m = cell,
                         .columns = static_cast<std::size_t>(box.size().x / cell) + 1,
                         .rows = static_cast<std::size_t>(box.size().y / cell) + 1};
  std::vector<std::vector<double>> cells(window.columns * window.rows);
  for (const auto& t : mesh.triangles) {
    std::array<MapPoint, 3> c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = window.at(mesh.positions[t[k]]);
    for_each_pixel(window, c, [&](std::size_t pixel, const std::array<double, 3>& weights) {
      double z = 0;
      for (std::size_t k = 0; k < 3; ++k) z += weights[k] * mesh.positions[t[k]].z;
      cells[pixel].push_back(z);
    });
  }
  std::erase_if(cells, [](const auto& heights) { return heights.empty(); });
  for (auto& heights : cells) std::sort(heights.begin(), heights.end());
  return cells;
}

double median_of(const std::vector<std::vector<double>>& cells) {
  std::vector<double> all;
  for (const auto& heights : cells) all.insert(all.end(), heights.begin(), heights.end());
  if (all.empty()) return 0;
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  return *middle;
}

}  // namespace

std::vector<PlanLevel> plan_levels(const SearchMesh& mesh, double apart_m) {
  const auto cells = heights_of(mesh);
  std::vector<double> stacked;
  std::size_t cells_above = 0;
  for (const auto& heights : cells) {
    if (heights.back() - heights.front() < apart_m) continue;
    ++cells_above;
    stacked.insert(stacked.end(), heights.begin(), heights.end());
  }
  if (static_cast<double>(cells_above) < kAbove * static_cast<double>(cells.size()) || cells.empty())
    return {{.floor = median_of(cells)}};

  std::map<long, std::vector<double>> steps;
  for (const double z : stacked) steps[std::lround(std::floor(z / kStep))].push_back(z);
  std::vector<const std::vector<double>*> by_size;
  for (const auto& [step, heights] : steps) by_size.push_back(&heights);
  std::ranges::stable_sort(by_size, std::ranges::greater{}, [](const auto* heights) { return heights->size(); });
  std::vector<PlanLevel> levels;
  for (const auto* heights : by_size) {
    if (static_cast<double>(heights->size()) < kOfLargest * static_cast<double>(by_size.front()->size())) break;
    std::vector<double> sorted = *heights;
    std::sort(sorted.begin(), sorted.end());
    const double floor = sorted[sorted.size() / 2];
    const bool near =
        std::ranges::any_of(levels, [&](const PlanLevel& l) { return std::abs(l.floor - floor) < apart_m; });
    if (!near) levels.push_back({.floor = floor});
  }
  std::ranges::sort(levels, {}, &PlanLevel::floor);
  for (std::size_t k = 1; k < levels.size(); ++k) levels[k - 1].high = levels[k].low = levels[k].floor - kReach;
  return levels;
}

}  // namespace vantage
