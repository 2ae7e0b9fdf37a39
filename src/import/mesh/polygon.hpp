// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/glm.hpp"

namespace vantage::importer {

// Cuts a polygon into triangles with the polygon's winding, and appends their corners to `out`: numbers of points,
// counted from 0 through all loops. The first loop is the outline; the others are holes of either winding. Points may
// lie somewhat off a plane. Self-intersections give arbitrary triangles; loops of less than three points give none.
void cut_into_triangles(std::span<const glm::dvec3> points, std::span<const std::size_t> loop_sizes,
                        std::vector<std::uint32_t>& out);

}  // namespace vantage::importer
