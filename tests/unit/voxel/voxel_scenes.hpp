// SPDX-License-Identifier: Apache-2.0
// Small scenes built in code for the voxel and placement tests.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "scene/scene_data.hpp"

namespace vantage::test {

// Adds one mesh. Local frame.
inline void add_mesh(SceneData& scene, const std::vector<Float3>& positions, const std::vector<Triangle>& triangles,
                     Role role = Role::surveyed) {
  if (scene.materials.empty()) scene.materials.emplace_back();
  const auto base = static_cast<std::uint32_t>(scene.positions.size());
  scene.ranges.push_back(
      {static_cast<std::uint32_t>(scene.triangles.size()), static_cast<std::uint32_t>(triangles.size()), 0});
  scene.meshes.push_back({"mesh", role, 0.5, static_cast<std::uint32_t>(triangles.size())});
  scene.positions.insert(scene.positions.end(), positions.begin(), positions.end());
  for (const Float3& p : positions) scene.local_bounds.extend({p.x, p.y, p.z});
  for (const Triangle& t : triangles) scene.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

// A parallelogram cut into columns × rows squares of two triangles.
inline void add_patch(SceneData& scene, const Vec3& corner, const Vec3& along, const Vec3& up, int columns = 1,
                      int rows = 1, Role role = Role::surveyed) {
  std::vector<Float3> positions;
  std::vector<Triangle> triangles;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const Vec3 p = corner + along * (double(i) / columns) + up * (double(j) / rows);
      positions.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  add_mesh(scene, positions, triangles, role);
}

// Triangles of random place, shape and size within a cube of half side `half`; one in four is a sliver.
inline std::vector<Float3> random_triangles(std::mt19937& rng, int count, float half, float size) {
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<Float3> p;
  for (int t = 0; t < count; ++t) {
    const Float3 c{unit(rng) * (half - size), unit(rng) * (half - size), unit(rng) * (half - size)};
    const auto near = [&](float s) { return Float3{c.x + s * unit(rng), c.y + s * unit(rng), c.z + s * unit(rng)}; };
    p.push_back(near(size));
    p.push_back(near(size));
    if (t % 4 == 0) {
      const Float3 &a = p[p.size() - 2], &b = p[p.size() - 1];
      const float e = 1e-5f * size;
      p.push_back({(a.x + b.x) / 2 + e, (a.y + b.y) / 2 - e, (a.z + b.z) / 2 + e});
    } else {
      p.push_back(near(size));
    }
  }
  return p;
}

inline std::vector<Triangle> separate_triangles(std::size_t positions) {
  std::vector<Triangle> t;
  for (std::uint32_t i = 0; i + 2 < positions; i += 3) t.push_back({i, i + 1, i + 2});
  return t;
}

}  // namespace vantage::test
