// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/tile_selection.hpp"

#include <atomic>
#include <cmath>

#include "core/parallel.hpp"
#include "trace/rays_of_box.hpp"

namespace vantage {
namespace {

std::uint32_t tiles_across(std::uint32_t rays, std::uint32_t side = RayTile::kSide) { return (rays + side - 1) / side; }
std::uint32_t tiles_down(const RayPattern& pattern) { return tiles_across(pattern.rows(), RayTile::rows_of(pattern)); }

void raise(float& value, float to) {
  const std::atomic_ref<float> shared(value);
  float old = shared.load(std::memory_order_relaxed);
  while (old < to && !shared.compare_exchange_weak(old, to, std::memory_order_relaxed)) {
  }
}

}  // namespace

RayTile tile_at(const RayPattern& pattern, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t rows = RayTile::rows_of(pattern);
  RayTile tile{a * rows, b * RayTile::kSide, 0, 0};
  tile.rows = std::min(rows, pattern.rows() - tile.row);
  tile.columns = std::min(RayTile::kSide, pattern.columns() - tile.column);
  return tile;
}

TileEnds all_tiles(const RayPattern& pattern) {
  TileEnds ends{tiles_down(pattern), tiles_across(pattern.columns()), {}};
  ends.end.assign(std::size_t{ends.tall} * ends.wide, pattern.max_range);
  return ends;
}

TileEnds tiles_with_bricks(const StationRays& rays, const TraceStation& station) {
  const RayPattern& pattern = rays.pattern();
  const VoxelGrid& grid = rays.grid();
  const double reach = static_cast<double>(rays.noise().reach());
  if (pattern.list) return all_tiles(pattern);  // neighbours in a list may point anywhere
  // If noise may carry a point through the head to the other side, the rays of that side are needed.
  if (reach > 0 && reach >= static_cast<double>(pattern.min_range)) return all_tiles(pattern);

  TileEnds tiles{tiles_down(pattern), tiles_across(pattern.columns()), {}};
  const std::uint32_t wide = tiles.wide;
  std::vector<float>& ends = tiles.end;
  ends.assign(std::size_t{tiles.tall} * wide, 0.0f);
  const Vec3 head{station.origin.x, station.origin.y, station.origin.z};
  const Vec3 min{grid.min()[0], grid.min()[1], grid.min()[2]};
  const double side = grid.voxel_size() * (1 << brick_bits), cube = grid.voxel_size() * (1 << grid.depth());
  // Bounds all values that are rounded on the way to a voxel.
  const double magnitude = std::sqrt(dot(head, head)) + std::sqrt(dot(min, min)) + 2 * cube;
  const double pad = rounding_pad(magnitude);
  const double stretch = 1 + 0x1p-20;  // far above the rounding of a distance

  parallel::for_all(tbb::blocked_range<std::size_t>(0, grid.bricks().size(), 1024), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      const VoxelBrick& brick = grid.bricks()[k];
      const Vec3 corner = min + Vec3{brick.x * side, brick.y * side, brick.z * side} - head;
      Vec3 low = corner - Vec3{pad, pad, pad}, high = corner + Vec3{side + pad, side + pad, side + pad};
      const Vec3 far{std::max(-low.x, high.x), std::max(-low.y, high.y), std::max(-low.z, high.z)};
      if (station.turn) turn_back(*station.turn, low, high);
      const RayRanges seen = rays_of_box(pattern, low, high);
      if (seen.empty()) continue;
      const auto end = static_cast<float>((std::sqrt(dot(far, far)) + reach) * stretch);
      for (const RayRanges::Range& columns : seen.columns) {
        if (columns.empty()) continue;
        for (std::uint32_t a = seen.rows.begin / RayTile::kSide; a <= (seen.rows.end - 1) / RayTile::kSide; ++a) {
          for (std::uint32_t b = columns.begin / RayTile::kSide; b <= (columns.end - 1) / RayTile::kSide; ++b)
            raise(ends[std::size_t{a} * wide + b], end);
        }
      }
    }
  });

  for (float& end : ends) end = end > pattern.min_range ? std::min(end, pattern.max_range) : 0.0f;
  return tiles;
}

std::vector<SelectedTile> selected(const TileEnds& ends, const RayPattern& pattern) {
  std::vector<SelectedTile> tiles;
  for (std::uint32_t a = 0; a < ends.tall; ++a)
    for (std::uint32_t b = 0; b < ends.wide; ++b)
      if (ends.of(a, b) > 0) tiles.push_back({tile_at(pattern, a, b), ends.of(a, b)});
  return tiles;
}

}  // namespace vantage
