// SPDX-License-Identifier: Apache-2.0
// Finds triangles that share an edge.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"

namespace vantage {

// [3 t + k]: the triangle across triangle t's edge from corner k to the next. Corners are equal if their positions are,
// bit for bit. `no_primitive` at an edge that does not belong to exactly two triangles.
std::vector<std::uint32_t> triangle_neighbours(std::span<const Float3> positions, std::span<const Triangle> triangles);

}  // namespace vantage
