// SPDX-License-Identifier: Apache-2.0
// Every ray against every triangle, in double precision: what engines are held against. It shares with them the float
// directions of RayPattern, the bits of the noise, and nothing else.
#pragma once

#include <cstdint>
#include <vector>

#include "trace/tracer.hpp"

namespace vantage::test {

struct ReferenceHit {
  static constexpr std::uint32_t none = 0xFFFFFFFFu;
  std::uint32_t triangle = none;
  double t = 0;      // without noise
  double range = 0;  // with it
  double reflectivity = 0;
  Vec3 point, normal;
  std::uint32_t voxel = no_voxel;  // no_voxel too where the point misses a limit
  DroppedPoints dropped;           // for what it would be: counted where the point lies in a surveyed voxel
  // How little would have to move for the answer to be another: metres from the ray to the nearest edge of a triangle
  // that it hits or passes, or to an end of the range; to another surface behind the hit; and from the point to its
  // nearest voxel face.
  double edge_distance = 1e300, gap = 1e300, face_distance = 1e300;
  // And relative to a limit, how near the point comes to it.
  double limit_distance = 1e300;
};

class ReferenceTracer {
 public:
  explicit ReferenceTracer(const TraceScene& scene) : scene_(scene) {}

  // All rays of a station. Rays are tested in blocks against those triangles whose bounding sphere meets the block's
  // cone.
  std::vector<ReferenceHit> scan(const TraceStation& station) const;

 private:
  TraceScene scene_;
};

}  // namespace vantage::test
