// SPDX-License-Identifier: Apache-2.0
// A site's surfaces, small enough for a page.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/scene_data.hpp"
#include "vantage/types.hpp"

namespace vantage {

// Bits of a vertex's kind.
inline constexpr std::uint8_t kSurveyedVertex = 1;  // on a surveyed mesh; else on one that only blocks
inline constexpr std::uint8_t kSolidVertex = 2;     // on a closed surface, whose back faces are the inside of a solid

struct SurfaceMesh {
  Box box, surveyed;  // local frame: of all vertices, and of surveyed ones
  // Coordinates from 0, the box's lower side, to 65 535, its upper side, in each axis.
  std::vector<std::array<std::uint16_t, 3>> positions;
  std::vector<std::uint8_t> kinds;       // one for each position
  std::vector<std::uint32_t> triangles;  // three indices each, in an order that keeps neighbours together
  double error_m = 0;                    // about how far simplification moved surfaces; 0: none
};

// Returns about `triangles` triangles at most: simplified by edge collapse (meshoptimizer) and, if parts too small for
// that are still too many, by clusters.
SurfaceMesh surface_mesh(const SceneData& scene, std::size_t triangles);

}  // namespace vantage
