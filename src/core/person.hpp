// SPDX-License-Identifier: Apache-2.0
// Measures of a person, by which sites are read and walked. None is a standard's: each comment gives the reason.
#pragma once

namespace vantage::person {

// A tall adult in shoes. Ground that lies higher than this above other ground belongs to another storey.
inline constexpr double kHeight_m = 1.8;
// Heights above the ground at which nothing may obstruct a person who walks with a tripod.
inline constexpr double kHip_m = 1.0, kKnee_m = 0.4;
// Largest depth of ground below the height at which a plan is cut, so that a head passes under the cut.
inline constexpr double kUnderCut_m = 1.7;
// The highest step that a person takes: more than a riser of some 0.21 m, less than a table or a sill.
// The default of `WalkableOptions` is the same; the recognition of units uses this one.
inline constexpr double kStep_m = 0.25;
// Largest height between places of the walking graph, 0.25 m apart or more: a step, plus the grid's loss of height; and
// then the slope of a stair of 45 degrees.
inline constexpr double kWayStep_m = 0.35, kWaySlope = 1.0;

}  // namespace vantage::person
