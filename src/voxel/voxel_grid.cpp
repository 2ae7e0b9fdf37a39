// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/target_clones.hpp"
#include "voxel/grid_fit.hpp"
#include "voxel/voxel_bricks.hpp"

namespace vantage {
namespace {

constexpr std::uint64_t kStep = 256;

// Among bricks with the same `first`, only the last holds voxels.
std::vector<std::uint32_t> bricks_at_steps(std::span<const VoxelBrick> bricks, std::uint64_t voxels) {
  std::vector<std::uint32_t> at((voxels + kStep - 1) / kStep);
  std::uint32_t brick = 0;
  for (std::size_t k = 0; k < at.size(); ++k) {
    while (brick + 1 < bricks.size() && bricks[brick + 1].first <= k * kStep) ++brick;
    at[k] = brick;
  }
  return at;
}

std::uint64_t brick_key(const VoxelBrick& brick) {
  return morton_encode(brick.x, brick.y, brick.z) << (3 * brick_bits);
}

}  // namespace

VoxelGrid VoxelGrid::build(const SceneData& scene, double user_size_m) {
  return *build(scene, user_size_m, Progress{});
}

std::optional<VoxelGrid> VoxelGrid::build(const SceneData& scene, double user_size_m, const Progress& progress) {
  const std::vector<MeshRange> surveyed = surveyed_ranges(scene);
  auto basis = std::make_shared<FitBasis>();
  const GridFit fit = fit_grid(scene, surveyed, user_size_m, basis.get());
  VoxelGrid grid;
  grid.basis_ = std::move(basis);
  grid.depth_ = fit.depth;
  grid.inverse_size_ = fit.inverse_size;
  grid.voxel_size_ = 1.0 / fit.inverse_size;
  grid.min_ = fit.min;
  std::optional<VoxelBricks> marked =
      mark_bricks(scene, surveyed, {{fit.min[0], fit.min[1], fit.min[2]}, fit.inverse_size}, fit.depth, progress);
  if (!marked) return std::nullopt;
  grid.take(std::move(*marked));
  auto weights = voxel_weights(scene, grid, {.stop = progress.stop});
  if (!weights) return std::nullopt;
  grid.total_weight_ =
      weights->empty() ? grid.size_ : std::accumulate(weights->begin(), weights->end(), std::uint64_t{0});
  grid.demands_.weights = std::move(*weights);
  return grid;
}

void VoxelGrid::take(VoxelBricks&& marked) {
  size_ = marked.voxels;
  bricks_ = std::move(marked.bricks);
  slots_ = std::move(marked.slots);
  brick_at_ = bricks_at_steps(bricks_, size_);
}

VANTAGE_TARGET_CLONES
std::uint64_t VoxelGrid::key(std::uint64_t voxel_index) const {
  std::uint32_t at = brick_at_[voxel_index / kStep];
  while (at + 1 < bricks_.size() && bricks_[at + 1].first <= voxel_index) ++at;
  const VoxelBrick& brick = bricks_[at];
  auto left = static_cast<int>(voxel_index - brick.first);
  std::uint32_t word = 0;
  for (int set = std::popcount(brick.mask[0]); left >= set; set = std::popcount(brick.mask[word])) {
    left -= set;
    ++word;
  }
  std::uint32_t bits = brick.mask[word];
  for (; left > 0; --left) bits &= bits - 1;
  return brick_key(brick) | (word * 32 + static_cast<std::uint32_t>(std::countr_zero(bits)));
}

VANTAGE_TARGET_CLONES
std::uint32_t VoxelGrid::find(std::uint64_t key) const {
  const auto [x, y, z] = morton_decode(key >> (3 * brick_bits));
  const std::uint32_t index = find_brick(slots_, x, y, z);
  if (index == kNoBrick) return kNoVoxel;
  const VoxelBrick& brick = bricks_[index];
  const auto bit = static_cast<std::uint32_t>(key & 511);
  const std::uint32_t word = bit / 32, flag = std::uint32_t{1} << (bit % 32);
  if (!(brick.mask[word] & flag)) return kNoVoxel;
  auto voxel_index = brick.first + static_cast<std::uint32_t>(std::popcount(brick.mask[word] & (flag - 1)));
  for (std::uint32_t w = 0; w < word; ++w) voxel_index += static_cast<std::uint32_t>(std::popcount(brick.mask[w]));
  return voxel_index;
}

std::optional<std::array<std::uint32_t, 3>> VoxelGrid::cell_of(const Float3& p) const {
  const float cells = static_cast<float>(1u << depth_);
  const std::array<float, 3> scaled{(p.x - min_[0]) * inverse_size_, (p.y - min_[1]) * inverse_size_,
                                    (p.z - min_[2]) * inverse_size_};
  std::array<std::uint32_t, 3> cell;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(scaled[axis] >= 0 && scaled[axis] < cells)) return std::nullopt;
    cell[axis] = static_cast<std::uint32_t>(scaled[axis]);
  }
  return cell;
}

std::uint32_t VoxelGrid::index_of(const Float3& p) const {
  const auto cell = cell_of(p);
  return cell ? find(morton_encode((*cell)[0], (*cell)[1], (*cell)[2])) : kNoVoxel;
}

std::vector<std::uint64_t> voxelize(std::span<const Float3> positions, std::span<const Triangle> triangles,
                                    const std::array<double, 3>& min, double voxel_size, int depth) {
  // A size that is the reciprocal of a float stands for that float.
  double inverse = 1 / voxel_size;
  if (1.0 / static_cast<float>(inverse) == voxel_size) inverse = static_cast<float>(inverse);
  SceneData scene;
  scene.positions.assign(positions.begin(), positions.end());
  scene.triangles.assign(triangles.begin(), triangles.end());
  const std::array all{MeshRange{0, scene.triangle_count(), 0}};
  const VoxelBricks marked = *mark_bricks(scene, all, {min, inverse}, depth);
  std::vector<std::uint64_t> keys;
  keys.reserve(marked.voxels);
  for (const VoxelBrick& brick : marked.bricks)
    for (std::uint32_t word = 0; word < brick_mask_words; ++word)
      for (std::uint32_t bits = brick.mask[word]; bits; bits &= bits - 1)
        keys.push_back(brick_key(brick) | (word * 32 + static_cast<std::uint32_t>(std::countr_zero(bits))));
  return keys;
}

}  // namespace vantage
