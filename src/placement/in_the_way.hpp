// SPDX-License-Identifier: Apache-2.0
// Places whose floor people need to walk a site, so that no tripod or stand may take it.
#pragma once

#include "vantage/placement.hpp"

namespace vantage {

// Returns true if a point of the survey frame has walls on both sides, as between the jambs of a door.
bool in_passage(const ClashChecker& clash, const Vec3& at);

// Returns true if the leaf of a door may swing there: a passage in free view is within a leaf's width.
bool in_swing(const ClashChecker& clash, const Vec3& at);

// Returns true if a point of the ground lies on a stair or by its top step, where the ground falls by steps.
bool on_steps(const ClashChecker& clash, const Vec3& ground);

// Returns true if a tripod on a point of the ground blocks a door or a stair.
bool in_the_way(const ClashChecker& clash, const Vec3& ground);

}  // namespace vantage
