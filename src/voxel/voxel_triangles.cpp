// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_triangles.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <optional>

#include "voxel/triangle_cells.hpp"
#include "voxel/triangle_lists.hpp"
#include "voxel/voxel_bricks.hpp"

namespace vantage {
namespace {

// Where more than one surveyed voxel in so many is asked for, walking the voxels of each triangle is cheaper than
// walking its bricks and testing the voxels asked for in each.
constexpr std::uint64_t dense_share = 32;

// Finds every (triangle, voxel number) pair.
class Finder {
 public:
  Finder(const SceneData& scene, const VoxelGrid& grid, std::span<const std::uint32_t> ranks, double margin_m)
      : scene_(scene),
        grid_(grid),
        ranks_(ranks),
        fine_{{grid.min()[0], grid.min()[1], grid.min()[2]}, grid.inverse_size()},
        margin_(margin_m / grid.voxel_size()),
        dense_(ranks.size() >= grid.size() / dense_share) {
    if (dense_) {
      number_.assign(grid.size(), no_voxel);
      for (std::size_t i = 0; i < ranks.size(); ++i) number_[ranks[i]] = static_cast<std::uint32_t>(i);
      return;
    }
    cells_.resize(ranks.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, ranks.size()),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i)
                          cells_[i] = morton_decode(grid.key(ranks[i]));
                      });
    first_.resize(grid.bricks().size() + 1, static_cast<std::uint32_t>(ranks.size()));
    std::size_t i = 0;
    for (std::size_t b = 0; b < grid.bricks().size(); ++b) {
      while (i < ranks.size() && ranks[i] < grid.bricks()[b].first) ++i;
      first_[b] = static_cast<std::uint32_t>(i);
    }
  }

  // Calls found(number, triangle) once a pair, from several threads at once.
  template <class Found>
  void for_each(const Found& found) const {
    for_each_surveyed(scene_, [&](std::uint32_t t) { dense_ ? by_voxels(t, found) : by_bricks(t, found); });
  }

 private:
  template <class Found>
  void by_voxels(std::uint32_t t, const Found& found) const {
    const auto corners = fine_.corners(scene_.positions, scene_.triangles[t]);
    TriangleCells(corners, std::int64_t{1} << grid_.depth(), margin_).for_each([&](const TriangleCells::Cell& c) {
      const std::uint32_t rank = grid_.find(morton_encode(
          static_cast<std::uint32_t>(c[0]), static_cast<std::uint32_t>(c[1]), static_cast<std::uint32_t>(c[2])));
      if (rank != no_voxel && number_[rank] != no_voxel) found(number_[rank], t);
    });
  }

  template <class Found>
  void by_bricks(std::uint32_t t, const Found& found) const {
    constexpr int shift = static_cast<int>(brick_bits);
    const std::int64_t voxels = std::int64_t{1} << grid_.depth(), bricks = std::max<std::int64_t>(voxels >> shift, 1);
    const auto corners = fine_.corners(scene_.positions, scene_.triangles[t]);
    auto coarse = corners;
    for (auto& corner : coarse)
      for (double& x : corner) x *= 1.0 / (1 << shift);
    // Most voxels asked for in a brick lie beside a small triangle: its extent tells, before any more is made of it.
    std::array<double, 3> low, high;
    for (int axis = 0; axis < 3; ++axis) {
      const auto [first, last] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
      low[axis] = first - margin_ - 1, high[axis] = last + margin_;
    }
    std::optional<TriangleCells> exact;
    TriangleCells(coarse, bricks, margin_ / (1 << shift)).for_each([&](const TriangleCells::Cell& c) {
      const std::uint32_t brick = find_brick(grid_.slots(), static_cast<std::uint32_t>(c[0]),
                                             static_cast<std::uint32_t>(c[1]), static_cast<std::uint32_t>(c[2]));
      if (brick == no_brick) return;
      for (std::uint32_t i = first_[brick]; i < first_[brick + 1]; ++i) {
        const std::array<std::uint32_t, 3>& cell = cells_[i];
        if (cell[0] < low[0] || cell[0] > high[0] || cell[1] < low[1] || cell[1] > high[1] || cell[2] < low[2] ||
            cell[2] > high[2])
          continue;
        if (!exact) exact.emplace(corners, voxels, margin_);
        if (exact->touches({cell[0], cell[1], cell[2]})) found(i, t);
      }
    });
  }

  const SceneData& scene_;
  const VoxelGrid& grid_;
  std::span<const std::uint32_t> ranks_;
  GridTransform fine_;
  double margin_;  // in voxels
  bool dense_;
  std::vector<std::uint32_t> number_;                // dense: of each rank, or no_voxel
  std::vector<std::array<std::uint32_t, 3>> cells_;  // sparse: of each voxel asked for
  std::vector<std::uint32_t> first_;                 // sparse: those of brick b are first_[b] … first_[b + 1] − 1
};

}  // namespace

VoxelTriangles triangles_touching(const SceneData& scene, const VoxelGrid& grid, std::span<const std::uint32_t> ranks,
                                  double margin_m) {
  return triangle_lists(Finder(scene, grid, ranks, margin_m), ranks.size());
}

}  // namespace vantage
