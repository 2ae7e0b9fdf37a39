// SPDX-License-Identifier: Apache-2.0
// What a door's leaf looks like, and what it is called.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/glm.hpp"

namespace vantage {

// A thin upright box, turned about the vertical, with the size of a door's leaf. Metres, z up.
struct DoorLeaf {
  glm::dvec3 middle{};
  glm::dvec3 along{}, through{};  // unit; level
  double width = 0, thickness = 0, height = 0;
};

// The box around triangles, if it has that size.
std::optional<DoorLeaf> leaf_around(std::size_t triangles,
                                    const std::function<std::array<glm::dvec3, 3>(std::uint32_t triangle)>& corners);

// Whether a box of that height may be one.
bool is_leaf_high(double height);

// Whether it is as large as a single leaf, and may be a door whatever it is called.
bool is_plain_leaf(const DoorLeaf& leaf);

// Whether a name is that of a door, and no part of furniture.
bool names_a_door(const std::string& name);

}  // namespace vantage
