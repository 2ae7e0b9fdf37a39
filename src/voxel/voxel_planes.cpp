// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_planes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.hpp"
#include "voxel/triangle_cells.hpp"
#include "voxel/triangle_lists.hpp"
#include "voxel/voxel_bricks.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
// Distance from a plane within which a corner lies in it, as a share of a voxel.
constexpr double kFlat = 1e-3;
// Least width of a surface: that of a door's leaf, and half a voxel.
constexpr double kWide_m = 0.75, kWideInVoxels = 0.5;
// Two planes of a voxel that differ by less, in their normals and by this share of a voxel in place, are one.
constexpr double kSame = 1e-3;
// A triangle of so many voxels or more is walked in parts, side by side.
constexpr double kLargeTriangle = 1 << 16;

Vec3 wide(const Float3& p) { return {p.x, p.y, p.z}; }

// Triangles that follow each other and lie in one plane.
struct Surface {
  Vec3 normal;
  double offset = 0, area = 0, largest = 0;  // area of the triangle that the plane is from
  Vec3 low, high;

  double width() const {
    const Vec3 size = high - low;
    const double longest = std::sqrt(dot(size, size));
    return longest > 0 ? area / longest : 0;
  }
  bool holds(const std::array<Vec3, 3>& corners, double distance) const {
    return std::ranges::all_of(corners, [&](const Vec3& p) { return std::abs(dot(normal, p) - offset) <= distance; });
  }
  void add(const std::array<Vec3, 3>& corners, const Vec3& own_normal, double own_area) {
    if (area == 0) low = high = corners[0];
    for (const Vec3& p : corners) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    area += own_area;
    if (own_area <= largest) return;  // the largest triangle knows the plane best
    largest = own_area, normal = own_normal, offset = dot(own_normal, corners[0]);
  }
};

// Finds every pair of a voxel and a triangle of a wide surface.
class WideFinder {
 public:
  WideFinder(const SceneData& scene, const VoxelGrid& grid, std::span<const std::uint32_t> plane_of)
      : scene_(scene),
        grid_(grid),
        plane_of_(plane_of),
        cells_({{grid.min()[0], grid.min()[1], grid.min()[2]}, grid.inverse_size()}) {}

  template <class Found>
  void for_each(const Found& found) const {
    for_each_surveyed(scene_, [&](std::uint32_t t) {
      if (plane_of_[t] == kNone) return;
      const auto corners = cells_.corners(scene_.corners(t));
      const TriangleCells cells(corners, std::int64_t{1} << grid_.depth());
      const auto visit = [&](const TriangleCells::Cell& c) {
        const std::uint32_t voxel = grid_.find(morton_encode(
            static_cast<std::uint32_t>(c[0]), static_cast<std::uint32_t>(c[1]), static_cast<std::uint32_t>(c[2])));
        if (voxel != no_voxel) found(voxel, t);
      };
      double extent = 0;
      for (std::size_t axis = 0; axis < 3; ++axis)
        extent = std::max(
            {extent, std::abs(corners[1][axis] - corners[0][axis]), std::abs(corners[2][axis] - corners[0][axis])});
      if (extent * extent < kLargeTriangle) {
        cells.for_each(visit);
        return;
      }
      constexpr std::int64_t parts = 64;
      parallel::for_all(std::int64_t{0}, parts, [&](std::int64_t part) { cells.for_each(visit, part, parts); });
    });
  }

 private:
  const SceneData& scene_;
  const VoxelGrid& grid_;
  std::span<const std::uint32_t> plane_of_;
  GridTransform cells_;
};

}  // namespace

VoxelPlanes::VoxelPlanes(const SceneData& scene, const VoxelGrid& grid) : first_(grid.size() + 1, 0) {
  const double voxel = grid.voxel_size(), least = std::max(kWide_m, kWideInVoxels * voxel);
  std::vector<std::uint32_t> plane_of(scene.triangle_count(), kNone);
  std::vector<double> area;  // of each plane's surface
  for (std::size_t m = 0; m < scene.ranges.size(); ++m) {
    if (scene.meshes[m].role != Role::surveyed) continue;
    const std::uint32_t begin = scene.ranges[m].first_triangle, end = begin + scene.ranges[m].triangle_count;
    Surface surface;
    std::uint32_t first = begin;
    const auto end_surface = [&](std::uint32_t last) {
      if (surface.width() < least) return;
      std::fill(plane_of.begin() + first, plane_of.begin() + last, static_cast<std::uint32_t>(planes_.size()));
      planes_.push_back({surface.normal, surface.offset});
      area.push_back(surface.area);
    };
    for (std::uint32_t t = begin; t < end; ++t) {
      const auto p = scene.corners(t);
      const std::array<Vec3, 3> corners{wide(p[0]), wide(p[1]), wide(p[2])};
      const Vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
      const double twice = std::sqrt(dot(normal, normal));
      if (!(twice > 0)) continue;
      if (surface.area > 0 && !surface.holds(corners, kFlat * voxel)) {
        end_surface(t);
        surface = {}, first = t;
      }
      surface.add(corners, normal * (1 / twice), twice / 2);
    }
    end_surface(end);
  }
  if (planes_.empty()) return;

  const VoxelTriangles touching = triangle_lists(WideFinder(scene, grid, plane_of), grid.size());
  const auto same = [&](std::uint32_t a, std::uint32_t b) {
    if (a == b) return true;
    const double turned = dot(planes_[a].normal, planes_[b].normal);
    return std::abs(turned) > 1 - kSame * kSame &&
           std::abs(planes_[a].offset - (turned < 0 ? -1 : 1) * planes_[b].offset) < kSame * voxel;
  };
  // Twice over the voxels: numbers of planes, then the planes.
  const auto planes_of = [&](std::size_t v, std::array<std::uint32_t, most>& kept) {
    std::vector<std::uint32_t> all;
    for (std::uint32_t k = touching.offset[v]; k < touching.offset[v + 1]; ++k)
      all.push_back(plane_of[touching.triangle[k]]);
    std::ranges::sort(all,
                      [&](std::uint32_t a, std::uint32_t b) { return area[a] != area[b] ? area[a] > area[b] : a < b; });
    std::size_t many = 0;
    for (const std::uint32_t plane : all) {
      if (many == most) break;
      if (std::none_of(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(many),
                       [&](std::uint32_t one) { return same(one, plane); }))
        kept[many++] = plane;
    }
    return many;
  };
  parallel::for_all(std::size_t{0}, static_cast<std::size_t>(grid.size()), [&](std::size_t v) {
    std::array<std::uint32_t, most> kept;
    first_[v + 1] = static_cast<std::uint32_t>(planes_of(v, kept));
  });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  plane_of_.resize(first_.back());
  parallel::for_all(std::size_t{0}, static_cast<std::size_t>(grid.size()), [&](std::size_t v) {
    std::array<std::uint32_t, most> kept;
    const std::size_t many = planes_of(v, kept);
    std::copy_n(kept.begin(), many, plane_of_.begin() + first_[v]);
  });
}

}  // namespace vantage
