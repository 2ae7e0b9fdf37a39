// SPDX-License-Identifier: Apache-2.0
// What all of the CPU engine's ways of tracing share: the pattern's rays, and what becomes of a hit. A ray's point is
// the same bits whichever of them asks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>

#include "trace/embree/point_judge.hpp"
#include "trace/embree/range_noise.hpp"
#include "trace/embree/ray_caster.hpp"
#include "trace/embree/surface.hpp"
#include "trace/embree/voxel_lookup.hpp"
#include "trace/tracer.hpp"

namespace vantage {

// Rays that are traced together: at most tile_side rows of as many columns.
struct RayTile {
  static constexpr std::uint32_t side = 16;
  static_assert(side * side <= RayBundle::capacity);
  std::uint32_t row = 0, column = 0, rows = 0, columns = 0;
};

class StationRays {
 public:
  explicit StationRays(const TraceScene& scene)
      : scene_(scene.scene),
        grid_(scene.grid),
        pattern_(scene.pattern),
        noise_(scene.noise),
        judge_(scene.limits),
        planes_(std::make_shared<Planes>(scene.scene)),
        caster_(scene.scene, planes_),
        surface_(scene.scene, planes_),
        prefixes_(*scene.grid) {}

  const SceneData& scene() const { return *scene_; }
  const VoxelGrid& grid() const { return *grid_; }
  const RayPattern& pattern() const { return *pattern_; }
  const RangeNoise& noise() const { return noise_; }
  const RayCaster& caster() const { return caster_; }
  const Surface& surface() const { return surface_; }
  VoxelLookup voxels() const { return {*grid_, prefixes_}; }

  Float3 direction(std::uint32_t row, std::uint32_t column) const {
    const RayPattern& p = *pattern_;
    return {p.sin_zenith[row] * p.cos_azimuth[column], p.sin_zenith[row] * p.sin_azimuth[column], p.cos_zenith[row]};
  }
  std::uint64_t ray(std::uint32_t row, std::uint32_t column) const {
    return std::uint64_t{row} * pattern_->columns() + column;
  }

  // The tile's rays, row by row, as a bundle that ends at `end`.
  void gather(const TraceStation& station, const RayTile& tile, float end, RayBundle& rays) const {
    const RayPattern& p = *pattern_;
    rays.origin = station.origin;
    rays.start = p.min_range;
    rays.size = tile.rows * tile.columns;
    const float *const cosines = p.cos_azimuth.data() + tile.column, *const sines = p.sin_azimuth.data() + tile.column;
    for (std::uint32_t i = 0; i < tile.rows; ++i) {
      const float sine = p.sin_zenith[tile.row + i], cosine = p.cos_zenith[tile.row + i];
      float* __restrict const x = rays.x + i * tile.columns;
      float* __restrict const y = rays.y + i * tile.columns;
      float* __restrict const z = rays.z + i * tile.columns;
      for (std::uint32_t j = 0; j < tile.columns; ++j) {
        x[j] = sine * cosines[j];
        y[j] = sine * sines[j];
        z[j] = cosine;
      }
    }
    std::fill_n(rays.end, rays.size, end);
  }

  // Distance of the point, noise included. REQUIRES: rays.primitive[slot] is a hit; `ray` and `place` key the noise.
  float range(const RayBundle& rays, std::uint32_t slot, std::uint64_t ray, std::uint32_t place) const {
    const float t = rays.t[slot];
    if (!noise_.enabled()) return t;
    const std::uint32_t triangle = rays.primitive[slot];
    const Float3 d{rays.x[slot], rays.y[slot], rays.z[slot]};
    return noise_.displaced(t, surface_.reflectivity(triangle, rays.origin, d, t), ray, place);
  }

  bool limited() const { return judge_.enabled(); }
  // What a point is dropped for; nothing where it counts. REQUIRES: limited(); rays.primitive[slot] is a hit on a
  // surveyed mesh.
  DroppedPoints dropped(const RayBundle& rays, std::uint32_t slot) const {
    const std::uint32_t triangle = rays.primitive[slot];
    const Float3 d{rays.x[slot], rays.y[slot], rays.z[slot]};
    const float t = rays.t[slot];
    const std::array<double, 3> normal = surface_.normal_at(triangle, rays.origin, d, t);
    const double cosine = normal[0] * d.x + normal[1] * d.y + normal[2] * d.z;
    return judge_.missed(surface_.mesh(triangle), cosine, t, surface_.reflectivity(triangle, d, normal));
  }

  static Float3 point(const RayBundle& rays, std::uint32_t slot, float range) {
    return {rays.origin.x + range * rays.x[slot], rays.origin.y + range * rays.y[slot],
            rays.origin.z + range * rays.z[slot]};
  }

 private:
  std::shared_ptr<const SceneData> scene_;
  std::shared_ptr<const VoxelGrid> grid_;
  std::shared_ptr<const RayPattern> pattern_;
  RangeNoise noise_;
  PointJudge judge_;
  std::shared_ptr<const Planes> planes_;
  RayCaster caster_;
  Surface surface_;
  BrickPrefixes prefixes_;
};

}  // namespace vantage
