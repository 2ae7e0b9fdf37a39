// SPDX-License-Identifier: Apache-2.0
// A surveyed sheet in the very plane of a blocking wall, but cut into other triangles: rounding decides which is hit.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vantage/simulator.hpp"

namespace vantage::test {

struct CoplanarFigures {
  std::string name;
  std::uint64_t rays = 0;             // that double precision sends into the sheet, 1e-3 m and more from its outline
  std::uint64_t counted = 0;          // of these, points that the engine puts on the sheet
  std::uint64_t missed = 0;           // that hit neither
  bool apart = false, noted = false;  // the sheet lies before the wall; the load speaks of one plane
  double off_m = 0;                   // of any of these points, from the plane
};
// The sheet in the wall's plane, square to an axis and oblique; 0.1 mm and 1 mm before it.
std::vector<CoplanarFigures> measure_coplanar(const EngineInfo& engine, double step_degrees);

}  // namespace vantage::test
