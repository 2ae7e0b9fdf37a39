// SPDX-License-Identifier: Apache-2.0
// A scene as found on site: with objects that the model lacks, and without those that only the model has.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/scene.hpp"

namespace vantage {

// Names of the meshes that changed_scene() adds.
inline constexpr const char* kNotInModel = "not in the model";
inline constexpr const char* kUnknown = "unknown space";

// Cubic cells, by their index on each axis.
using SolidCell = std::array<std::int32_t, 3>;
struct SolidCells {
  Vec3 corner;  // lower corner of cell (0, 0, 0), survey frame
  double cell_m = 0.1;
  std::vector<SolidCell> cells = {};  // ascending, without duplicates
};

// Returns the scene without the triangles of the meshes `removed`, and with a blocking mesh, the outside of these
// cells. The outside of `unknown` cells is surveyed, with a weight. The scene keeps its local origin, weights and
// search area. Throws Error: malformed_file if nothing is left to survey; out_of_memory if meshes that nodes share do
// not fit when stored at each place.
Scene changed_scene(const Scene& scene, const SolidCells& cells, std::span<const std::uint32_t> removed,
                    const SolidCells& unknown = {}, std::uint32_t unknown_weight = 1);

}  // namespace vantage
