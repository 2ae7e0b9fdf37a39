// SPDX-License-Identifier: Apache-2.0
// What a hit means: its normal, reflectivity, and whether it counts.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "scene/scene_data.hpp"
#include "trace/embree/planes.hpp"

namespace vantage {

// Tables over the triangles of a scene. Immutable; safe to use from any thread.
class Surface {
 public:
  Surface(std::shared_ptr<const SceneData> scene, std::shared_ptr<const Planes> planes);

  std::uint32_t mesh(std::uint32_t triangle) const { return mesh_[triangle]; }
  bool surveyed(std::uint32_t triangle) const { return (surveyed_[triangle / 64] >> (triangle % 64) & 1) != 0; }

  // Weights of the triangle's second and third vertex at distance t.
  std::array<double, 2> barycentric(std::uint32_t triangle, const Float3& o, const Float3& d, float t) const;
  // Unit normal turned against d: of the vertices, interpolated, or of the plane where they have none or cancel out.
  std::array<double, 3> normal(std::uint32_t triangle, const Float3& d, const std::array<double, 2>& weights) const;
  // The same at distance t.
  std::array<double, 3> normal_at(std::uint32_t triangle, const Float3& o, const Float3& d, float t) const;
  // R·(I·(−N)), never below 0.
  float reflectivity(std::uint32_t triangle, const Float3& d, const std::array<double, 3>& normal) const {
    const double facing = -(normal[0] * d.x + normal[1] * d.y + normal[2] * d.z);
    const double value = diffuse_[mesh_[triangle]] * facing;
    return static_cast<float>(value < 0 ? 0 : value > 1 ? 1 : value);
  }
  float reflectivity(std::uint32_t triangle, const Float3& o, const Float3& d, float t) const;

 private:
  std::shared_ptr<const SceneData> scene_;
  std::shared_ptr<const Planes> planes_;
  std::vector<std::uint64_t> surveyed_;  // a bit a triangle
  std::vector<std::uint32_t> mesh_;
  std::vector<double> diffuse_;  // a mesh
};

}  // namespace vantage
