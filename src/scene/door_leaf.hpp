// SPDX-License-Identifier: Apache-2.0
// The shape of a door's leaf.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "core/glm.hpp"

namespace vantage {

// A thin upright box, turned about the vertical, with the size of a door's leaf. Metres, z up.
struct DoorLeaf {
  glm::dvec3 middle{};
  glm::dvec3 along{}, through{};  // unit; level
  double width = 0, thickness = 0, height = 0;
};

// Sizes of leaves, with their frames if both are one mesh. Metres.
struct LeafSizes {
  double lowest = 1.75, highest = 3.0, narrowest = 0.55, widest = 2.6, thickest = 0.4;
  bool high(double height) const { return height >= lowest && height <= highest; }
};
// Sizes of gates, and of the leaves that stand side by side in one opening.
inline constexpr LeafSizes kGateSizes{.highest = 5.0, .narrowest = 0.4, .widest = 6.0, .thickest = 0.25};

// Returns the box around triangles if it has such a size.
std::optional<DoorLeaf> leaf_around(std::size_t triangles,
                                    const std::function<std::array<glm::dvec3, 3>(std::uint32_t triangle)>& corners,
                                    const LeafSizes& sizes = {});

// Returns true if the leaf has the size of a single leaf, so that it may be a door whatever its name.
bool is_plain_leaf(const DoorLeaf& leaf);

}  // namespace vantage
