// SPDX-License-Identifier: Apache-2.0
#include "report/coverage_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "scan/captured_share.hpp"

namespace vantage {
namespace {

using Place = std::array<std::uint32_t, 3>;  // of a voxel, in voxels from the lowest

// Smallest side of a cell, in voxels, at which `most` cells hold all places.
std::uint32_t fitting_side(const std::vector<Place>& places, std::size_t most) {
  Place last{};
  for (const Place& p : places)
    for (std::size_t k = 0; k < 3; ++k) last[k] = std::max(last[k], p[k]);
  const auto fits = [&](std::uint32_t side) {
    if (last[0] / side >= CoverageCells::kMostAcross || last[1] / side >= CoverageCells::kMostAcross ||
        last[2] / side >= CoverageCells::kMostUp)
      return false;
    std::vector<std::uint64_t> keys;
    for (const Place& p : places)
      keys.push_back(std::uint64_t{p[0] / side} << 42 | std::uint64_t{p[1] / side} << 21 | p[2] / side);
    std::ranges::sort(keys);
    return static_cast<std::size_t>(std::unique(keys.begin(), keys.end()) - keys.begin()) <= most;
  };
  std::uint32_t high = 1;
  while (!fits(high)) high *= 2;
  std::uint32_t low = high / 2;  // too small, or 0
  while (high - low > 1) (fits((low + high) / 2) ? high : low) = (low + high) / 2;
  return high;
}

}  // namespace

std::size_t CoverageCells::place_of(std::uint32_t voxel) const {
  return static_cast<std::size_t>(std::ranges::lower_bound(voxels, voxel) - voxels.begin());
}

CoverageCells coverage_cells(const Simulator& simulator, std::uint64_t voxels, std::size_t cells) {
  CoverageCells result;
  if (simulator.voxel_count() == 0) return result;
  result.voxels = simulator.sampled_voxels(std::min(voxels, simulator.voxel_count()));
  Box box;
  for (const std::uint32_t index : result.voxels) box.extend(simulator.voxel_centre(index));
  const double voxel = simulator.voxel_size_m();
  std::vector<Place> places;
  for (const std::uint32_t index : result.voxels) {
    const Vec3 from = simulator.voxel_centre(index) - box.min;
    const auto step = [&](double metres) { return static_cast<std::uint32_t>(std::lround(metres / voxel)); };
    places.push_back({step(from.x), step(from.y), step(from.z)});
  }
  const std::uint32_t side = fitting_side(places, cells);
  result.size_m = voxel * side;
  result.corner = box.min - Vec3{voxel / 2, voxel / 2, voxel / 2} - simulator.origin();
  std::unordered_map<std::uint32_t, std::uint32_t> known;
  for (const Place& p : places) {
    const std::uint32_t key = p[0] / side | p[1] / side << 11 | p[2] / side << 22;
    const auto [cell, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(result.keys.size()));
    if (is_new) result.keys.push_back(key);
    result.cell_of.push_back(cell->second);
  }
  for (const std::uint32_t key : result.keys) {
    result.first.push_back(static_cast<std::uint32_t>(result.neighbours.size()));
    const std::uint32_t x = key & 2047, y = key >> 11 & 2047, z = key >> 22;
    for (std::uint32_t i = x - (x > 0); i <= x + 1; ++i)
      for (std::uint32_t j = y - (y > 0); j <= y + 1; ++j)
        for (std::uint32_t k = z - (z > 0); k <= z + 1; ++k) {
          const auto cell = known.find(i | j << 11 | k << 22);
          if (cell != known.end() && cell->first != key) result.neighbours.push_back(cell->second);
        }
  }
  result.first.push_back(static_cast<std::uint32_t>(result.neighbours.size()));
  return result;
}

namespace {

// Calls give(from, to) for each unknown cell, ring by ring around the known ones. Cells that cannot be reached follow
// the one before them in order.
template <class Give>
void spread(const CoverageCells& cells, std::vector<bool> known, Give&& give) {
  std::vector<std::uint32_t> queue;
  for (std::uint32_t c = 0; c < known.size(); ++c)
    if (known[c]) queue.push_back(c);
  for (std::size_t head = 0; head < queue.size(); ++head)
    for (std::uint32_t n = cells.first[queue[head]]; n < cells.first[queue[head] + 1]; ++n) {
      const std::uint32_t next = cells.neighbours[n];
      if (known[next]) continue;
      known[next] = true;
      give(queue[head], next);
      queue.push_back(next);
    }
  for (std::uint32_t c = 1; c < known.size(); ++c)
    if (!known[c]) give(c - 1, c);
}

}  // namespace

Seer seer_of(const VoxelField& field, std::uint32_t voxel) {
  Seer seer = 0;
  field.stations.for_each_station(voxel,
                                  [&](std::size_t station) { seer = together(seer, static_cast<Seer>(station + 1)); });
  return seer;
}

CellColours cell_colours(const CoverageCells& cells, std::span<const std::uint32_t> voxel_indices,
                         std::span<const std::uint32_t> counts, std::span<const Seer> seen_by,
                         const Simulator& simulator) {
  std::vector<double> sum(cells.keys.size(), 0.0);
  std::vector<std::uint32_t> voxels(cells.keys.size(), 0);
  std::vector<Seer> seen(cells.keys.size(), 0);
  for (std::size_t i = 0; i < voxel_indices.size(); ++i) {
    const std::uint32_t cell = cells.cell_of[cells.place_of(voxel_indices[i])];
    sum[cell] += captured_share(simulator, voxel_indices[i], counts[i]);
    seen[cell] = together(seen[cell], seen_by[i]);
    ++voxels[cell];
  }
  CellColours colours;
  std::vector<bool> known;
  for (std::size_t c = 0; c < sum.size(); ++c) {
    known.push_back(voxels[c] > 0);
    colours.coverage.push_back(static_cast<std::uint8_t>(voxels[c] > 0 ? std::lround(254 * sum[c] / voxels[c]) : 0));
    colours.only.push_back(static_cast<std::uint8_t>(std::min<Seer>(seen[c], 255)));
  }
  spread(cells, std::move(known), [&](std::uint32_t from, std::uint32_t to) {
    colours.coverage[to] = colours.coverage[from];
    colours.only[to] = colours.only[from];
  });
  return colours;
}

std::vector<std::uint8_t> cell_reasons(const CoverageCells& cells, std::span<const std::uint32_t> voxel_indices,
                                       std::span<const VoxelStatus> status) {
  std::vector<std::array<std::uint32_t, why_missed_count>> count(cells.keys.size());
  for (std::size_t i = 0; i < voxel_indices.size(); ++i)
    ++count[cells.cell_of[cells.place_of(voxel_indices[i])]][static_cast<std::size_t>(status[i].why)];
  std::vector<std::uint8_t> reasons;
  std::vector<bool> known;
  for (std::uint32_t cell = 0; cell < count.size(); ++cell) {
    auto c = count[cell];
    for (std::uint32_t n = cells.first[cell]; n < cells.first[cell + 1]; ++n)
      for (std::size_t k = 0; k < why_missed_count; ++k) c[k] += count[cells.neighbours[n]][k];
    const auto most = std::ranges::max_element(c);
    known.push_back(*most > 0);
    reasons.push_back(static_cast<std::uint8_t>(most - c.begin()));
  }
  spread(cells, std::move(known), [&](std::uint32_t from, std::uint32_t to) { reasons[to] = reasons[from]; });
  return reasons;
}

}  // namespace vantage
