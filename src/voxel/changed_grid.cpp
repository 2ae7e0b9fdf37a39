// SPDX-License-Identifier: Apache-2.0
// Voxels of a changed scene. Bricks touched by a removed or new triangle are marked from scratch by all triangles that
// touch them; all others stay.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "scene/scene_difference.hpp"
#include "voxel/grid_fit.hpp"
#include "voxel/triangle_cells.hpp"
#include "voxel/voxel_bricks.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {
namespace {

constexpr int kShift = static_cast<int>(brick_bits);

std::uint64_t key_of(const VoxelBrick& brick) { return morton_encode(brick.x, brick.y, brick.z); }

// Boxes around bricks, one for each changed mesh, in bricks.
struct BrickBox {
  std::array<double, 3> low, high;
};

class Remarked {
 public:
  Remarked(const GridTransform& grid, int depth)
      : fine_(grid),
        coarse_(grid.coarser(kShift)),
        cells_(std::int64_t{1} << depth),
        bricks_(std::max<std::int64_t>(cells_ >> kShift, 1)) {}

  // Takes the bricks that triangles touch.
  void include(const SceneData& scene, const MeshRange& mesh) {
    const std::uint32_t end = mesh.first_triangle + mesh.triangle_count;
    BrickBox box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
    for (std::uint32_t t = mesh.first_triangle; t < end; ++t)
      TriangleCells(coarse_.corners(scene.corners(t)), bricks_).for_each([&](const TriangleCells::Cell& c) {
        const std::array<std::uint32_t, 3> at{static_cast<std::uint32_t>(c[0]), static_cast<std::uint32_t>(c[1]),
                                              static_cast<std::uint32_t>(c[2])};
        const std::uint64_t key = morton_encode(at[0], at[1], at[2]);
        if (!keys_.empty() && keys_.back() == key) return;
        keys_.push_back(key);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          box.low[axis] = std::min(box.low[axis], static_cast<double>(at[axis]));
          box.high[axis] = std::max(box.high[axis], static_cast<double>(at[axis]) + 1);
        }
      });
    if (box.low[0] <= box.high[0]) boxes_.push_back(box);
  }

  // Marks the bricks from scratch by all surveyed triangles of a scene that touch them. `bounds`: of each of its
  // surveyed meshes with triangles.
  void mark(const SceneData& scene, std::span<const MeshRange> surveyed, std::span<const Box> bounds) {
    std::ranges::sort(keys_);
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    marked_.bricks.resize(keys_.size());
    for (std::size_t b = 0; b < keys_.size(); ++b) {
      const auto [x, y, z] = morton_decode(keys_[b]);
      marked_.bricks[b].x = x, marked_.bricks[b].y = y, marked_.bricks[b].z = z;
    }
    marked_.slots = hash_bricks(marked_.bricks);
    touched_.assign(keys_.size(), 0);
    constexpr std::size_t kMostBoxes = 16;
    if (boxes_.size() > kMostBoxes) {
      for (const BrickBox& box : boxes_)
        for (std::size_t axis = 0; axis < 3; ++axis) {
          boxes_.front().low[axis] = std::min(boxes_.front().low[axis], box.low[axis]);
          boxes_.front().high[axis] = std::max(boxes_.front().high[axis], box.high[axis]);
        }
      boxes_.erase(boxes_.begin() + 1, boxes_.end());
    }
    for (std::size_t m = 0; m < surveyed.size(); ++m) {
      const std::array<Float3, 3> corners{narrow(bounds[m].min), narrow(bounds[m].max), narrow(bounds[m].max)};
      if (!near(coarse_.corners(corners))) continue;
      parallel::for_all(tbb::blocked_range<std::uint32_t>(surveyed[m].first_triangle,
                                                          surveyed[m].first_triangle + surveyed[m].triangle_count, 512),
                        [&](const tbb::blocked_range<std::uint32_t>& range) {
                          for (std::uint32_t t = range.begin(); t != range.end(); ++t) mark(scene.corners(t));
                        });
    }
  }

  std::span<const std::uint64_t> keys() const { return keys_; }
  // Returns brick number k as marked; null if no triangle touches it.
  const VoxelBrick* brick(std::size_t k) const { return touched_[k] ? &marked_.bricks[k] : nullptr; }

 private:
  // Returns true if corners, in bricks, lie where a changed mesh is or was. Wider than all roundings.
  bool near(const std::array<std::array<double, 3>, 3>& corners) const {
    std::array<double, 3> low, high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min({corners[0][axis], corners[1][axis], corners[2][axis]}) - 1;
      high[axis] = std::max({corners[0][axis], corners[1][axis], corners[2][axis]}) + 1;
    }
    return std::ranges::any_of(boxes_, [&](const BrickBox& box) {
      return low[0] <= box.high[0] && high[0] >= box.low[0] && low[1] <= box.high[1] && high[1] >= box.low[1] &&
             low[2] <= box.high[2] && high[2] >= box.low[2];
    });
  }

  void mark(const std::array<Float3, 3>& corners) {
    const auto in_bricks = coarse_.corners(corners);
    if (!near(in_bricks)) return;
    bool any = false;
    TriangleCells(in_bricks, bricks_).for_each([&](const TriangleCells::Cell& c) {
      const std::uint32_t index = find_brick(marked_.slots, static_cast<std::uint32_t>(c[0]),
                                             static_cast<std::uint32_t>(c[1]), static_cast<std::uint32_t>(c[2]));
      if (index == kNoBrick) return;
      std::atomic_ref(touched_[index]).store(1, std::memory_order_relaxed);
      any = true;
    });
    if (!any) return;
    const TriangleCells cells(fine_.corners(corners), cells_);
    for (const BrickBox& box : boxes_) {
      // A cell of several boxes is marked several times.
      TriangleCells::Cell low, high;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = static_cast<std::int64_t>(box.low[axis]) << kShift;
        high[axis] = (static_cast<std::int64_t>(box.high[axis]) << kShift) - 1;
      }
      cells.for_each_within(low, high, MarkVoxels(marked_));
    }
  }

  GridTransform fine_, coarse_;
  std::int64_t cells_, bricks_;
  std::vector<std::uint64_t> keys_;
  std::vector<BrickBox> boxes_;
  VoxelBricks marked_;
  std::vector<std::uint8_t> touched_;  // by a triangle
};

}  // namespace

std::optional<VoxelGrid> VoxelGrid::changed(const SceneData& before, const SceneData& after,
                                            const SceneDifference& difference, double user_size_m) const {
  const std::vector<MeshRange> surveyed = surveyed_ranges(after);
  std::optional<std::uint32_t> weight;
  for (const MeshInfo& mesh : after.meshes)
    if (mesh.role == Role::surveyed && std::exchange(weight, mesh.weight).value_or(mesh.weight) != mesh.weight)
      return std::nullopt;
  auto basis = std::make_shared<FitBasis>();
  const std::optional<GridFit> fit = refit_grid(*basis_, before, after, surveyed, difference, user_size_m, *basis);
  if (!fit || fit->depth != depth_ || fit->inverse_size != inverse_size_ || fit->min != min_) return std::nullopt;

  Remarked remarked({{min_[0], min_[1], min_[2]}, inverse_size_}, depth_);
  for (const std::uint32_t m : difference.gone)
    if (before.meshes[m].role == Role::surveyed) remarked.include(before, before.ranges[m]);
  for (std::size_t m = 0; m < after.meshes.size(); ++m)
    if (after.meshes[m].role == Role::surveyed && difference.mesh_before[m] == SceneDifference::kNew)
      remarked.include(after, after.ranges[m]);
  remarked.mark(after, surveyed, basis->bounds);

  VoxelBricks marked;
  marked.bricks.reserve(bricks_.size() + remarked.keys().size());
  std::size_t next = 0;
  const auto take_up_to = [&](std::uint64_t key) {  // bricks marked anew, below this key
    for (; next < remarked.keys().size() && remarked.keys()[next] < key; ++next)
      if (const VoxelBrick* const brick = remarked.brick(next)) marked.bricks.push_back(*brick);
  };
  for (const VoxelBrick& brick : bricks_) {
    const std::uint64_t key = key_of(brick);
    take_up_to(key);
    if (next == remarked.keys().size() || remarked.keys()[next] != key) marked.bricks.push_back(brick);
  }
  take_up_to(~std::uint64_t{0});
  number_bricks(marked);
  marked.slots = hash_bricks(marked.bricks);

  VoxelGrid grid;
  grid.depth_ = depth_;
  grid.voxel_size_ = voxel_size_;
  grid.inverse_size_ = inverse_size_;
  grid.min_ = min_;
  grid.basis_ = std::move(basis);
  grid.take(std::move(marked));
  grid.total_weight_ = grid.size_;
  return grid;
}

}  // namespace vantage
