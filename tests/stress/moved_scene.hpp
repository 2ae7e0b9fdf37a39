// SPDX-License-Identifier: Apache-2.0
// A yard under a root node that shifts, scales or turns it, with scanner and voxels moved alike.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vantage/simulator.hpp"

namespace vantage::test {

struct Move {
  std::string name;
  Vec3 shift;  // survey frame
  double scale = 1;
  double turn_degrees = 0;  // about the vertical
  Vec3 operator()(const Vec3& p) const;
};
std::vector<Move> shifts_and_scales();  // 1 km, 100 km, UTM, × 0.001, × 1000, and UTM with × 0.001
std::vector<Move> turns();              // odd angles

// A surveyed dish and a leaning box on uneven ground, behind a blocking fence. glTF with `move` in a root node, or
// baked into its float32 vertices.
Scene yard(const Move& move, bool baked = false);

struct MovedFigures {
  std::uint64_t rays = 0;
  std::uint64_t differing = 0;       // rays with another triangle or voxel
  std::uint64_t differing_hits = 0;  // rays with another triangle, or that hit instead of missing
  double farthest_m = 0;             // between points of the same ray and triangle, moved back
  bool counts_equal = false;         // in every voxel
  double coverage = 0, moved_coverage = 0;
  // From the unmoved points, moved in double and put into the moved grid.
  double predicted_coverage = 0;
};
MovedFigures compare_moved(const EngineInfo& engine, const Move& move, double step_degrees);

}  // namespace vantage::test
