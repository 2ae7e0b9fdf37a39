// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/count_station.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "core/parallel.hpp"
#include "core/target_clones.hpp"
#include "trace/embree/picture.hpp"
#include "trace/embree/run_steps.hpp"
#include "trace/embree/tile_selection.hpp"

namespace vantage {
namespace {

// Adds the points of `hits`, which lie on surveyed meshes and have their ranges.
[[gnu::always_inline]] inline void count_points(const StationRays& station_rays, const TraceStation& station,
                                                const Hits& hits, const PaneView* panes, VoxelLookup& voxels,
                                                PointBuckets::Local& points, std::uint32_t shift,
                                                StationTotals& totals) {
  const Float3& origin = station.origin;
  std::array<Passed, RayBundle::kCapacity> passed;
  const bool behind_glass = station_rays.glass() && station_rays.glass()->follow(origin, hits, panes, passed);
  const bool all_count = !station_rays.limited() || station_rays.all_count(hits);
  if (behind_glass || !all_count) {
    voxels.clear();
    for (std::uint32_t k = 0; k < hits.size; ++k) {
      const Float3 point = hits.point(origin, k);
      if (all_count && passed[k].share == 1) {
        voxels.add(point);
        continue;
      }
      const DroppedPoints dropped =
          station_rays.dropped(station, hits.ray(k), {hits.x[k], hits.y[k], hits.z[k]}, hits.t[k], hits.primitive[k],
                               behind_glass ? passed[k].share : 1);
      if (dropped.points == 0) {
        voxels.add(point);
      } else if (station_rays.grid().index_of(point) != kNoVoxel) {
        totals.dropped = totals.dropped + dropped;
      }
    }
  } else {
    voxels.set(hits.size, [&](std::uint32_t k) { return hits.point(origin, k); });
  }
  voxels.each_run([&](std::uint32_t voxel_index, std::uint32_t begin, std::uint32_t end) {
    points.add(voxel_index, shift, end - begin);
    totals.points_on_surveyed += end - begin;
  });
}

VANTAGE_TARGET_CLONES
StationTotals count_tile(const StationRays& station_rays, const TraceStation& station, const PaneView* panes,
                         const SelectedTile& planned, VoxelLookup& voxels, PointBuckets::Local& points,
                         std::uint32_t shift) {
  const RayTile& tile = planned.tile;
  RayBundle rays;
  station_rays.gather(station, tile, planned.end, rays);
  station_rays.caster().cast(rays);

  const Surface& surface = station_rays.surface();
  StationTotals totals;
  totals.rays = rays.size;
  Hits hits;
  std::uint32_t slot = 0;
  for (std::uint32_t row = tile.row; row < tile.row + tile.rows; ++row) {
    const std::uint64_t first = station_rays.ray(row, tile.column);
    for (std::uint32_t column = 0; column < tile.columns; ++column, ++slot) {
      const std::uint32_t triangle = rays.primitive[slot];
      if (triangle == RayBundle::kNoHit) continue;
      ++totals.points;
      if (surface.surveyed(triangle)) hits.add(rays, slot, first + column);
    }
  }
  station_rays.find_ranges(station, hits, true);
  count_points(station_rays, station, hits, panes, voxels, points, shift, totals);
  return totals;
}

// Replaces tiny components as RayCaster::safe() does.
[[gnu::always_inline]] inline void make_safe(Floats8& v) {
  v = (v >= RayCaster::kLeastComponent) | (v <= -RayCaster::kLeastComponent) ? v : Floats8{};
}

// Adds rays row to row + many of a column, which hit the same triangle.
[[gnu::always_inline]] inline void add_run(const StationRays& station_rays, const TraceStation& station,
                                           const Picture& picture, std::uint32_t column, std::uint32_t row,
                                           std::uint32_t many, std::uint32_t triangle, const Planes::Seen& plane,
                                           Hits& hits) {
  const RayPattern& pattern = station_rays.pattern();
  const float cosine = pattern.cos_azimuth[column], sine = pattern.sin_azimuth[column];
  // The last vector may run past the run's rays; those values are overwritten or never read.
  for (std::uint32_t k = 0, at = hits.size; k < many; k += 8, at += 8) {
    Floats8 sines, z, t;
    load(sines, picture.sines() + row + k);
    load(z, picture.cosines() + row + k);
    Floats8 x = sines * cosine, y = sines * sine;
    if (station.turn) {
      const Turn& turn = *station.turn;
      const Floats8 tx = turn.x.x * x + turn.x.y * y + turn.x.z * z, ty = turn.y.x * x + turn.y.y * y + turn.y.z * z,
                    tz = turn.z.x * x + turn.z.y * y + turn.z.z * z;
      x = tx, y = ty, z = tz;
    }
    store(hits.x + at, x);
    store(hits.y + at, y);
    store(hits.z + at, z);
    make_safe(x);
    make_safe(y);
    make_safe(z);
    if (Planes::distances(plane, x, y, z, t)) {
      store(hits.t + at, t);
    } else {
      for (std::uint32_t i = 0; i < 8; ++i) {
        const float dx = x[i], dy = y[i], dz = z[i];
        station_rays.planes().distances<1>(plane, triangle, station.origin, &dx, &dy, &dz, hits.t + at + i);
      }
    }
  }
  std::fill_n(hits.primitive + hits.size, many, triangle);
  if (station_rays.draws())
    for (std::uint32_t k = 0; k < many; ++k) {
      const std::uint64_t ray = station_rays.ray(row + k, column);
      hits.ray_low[hits.size + k] = static_cast<std::uint32_t>(ray);
      hits.ray_high[hits.size + k] = static_cast<std::uint32_t>(ray >> 32);
    }
  hits.size += many;
}

// Returns the end of a triangle's run. Reads up to eight elements past `end`, and may return a place there.
[[gnu::always_inline]] inline std::uint32_t end_of_run(const std::uint32_t* triangles, std::uint32_t at,
                                                       std::uint32_t end, std::uint32_t triangle) {
  for (; at < end; at += 8) {
    Ints8 next;
    load(next, triangles + at);
    if (any(next != static_cast<std::int32_t>(triangle))) break;
  }
  while (at < end && triangles[at] == triangle) ++at;
  return at;
}

// Points by voxel: `many` of them lie in the voxel of each `point`.
struct SettledPoints {
  std::uint32_t size = 0;
  std::array<Float3, VoxelLookup::kCapacity> point;
  std::array<std::uint32_t, VoxelLookup::kCapacity> many;

  bool full() const { return size == VoxelLookup::kCapacity; }
  void add(const Float3& of_voxel, std::uint32_t points) {
    point[size] = of_voxel;
    many[size++] = points;
  }
  [[gnu::always_inline]] void count(VoxelLookup& voxels, PointBuckets::Local& points, std::uint32_t shift,
                                    StationTotals& totals) {
    voxels.set(size, [&](std::uint32_t k) { return point[k]; });
    voxels.each_run([&](std::uint32_t voxel_index, std::uint32_t begin, std::uint32_t end) {
      std::uint32_t sum = 0;
      for (std::uint32_t k = begin; k < end; ++k) sum += many[k];
      totals.points_on_surveyed += sum;
      for (; sum > PointBuckets::kMostAtOnce; sum -= PointBuckets::kMostAtOnce)
        points.add(voxel_index, shift, PointBuckets::kMostAtOnce);
      points.add(voxel_index, shift, sum);
    });
    size = 0;
  }
};

VANTAGE_TARGET_CLONES
StationTotals count_strip(const StationRays& station_rays, const TraceStation& station, const PaneView* panes,
                          const Picture& picture, const RunSteps& steps, const Picture::Strip& strip,
                          VoxelLookup& voxels, PointBuckets::Local& points, std::uint32_t shift) {
  const Surface& surface = station_rays.surface();
  const std::uint32_t rows = station_rays.pattern().rows();
  StationTotals totals;
  totals.rays = strip.rays;
  Hits hits;
  hits.size = 0;
  SettledPoints settled;
  const auto count = [&]() __attribute__((always_inline)) {
    station_rays.find_ranges(station, hits, true);
    count_points(station_rays, station, hits, panes, voxels, points, shift, totals);
    hits.size = 0;
  };
  Facet facet;
  std::uint32_t known = Picture::kNone;  // the facet's triangle
  for (std::uint32_t j = 0; j < strip.columns; ++j) {
    const std::uint32_t* const triangles = strip.triangles(j);
    for (std::uint32_t row = 0, end; row < rows; row = end) {
      const std::uint32_t triangle = triangles[row];
      end = std::min(rows, end_of_run(triangles, row + 1, rows, triangle));
      if (triangle == Picture::kNone) continue;
      totals.points += end - row;
      if (!surface.surveyed(triangle)) continue;
      const Planes::Seen plane = station_rays.planes().seen(triangle, station.origin);
      const auto one_by_one = [&](std::uint32_t from, std::uint32_t to) __attribute__((always_inline)) {
        while (from < to) {
          const std::uint32_t many = std::min(to - from, RayBundle::kCapacity - hits.size);
          add_run(station_rays, station, picture, strip.first + j, from, many, triangle, plane, hits);
          from += many;
          if (hits.size == RayBundle::kCapacity) count();
        }
      };
      if (!steps.pay(end - row)) {
        one_by_one(row, end);
        continue;
      }
      if (triangle != known) facet = surface.facet(triangle), known = triangle;
      steps.along(
          row, end, strip.first + j, triangle, plane, facet,
          [&](const Float3& point, std::uint32_t many) __attribute__((always_inline)) {
            settled.add(point, many);
            if (settled.full()) settled.count(voxels, points, shift, totals);
          },
          one_by_one);
    }
  }
  count();
  settled.count(voxels, points, shift, totals);
  return totals;
}

// Sums up the totals of parts first to end, in parallel.
template <class Part>
StationTotals add_up(std::size_t first, std::size_t end, std::size_t grain, const StationRays& rays,
                     PointBuckets& points, const Part& part) {
  return parallel::reduce(
      tbb::blocked_range<std::size_t>(first, end, grain), StationTotals{},
      [&](const auto& range, StationTotals sum) {
        VoxelLookup voxels = rays.voxels();
        PointBuckets::Local& local = points.local();
        for (std::size_t k = range.begin(); k < range.end(); ++k) sum = sum + part(k, voxels, local);
        return sum;
      },
      std::plus<>());
}

}  // namespace

bool count_station(const StationRays& rays, const TraceStation& station, bool skip, PassField& field,
                   PointBuckets& points, StationTotals& totals, const Progress& progress) {
  const TileEnds ends = skip ? tiles_with_bricks(rays, station) : all_tiles(rays.pattern());
  const std::unique_ptr<const Picture> picture = Picture::where_it_pays(rays, station, ends);
  const std::vector<SelectedTile> tiles = picture ? std::vector<SelectedTile>() : selected(ends, rays.pattern());
  const std::unique_ptr<const PaneView> panes = rays.glass() ? rays.glass()->view(station.origin) : nullptr;
  const std::unique_ptr<const RunSteps> steps =
      picture ? std::make_unique<const RunSteps>(rays, station, *picture) : nullptr;
  tbb::enumerable_thread_specific<Picture::Strip> strips;
  const std::size_t parts = picture ? picture->strips() : tiles.size();
  // Checks the stop token about every tenth of a second.
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  const std::size_t chunk = threads * (picture ? std::max<std::size_t>(1, 4096 / ends.tall) : 1024);
  for (std::size_t first = 0; first < parts; first += chunk) {
    if (progress.stopped()) return false;
    const std::size_t end = std::min(parts, first + chunk);
    const std::uint32_t shift = points.shift();
    if (picture) {
      totals = totals + add_up(first, end, 1, rays, points, [&](std::size_t k, VoxelLookup& voxels, auto& local) {
                 Picture::Strip& strip = strips.local();
                 const auto index = static_cast<std::uint32_t>(k);
                 picture->draw(index, strip);
                 return count_strip(rays, station, panes.get(), *picture, *steps, strip, voxels, local, shift);
               });
    } else {
      totals = totals + add_up(first, end, 16, rays, points, [&](std::size_t k, VoxelLookup& voxels, auto& local) {
                 return count_tile(rays, station, panes.get(), tiles[k], voxels, local, shift);
               });
    }
    points.flush(field, std::uint64_t{1} << station.bit());
    progress(static_cast<double>(end) / static_cast<double>(parts));
  }
  return true;
}

}  // namespace vantage
