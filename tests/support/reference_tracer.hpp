// SPDX-License-Identifier: Apache-2.0
// Traces every ray against every triangle, in double precision, as the reference for engines. It shares with them only
// the float directions of RayPattern and the random bits of the noise.
#pragma once

#include <cstdint>
#include <vector>

#include "trace/tracer.hpp"

namespace vantage::test {

struct ReferenceHit {
  static constexpr std::uint32_t none = 0xFFFFFFFFu;
  std::uint32_t triangle = none;
  double t = 0;      // without noise
  double range = 0;  // with noise
  double reflectivity = 0;
  Vec3 point, normal;
  std::uint32_t voxel = kNoVoxel;  // also kNoVoxel if the point misses a limit
  DroppedPoints dropped;           // limits that the point misses, if it lies in a surveyed voxel
  // Smallest change that would alter the answer, in metres: from the ray to the nearest edge of a triangle that it hits
  // or passes, or to an end of the range; to another surface behind the hit; and from the point to its nearest voxel
  // face.
  double edge_distance = 1e300, gap = 1e300, face_distance = 1e300;
  // Distance of the point from a limit, relative to the limit.
  double limit_distance = 1e300;
};

class ReferenceTracer {
 public:
  explicit ReferenceTracer(const TraceScene& scene) : scene_(scene) {}

  // Traces all rays of a station. Rays are tested in blocks against triangles whose bounding sphere meets the block's
  // cone.
  std::vector<ReferenceHit> scan(const TraceStation& station) const;

 private:
  TraceScene scene_;
};

}  // namespace vantage::test
