// SPDX-License-Identifier: Apache-2.0
// Rays aimed from inside at the edges and vertices of closed meshes; a ray without a hit has leaked.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene_data.hpp"
#include "vantage/simulator.hpp"

namespace vantage::test {

// Every straight line from near the centre crosses the surface once.
struct ClosedMesh {
  std::string name;
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  double core_m = 0;  // rays start within this distance of the centre
};
ClosedMesh cube();          // 12 triangles
ClosedMesh bumpy_sphere();  // 8192 triangles
ClosedMesh sliver_prism();  // 2 m high; 64 of its 160 triangles are 1 : 10⁶
ClosedMesh shaft();         // 644 triangles; far longer along one axis, whose rounding must suffice for all three
std::vector<ClosedMesh> closed_meshes();

struct Leaks {
  std::uint64_t edge_rays = 0, edge_escapes = 0, vertex_rays = 0, vertex_escapes = 0;
};
// Aims half of the rays at random points of random edges, half at random vertices. Each batch of up to 10⁶ rays turns
// the mesh and starts at another point. Directions are rounded to float, so rays pass their targets within about 1e-7
// of the distance, on any side.
Leaks count_leaks(const EngineInfo& engine, const ClosedMesh& mesh, std::uint64_t rays);

}  // namespace vantage::test
