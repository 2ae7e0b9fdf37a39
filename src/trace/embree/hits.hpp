// SPDX-License-Identifier: Apache-2.0
// Hits whose points are wanted, in arrays, so that algorithm 1 works on many at once.
#pragma once

#include <cstdint>

#include "trace/embree/range_noise.hpp"
#include "trace/embree/ray_caster.hpp"
#include "trace/embree/surface.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {

inline Float3 point_at(const Float3& origin, const Float3& d, float range) {
  return {origin.x + range * d.x, origin.y + range * d.y, origin.z + range * d.z};
}

struct Hits {
  static constexpr std::uint32_t kLanes = 8;
  static constexpr std::uint32_t kCapacity = RayBundle::kCapacity + kLanes;  // whole vectors

  std::uint32_t size = 0;
  alignas(64) float x[kCapacity], y[kCapacity], z[kCapacity];  // directions
  alignas(64) float t[kCapacity];                              // distances
  alignas(64) std::uint32_t primitive[kCapacity];
  alignas(64) std::uint32_t ray_low[kCapacity], ray_high[kCapacity];  // halves of the ray's number, which keys draws
  std::uint32_t slot[kCapacity];                                      // in the bundle
  alignas(64) float range[kCapacity];                                 // output of find_ranges

  // REQUIRES: the slot has a hit; at most RayBundle::kCapacity calls since the size was 0.
  void add(const RayBundle& rays, std::uint32_t from, std::uint64_t ray) {
    x[size] = rays.x[from];
    y[size] = rays.y[from];
    z[size] = rays.z[from];
    t[size] = rays.t[from];
    primitive[size] = rays.primitive[from];
    ray_low[size] = static_cast<std::uint32_t>(ray);
    ray_high[size] = static_cast<std::uint32_t>(ray >> 32);
    slot[size++] = from;
  }
  std::uint64_t ray(std::uint32_t k) const { return ray_low[k] | std::uint64_t{ray_high[k]} << 32; }
  Float3 point(const Float3& origin, std::uint32_t k) const { return point_at(origin, {x[k], y[k], z[k]}, range[k]); }
};

// Fills `range`, the distances of the points with noise. `place` also keys the noise. With a grid, only the points'
// voxels are exact: a range stays the hit's distance if noise moves no point out of its voxel.
void find_ranges(const Surface& surface, const RangeNoise& noise, const Float3& origin, std::uint32_t place, Hits& hits,
                 const VoxelGrid* grid = nullptr);

}  // namespace vantage
