// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/scan_station.hpp"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <array>

namespace vantage {
namespace {

// Fills the elements of one tile. `first_ray` is the chunk's.
void scan_tile(const StationRays& station_rays, const TraceStation& station, const RayTile& tile,
               std::uint64_t first_ray, std::uint32_t outputs, Tracer::RawChunk& chunk) {
  RayBundle rays;
  station_rays.gather(station, tile, station_rays.pattern().max_range, rays);
  station_rays.caster().cast(rays);
  std::array<Passed, RayBundle::capacity> passed;
  bool behind_glass = false;
  if (station_rays.glass()) {
    RayBundle beams = rays;
    beams.start = 0;
    for (std::uint32_t slot = 0; slot < rays.size; ++slot)
      if (rays.primitive[slot] != RayBundle::no_hit) beams.end[slot] = rays.t[slot];
    behind_glass = station_rays.glass()->follow(beams, passed);
  }
  const Surface& surface = station_rays.surface();
  const RangeNoise& noise = station_rays.noise();
  const bool need_normal = (outputs & (Tracer::normal | Tracer::reflectivity)) != 0 || noise.enabled();
  const bool need_weights = need_normal || (outputs & Tracer::barycentric) != 0;

  for (std::uint32_t slot = 0; slot < rays.size; ++slot) {
    const std::uint64_t ray = station_rays.ray(tile.row + slot / tile.columns, tile.column + slot % tile.columns);
    const std::uint64_t k = ray - first_ray;
    std::uint32_t triangle = rays.primitive[slot];
    DroppedPoints dropped;
    if (const Passed way = behind_glass ? passed[slot] : Passed{1, RayBundle::no_hit, 0};
        way.pane != RayBundle::no_hit && way.t >= station_rays.pattern().min_range) {
      triangle = way.pane;
      rays.t[slot] = way.t;
    } else if (triangle != RayBundle::no_hit && station_rays.limited()) {
      dropped = station_rays.dropped(rays, slot, way.share);
    }
    if (dropped.echo > 0) triangle = RayBundle::no_hit;
    const bool hit = triangle != RayBundle::no_hit;
    float range = std::numeric_limits<float>::infinity(), reflectivity = 0;
    Float3 point, normal;
    std::array<double, 2> weights{};
    if (hit) {
      const Float3 d{rays.x[slot], rays.y[slot], rays.z[slot]};
      range = rays.t[slot];
      if (need_weights) {
        const Facet facet = surface.facet(triangle);
        weights = facet.weights(rays.origin, d, range);
        if (need_normal) {
          const Vec3 unit = facet.normal(d, weights);
          normal = narrow(unit);
          reflectivity = facet.reflectivity(d, unit);
        }
      }
      if (noise.enabled()) range = noise.displaced(range, reflectivity, ray, station.place);
      point = point_at(rays.origin, d, range);
    }
    if (outputs & Tracer::range) chunk.range[k] = range;
    if (outputs & Tracer::position) chunk.position[k] = point;
    if (outputs & Tracer::normal) chunk.normal[k] = normal;
    if (outputs & Tracer::reflectivity) chunk.reflectivity[k] = reflectivity;
    if (outputs & Tracer::primitive) chunk.primitive[k] = triangle;
    if (outputs & Tracer::barycentric)
      chunk.barycentric[k] = {static_cast<float>(weights[0]), static_cast<float>(weights[1])};
    if (outputs & Tracer::voxel) {
      const bool counts = hit && surface.surveyed(triangle) && dropped.points == 0;
      chunk.voxel[k] = counts ? station_rays.grid().index_of(point) : no_voxel;
    }
  }
}

}  // namespace

void scan_station(const StationRays& rays, const TraceStation& station, std::uint64_t first_ray,
                  std::uint64_t ray_count, std::uint32_t outputs, Tracer::RawChunk& chunk) {
  const auto size = [&](std::uint32_t output) { return static_cast<std::size_t>(outputs & output ? ray_count : 0); };
  chunk.range.resize(size(Tracer::range));
  chunk.position.resize(size(Tracer::position));
  chunk.normal.resize(size(Tracer::normal));
  chunk.reflectivity.resize(size(Tracer::reflectivity));
  chunk.primitive.resize(size(Tracer::primitive));
  chunk.barycentric.resize(size(Tracer::barycentric));
  chunk.voxel.resize(size(Tracer::voxel));

  const std::uint32_t columns = rays.pattern().columns();
  const auto first_row = static_cast<std::uint32_t>(first_ray / columns),
             row_count = static_cast<std::uint32_t>(ray_count / columns);
  const std::uint32_t tall = (row_count + RayTile::side - 1) / RayTile::side,
                      wide = (columns + RayTile::side - 1) / RayTile::side;
  tbb::parallel_for(tbb::blocked_range2d<std::uint32_t>(0, tall, 1, 0, wide, 16), [&](const auto& range) {
    for (std::uint32_t a = range.rows().begin(); a < range.rows().end(); ++a) {
      for (std::uint32_t b = range.cols().begin(); b < range.cols().end(); ++b) {
        RayTile tile{first_row + a * RayTile::side, b * RayTile::side, 0, 0};
        tile.rows = std::min(RayTile::side, first_row + row_count - tile.row);
        tile.columns = std::min(RayTile::side, columns - tile.column);
        scan_tile(rays, station, tile, first_ray, outputs, chunk);
      }
    }
  });
}

}  // namespace vantage
