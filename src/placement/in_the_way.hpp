// SPDX-License-Identifier: Apache-2.0
// Places where whoever walks a site needs the floor that a tripod or a stand would take.
#pragma once

#include "vantage/placement.hpp"

namespace vantage {

// True if a point of the survey frame has walls on both sides of it, as between the jambs of a door.
bool in_passage(const ClashChecker& clash, const Vec3& at);

// True if the leaf of a door may swing there: a passage in free view is as near as a leaf is wide.
bool in_swing(const ClashChecker& clash, const Vec3& at);

// True if a point of the ground lies on a stair or by its top step: from there the ground falls by steps on a side.
bool on_steps(const ClashChecker& clash, const Vec3& ground);

// True if a tripod on a point of the ground bars a door or a stair.
bool in_the_way(const ClashChecker& clash, const Vec3& ground);

}  // namespace vantage
