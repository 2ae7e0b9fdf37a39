// SPDX-License-Identifier: Apache-2.0
// Places for checks of the vertical index of an instrument, which level sights hide.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "vantage/evaluation.hpp"

namespace vantage {

// True if the instrument, and not chance, makes most of the predicted registration error, so that it is to be checked.
bool wants_steep_check(const Evaluation& evaluation);

// A scanner's name without its setting: settings of one scanner are one instrument.
std::string instrument_of(const Scanner& scanner);

// Least elevation of a sight, above or below the head, and the longest one, of a check.
inline constexpr double kLeastElevation_deg = 30, kLongestSight_m = 30;
// Angle of a point above or below the level of a head, in degrees.
double elevation_deg(const Vec3& head, const Vec3& point);

// Adds a target (`Target::check`) for each instrument that needs a check, on a surveyed surface that two of its
// stations see from one side, steeply and near enough. Among such places the best has the second station farthest
// below or above it, to a decimetre, then nearest: an error of the index moves a sight sideways by itself times that
// height. `Evaluation::no_steep_check` lists the instruments without a place. It searches a sample of the surveyed
// voxels.
void add_steep_checks(Evaluation& evaluation, const Simulator& simulator, const ClashChecker& clash);

}  // namespace vantage
