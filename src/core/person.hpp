// SPDX-License-Identifier: Apache-2.0
// A person, by what a site is read and walked. No figure is a standard's: each is what its comment gives as the reason.
#pragma once

namespace vantage::person {

// A tall adult in shoes. Ground that lies higher than that above other ground is of another storey.
inline constexpr double kHeight_m = 1.8;
// Heights over the ground at which nothing may be in the way of somebody who walks with a tripod.
inline constexpr double kHip_m = 1.0, kKnee_m = 0.4;
// How far below the height at which a plan is cut its ground may lie: a head passes under the cut.
inline constexpr double kUnderCut_m = 1.7;
// The highest step that one takes: more than a riser, which has some 0.21 m, and less than a table or a sill. Defaults
// of `WalkableOptions` and the reading of units go by it.
inline constexpr double kStep_m = 0.25;
// Between places of the walking graph, 0.25 m apart or more: a step, and what their heights lose to the grid; then the
// slope of a stair of 45 degrees.
inline constexpr double kWayStep_m = 0.35, kWaySlope = 1.0;

}  // namespace vantage::person
