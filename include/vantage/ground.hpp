// SPDX-License-Identifier: Apache-2.0
/// Keeps ground that is surveyed only because nothing says otherwise from drowning what stands on it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vantage/placement.hpp"
#include "vantage/scene.hpp"

namespace vantage {

/// What the meshes that one stands on have of the surveyed surface, and the weights that bound it.
struct GroundWeights {
  std::vector<std::size_t> ground;  ///< Meshes that one stands on, ascending.
  double share = 0;                 ///< Of all surveyed surface in square metres that is theirs.
  double weighted_share = 0;        ///< With `weights`.
  /// A weight for each mesh: 1 for ground, as much for the others as makes the ground's share a third at most, up to
  /// 255. All 1 where it is that already, or where there is nothing but ground.
  std::vector<std::uint32_t> weights;
  bool changes = false;  ///< Whether some weight is not 1.
  std::string told;      ///< One sentence for logs: what was done and why, or why not. Empty where there was no need.
};

/// Largest share that ground keeps.
inline constexpr double most_ground_share = 1.0 / 3;

/// A surveyed mesh is ground where at least a quarter of its upward surface (within 45° of level) lies in the search
/// area. Weights are of whole meshes: what stands on the ground and is one mesh with it weighs as little as it does,
/// and the sentence says so where nothing else is surveyed.
GroundWeights ground_weights(const Scene& scene, const SearchArea& area);

/// Whether the scene leaves it open what is surveyed, so that ground should be weighed: the search area is derived, no
/// pattern and no mark chose surveyed meshes, and none has a weight.
bool ground_is_unmarked(const Scene& scene, const SearchArea& area);

/// The same scene with these weights. Throws Error invalid_argument unless there is one of 1 to 255 for each mesh.
Scene with_weights(const Scene& scene, const std::vector<std::uint32_t>& weights);

}  // namespace vantage
