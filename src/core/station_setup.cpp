// SPDX-License-Identifier: Apache-2.0
#include "vantage/station_setup.hpp"

#include <cmath>

namespace vantage {
namespace {

// Replaces a cosine by 0 if only the rounding of π/2 keeps it from being 0.
double without_rounding(double value) { return std::abs(value) < 1e-15 ? 0 : value; }

}  // namespace

std::array<Vec3, 3> StationSetup::survey_from_scanner() const {
  const double sh = without_rounding(std::sin(heading.in_radians())),
               ch = without_rounding(std::cos(heading.in_radians())),
               st = without_rounding(std::sin(tilt.in_radians())), ct = without_rounding(std::cos(tilt.in_radians()));
  return {{{ch * ct, -sh, ch * st}, {sh * ct, ch, sh * st}, {-st, 0, ct}}};
}

}  // namespace vantage
