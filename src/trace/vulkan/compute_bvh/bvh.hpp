// SPDX-License-Identifier: Apache-2.0
// The binary BVH that shaders/trace/compute_bvh traverses.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "shared/bvh_types.h"
#include "shared/trace_types.h"
#include "trace/vulkan/placed_meshes.hpp"

namespace vantage {

struct Bvh {
  std::vector<BvhNode> nodes;          // depth first; node 0 is the root
  std::vector<BvhTriangle> triangles;  // in leaf order
  std::vector<BvhPlacement> placements;
};

// Binned surface-area heuristic (Wald: On fast Construction of SAH-based Bounding Volume Hierarchies, 2007). Parallel;
// the tree does not depend on the number of threads. `ids[k]` is stored with triangle k. A traversal never has more
// than bvh_stack_size nodes on its stack. REQUIRES: fewer than bvh_leaf_first_mask triangles, and at least one.
Bvh build_bvh(std::span<const Float3> positions, std::span<const Triangle> triangles,
              std::span<const std::uint32_t> ids);

// Returns a triangle for shaders.
BvhTriangle bvh_triangle(std::span<const Float3> positions, const Triangle& triangle, std::uint32_t id);

// Returns a placement for shaders, of a mesh whose tree has boxes of this widening. The caller fills in the root.
BvhPlacement bvh_placement(const vulkan::MeshPlacement& place, float widening);

// Builds the same with meshes that nodes share: each has its own tree behind the others, and the tree at node 0 holds
// their placements among the triangles.
Bvh build_placed_bvh(std::span<const Float3> positions, std::span<const Triangle> triangles,
                     std::span<const std::uint32_t> ids, const vulkan::PlacedMeshes& placed);

}  // namespace vantage
