// SPDX-License-Identifier: Apache-2.0
// Floors of rooms that a model names but has no floor for, as where the slabs are in the structural engineer's file.
#pragma once

#include <string_view>

#include "scene/load_budget.hpp"
#include "scene/raw_scene.hpp"

namespace vantage {

inline constexpr std::string_view kRoomFloors = "floors of rooms";  // the mesh's name

// Adds one blocking mesh of floors at the bottom of each room that has hardly any surface there. They reach under the
// walls, and so through doorways, and leave out what lies above stairs and ramps, by their class in IFC. A note says
// so. Throws Error out_of_memory if they do not fit into `budget`. REQUIRES: lengths in metres.
void lay_room_floors(RawScene& raw, LoadBudget& budget);

}  // namespace vantage
