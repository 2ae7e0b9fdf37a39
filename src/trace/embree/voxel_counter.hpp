// SPDX-License-Identifier: Apache-2.0
// The points that stations leave in one voxel, from just those rays that can leave one there.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trace/embree/occluders.hpp"
#include "trace/embree/sampled_voxels.hpp"
#include "trace/embree/seen_triangle.hpp"
#include "trace/embree/station_rays.hpp"

namespace vantage {

// For one network; voxels that follow each other should be neighbours. Not thread-safe.
class SampledVoxelCounter {
 public:
  // `pad`: rounding_pad() of everything in sight. Borrows all three.
  SampledVoxelCounter(const StationRays& rays, const SampledVoxels& voxels, std::span<const TraceStation> stations,
                      double pad);

  struct Result {
    std::uint32_t count = 0;  // saturating
    std::uint64_t mask = 0;
  };
  // Every station's points, or, where `stop_at` is not 0, stations' points until there are so many.
  Result count(std::size_t voxel, std::uint32_t stop_at);
  std::uint64_t traced() const { return traced_; }

 private:
  struct Cube {
    std::array<std::uint32_t, 3> cell;
    Vec3 low, high;  // relative to the head, padded
  };
  struct Pending {
    std::uint64_t ray;
    double nearest;  // no hit that counts is nearer
  };

  std::uint64_t count_station(std::size_t voxel, std::size_t station, std::uint64_t wanted);
  std::uint64_t cast_pending(std::size_t station, const Cube& cube);

  const StationRays& rays_;
  const SampledVoxels& voxels_;
  std::span<const TraceStation> stations_;
  double pad_, reach_;
  std::vector<Occluders> occluders_;  // one a station
  std::vector<SeenTriangle> seen_;    // the voxel's triangles from the present head
  RayBundle bundle_;
  std::array<Pending, RayBundle::capacity> pending_;
  std::uint64_t traced_ = 0;
};

}  // namespace vantage
