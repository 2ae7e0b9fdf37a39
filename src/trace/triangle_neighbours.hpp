// SPDX-License-Identifier: Apache-2.0
// Which triangles share an edge.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"

namespace vantage {

// [3 t + k]: the triangle on the other side of triangle t's edge from corner k to the next. Corners are the same where
// their positions are, bit for bit. `no_primitive` at an edge that not exactly two triangles have.
std::vector<std::uint32_t> triangle_neighbours(std::span<const Float3> positions, std::span<const Triangle> triangles);

}  // namespace vantage
