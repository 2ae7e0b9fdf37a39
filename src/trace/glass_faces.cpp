// SPDX-License-Identifier: Apache-2.0
#include "trace/glass_faces.hpp"

#include <cstdint>

#include "shared/trace_types.h"
#include "trace/triangle_neighbours.hpp"

namespace vantage {

std::vector<Triangle> glass_triangles(const SceneData& scene) {
  std::vector<Triangle> glass;  // nodes share no glass, so all of it is stored in place
  for (std::uint32_t t = scene.opaque_count(); t < scene.triangle_count(); ++t) glass.push_back(scene.attributes(t));
  return glass;
}

std::vector<bool> faces_of_solids(const SceneData& scene) {
  const std::vector<Triangle> glass = glass_triangles(scene);
  const std::vector<std::uint32_t> neighbours = triangle_neighbours(scene.positions, glass);
  std::vector<bool> closed(glass.size(), true);
  std::vector<std::uint32_t> open;
  const auto mark = [&](std::uint32_t t) {
    if (!closed[t]) return;
    closed[t] = false;
    open.push_back(t);
  };
  for (std::uint32_t k = 0; k < neighbours.size(); ++k)
    if (neighbours[k] == no_primitive) mark(k / 3);
  while (!open.empty()) {
    const std::uint32_t t = open.back();
    open.pop_back();
    for (std::uint32_t k = 3 * t; k < 3 * t + 3; ++k)
      if (neighbours[k] != no_primitive) mark(neighbours[k]);
  }
  return closed;
}

}  // namespace vantage
