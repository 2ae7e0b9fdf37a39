// SPDX-License-Identifier: Apache-2.0
// Adds floors of rooms that a model names but has no floor for, e.g. with slabs in the structural engineer's file.
#pragma once

#include <string_view>

#include "scene/load_budget.hpp"
#include "scene/raw_scene.hpp"

namespace vantage {

inline constexpr std::string_view kRoomFloors = "floors of rooms";  // the mesh's name

// Adds one blocking mesh of floors at the bottom of each room that has hardly any surface there. The floors reach under
// the walls, and thus through doorways; they leave out places above stairs and ramps, by their class in IFC. A note
// reports it. Throws Error out_of_memory if they do not fit into `budget`. REQUIRES: lengths in metres.
void lay_room_floors(RawScene& raw, LoadBudget& budget);

}  // namespace vantage
