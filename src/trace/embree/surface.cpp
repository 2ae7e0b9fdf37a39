// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/surface.hpp"

#include <algorithm>
#include <utility>

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

Facet Surface::facet(std::uint32_t triangle) const {
  const Triangle& indices = scene_->triangles[triangle];
  Facet facet;
  facet.corner = widen(scene_->positions[indices[0]]);
  facet.first = widen(scene_->positions[indices[1]]) - facet.corner;
  facet.second = widen(scene_->positions[indices[2]]) - facet.corner;
  facet.across = cross(facet.first, facet.second);
  facet.area = dot(facet.across, facet.across);
  facet.smooth = !scene_->normals.empty();
  if (facet.smooth) {
    for (std::size_t k = 0; k < 3; ++k) facet.normals[k] = widen(scene_->normals[indices[k]]);
  }
  facet.plane = planes_->normal(triangle);
  facet.diffuse = diffuse_[mesh_[triangle]];
  return facet;
}

}  // namespace vantage
