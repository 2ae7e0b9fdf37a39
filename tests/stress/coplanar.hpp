// SPDX-License-Identifier: Apache-2.0
// A surveyed sheet in exactly the plane of a blocking wall, but with other triangles. Loading cuts the wall back;
// otherwise rounding would decide which of the two is hit.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vantage/simulator.hpp"

namespace vantage::test {

struct CoplanarFigures {
  std::string name;
  std::uint64_t wall_rays = 0;        // rays that hit the wall in double precision, at least 1e-3 m from its outline
  std::uint64_t missed = 0;           // of these, rays without a hit
  std::uint64_t sheet_rays = 0;       // of these, into the sheet, at least 1e-3 m from its outline
  std::uint64_t counted = 0;          // of these, points that the engine puts on the sheet
  std::uint64_t strayed = 0;          // points put there by rays at least 1e-3 m beside the sheet
  bool apart = false, noted = false;  // the sheet lies in front of the wall; the load reports a cut
  double off_m = 0;                   // largest distance from its plane, of points of rays into the sheet
};
// The sheet in the wall's plane, perpendicular to an axis and oblique, and cut into 2048 triangles; then 0.1 mm and 1
// mm in front of it.
std::vector<CoplanarFigures> measure_coplanar(const EngineInfo& engine, double step_degrees);

}  // namespace vantage::test
