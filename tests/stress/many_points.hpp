// SPDX-License-Identifier: Apache-2.0
// Traces more points than 32 bits hold into one voxel.
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/simulator.hpp"

namespace vantage::test {

struct ManyPoints {
  std::size_t stations = 0;
  std::uint64_t rays = 0, points = 0;  // of all stations; every ray of a closed cube gives a point
  std::uint32_t count = 0;             // points counted in the voxel
  double goal = 0, coverage = 0;
  double wanted() const;   // coverage from the points in 64 bits
  double wrapped() const;  // coverage if 32 bits had wrapped
};
// 16 and 64 stations in a closed cube smaller than its only voxel, which saturates at 2·10⁹ points.
std::vector<ManyPoints> trace_many_points(const EngineInfo& engine, double step_degrees);

}  // namespace vantage::test
