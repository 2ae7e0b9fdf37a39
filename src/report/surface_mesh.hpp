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

// What a vertex belongs to, bits.
inline constexpr std::uint8_t kSurveyedVertex = 1;  // a surveyed mesh; else one that only blocks
inline constexpr std::uint8_t kSolidVertex = 2;     // a closed surface: its back faces are the inside of something

struct SurfaceMesh {
  Box box, surveyed;  // local frame: of all vertices, and of surveyed ones
  // A coordinate of 0 is the box's lower side, 65 535 its upper one, in each axis.
  std::vector<std::array<std::uint16_t, 3>> positions;
  std::vector<std::uint8_t> kinds;       // one a position
  std::vector<std::uint32_t> triangles;  // three indices each, in an order that keeps neighbours together
  double error_m = 0;                    // how far surfaces moved where the mesh was made simpler, about; 0: it was not
};

// At most about `triangles` of them: made simpler by edge collapse (meshoptimizer), and where parts too small for that
// still are too many, by clusters.
SurfaceMesh surface_mesh(const SceneData& scene, std::size_t triangles);

}  // namespace vantage
