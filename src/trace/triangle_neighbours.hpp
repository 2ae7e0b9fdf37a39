// SPDX-License-Identifier: Apache-2.0
// Finds triangles that share an edge.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "scene/scene_difference.hpp"

namespace vantage {

// Returns at [3 t + k] the triangle across triangle t's edge from corner k to the next. Corners are equal if their
// positions are, bit for bit. `no_primitive` at an edge that does not belong to exactly two triangles.
std::vector<std::uint32_t> triangle_neighbours(std::span<const Float3> positions, std::span<const Triangle> triangles);

// Returns neighbours of the opaque triangles of a later scene: kept ones for kept triangles, and for others those
// within the same run of new triangles. Empty if `neighbours` is.
std::vector<std::uint32_t> neighbours_after(std::span<const std::uint32_t> neighbours, const SceneData& later,
                                            const SceneDifference& difference);

}  // namespace vantage
