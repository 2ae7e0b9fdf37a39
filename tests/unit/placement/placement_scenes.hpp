// SPDX-License-Identifier: Apache-2.0
// Meshes built in code for the placement tests.
#pragma once

#include <memory>
#include <random>
#include <vector>

#include "scene/scene_data.hpp"
#include "vantage/placement.hpp"

namespace vantage::test {

// Hilly ground of columns × rows squares over (u, v) in [0, 1]², bent so that no triangle is regular. `squeeze` moves
// the columns towards u = 0: 1 leaves them, small values make slivers.
inline SearchMesh hills(int columns, int rows, double squeeze = 1, unsigned seed = 1) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> jitter(-0.2, 0.2), height(0, 0.2);
  SearchMesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const bool inside = i > 0 && i < columns && j > 0 && j < rows;
      double u = (i + (inside ? jitter(rng) : 0)) / columns;
      const double v = (j + (inside ? jitter(rng) : 0)) / rows;
      if (i < columns) u *= squeeze;
      mesh.uvs.push_back({u, v});
      mesh.positions.push_back({500000 + 40 * u, 4500000 + 40 * v, 100 + height(rng) * (squeeze < 1 ? 0 : 1)});
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

inline const Vec3 origin{1000, 2000, 30};  // of the scenes that Builder makes

// Collects patches and boxes into one surveyed mesh. Z up; normals by the right-hand rule.
class Builder {
 public:
  Builder& quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const auto first = static_cast<std::uint32_t>(positions_.size());
    positions_.insert(positions_.end(), {a, b, c, d});
    triangles_.push_back({first, first + 1, first + 2});
    triangles_.push_back({first, first + 2, first + 3});
    return *this;
  }
  Builder& floor(double x0, double y0, double x1, double y1, double z) {
    return quad({x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z});
  }
  Builder& box(const Vec3& a, const Vec3& b) {
    floor(a.x, a.y, b.x, b.y, b.z);
    quad({a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, a.y, a.z});
    quad({a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z});
    quad({b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z});
    quad({b.x, b.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z});
    return quad({a.x, b.y, a.z}, {a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z});
  }
  SceneData data() const {
    SceneData scene;
    scene.origin = origin;
    for (const Vec3& p : positions_) {
      scene.positions.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
      scene.local_bounds.extend(p);
    }
    scene.triangles = triangles_;
    const auto count = static_cast<std::uint32_t>(triangles_.size());
    scene.ranges = {{0, count, 0}};
    scene.meshes = {{"mesh", Role::surveyed, 0.5, count}};
    scene.materials.emplace_back();
    return scene;
  }
  Scene scene() const { return Scene(std::make_shared<const SceneData>(data())); }

 private:
  std::vector<Vec3> positions_;
  std::vector<Triangle> triangles_;
};

}  // namespace vantage::test
