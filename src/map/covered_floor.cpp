// SPDX-License-Identifier: Apache-2.0
#include "map/covered_floor.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vantage {

std::optional<double> covered_floor(const SearchMesh& mesh, const HeightBuffer& heights, const SceneData& scene) {
  const MapWindow& w = heights.window;
  double covered = 0, all = 0;
  std::vector<double> grounds;
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const Vec3 centre = (a + b + c) * (1.0 / 3), n = cross(b - a, c - a);
    const double area = std::abs(n.z) / 2;
    const double column = (centre.x - w.x_min) / w.pixel_m, row = (w.y_max - centre.y) / w.pixel_m;
    if (column < 0 || row < 0 || column >= static_cast<double>(w.columns) || row >= static_cast<double>(w.rows))
      continue;
    const float top = heights.z[static_cast<std::size_t>(row) * w.columns + static_cast<std::size_t>(column)];
    all += area;
    if (double{top} + scene.origin.z > centre.z + 1.5) covered += area;
    grounds.push_back(centre.z);
  }
  if (!(covered > 0.5 * all)) return std::nullopt;
  const auto middle = grounds.begin() + static_cast<std::ptrdiff_t>(grounds.size() / 2);
  std::nth_element(grounds.begin(), middle, grounds.end());
  return *middle;
}

}  // namespace vantage
