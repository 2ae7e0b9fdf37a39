// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/sampled_voxels.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "voxel/voxel_triangles.hpp"

namespace vantage {

SampledVoxels::SampledVoxels(const SceneData& scene, const VoxelGrid& grid, std::span<const std::uint32_t> ranks,
                             double margin_m)
    : margin_m_(margin_m), ranks_(ranks.begin(), ranks.end()), cells_(ranks.size()) {
  VoxelTriangles lists = triangles_touching(scene, grid, ranks, margin_m);
  offset_ = std::move(lists.offset);
  corners_.resize(lists.triangle.size());
  tbb::parallel_for(std::size_t{0}, corners_.size(), [&](std::size_t k) {
    const Triangle& t = scene.triangles[lists.triangle[k]];
    corners_[k] = {scene.positions[t[0]], scene.positions[t[1]], scene.positions[t[2]]};
  });
  tbb::parallel_for(std::size_t{0}, cells_.size(),
                    [&](std::size_t i) { cells_[i] = morton_decode(grid.key(ranks[i])); });
}

bool SampledVoxels::made_for(std::span<const std::uint32_t> ranks, double margin_m) const {
  return margin_m_ == margin_m && std::ranges::equal(ranks_, ranks);
}

}  // namespace vantage
