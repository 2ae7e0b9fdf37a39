// SPDX-License-Identifier: Apache-2.0
// More points than 32 bits hold, traced into one voxel.
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/simulator.hpp"

namespace vantage::test {

struct ManyPoints {
  std::size_t stations = 0;
  std::uint64_t rays = 0, points = 0;  // of all stations; every ray of a closed cube is a point
  std::uint32_t count = 0;             // what the voxel holds of them
  double goal = 0, coverage = 0;
  double wanted() const;   // coverage by the points in 64 bits
  double wrapped() const;  // and what it would be if 32 bits had wrapped
};
// 16 and 64 stations in a closed cube smaller than its only voxel, which is saturated from 2·10⁹ points on.
std::vector<ManyPoints> trace_many_points(const EngineInfo& engine, double step_degrees);

}  // namespace vantage::test
