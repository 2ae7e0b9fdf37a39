// SPDX-License-Identifier: Apache-2.0
// Orders triangles so that software Vulkan devices build good trees.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"

namespace vantage {

// Returns a permutation of triangles. lavapipe (Mesa 25.0) builds its tree by halving triangles in input order, so that
// the order determines the tree. The order comes from recursive median splits by centroid, left child the first ⌈n/2⌉,
// along the axis of least surface area cost. Parallel and deterministic.
std::vector<std::uint32_t> median_sort(std::span<const Float3> positions, std::span<const Triangle> triangles);

}  // namespace vantage
