// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vantage/types.hpp"

namespace vantage {

Surface::Surface(std::shared_ptr<const SceneData> scene, std::shared_ptr<const Planes> planes)
    : scene_(std::move(scene)), planes_(std::move(planes)) {
  const SceneData& s = *scene_;
  mesh_.resize(s.triangles.size());
  surveyed_.resize((s.triangles.size() + 63) / 64);
  for (std::size_t m = 0; m < s.ranges.size(); ++m) {
    const MeshRange& range = s.ranges[m];
    diffuse_.push_back(s.meshes[m].diffuse);
    std::fill_n(mesh_.begin() + range.first_triangle, range.triangle_count, static_cast<std::uint32_t>(m));
    if (s.meshes[m].role != Role::surveyed) continue;
    for (std::uint32_t i = range.first_triangle; i < range.first_triangle + range.triangle_count; ++i)
      surveyed_[i / 64] |= std::uint64_t{1} << (i % 64);
  }
}

std::array<double, 2> Surface::barycentric(std::uint32_t triangle, const Float3& o, const Float3& d, float t) const {
  const Triangle& indices = scene_->triangles[triangle];
  const Vec3 a = widen(scene_->positions[indices[0]]);
  const Vec3 e1 = widen(scene_->positions[indices[1]]) - a, e2 = widen(scene_->positions[indices[2]]) - a;
  const Vec3 p = widen(o) + widen(d) * t - a;
  const Vec3 n = cross(e1, e2);
  const double area = dot(n, n);
  if (!(area > 0)) return {0, 0};
  const double u = std::clamp(dot(cross(p, e2), n) / area, 0.0, 1.0);
  const double v = std::clamp(dot(cross(e1, p), n) / area, 0.0, 1.0 - u);
  return {u, v};
}

std::array<double, 3> Surface::normal(std::uint32_t triangle, const Float3& d,
                                      const std::array<double, 2>& weights) const {
  Vec3 n;
  double length = 0;
  if (!scene_->normals.empty()) {
    const Triangle& indices = scene_->triangles[triangle];
    n = widen(scene_->normals[indices[0]]) * (1 - weights[0] - weights[1]) +
        widen(scene_->normals[indices[1]]) * weights[0] + widen(scene_->normals[indices[2]]) * weights[1];
    length = std::sqrt(dot(n, n));
  }
  if (length > 0) {
    n = n * (1 / length);
  } else {
    n = planes_->normal(triangle);
  }
  if (dot(n, widen(d)) > 0) n = n * -1;
  return {n.x, n.y, n.z};
}

std::array<double, 3> Surface::normal_at(std::uint32_t triangle, const Float3& o, const Float3& d, float t) const {
  return normal(triangle, d, scene_->normals.empty() ? std::array<double, 2>{} : barycentric(triangle, o, d, t));
}

float Surface::reflectivity(std::uint32_t triangle, const Float3& o, const Float3& d, float t) const {
  return reflectivity(triangle, d, normal_at(triangle, o, d, t));
}

}  // namespace vantage
