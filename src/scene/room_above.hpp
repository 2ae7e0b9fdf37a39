// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "vantage/scene.hpp"

namespace vantage {

// Returns the room above a place on the ground, whose own height may be in the room below.
inline std::optional<std::size_t> room_above(std::span<const Room> rooms, const Vec3& ground) {
  constexpr double kKnee_m = 0.5;
  return room_at(rooms, ground + Vec3{0, 0, kKnee_m});
}

}  // namespace vantage
