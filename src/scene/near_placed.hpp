// SPDX-License-Identifier: Apache-2.0
// Triangles of shared meshes near triangles of the other role, after placement.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/shared_meshes.hpp"

namespace vantage {

// A scene's own triangles, and those of shared meshes near triangles of the other role, in the order that they would
// have if all meshes were stored in place. Glass is near nothing.
struct NearPlaced {
  std::vector<Float3> positions;  // local frame
  std::vector<Triangle> triangles;
  std::vector<MeshRange> ranges;       // as many as the scene's
  std::vector<std::uint32_t> numbers;  // of the triangles in the scene, ascending in a range; see placed_runs()
  Box surveyed;                        // all shared meshes that are surveyed, near or not
};

// Finds them. `positions`: of the scene's own triangles, local frame. Throws Error out_of_memory if more than `most`
// triangles of shared meshes are near.
NearPlaced near_placed(const RawScene& raw, const std::vector<Float3>& positions, const Vec3& origin,
                       std::uint64_t most);

}  // namespace vantage
