// SPDX-License-Identifier: Apache-2.0
// Pieces of the scene's triangles on which one could stand.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/glm.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

// A triangle soup in the local frame, in double. A piece is a whole source triangle or a part of one.
struct SurfacePieces {
  std::vector<glm::dvec3> points;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> source;  // of each piece; pieces of one source are consecutive
};

// The clear parts of the triangles. Each is halved across its longest edge until no edge exceeds `spacing_m`; what is
// left is clear where `clear` holds for its centroid; halves that are both clear are put together again. Parallel;
// `clear` is called from several threads.
SurfacePieces clear_pieces(std::vector<glm::dvec3> points, std::span<const Triangle> triangles, double spacing_m,
                           const std::function<bool(const glm::dvec3&)>& clear);

double piece_area(const SurfacePieces& pieces, std::uint32_t piece);       // true area
double piece_plan_area(const SurfacePieces& pieces, std::uint32_t piece);  // seen from above

}  // namespace vantage
