// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/sampled_voxels.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "trace/embree/seen_triangle.hpp"
#include "trace/triangle_gap.hpp"
#include "voxel/voxel_triangles.hpp"

namespace vantage {
namespace {

Vec3 widen(const Float3& p) { return {p.x, p.y, p.z}; }

SampledVoxels::Listed listed(const Float3& a, const Float3& b, const Float3& c) {
  SampledVoxels::Listed result{a, b, c, 0, 0, 0, {}, 0};
  const Vec3 e1 = widen(b) - widen(a), e2 = widen(c) - widen(a), e3 = widen(c) - widen(b);
  result.longest =
      std::nextafter(static_cast<float>(std::sqrt(std::max({dot(e1, e1), dot(e2, e2), dot(e3, e3)}))), HUGE_VALF);
  const Vec3 n = cross(e1, e2);
  const double length = std::sqrt(dot(n, n));
  result.slenderness = static_cast<float>(SeenTriangle::slenderness(widen(a), widen(b), widen(c), length));
  if (length > 0) result.normal = n * (1 / length);
  result.offset = dot(result.normal, widen(a));
  return result;
}

}  // namespace

SampledVoxels::SampledVoxels(const SceneData& scene, const VoxelGrid& grid, std::span<const std::uint32_t> ranks,
                             double margin_m)
    : margin_m_(margin_m), ranks_(ranks.begin(), ranks.end()), cells_(ranks.size()) {
  VoxelTriangles lists = triangles_touching(scene, grid, ranks, margin_m);
  offset_ = std::move(lists.offset);
  listed_.resize(lists.triangle.size());
  tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t i) {
    cells_[i] = morton_decode(grid.key(ranks[i]));
    for (std::uint32_t k = offset_[i]; k < offset_[i + 1]; ++k) {
      const Triangle& t = scene.triangles[lists.triangle[k]];
      listed_[k] = listed(scene.positions[t[0]], scene.positions[t[1]], scene.positions[t[2]]);
      listed_[k].gap = triangle_gap(listed_[k].a, listed_[k].b, listed_[k].c, grid, cells_[i]);
    }
    std::sort(listed_.begin() + offset_[i], listed_.begin() + offset_[i + 1],
              [](const Listed& a, const Listed& b) { return a.gap < b.gap; });
  });
}

bool SampledVoxels::made_for(std::span<const std::uint32_t> ranks, double margin_m) const {
  return margin_m_ == margin_m && std::ranges::equal(ranks_, ranks);
}

}  // namespace vantage
