// SPDX-License-Identifier: Apache-2.0
// Cells along a ray: Amanatides and Woo, A Fast Voxel Traversal Algorithm for Ray Tracing, 1987.
#include "import/cloud/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage::importer {
namespace {

constexpr double kCoarse_m = 0.12;
constexpr double kMostCoarse = 2e8;  // coarse cells in the box around the cloud, a byte each
// Rays are followed in the box of the cloud and this far beyond it, which is more than people are high.
constexpr double kBeyondCloud_m = 3;
// A ray that runs along a surface touches it only by noise.
constexpr float kLeastSlope = 0.3F;
// A plane near the face between two cells may cross either of them, by noise.
constexpr float kBeyond = 0.2F;
// A single ray may have been recorded wrongly.
constexpr std::uint8_t kSeveral = 2;

// Calls `visit(index, begin, end)` for each unit cell along from + t · direction, 0 <= t <= length.
template <class Visit>
void walk(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double length, Visit&& visit) {
  CellIndex index = from.array().floor().cast<int>();
  Eigen::Vector3d next, step;
  CellIndex way;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = direction[axis];
    way[axis] = d > 0 ? 1 : -1;
    step[axis] = d != 0 ? 1 / std::abs(d) : std::numeric_limits<double>::infinity();
    const double to_face = d > 0 ? index[axis] + 1 - from[axis] : from[axis] - index[axis];
    next[axis] = d != 0 ? to_face * step[axis] : std::numeric_limits<double>::infinity();
  }
  for (double t = 0; t < length;) {
    int axis = 0;
    const double leaves = std::min(next.minCoeff(&axis), length);
    visit(index, t, leaves);
    t = leaves;
    index[axis] += way[axis];
    next[axis] += step[axis];
  }
}

std::int32_t floor_div(std::int32_t value, std::int32_t by) {
  return value >= 0 ? value / by : -((-value - 1) / by) - 1;
}

}  // namespace

FreeSpace::FreeSpace(CellGrid& grid, const std::vector<CellPlane>& planes) : grid_(grid), planes_(planes) {
  Eigen::Array3d low = Eigen::Array3d::Constant(1e9), high = -low;
  for (std::uint32_t k = 0; k < grid.size(); ++k) {
    const Eigen::Array3d at = CellGrid::index_of(grid[k]).cast<double>().array();
    low = low.min(at), high = high.max(at);
  }
  low_ = low - kBeyondCloud_m / grid.cell_m(), high_ = high + 1 + kBeyondCloud_m / grid.cell_m();
  const double volume = (high_ - low_).prod();
  coarse_ = std::max({1, static_cast<std::int32_t>(std::lround(kCoarse_m / grid.cell_m())),
                      static_cast<std::int32_t>(std::ceil(std::cbrt(volume / kMostCoarse)))});
  for (std::uint32_t k = 0; k < grid.size(); ++k) {
    const CellIndex at = CellGrid::index_of(grid[k]);
    state({floor_div(at.x(), coarse_), floor_div(at.y(), coarse_), floor_div(at.z(), coarse_)}) |= kSurface;
  }
}

std::uint64_t FreeSpace::brick_key(const CellIndex& coarse) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis)
    key = key << 21 | static_cast<std::uint64_t>(floor_div(coarse[axis], kSide) + CellGrid::kReach);
  return key;
}

std::size_t FreeSpace::place_in_brick(const CellIndex& coarse) {
  const auto part = [&](int axis) {
    return static_cast<std::size_t>(coarse[axis] - kSide * floor_div(coarse[axis], kSide));
  };
  return (part(0) * kSide + part(1)) * kSide + part(2);
}

std::uint8_t& FreeSpace::state(const CellIndex& coarse) {
  const std::uint64_t key = brick_key(coarse);
  if (key != last_key_) last_ = &bricks_[key], last_key_ = key;
  return (*last_)[place_in_brick(coarse)];
}

bool FreeSpace::known(const Eigen::Vector3d& place) const {
  const CellIndex coarse = (place / coarse_).array().floor().cast<int>();
  const auto brick = bricks_.find(brick_key(coarse));
  return brick != bricks_.end() && brick->second[place_in_brick(coarse)] != 0;
}

void FreeSpace::add_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& to, std::uint16_t scan) {
  const Eigen::Vector3d way = to - from;
  const double length = way.norm(), end = length - 2 * coarse_;
  if (!(end > 0) || !(from.cwiseAbs().maxCoeff() < CellGrid::kReach)) return;
  const Eigen::Vector3d direction = way / length;
  double begin = 0;  // where the ray enters the box
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    const double face = direction[axis] > 0 ? low_[axis] : high_[axis];
    begin = std::max(begin, (face - from[axis]) / direction[axis]);
  }
  if (!(begin < end)) return;
  const Eigen::Vector3d enters = from + begin * direction;
  walk(enters / coarse_, direction, (end - begin) / coarse_, [&](const CellIndex& coarse, double begins, double ends) {
    std::uint8_t& here = state(coarse);
    here |= kFree;
    if (here & kSurface) test_cells(enters, direction, begins * coarse_, ends * coarse_, scan);
  });
}

void FreeSpace::test_cells(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double begin, double end,
                           std::uint16_t scan) {
  walk(from + begin * direction, direction, end - begin, [&](const CellIndex& index, double, double) {
    const std::uint32_t k = grid_.find(index);
    if (k == CellGrid::kNone) return;
    Cell& cell = grid_[k];
    if (cell.scan == scan || cell.scan == Cell::kSeveralScans || cell.seen_through == UINT8_MAX) return;
    const Eigen::Vector3f d = direction.cast<float>();
    const float slope = planes_[k].normal.dot(d);
    if (std::abs(slope) < kLeastSlope) return;
    const Eigen::Vector3f seen = (from - CellGrid::middle_of(index)).cast<float>();
    const float t = (planes_[k].offset - planes_[k].normal.dot(seen)) / slope;
    if ((seen + t * d).cwiseAbs().maxCoeff() <= 0.5F + kBeyond) ++cell.seen_through;
  });
}

std::uint32_t drop_seen_through(CellGrid& grid) {
  std::vector<std::uint32_t> dropped;
  for (std::uint32_t k = 0; k < grid.size(); ++k)
    if (grid[k].kept && grid[k].seen_through >= kSeveral) dropped.push_back(k);
  for (const std::uint32_t k : dropped) grid[k].kept = false;
  // Drops cells that few rays met, too, if most cells around them are dropped.
  std::vector<std::uint32_t> remains;
  for (const std::uint32_t gone : dropped)
    grid.for_neighbours(CellGrid::index_of(grid[gone]), [&](std::uint32_t k, const CellIndex& at) {
      if (grid[k].scan != grid[gone].scan) return;
      std::uint32_t others = 0, stay = 0;
      grid.for_all_around(at, [&](std::uint32_t beside, const CellIndex&) {
        ++others;
        stay += grid[beside].kept ? 1 : 0;
      });
      if (2 * stay < others) remains.push_back(k);
    });
  std::ranges::sort(remains);
  remains.erase(std::unique(remains.begin(), remains.end()), remains.end());
  for (const std::uint32_t k : remains) grid[k].kept = false;
  return static_cast<std::uint32_t>(dropped.size() + remains.size());
}

}  // namespace vantage::importer
