// SPDX-License-Identifier: Apache-2.0
// Region growing on planes (Besl and Jain, Segmentation through Variable-Order Surface Fitting, 1988), by the moments
// of cells instead of points.
#include "import/cloud/flat_regions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "import/cloud/plane.hpp"

namespace vantage::importer {
namespace {

constexpr std::uint32_t kNone = UINT32_MAX;
// The points of a region lie within a tolerance of its plane, root mean square, in cells. It is kNoiseTimes the noise,
// at least kLeastTolerance for slightly bent walls, and at most kMostTolerance.
constexpr double kLeastTolerance = 0.12, kMostTolerance = 1, kNoiseTimes = 2.5;
// Scan lines across a far floor are at most this many cells apart.
constexpr int kGap = 4;
constexpr double kAlong = 0.5;  // largest share of the normal in a step along the plane
constexpr double kLeastWidth = 0.2;
constexpr double kLeastAround = 8, kLeastOwn = 3;  // points of a cell by itself, with and without its neighbours'
constexpr std::uint32_t kLeastGroup = 12;          // cells

int largest_part(const Eigen::Vector3d& v) {
  int axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return axis;
}

std::array<std::int32_t, 2> column_of(const CellIndex& index, int axis) {
  return {index[(axis + 1) % 3], index[(axis + 2) % 3]};
}

class Growth {
 public:
  Growth(const CellGrid& grid, const std::vector<CellPlane>& planes)
      : grid_(grid), planes_(planes), region_(grid.size(), kNone), covered_(grid.size(), false) {
    std::vector<float> thickness;
    for (std::uint32_t k = 0; k < grid.size(); ++k)
      if (grid[k].kept && planes[k].width >= static_cast<float>(kLeastWidth)) thickness.push_back(planes[k].thickness);
    if (!thickness.empty()) {
      const auto half = thickness.begin() + static_cast<std::ptrdiff_t>(thickness.size() / 2);
      std::nth_element(thickness.begin(), half, thickness.end());
      noise_ = static_cast<double>(*half);
    }
    tolerance_ = std::clamp(kNoiseTimes * noise_, kLeastTolerance, kMostTolerance);
  }

  std::vector<FlatRegion> run() {
    // Begins at the flattest places, whose planes are known best.
    std::vector<std::uint32_t> seeds;
    for (std::uint32_t k = 0; k < grid_.size(); ++k)
      if (grid_[k].kept && planes_[k].width >= static_cast<float>(kLeastWidth) &&
          planes_[k].thickness <= static_cast<float>(tolerance_))
        seeds.push_back(k);
    std::ranges::stable_sort(seeds, {}, [&](std::uint32_t k) { return planes_[k].thickness; });
    for (const std::uint32_t seed : seeds)
      if (region_[seed] == kNone) grow(seed);
    seeds = {};
    add_columns();
    add_edges();
    add_single_cells();
    return std::move(regions_);
  }

 private:
  bool fits(std::uint32_t k, const CellIndex& index, const Plane& plane, const CellIndex& base) const {
    const Moments own = grid_[k].moments();
    const double offset = plane.offset - plane.normal.dot((index - base).cast<double>());
    return own.square_distance(plane.normal, offset) <= tolerance_ * tolerance_;
  }

  void grow(std::uint32_t seed) {
    const CellIndex base = CellGrid::index_of(grid_[seed]);
    Moments all = grid_.around(seed);
    Plane plane = plane_of(all);
    if (!fits(seed, base, plane, base)) return;
    const auto number = static_cast<std::uint32_t>(regions_.size());
    std::vector<std::uint32_t> queue{seed};
    region_[seed] = number;
    all = grid_[seed].moments();
    std::size_t refit = 16;
    Eigen::Vector3d towards = Eigen::Vector3d::Zero();
    for (std::size_t next = 0; next < queue.size(); ++next) {
      const Cell& cell = grid_[queue[next]];
      towards += Eigen::Vector3d(cell.towards[0], cell.towards[1], cell.towards[2]);
      const CellIndex at = CellGrid::index_of(cell);
      for_steps(plane.normal, [&](const CellIndex& step) {
        const CellIndex there = at + step;
        const std::uint32_t k = grid_.find(there);
        if (k == CellGrid::kNone || !grid_[k].kept || region_[k] != kNone || !fits(k, there, plane, base)) return;
        region_[k] = number;
        queue.push_back(k);
        all.add(grid_[k].moments(), (there - base).cast<double>());
      });
      if (queue.size() < refit) continue;
      plane = plane_of(all);
      refit *= 2;
    }
    if (queue.size() > 2) plane = plane_of(all);
    FlatRegion region;
    region.normal = plane.normal, region.offset = plane.offset, region.base = CellGrid::middle_of(base);
    region.axis = largest_part(plane.normal);
    turn(region, towards);
    regions_.push_back(std::move(region));
  }

  // Calls `visit` for all steps to adjacent cells, and for a few longer ones along the plane.
  template <class Visit>
  void for_steps(const Eigen::Vector3d& normal, Visit&& visit) const {
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const CellIndex step(x, y, z);
          if (step.isZero()) continue;
          visit(step);
          const Eigen::Vector3d way = step.cast<double>();
          if (std::abs(normal.dot(way)) > kAlong * way.norm()) continue;
          for (int k = 2; k <= kGap; ++k) visit(k * step);
        }
  }

  // Turns the normal to the scanners that saw the region, or up without any: somebody may walk on it.
  static void turn(FlatRegion& region, const Eigen::Vector3d& towards) {
    const double seen = region.normal.dot(towards);
    const double side = std::abs(seen) > 1e-6 ? seen : region.normal.z();
    if (side < 0) region.normal = -region.normal, region.offset = -region.offset;
  }

  void add_columns() {
    for (std::uint32_t k = 0; k < grid_.size(); ++k)
      if (region_[k] != kNone) {
        FlatRegion& region = regions_[region_[k]];
        region.columns.push_back(column_of(CellGrid::index_of(grid_[k]), region.axis));
      }
  }

  // A cell at an edge fits none of its planes, so each plane that crosses it goes on into it.
  void add_edges() {
    for (std::uint32_t k = 0; k < grid_.size(); ++k) {
      if (!grid_[k].kept || region_[k] != kNone) continue;
      const CellIndex at = CellGrid::index_of(grid_[k]);
      const Eigen::Vector3d mean = CellGrid::middle_of(at) + grid_[k].moments().mean();
      std::vector<std::uint32_t> done;
      grid_.for_neighbours(at, [&](std::uint32_t beside, const CellIndex&) {
        const std::uint32_t number = region_[beside];
        if (number == kNone || std::ranges::find(done, number) != done.end()) return;
        done.push_back(number);
        FlatRegion& region = regions_[number];
        const double far = region.normal.dot(CellGrid::middle_of(at) - region.base) - region.offset;
        if (std::abs(far) <= 0.5 * region.normal.cwiseAbs().sum()) {
          region.columns.push_back(column_of(at, region.axis));
          covered_[k] = true;
        }
        // A few points beside a surface are noise of it.
        if (std::abs(region.normal.dot(mean - region.base) - region.offset) <= kNoiseTimes * noise_) covered_[k] = true;
      });
    }
  }

  void add_single_cells() {
    for (std::uint32_t k = 0; k < grid_.size(); ++k) {
      const Cell& cell = grid_[k];
      if (!cell.kept || region_[k] != kNone || covered_[k]) continue;
      if (cell.count < kLeastOwn || planes_[k].width < static_cast<float>(kLeastWidth)) continue;
      if (grid_.around(k).count < kLeastAround) continue;
      FlatRegion region;
      const CellIndex at = CellGrid::index_of(cell);
      region.base = CellGrid::middle_of(at);
      region.normal = planes_[k].normal.cast<double>();
      region.offset = region.normal.dot(cell.moments().mean());
      region.axis = largest_part(region.normal);
      region.columns.push_back(column_of(at, region.axis));
      turn(region, {cell.towards[0], cell.towards[1], cell.towards[2]});
      regions_.push_back(std::move(region));
    }
  }

  const CellGrid& grid_;
  const std::vector<CellPlane>& planes_;
  double noise_ = 0, tolerance_ = kLeastTolerance;
  std::vector<std::uint32_t> region_;  // one a cell
  std::vector<bool> covered_;
  std::vector<FlatRegion> regions_;
};

}  // namespace

double FlatRegion::height(double u, double v) const {
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  return base[axis] + (offset - normal[a] * (u - base[a]) - normal[b] * (v - base[b])) / normal[axis];
}

std::vector<CellPlane> cell_planes(const CellGrid& grid) {
  std::vector<CellPlane> planes(grid.size());
  for (std::uint32_t k = 0; k < grid.size(); ++k) {
    if (!grid[k].kept) continue;
    const Plane plane = plane_of(grid.around(k));
    planes[k] = {plane.normal.cast<float>(), static_cast<float>(plane.offset), static_cast<float>(plane.thickness),
                 static_cast<float>(plane.width)};
  }
  return planes;
}

std::uint32_t drop_lone(CellGrid& grid) {
  std::vector<bool> seen(grid.size(), false);
  std::uint32_t dropped = 0;
  std::vector<std::uint32_t> group;
  for (std::uint32_t k = 0; k < grid.size(); ++k) {
    if (seen[k] || !grid[k].kept) continue;
    group.assign(1, k);
    seen[k] = true;
    for (std::size_t next = 0; next < group.size(); ++next)
      grid.for_neighbours(CellGrid::index_of(grid[group[next]]), [&](std::uint32_t beside, const CellIndex&) {
        if (!seen[beside]) seen[beside] = true, group.push_back(beside);
      });
    if (group.size() >= kLeastGroup) continue;
    for (const std::uint32_t lone : group) grid[lone].kept = false;
    dropped += static_cast<std::uint32_t>(group.size());
  }
  return dropped;
}

std::vector<FlatRegion> flat_regions(const CellGrid& grid, const std::vector<CellPlane>& planes) {
  return Growth(grid, planes).run();
}

}  // namespace vantage::importer
