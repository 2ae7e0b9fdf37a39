// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_triangles.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "voxel/triangle_cells.hpp"
#include "voxel/triangle_lists.hpp"
#include "voxel/voxel_bricks.hpp"

namespace vantage {
namespace {

// If more than one in this many surveyed voxels is wanted, walking each triangle's voxels is cheaper than walking its
// bricks and testing the wanted voxels in each.
constexpr std::uint64_t kDenseShare = 32;

bool is_dense(std::span<const std::uint32_t> voxel_indices, const VoxelGrid& grid) {
  return voxel_indices.size() >= grid.size() / kDenseShare;
}

constexpr int kBrickShift = static_cast<int>(brick_bits);
std::int64_t voxels_a_side(const VoxelGrid& grid) { return std::int64_t{1} << grid.depth(); }
GridTransform transform_of(const VoxelGrid& grid) {
  return {{grid.min()[0], grid.min()[1], grid.min()[2]}, grid.inverse_size()};
}

// Tests which voxels one triangle touches, widened by a margin in voxels. Most wanted voxels lie beside a small
// triangle: its extent decides first, at low cost.
class TriangleReach {
 public:
  TriangleReach(const std::array<std::array<double, 3>, 3>& corners, std::int64_t voxels, double margin)
      : corners_(corners), voxels_(voxels), margin_(margin) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [first, last] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
      low_[axis] = first - margin - 1, high_[axis] = last + margin;
    }
  }
  bool touches(const std::array<std::uint32_t, 3>& cell) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (cell[axis] < low_[axis] || cell[axis] > high_[axis]) return false;
    if (!exact_) exact_.emplace(corners_, voxels_, margin_);
    return exact_->touches({cell[0], cell[1], cell[2]});
  }

 private:
  std::array<std::array<double, 3>, 3> corners_;
  std::int64_t voxels_;
  double margin_;
  std::array<double, 3> low_, high_;
  std::optional<TriangleCells> exact_;
};

// Calls visit(brick) for each brick of the grid that a triangle touches, widened by a margin in voxels.
template <class Visit>
void for_each_brick(const VoxelGrid& grid, const std::array<std::array<double, 3>, 3>& corners, double margin,
                    const Visit& visit) {
  const std::int64_t bricks = std::max<std::int64_t>(voxels_a_side(grid) >> kBrickShift, 1);
  auto coarse = corners;
  for (auto& corner : coarse)
    for (double& x : corner) x *= 1.0 / (1 << kBrickShift);
  TriangleCells(coarse, bricks, margin / (1 << kBrickShift)).for_each([&](const TriangleCells::Cell& c) {
    const std::uint32_t brick = find_brick(grid.slots(), static_cast<std::uint32_t>(c[0]),
                                           static_cast<std::uint32_t>(c[1]), static_cast<std::uint32_t>(c[2]));
    if (brick != kNoBrick) visit(brick);
  });
}

// Finds every (triangle, brick) pair.
class BrickFinder {
 public:
  BrickFinder(const SceneData& scene, const VoxelGrid& grid, double margin_m)
      : scene_(scene), grid_(grid), fine_(transform_of(grid)), margin_(margin_m / grid.voxel_size()) {}

  template <class Found>
  void for_each(const Found& found) const {
    for_each_surveyed(scene_, [&](std::uint32_t t) {
      for_each_brick(grid_, fine_.corners(scene_.corners(t)), margin_, [&](std::uint32_t brick) { found(brick, t); });
    });
  }

 private:
  const SceneData& scene_;
  const VoxelGrid& grid_;
  GridTransform fine_;
  double margin_;
};

// Cells from `low` to `high`, both included.
struct CellBox {
  std::array<std::uint32_t, 3> low{0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu}, high{};

  void extend(const std::array<std::uint32_t, 3>& cell) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      low[axis] = std::min(low[axis], cell[axis]), high[axis] = std::max(high[axis], cell[axis]);
  }
};

// Finds every (triangle, voxel number) pair.
class Finder {
 public:
  Finder(const SceneData& scene, const VoxelGrid& grid, std::span<const std::uint32_t> voxel_indices, double margin_m)
      : scene_(scene),
        grid_(grid),
        voxel_indices_(voxel_indices),
        fine_(transform_of(grid)),
        margin_(margin_m / grid.voxel_size()),
        dense_(is_dense(voxel_indices, grid)) {
    if (voxel_indices.empty()) return;
    if (dense_) {
      first_index_ = voxel_indices.front();
      number_.assign(std::size_t{voxel_indices.back() - first_index_} + 1, kNoVoxel);
      for (std::size_t i = 0; i < voxel_indices.size(); ++i)
        number_[voxel_indices[i] - first_index_] = static_cast<std::uint32_t>(i);
      within_ = parallel::reduce(
          tbb::blocked_range<std::size_t>(0, voxel_indices.size()), CellBox(),
          [&](const tbb::blocked_range<std::size_t>& range, CellBox box) {
            for (std::size_t i = range.begin(); i != range.end(); ++i)
              box.extend(morton_decode(grid.key(voxel_indices[i])));
            return box;
          },
          [](CellBox a, const CellBox& b) { return a.extend(b.low), a.extend(b.high), a; });
      return;
    }
    cells_.resize(voxel_indices.size());
    parallel::for_all(tbb::blocked_range<std::size_t>(0, voxel_indices.size()),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i)
                          cells_[i] = morton_decode(grid.key(voxel_indices[i]));
                      });
    first_.resize(grid.bricks().size() + 1, static_cast<std::uint32_t>(voxel_indices.size()));
    std::size_t i = 0;
    for (std::size_t b = 0; b < grid.bricks().size(); ++b) {
      while (i < voxel_indices.size() && voxel_indices[i] < grid.bricks()[b].first) ++i;
      first_[b] = static_cast<std::uint32_t>(i);
    }
  }

  // Calls found(number, triangle) once per pair, from several threads at once.
  template <class Found>
  void for_each(const Found& found) const {
    if (voxel_indices_.empty()) return;
    for_each_surveyed(scene_, [&](std::uint32_t t) { dense_ ? by_voxels(t, found) : by_bricks(t, found); });
  }

 private:
  template <class Found>
  void by_voxels(std::uint32_t t, const Found& found) const {
    const auto corners = fine_.corners(scene_.corners(t));
    TriangleCells::Cell low, high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = within_.low[axis], high[axis] = within_.high[axis];
      const auto [first, last] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
      if (first > static_cast<double>(high[axis]) + 1 + margin_ || last < static_cast<double>(low[axis]) - margin_)
        return;
    }
    TriangleCells(corners, voxels_a_side(grid_), margin_).for_each_within(low, high, [&](const TriangleCells::Cell& c) {
      const std::uint32_t voxel_index = grid_.find(morton_encode(
          static_cast<std::uint32_t>(c[0]), static_cast<std::uint32_t>(c[1]), static_cast<std::uint32_t>(c[2])));
      const std::uint32_t place = voxel_index - first_index_;  // voxels before the first one wrap around
      if (voxel_index != kNoVoxel && place < number_.size() && number_[place] != kNoVoxel) found(number_[place], t);
    });
  }

  template <class Found>
  void by_bricks(std::uint32_t t, const Found& found) const {
    const auto corners = fine_.corners(scene_.corners(t));
    TriangleReach reach(corners, voxels_a_side(grid_), margin_);
    for_each_brick(grid_, corners, margin_, [&](std::uint32_t brick) {
      for (std::uint32_t i = first_[brick]; i < first_[brick + 1]; ++i)
        if (reach.touches(cells_[i])) found(i, t);
    });
  }

  const SceneData& scene_;
  const VoxelGrid& grid_;
  std::span<const std::uint32_t> voxel_indices_;
  GridTransform fine_;
  double margin_;  // in voxels
  bool dense_;
  CellBox within_;                                   // dense: around the wanted voxels
  std::uint32_t first_index_ = 0;                    // dense: index of the first of them
  std::vector<std::uint32_t> number_;                // dense: for each voxel index from there, its number or kNoVoxel
  std::vector<std::array<std::uint32_t, 3>> cells_;  // sparse: cell of each wanted voxel
  std::vector<std::uint32_t> first_;                 // sparse: brick b has first_[b] … first_[b + 1] − 1
};

}  // namespace

VoxelTriangles triangles_touching(const SceneData& scene, const VoxelGrid& grid,
                                  std::span<const std::uint32_t> voxel_indices, double margin_m) {
  return triangle_lists(Finder(scene, grid, voxel_indices, margin_m), voxel_indices.size());
}

SampleTriangles::SampleTriangles(std::shared_ptr<const SceneData> scene, std::shared_ptr<const VoxelGrid> grid)
    : scene_(std::move(scene)), grid_(std::move(grid)) {}

VoxelTriangles SampleTriangles::touching(std::span<const std::uint32_t> voxel_indices, double margin_m) {
  if (is_dense(voxel_indices, *grid_)) return triangles_touching(*scene_, *grid_, voxel_indices, margin_m);
  const std::shared_ptr<const Bricks> bricks = bricks_for(voxel_indices, margin_m);
  return bricks ? by_bricks(*bricks, voxel_indices, margin_m)
                : triangles_touching(*scene_, *grid_, voxel_indices, margin_m);
}

std::shared_ptr<const SampleTriangles::Bricks> SampleTriangles::bricks_for(std::span<const std::uint32_t> voxel_indices,
                                                                           double margin_m) {
  constexpr double kToSpare = 1.5;  // of the margin, which grows with the distance of stations
  const std::lock_guard lock(mutex_);
  if (first_.empty()) first_.assign(voxel_indices.begin(), voxel_indices.end());
  if (std::ranges::equal(first_, voxel_indices)) return nullptr;
  if (!bricks_ || bricks_->margin_m < margin_m) {
    const double margin = kToSpare * margin_m;
    // A thread that waits here must not take up other work, which might wait here, too.
    tbb::this_task_arena::isolate([&] {
      bricks_ = std::make_shared<const Bricks>(
          Bricks{margin, triangle_lists(BrickFinder(*scene_, *grid_, margin), grid_->bricks().size())});
    });
  }
  return bricks_;
}

VoxelTriangles SampleTriangles::by_bricks(const Bricks& bricks, std::span<const std::uint32_t> voxel_indices,
                                          double margin_m) const {
  const GridTransform fine = transform_of(*grid_);
  const double margin = margin_m / grid_->voxel_size();
  std::vector<std::vector<std::uint32_t>> found(voxel_indices.size());
  parallel::for_all(std::size_t{0}, voxel_indices.size(), [&](std::size_t i) {
    const auto cell = morton_decode(grid_->key(voxel_indices[i]));
    const std::uint32_t brick =
        find_brick(grid_->slots(), cell[0] >> kBrickShift, cell[1] >> kBrickShift, cell[2] >> kBrickShift);
    for (std::uint32_t k = bricks.triangles.offset[brick]; k < bricks.triangles.offset[brick + 1]; ++k) {
      const std::uint32_t t = bricks.triangles.triangle[k];
      TriangleReach reach(fine.corners(scene_->corners(t)), voxels_a_side(*grid_), margin);
      if (reach.touches(cell)) found[i].push_back(t);
    }
  });
  std::uint64_t pairs = 0;
  for (const auto& own : found) pairs += own.size();
  require_listable(pairs);
  VoxelTriangles lists;
  lists.offset.push_back(0);
  for (const auto& own : found) {
    lists.triangle.insert(lists.triangle.end(), own.begin(), own.end());
    lists.offset.push_back(static_cast<std::uint32_t>(lists.triangle.size()));
  }
  return lists;
}

}  // namespace vantage
