// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/scan_station.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <limits>

#include "core/parallel.hpp"
#include "core/target_clones.hpp"

namespace vantage {
namespace {

// The wanted outputs of a chunk's rays, and the arrays for them.
struct Wanted {
  Tracer::RawChunk& chunk;
  std::uint32_t outputs;
  std::uint64_t first_ray;  // of the chunk
};

// Fills the elements of rays that hit nothing.
void clear(const RayTile& tile, const StationRays& rays, const Wanted& wanted) {
  for (std::uint32_t i = 0; i < tile.rows; ++i) {
    const std::uint64_t first = rays.ray(tile.row + i, tile.column) - wanted.first_ray;
    const auto fill = [&](std::uint32_t output, auto& values, auto value) {
      if (wanted.outputs & output)
        std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(first), tile.columns, value);
    };
    Tracer::RawChunk& chunk = wanted.chunk;
    fill(Tracer::range, chunk.range, std::numeric_limits<float>::infinity());
    fill(Tracer::position, chunk.position, Float3{});
    fill(Tracer::normal, chunk.normal, Float3{});
    fill(Tracer::reflectivity, chunk.reflectivity, 0.0f);
    fill(Tracer::primitive, chunk.primitive, RayBundle::kNoHit);
    fill(Tracer::barycentric, chunk.barycentric, Float2{});
    fill(Tracer::voxel, chunk.voxel, kNoVoxel);
  }
}

// Finds the tile's points: hits, or panes that reflect the beam, without those whose echo is too weak or lost.
// `counts`: true if a point meets all limits. Overwrites the bundle's hits.
void find_points(const StationRays& station_rays, const TraceStation& station, const RayTile& tile, RayBundle& rays,
                 Hits& points, bool* counts) {
  std::array<Passed, RayBundle::kCapacity> passed;
  bool behind_glass = false;
  if (station_rays.glass()) {
    RayBundle beams = rays;
    beams.start = 0;
    for (std::uint32_t slot = 0; slot < rays.size; ++slot)
      if (rays.primitive[slot] != RayBundle::kNoHit) beams.end[slot] = rays.t[slot];
    behind_glass = station_rays.glass()->follow(beams, passed);
  }
  std::array<bool, RayBundle::kCapacity> returned{};  // reflected by a pane
  if (behind_glass)
    for (std::uint32_t slot = 0; slot < rays.size; ++slot) {
      const Passed& way = passed[slot];
      if (way.pane == RayBundle::kNoHit || way.t < station_rays.pattern().min_range) continue;
      rays.primitive[slot] = way.pane;
      rays.t[slot] = way.t;
      returned[slot] = true;
    }
  points.size = 0;
  std::uint32_t slot = 0;
  for (std::uint32_t row = tile.row; row < tile.row + tile.rows; ++row)
    for (std::uint32_t column = tile.column; column < tile.column + tile.columns; ++column, ++slot)
      if (rays.primitive[slot] != RayBundle::kNoHit) points.add(rays, slot, station_rays.ray(row, column));
  std::fill_n(counts, points.size, true);
  if (!station_rays.limited() || (!behind_glass && station_rays.all_count(points))) return;

  const std::uint32_t all = points.size;
  points.size = 0;
  for (std::uint32_t k = 0; k < all; ++k) {
    const std::uint32_t from = points.slot[k];
    const std::uint64_t ray = points.ray(k);
    DroppedPoints dropped;
    if (returned[from])
      dropped.echo = station_rays.lost(ray, station.place) ? 1 : 0;
    else
      dropped = station_rays.dropped(station, ray, rays, from, behind_glass ? passed[from].share : 1);
    if (dropped.echo > 0) continue;
    counts[points.size] = dropped.points == 0;
    points.add(rays, from, ray);
  }
}

// Fills normals, reflectivities and weights of corners, triangle by triangle.
[[gnu::always_inline]] inline void shade(const Surface& surface, const Float3& origin, const Hits& points,
                                         const std::uint64_t* at, const Wanted& wanted) {
  Tracer::RawChunk& chunk = wanted.chunk;
  for (std::uint32_t k = 0; k < points.size;) {
    const std::uint32_t triangle = points.primitive[k];
    const Facet facet = surface.facet(triangle);
    for (; k < points.size && points.primitive[k] == triangle; ++k) {
      const Float3 d{points.x[k], points.y[k], points.z[k]};
      const std::array<double, 2> weights = facet.weights(origin, d, points.t[k]);
      if (wanted.outputs & Tracer::barycentric)
        chunk.barycentric[at[k]] = {static_cast<float>(weights[0]), static_cast<float>(weights[1])};
      const Vec3 normal = facet.normal(d, weights);
      if (wanted.outputs & Tracer::normal) chunk.normal[at[k]] = narrow(normal);
      if (wanted.outputs & Tracer::reflectivity) chunk.reflectivity[at[k]] = facet.reflectivity(d, normal);
    }
  }
}

// Fills the elements of one tile. `rays`: its rays with their hits.
VANTAGE_TARGET_CLONES
void fill_tile(const StationRays& station_rays, const TraceStation& station, const RayTile& tile, RayBundle& rays,
               VoxelLookup& voxels, const Wanted& wanted) {
  const std::uint32_t outputs = wanted.outputs;
  Tracer::RawChunk& chunk = wanted.chunk;
  clear(tile, station_rays, wanted);
  Hits points;
  bool counts[RayBundle::kCapacity];
  find_points(station_rays, station, tile, rays, points, counts);
  if (points.size == 0) return;
  std::uint64_t at[RayBundle::kCapacity];  // in the chunk
  for (std::uint32_t k = 0; k < points.size; ++k) at[k] = points.ray(k) - wanted.first_ray;

  if (outputs & (Tracer::normal | Tracer::reflectivity | Tracer::barycentric))
    shade(station_rays.surface(), station.origin, points, at, wanted);
  if (outputs & Tracer::primitive)
    for (std::uint32_t k = 0; k < points.size; ++k) chunk.primitive[at[k]] = points.primitive[k];
  if ((outputs & (Tracer::range | Tracer::position | Tracer::voxel)) == 0) return;
  station_rays.find_ranges(station, points, false);
  if (outputs & Tracer::range)
    for (std::uint32_t k = 0; k < points.size; ++k) chunk.range[at[k]] = points.range[k];
  if (outputs & Tracer::position)
    for (std::uint32_t k = 0; k < points.size; ++k) chunk.position[at[k]] = points.point(station.origin, k);
  if ((outputs & Tracer::voxel) == 0) return;
  std::uint64_t counted[RayBundle::kCapacity];  // in the chunk
  std::uint32_t many = 0;
  voxels.clear();
  for (std::uint32_t k = 0; k < points.size; ++k) {
    if (!counts[k] || !station_rays.surface().surveyed(points.primitive[k])) continue;
    counted[many++] = at[k];
    voxels.add(points.point(station.origin, k));
  }
  voxels.each_run([&](std::uint32_t voxel_index, std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t k = begin; k < end; ++k) chunk.voxel[counted[k]] = voxel_index;
  });
}

}  // namespace

bool ChunkedScan::View::is_of(const StationRays& other, const TraceStation& from) const {
  const auto same_turn = [](const Turn& a, const Turn& b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
  return &other == &rays && from.origin == station.origin && from.turn.has_value() == station.turn.has_value() &&
         (!from.turn || same_turn(*from.turn, *station.turn));
}

void ChunkedScan::scan(const StationRays& rays, const TraceStation& station, std::uint64_t first_ray,
                       std::uint64_t ray_count, std::uint32_t outputs, Tracer::RawChunk& chunk) {
  const auto size = [&](std::uint32_t output) { return static_cast<std::size_t>(outputs & output ? ray_count : 0); };
  chunk.range.resize(size(Tracer::range));
  chunk.position.resize(size(Tracer::position));
  chunk.normal.resize(size(Tracer::normal));
  chunk.reflectivity.resize(size(Tracer::reflectivity));
  chunk.primitive.resize(size(Tracer::primitive));
  chunk.barycentric.resize(size(Tracer::barycentric));
  chunk.voxel.resize(size(Tracer::voxel));
  if (ray_count == 0) return;

  if (!view_ || !view_->is_of(rays, station)) {
    view_.reset();
    view_ = std::make_unique<const View>(rays, station);
  }
  const Picture* const picture = view_->picture.get();
  const RayPattern& pattern = rays.pattern();
  const auto first_row = static_cast<std::uint32_t>(first_ray / pattern.columns()),
             end_row = first_row + static_cast<std::uint32_t>(ray_count / pattern.columns());
  const std::uint32_t rows = RayTile::rows_of(pattern);
  const Picture::Tiles tiles{first_row / rows, (end_row - 1) / rows + 1};
  const Wanted wanted{chunk, outputs, first_ray};
  const auto trace = [&](std::uint32_t a, std::uint32_t b, const Picture::Strip* strip, RayBundle& bundle,
                         VoxelLookup& voxels) {
    RayTile tile = tile_at(pattern, a, b);
    const std::uint32_t end = std::min(tile.row + tile.rows, end_row);
    tile.row = std::max(tile.row, first_row);
    tile.rows = end - tile.row;
    rays.gather(station, tile, pattern.max_range, bundle);
    if (strip) {
      picture->fill(*strip, tile, bundle);
    } else {
      rays.caster().cast(bundle);
    }
    fill_tile(rays, station, tile, bundle, voxels, wanted);
  };
  if (pattern.list) {  // a list has one column of tiles
    parallel::for_all(tbb::blocked_range<std::uint32_t>(tiles.first, tiles.end), [&](const auto& range) {
      VoxelLookup voxels = rays.voxels();
      RayBundle bundle;
      for (std::uint32_t a = range.begin(); a < range.end(); ++a) trace(a, 0, nullptr, bundle, voxels);
    });
    if (end_row == pattern.rows()) view_.reset();
    return;
  }
  tbb::enumerable_thread_specific<Picture::Strip> strips;
  parallel::for_all(tbb::blocked_range<std::uint32_t>(0, view_->ends.wide), [&](const auto& range) {
    VoxelLookup voxels = rays.voxels();
    RayBundle bundle;
    Picture::Strip& strip = strips.local();
    for (std::uint32_t b = range.begin(); b < range.end(); ++b) {
      if (picture) picture->draw(b, tiles, strip);
      for (std::uint32_t a = tiles.first; a < tiles.end; ++a) trace(a, b, picture ? &strip : nullptr, bundle, voxels);
    }
  });
  if (end_row == pattern.rows()) view_.reset();
}

}  // namespace vantage
