// SPDX-License-Identifier: Apache-2.0
// What a hit means: its distance in double precision, normal, reflectivity.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "scene/scene_data.hpp"

namespace vantage {

// Tables over the triangles of a scene. Immutable; safe to use from any thread.
class Surface {
 public:
  explicit Surface(std::shared_ptr<const SceneData> scene);

  bool surveyed(std::uint32_t triangle) const { return (surveyed_[triangle / 64] >> (triangle % 64) & 1) != 0; }

  void prefetch(std::uint32_t triangle) const { __builtin_prefetch(&planes_[triangle]); }

  // Distance to the triangle's plane along d, in double and rounded once. Where it differs from `rough`, Embree's
  // distance, by more than one part in 2^plane_trust the ray lies in the plane within rounding, the plane says nothing,
  // and `rough` stands.
  static constexpr int plane_trust = 8;
  float distance(std::uint32_t triangle, const Float3& o, const Float3& d, float rough) const {
    const Plane& p = planes_[triangle];
    const double height = p.offset - (p.x * o.x + p.y * o.y + p.z * o.z);
    const auto t = static_cast<float>(height / (p.x * d.x + p.y * d.y + p.z * d.z));
    return std::abs(t - rough) <= rough * (1.0f / (1 << plane_trust)) ? t : rough;
  }

  // Weights of the triangle's second and third vertex at distance t.
  std::array<double, 2> barycentric(std::uint32_t triangle, const Float3& o, const Float3& d, float t) const;
  // Unit normal turned against d: of the vertices, interpolated, or of the plane where they have none or cancel out.
  std::array<double, 3> normal(std::uint32_t triangle, const Float3& d, const std::array<double, 2>& weights) const;
  // R·(I·(−N)), never below 0.
  float reflectivity(std::uint32_t triangle, const Float3& d, const std::array<double, 3>& normal) const {
    const double facing = -(normal[0] * d.x + normal[1] * d.y + normal[2] * d.z);
    const double value = diffuse_[mesh_[triangle]] * facing;
    return static_cast<float>(value < 0 ? 0 : value > 1 ? 1 : value);
  }
  float reflectivity(std::uint32_t triangle, const Float3& o, const Float3& d, float t) const;

 private:
  struct Plane {
    double x, y, z, offset;  // unit normal n and n·p of its points
  };
  std::shared_ptr<const SceneData> scene_;
  std::vector<Plane> planes_;
  std::vector<std::uint64_t> surveyed_;  // a bit a triangle
  std::vector<std::uint32_t> mesh_;
  std::vector<double> diffuse_;  // a mesh
};

}  // namespace vantage
