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

// How far beyond the noise's reach of a cube a triangle may lie that holds a hit counted there: Embree's doubt about
// edges, which a slant stretches.
inline double triangle_margin(double pad) { return 64 * pad; }

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
  // Where hits lie whose points count in the voxel: within the noise's reach of its cube. Relative to the head.
  struct Cube {
    std::array<std::uint32_t, 3> cell{};
    Vec3 centre;
    double half = 0;
    double nearest = 0, farthest = 0;  // distance of any such hit
  };
  // One of the voxel's triangles from the present head.
  struct SeenPlane {
    std::array<Float3, 3> edge;  // normals of the planes through head and edges
    float tolerance;
    float slenderness;
    Vec3 normal;
    double height;
  };
  // Rays that may cross the cube.
  struct Fan {
    static constexpr std::uint32_t capacity = 256;
    std::uint32_t size = 0;
    alignas(64) float x[capacity], y[capacity], z[capacity];
    alignas(64) std::uint32_t may_hit[capacity];
    std::uint64_t ray[capacity];

    void append(const RayPattern& pattern, std::uint32_t row, std::uint32_t column, std::uint32_t n) {
      const float sine = pattern.sin_zenith[row], cosine = pattern.cos_zenith[row];
      const std::uint64_t first = std::uint64_t{row} * pattern.columns() + column;
      for (std::uint32_t k = 0; k < n; ++k, ++size) {
        x[size] = sine * pattern.cos_azimuth[column + k];
        y[size] = sine * pattern.sin_azimuth[column + k];
        z[size] = cosine;
        ray[size] = first + k;
      }
    }
  };
  struct Pending {
    std::uint64_t ray;
    double nearest;  // as nearest_hit() says
  };

  void see_triangles(std::size_t voxel, const Vec3& head, double reach, double farthest);
  void mark_rays(Fan& fan) const;
  double nearest_hit(const Fan& fan, std::uint32_t i, const Cube& cube) const;
  std::uint64_t count_station(std::size_t voxel, std::size_t station, std::uint64_t wanted);
  std::uint64_t work_through_fan(std::size_t station, const Cube& cube);
  std::uint64_t cast_pending(std::size_t station, const Cube& cube);
  void cast_singly(std::size_t station);
  void remember(std::size_t station, std::uint32_t occluder);

  const StationRays& rays_;
  const SampledVoxels& voxels_;
  std::span<const TraceStation> stations_;
  double pad_, reach_;
  std::vector<Occluders> occluders_;  // one a station
  std::vector<SeenPlane> seen_;
  Fan fan_{};
  RayBundle bundle_;
  std::array<Pending, RayBundle::capacity> pending_;
  std::uint32_t batch_ = 1;
  std::uint64_t traced_ = 0;
};

}  // namespace vantage
