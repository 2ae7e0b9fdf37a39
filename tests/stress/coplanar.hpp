// SPDX-License-Identifier: Apache-2.0
// A surveyed sheet in the very plane of a blocking wall, but cut into other triangles: the wall is cut back on load, or
// else rounding would decide which of the two is hit.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vantage/simulator.hpp"

namespace vantage::test {

struct CoplanarFigures {
  std::string name;
  std::uint64_t wall_rays = 0;        // that double precision sends into the wall, 1e-3 m and more from its outline
  std::uint64_t missed = 0;           // of these, that hit nothing
  std::uint64_t sheet_rays = 0;       // of these, into the sheet, 1e-3 m and more from its outline
  std::uint64_t counted = 0;          // of these, points that the engine puts on the sheet
  std::uint64_t strayed = 0;          // points that it puts there, of rays 1e-3 m and more beside the sheet
  bool apart = false, noted = false;  // the sheet lies before the wall; the load speaks of a cut
  double off_m = 0;                   // of any point of a ray into the sheet, from its plane
};
// The sheet in the wall's plane, square to an axis and oblique, and cut into 2048 triangles; 0.1 mm and 1 mm before it.
std::vector<CoplanarFigures> measure_coplanar(const EngineInfo& engine, double step_degrees);

}  // namespace vantage::test
