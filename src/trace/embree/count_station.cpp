// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/count_station.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "core/target_clones.hpp"
#include "trace/embree/tile_selection.hpp"

namespace vantage {
namespace {

VANTAGE_TARGET_CLONES
StationTotals count_tile(const StationRays& station_rays, const TraceStation& station, const SelectedTile& planned,
                         VoxelLookup& voxels, PointBuckets::Local& points, std::uint32_t shift) {
  const RayTile& tile = planned.tile;
  RayBundle rays;
  station_rays.gather(station, tile, planned.end, rays);
  station_rays.caster().cast(rays);

  const Surface& surface = station_rays.surface();
  const bool limited = station_rays.limited();
  StationTotals totals;
  totals.rays = rays.size;
  Hits hits;
  std::uint32_t slot = 0;
  for (std::uint32_t row = tile.row; row < tile.row + tile.rows; ++row) {
    const std::uint64_t first = station_rays.ray(row, tile.column);
    for (std::uint32_t column = 0; column < tile.columns; ++column, ++slot) {
      const std::uint32_t triangle = rays.primitive[slot];
      if (triangle == RayBundle::no_hit) continue;
      ++totals.points;
      if (surface.surveyed(triangle)) hits.add(rays, slot, first + column);
    }
  }
  station_rays.find_ranges(station, hits);
  voxels.clear();
  for (std::uint32_t k = 0; k < hits.size; ++k) {
    const Float3 point = hits.point(rays.origin, k);
    const DroppedPoints dropped = limited ? station_rays.dropped(rays, hits.slot[k]) : DroppedPoints{};
    if (dropped.points == 0) {
      voxels.add(point);
    } else if (station_rays.grid().index_of(point) != no_voxel) {
      totals.dropped = totals.dropped + dropped;
    }
  }
  voxels.each_index([&](std::uint32_t voxel_index) {
    points.add(voxel_index, shift);
    ++totals.points_on_surveyed;
  });
  return totals;
}

}  // namespace

bool count_station(const StationRays& rays, const TraceStation& station, bool skip, VoxelField& field,
                   PointBuckets& points, StationTotals& totals, const Progress& progress) {
  // About a tenth of a second between checks of the stop token.
  const std::size_t chunk = 1024 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  const std::vector<SelectedTile> tiles = skip ? tiles_with_bricks(rays, station) : all_tiles(rays.pattern());
  for (std::size_t first = 0; first < tiles.size(); first += chunk) {
    if (progress.stopped()) return false;
    const std::size_t end = std::min(tiles.size(), first + chunk);
    totals = totals + tbb::parallel_reduce(
                          tbb::blocked_range<std::size_t>(first, end, 16), StationTotals{},
                          [&](const auto& range, StationTotals part) {
                            VoxelLookup voxels = rays.voxels();
                            PointBuckets::Local& local = points.local();
                            for (std::size_t k = range.begin(); k < range.end(); ++k)
                              part = part + count_tile(rays, station, tiles[k], voxels, local, points.shift());
                            return part;
                          },
                          std::plus<>());
    points.flush(field, std::uint64_t{1} << station.bit());
    progress(static_cast<double>(end) / static_cast<double>(tiles.size()));
  }
  return true;
}

}  // namespace vantage
