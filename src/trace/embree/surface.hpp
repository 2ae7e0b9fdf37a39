// SPDX-License-Identifier: Apache-2.0
// Properties of a hit: its normal, reflectivity, and whether it counts.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "scene/scene_data.hpp"
#include "trace/embree/planes.hpp"

namespace vantage {

// A triangle's data for its hits, computed once. Only normal() branches, so loops over hits vectorise.
struct Facet {
  Vec3 corner, first, second;  // a corner, and the edges that leave it
  Vec3 across;                 // first × second
  double area = 0;             // across·across
  bool smooth = false;         // has `normals`, one per corner
  std::array<Vec3, 3> normals;
  Vec3 plane;  // unit normal
  double diffuse = 0;
  // Largest distance of a hit's normal from the plane's, turned the same way, as unit vectors; 1: unknown.
  double tilt = 0;

  // Returns the weights of the second and third corner at distance t.
  [[gnu::always_inline]] std::array<double, 2> weights(const Float3& o, const Float3& d, float t) const {
    const Vec3 p = widen(o) + widen(d) * t - corner;
    const double u = std::min(std::max(dot(cross(p, second), across) / area, 0.0), 1.0);
    const double v = std::min(std::max(dot(cross(first, p), across) / area, 0.0), 1.0 - u);
    return {area > 0 ? u : 0.0, area > 0 ? v : 0.0};
  }
  // Returns the unit normal turned against d: interpolated, or the plane's if corners have none or cancel out.
  Vec3 normal(const Float3& d, const std::array<double, 2>& weights) const {
    return smooth ? smooth_normal(d, weights) : flat_normal(d);
  }
  [[gnu::always_inline]] Vec3 flat_normal(const Float3& d) const { return against(d, plane); }
  // REQUIRES: smooth.
  [[gnu::always_inline]] Vec3 smooth_normal(const Float3& d, const std::array<double, 2>& weights) const {
    const Vec3 n = normals[0] * (1 - weights[0] - weights[1]) + normals[1] * weights[0] + normals[2] * weights[1];
    const double length = std::sqrt(dot(n, n)), scale = 1 / length;
    const bool some = length > 0;
    return against(d, {some ? n.x * scale : plane.x, some ? n.y * scale : plane.y, some ? n.z * scale : plane.z});
  }
  // Returns R·(I·(−N)), never below 0.
  [[gnu::always_inline]] float reflectivity(const Float3& d, const Vec3& normal) const {
    const double value = diffuse * -dot(normal, widen(d));
    return static_cast<float>(std::min(std::max(value, 0.0), 1.0));
  }

 private:
  [[gnu::always_inline]] static Vec3 against(const Float3& d, const Vec3& n) {
    return n * (dot(n, widen(d)) > 0 ? -1.0 : 1.0);
  }
};

// Returns Facet::tilt of a triangle with this unit normal.
double tilt_of(const SceneData& scene, std::uint32_t triangle, const Vec3& plane);

// Tables over the triangles of a scene. Immutable; safe to use from any thread.
class Surface {
 public:
  Surface(std::shared_ptr<const SceneData> scene, std::shared_ptr<const Planes> planes);

  std::uint32_t mesh(std::uint32_t triangle) const {
    return mesh_.empty() ? scene_->mesh_of(triangle) : mesh_[triangle];
  }
  bool surveyed(std::uint32_t triangle) const { return (surveyed_[triangle / 64] >> (triangle % 64) & 1) != 0; }

  Facet facet(std::uint32_t triangle) const;

 private:
  std::shared_ptr<const SceneData> scene_;
  std::shared_ptr<const Planes> planes_;
  std::vector<std::uint64_t> surveyed_;  // a bit per triangle
  std::vector<std::uint32_t> mesh_;      // per triangle; empty if the scene shares meshes: too many
  std::vector<double> diffuse_;          // per mesh
};

}  // namespace vantage
