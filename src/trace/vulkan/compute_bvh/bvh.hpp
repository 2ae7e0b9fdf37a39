// SPDX-License-Identifier: Apache-2.0
// The binary BVH that shaders/trace/compute_bvh.glsl traverses.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "shared/bvh_types.h"
#include "shared/trace_types.h"

namespace vantage {

struct Bvh {
  std::vector<BvhNode> nodes;          // depth first; node 0 is the root
  std::vector<BvhTriangle> triangles;  // in leaf order
};

// Binned surface-area heuristic (Wald: On fast Construction of SAH-based Bounding Volume Hierarchies, 2007). Parallel;
// the tree does not depend on the number of threads. `ids[k]` is stored with triangle k. A traversal never has more
// than bvh_stack_size nodes on its stack. REQUIRES: fewer than bvh_leaf_first_mask triangles, and at least one.
Bvh build_bvh(std::span<const Float3> positions, std::span<const Triangle> triangles,
              std::span<const std::uint32_t> ids);

}  // namespace vantage
