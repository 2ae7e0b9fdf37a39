// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "vantage/missed.hpp"

namespace vantage {

// One for each room, with its ground and what is left out, and without voxels.
std::vector<RoomShare> shares_by_room(std::span<const Room> rooms, const SearchArea& area);

}  // namespace vantage
