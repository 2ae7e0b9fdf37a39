// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/count_network.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <functional>

#include "trace/embree/tile_plan.hpp"
#include "trace/embree/voxel_cursor.hpp"
#include "trace/field_counts.hpp"

namespace vantage {
namespace {

struct TileSums {
  std::uint64_t rays = 0, points = 0, points_on_surveyed = 0;
  friend TileSums operator+(const TileSums& a, const TileSums& b) {
    return {a.rays + b.rays, a.points + b.points, a.points_on_surveyed + b.points_on_surveyed};
  }
};

// A tile's share is at most RayBundle::capacity, so however many threads add at once, none passes the top before it is
// seen to be near.
void add_saturating(std::uint32_t& count, std::uint32_t n) {
  constexpr std::uint32_t near_top = 0xFF000000u;
  const std::atomic_ref<std::uint32_t> shared(count);
  std::uint32_t old = shared.load(std::memory_order_relaxed);
  if (old < near_top) {
    shared.fetch_add(n, std::memory_order_relaxed);
    return;
  }
  while (!shared.compare_exchange_weak(old, old > 0xFFFFFFFFu - n ? 0xFFFFFFFFu : old + n, std::memory_order_relaxed)) {
  }
}

// Adds the points of one station to the voxels they lie in.
class VoxelCounter {
 public:
  VoxelCounter(VoxelField& field, const TraceStation& station, bool masks)
      : field_(field), bit_(std::uint64_t{1} << station.place), masks_(masks) {}

  void add(std::uint32_t rank, std::uint32_t n) const {
    add_saturating(field_.count[rank], n);
    if (!masks_) return;
    const std::atomic_ref<std::uint64_t> mask(field_.stations[rank]);
    if ((mask.load(std::memory_order_relaxed) & bit_) == 0) mask.fetch_or(bit_, std::memory_order_relaxed);
  }

 private:
  VoxelField& field_;
  std::uint64_t bit_;
  bool masks_;
};

TileSums count_tile(const StationRays& station_rays, const TraceStation& station, const PlannedTile& planned,
                    VoxelCursor& voxels, const VoxelCounter& counter) {
  const RayTile& tile = planned.tile;
  RayBundle rays;
  station_rays.gather(station, tile, planned.end, rays);
  station_rays.caster().cast(rays);

  TileSums sums;
  sums.rays = rays.size;
  std::uint32_t run_rank = no_voxel, run = 0;  // neighbours often share a voxel: one addition for all of them
  for (std::uint32_t slot = 0; slot < rays.size; ++slot) {
    const std::uint32_t triangle = rays.primitive[slot];
    if (triangle == RayBundle::no_hit) continue;
    ++sums.points;
    if (!station_rays.surface().surveyed(triangle)) continue;
    const std::uint64_t ray = station_rays.ray(tile.row + slot / tile.columns, tile.column + slot % tile.columns);
    const float range = station_rays.range(rays, slot, ray, station.place);
    const std::uint32_t rank = voxels.rank_of(StationRays::point(rays, slot, range));
    if (rank != run_rank) {
      if (run != 0) counter.add(run_rank, run);
      run_rank = rank;
      run = 0;
    }
    if (rank == no_voxel) continue;
    ++run;
    ++sums.points_on_surveyed;
  }
  if (run != 0) counter.add(run_rank, run);
  return sums;
}

}  // namespace

NetworkCounts count_network(const StationRays& rays, std::span<const TraceStation> stations,
                            std::uint32_t station_count, double goal_density, const Tracer::CountOptions& options,
                            const Progress& progress) {
  const auto begun = std::chrono::steady_clock::now();
  VoxelField own;
  VoxelField& field = options.field ? *options.field : own;
  field.count.assign(rays.grid().size(), 0);
  field.stations.assign(options.masks ? rays.grid().size() : 0, 0);

  // A tenth of a second or so between two looks at the stop token.
  const std::size_t chunk = 4096 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());

  std::uint64_t traced = 0;
  std::vector<std::uint64_t> points(options.skip ? 0 : station_count), on_surveyed(station_count);
  bool cancelled = false;
  for (std::size_t s = 0; s < stations.size() && !cancelled; ++s) {
    const TraceStation& station = stations[s];
    const VoxelCounter counter(field, station, options.masks);
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
                          VoxelCursor voxels(rays.grid());
                          for (std::size_t k = range.begin(); k < range.end(); ++k)
                            part = part + count_tile(rays, station, tiles[k], voxels, counter);
                          return part;
                        },
                        std::plus<>());
      progress((static_cast<double>(s) + static_cast<double>(end) / static_cast<double>(tiles.size())) /
               static_cast<double>(stations.size()));
    }
    traced += sums.rays;
    if (!options.skip) points[station.place] = sums.points;
    on_surveyed[station.place] = sums.points_on_surveyed;
  }

  NetworkCounts result = reduce_field(field.count, field.stations, station_count, goal_density);
  result.rays = traced;
  result.points = std::move(points);
  result.points_on_surveyed = std::move(on_surveyed);
  result.cancelled = cancelled;
  result.trace_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return result;
}

}  // namespace vantage
