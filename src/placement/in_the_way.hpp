// SPDX-License-Identifier: Apache-2.0
// Places where no tripod should stand: people need the floor to walk the site, or it ends at a drop.
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

// Returns true if a foot of a tripod on a point of the ground may come to stand over a drop without a rail, as at the
// edge of a platform or a loft. Ground that ends where the model ends is no drop.
bool at_brink(const ClashChecker& clash, const Vec3& ground);

// Returns true if either holds.
bool better_aside(const ClashChecker& clash, const Vec3& ground);

}  // namespace vantage
