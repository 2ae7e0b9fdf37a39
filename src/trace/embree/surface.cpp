// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vantage {

Surface::Surface(std::shared_ptr<const SceneData> scene, std::shared_ptr<const Planes> planes)
    : scene_(std::move(scene)), planes_(std::move(planes)) {
  const SceneData& s = *scene_;
  if (!s.shares()) mesh_.resize(s.triangle_count());
  surveyed_.resize((s.triangle_count() + 63) / 64);
  for (std::size_t m = 0; m < s.ranges.size(); ++m) {
    const MeshRange& range = s.ranges[m];
    diffuse_.push_back(s.meshes[m].diffuse);
    if (!s.shares())
      std::fill_n(mesh_.begin() + range.first_triangle, range.triangle_count, static_cast<std::uint32_t>(m));
    if (s.meshes[m].role != Role::surveyed) continue;
    for (std::uint32_t i = range.first_triangle; i < range.first_triangle + range.triangle_count; ++i)
      surveyed_[i / 64] |= std::uint64_t{1} << (i % 64);
  }
}

double tilt_of(const SceneData& scene, std::uint32_t triangle, const Vec3& plane) {
  if (scene.normals.empty()) return 0;
  constexpr double kRounding = 1e-6, kUnknown = 1;
  double most = 0, sign = 0;
  for (const Float3& corner : scene.corner_normals(triangle)) {
    const Vec3 normal = widen(corner);
    const double size = std::sqrt(dot(normal, normal));
    if (!(size > 0)) continue;
    if (sign == 0) sign = dot(normal, plane) < 0 ? -1 : 1;
    const Vec3 off = normal * (sign / size) - plane;
    most = std::max(most, std::sqrt(dot(off, off)));
  }
  // Between the corners no angle exceeds theirs, but a chord may exceed it by less than a tenth.
  return most < 0.5 ? 1.1 * most + kRounding : kUnknown;
}

Facet Surface::facet(std::uint32_t triangle) const {
  const auto corners = scene_->corners(triangle);
  Facet facet;
  facet.corner = widen(corners[0]);
  facet.first = widen(corners[1]) - facet.corner;
  facet.second = widen(corners[2]) - facet.corner;
  facet.across = cross(facet.first, facet.second);
  facet.area = dot(facet.across, facet.across);
  facet.smooth = !scene_->normals.empty();
  if (facet.smooth) {
    const auto normals = scene_->corner_normals(triangle);
    for (std::size_t k = 0; k < 3; ++k) facet.normals[k] = widen(normals[k]);
  }
  facet.plane = planes_->normal(triangle);
  facet.tilt = tilt_of(*scene_, triangle, facet.plane);
  facet.diffuse = diffuse_[mesh(triangle)];
  return facet;
}

}  // namespace vantage
