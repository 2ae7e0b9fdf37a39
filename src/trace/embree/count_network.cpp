// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/count_network.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <functional>

#include "core/target_clones.hpp"
#include "trace/embree/point_buckets.hpp"
#include "trace/embree/tile_plan.hpp"
#include "trace/field_counts.hpp"

namespace vantage {
namespace {

struct TileSums {
  std::uint64_t rays = 0, points = 0, points_on_surveyed = 0;
  DroppedPoints dropped = {};
  friend TileSums operator+(const TileSums& a, const TileSums& b) {
    return {a.rays + b.rays, a.points + b.points, a.points_on_surveyed + b.points_on_surveyed, a.dropped + b.dropped};
  }
};

VANTAGE_TARGET_CLONES
TileSums count_tile(const StationRays& station_rays, const TraceStation& station, const PlannedTile& planned,
                    VoxelLookup& voxels, PointBuckets::Local& points, std::uint32_t shift) {
  const RayTile& tile = planned.tile;
  RayBundle rays;
  station_rays.gather(station, tile, planned.end, rays);
  station_rays.caster().cast(rays);

  const Surface& surface = station_rays.surface();
  const bool limited = station_rays.limited();
  TileSums sums;
  sums.rays = rays.size;
  Hits hits;
  std::uint32_t slot = 0;
  for (std::uint32_t row = tile.row; row < tile.row + tile.rows; ++row) {
    const std::uint64_t first = station_rays.ray(row, tile.column);
    for (std::uint32_t column = 0; column < tile.columns; ++column, ++slot) {
      const std::uint32_t triangle = rays.primitive[slot];
      if (triangle == RayBundle::no_hit) continue;
      ++sums.points;
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
    } else if (station_rays.grid().rank_of(point) != no_voxel) {
      sums.dropped = sums.dropped + dropped;
    }
  }
  voxels.each_rank([&](std::uint32_t rank) {
    points.add(rank, shift);
    ++sums.points_on_surveyed;
  });
  return sums;
}

}  // namespace

NetworkCounts count_network(std::span<const StationRays> scanners, std::span<const TraceStation> stations,
                            std::uint32_t station_count, double goal_density, const Tracer::CountOptions& options,
                            VoxelField& scratch, const Progress& progress) {
  const auto begun = std::chrono::steady_clock::now();
  const VoxelGrid& grid = scanners.front().grid();
  const bool limited = scanners.front().limited();  // all are or none
  VoxelField& field = options.field ? *options.field : scratch;
  field.count.assign(grid.size(), 0);
  field.stations.assign(options.masks ? grid.size() : 0, 0);

  // A tenth of a second or so between two looks at the stop token.
  const std::size_t chunk = 1024 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());

  PointBuckets points_found(grid.size());
  std::uint64_t traced = 0;
  std::vector<std::uint64_t> points(options.skip ? 0 : station_count), on_surveyed(station_count);
  std::vector<DroppedPoints> dropped(limited ? station_count : 0);
  bool cancelled = false;
  for (std::size_t s = 0; s < stations.size() && !cancelled; ++s) {
    const TraceStation& station = stations[s];
    const StationRays& rays = scanners[station.scanner];
    const std::vector<PlannedTile> tiles = options.skip ? tiles_with_bricks(rays, station) : all_tiles(rays.pattern());
    TileSums sums;
    for (std::size_t first = 0; first < tiles.size(); first += chunk) {
      if (progress.stopped()) {
        cancelled = true;
        break;
      }
      const std::size_t end = std::min(tiles.size(), first + chunk);
      sums = sums + tbb::parallel_reduce(
                        tbb::blocked_range<std::size_t>(first, end, 16), TileSums{},
                        [&](const auto& range, TileSums part) {
                          VoxelLookup voxels = rays.voxels();
                          PointBuckets::Local& local = points_found.local();
                          for (std::size_t k = range.begin(); k < range.end(); ++k)
                            part = part + count_tile(rays, station, tiles[k], voxels, local, points_found.shift());
                          return part;
                        },
                        std::plus<>());
      points_found.flush(field, std::uint64_t{1} << station.bit());
      progress((static_cast<double>(s) + static_cast<double>(end) / static_cast<double>(tiles.size())) /
               static_cast<double>(stations.size()));
    }
    traced += sums.rays;
    if (!options.skip) points[station.bit()] = sums.points;
    on_surveyed[station.bit()] = sums.points_on_surveyed;
    if (limited) dropped[station.bit()] = sums.dropped;
  }

  NetworkCounts result = reduce_field(field.count, field.stations, station_count, goal_density, grid.demands());
  result.rays = traced;
  result.points = std::move(points);
  result.points_on_surveyed = std::move(on_surveyed);
  result.dropped = std::move(dropped);
  result.cancelled = cancelled;
  result.trace_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return result;
}

}  // namespace vantage
