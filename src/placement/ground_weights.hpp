// SPDX-License-Identifier: Apache-2.0
// Weights that keep unmarked surveyed ground from dominating the objects on it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vantage/placement.hpp"
#include "vantage/scene.hpp"

namespace vantage {

// The ground's share of the surveyed surface, and the weights that bound it.
struct GroundWeights {
  std::vector<std::size_t> ground;  // Meshes that one stands on, ascending.
  double share = 0;                 // Ground's share of all surveyed surface, by area.
  double weighted_share = 0;        // Ground's share with `weights`.
  // Weight of each mesh: 1 for ground; for the others the weight, up to 255, that reduces the ground's share to a
  // third. All 1 if the share is that small already, or if there is nothing but ground.
  std::vector<std::uint32_t> weights;
  bool changes = false;  // True if any weight differs from 1.
  std::string told;      // One sentence for logs: what was done and why, or why not. Empty if there was no need.
};

// Largest share that ground keeps.
inline constexpr double kMostGroundShare = 1.0 / 3;

// Finds ground and its weights. A surveyed mesh is ground if at least a quarter of its upward surface (within 45° of
// level) lies in the search area. Weights are per mesh: anything that is one mesh with the ground weighs as little;
// the sentence says so if nothing else is surveyed.
GroundWeights ground_weights(const Scene& scene, const SearchArea& area);

// Returns true if nothing determines what is surveyed, so that ground should be weighed: the search area is derived, no
// pattern or mark chose surveyed meshes, and none has a weight.
bool ground_is_unmarked(const Scene& scene, const SearchArea& area);

// Returns the same scene with these weights. Throws Error invalid_argument unless there is one of 1 to 255 for each
// mesh.
Scene with_weights(const Scene& scene, const std::vector<std::uint32_t>& weights);

}  // namespace vantage
