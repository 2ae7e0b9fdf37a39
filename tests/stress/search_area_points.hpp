// SPDX-License-Identifier: Apache-2.0
// Points of a search area where its triangles meet: none may be lost, and none may jump.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vantage::test {

struct EdgePoints {
  std::string name;
  std::uint64_t points = 0, lost = 0;  // including four neighbours 1e-13 away
  double farthest_m = 0;               // from the same point of the edge in space
  double jump_m = 0;                   // to the neighbours
};
// Random points on random edges, one in ten a vertex: of a jittered terrain, of slivers 1 : 10⁶ and 1 : 10⁹, and along
// the bounds.
std::vector<EdgePoints> locate_edge_points(std::uint64_t points);

}  // namespace vantage::test
