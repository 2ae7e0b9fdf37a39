// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_planes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "voxel/triangle_cells.hpp"
#include "voxel/triangle_lists.hpp"
#include "voxel/voxel_bricks.hpp"
#include "voxel/voxel_surfaces.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
// Distance from a plane within which a corner lies in it, as a share of a voxel.
constexpr double kFlat = 1e-3;
// Least width of a surface: a door's leaf, and half a voxel.
constexpr double kWide_m = 0.75, kWideInVoxels = 0.5;
// Two planes of a voxel count as one if they differ by less, in their normals and by this share of a voxel in place.
constexpr double kSame = 1e-3;
// Least share of a voxel's surface that lies in one direction (`kOnePlaneCosine`) if the voxel is flat.
constexpr double kFlatShare = 0.95;
// A triangle of this many voxels or more is walked in parts, in parallel.
constexpr double kLargeTriangle = 1 << 16;

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

// Every pair of a voxel and a triangle that touches it. Triangles are walked once, since lists are made in two passes.
class TouchFinder {
 public:
  TouchFinder(const SceneData& scene, const VoxelGrid& grid) : grid_(grid) {
    const GridTransform cells{{grid.min()[0], grid.min()[1], grid.min()[2]}, grid.inverse_size()};
    const std::uint32_t triangles = scene.triangle_count();
    pairs_.resize((triangles + kAtOnce - 1) / kAtOnce);
    parallel::for_all(std::size_t{0}, pairs_.size(), [&](std::size_t block) {
      const auto first = static_cast<std::uint32_t>(block * kAtOnce);
      std::size_t mesh = 0;
      for (std::uint32_t t = first; t < std::min(triangles, first + kAtOnce); ++t) {
        while (mesh + 1 < scene.ranges.size() && scene.ranges[mesh + 1].first_triangle <= t) ++mesh;
        if (scene.meshes[mesh].role == Role::surveyed) walk(cells.corners(scene.corners(t)), t, pairs_[block]);
      }
    });
  }

  template <class Found>
  void for_each(const Found& found) const {
    parallel::for_all(std::size_t{0}, pairs_.size(), [&](std::size_t block) {
      for (const auto& [voxel, t] : pairs_[block]) found(voxel, t);
    });
  }

 private:
  static constexpr std::uint32_t kAtOnce = 4096;
  using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

  void walk(const std::array<TriangleCells::Point, 3>& corners, std::uint32_t t, Pairs& pairs) const {
    const TriangleCells cells(corners, std::int64_t{1} << grid_.depth());
    const auto add_to = [&](Pairs& some) {
      return [&](const TriangleCells::Cell& c) {
        const std::uint32_t voxel = grid_.find(morton_encode(
            static_cast<std::uint32_t>(c[0]), static_cast<std::uint32_t>(c[1]), static_cast<std::uint32_t>(c[2])));
        if (voxel != kNoVoxel) some.emplace_back(voxel, t);
      };
    };
    double extent = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      extent = std::max(
          {extent, std::abs(corners[1][axis] - corners[0][axis]), std::abs(corners[2][axis] - corners[0][axis])});
    if (extent * extent < kLargeTriangle) {
      cells.for_each(add_to(pairs));
      return;
    }
    std::array<Pairs, 64> parts;
    parallel::for_all(std::size_t{0}, parts.size(), [&](std::size_t part) {
      cells.for_each(add_to(parts[part]), static_cast<std::int64_t>(part), static_cast<std::int64_t>(parts.size()));
    });
    for (const Pairs& part : parts) pairs.insert(pairs.end(), part.begin(), part.end());
  }

  const VoxelGrid& grid_;
  std::vector<Pairs> pairs_;
};

// Returns the plane of a voxel's surface if nearly all of it lies in one direction.
std::optional<VoxelPlanes::Plane> flat_plane(const SceneData& scene, std::span<const std::uint32_t> triangles,
                                             const Vec3& middle, double face_m2) {
  struct Part {
    Vec3 normal;
    double height, area;  // of the middle over it
  };
  std::vector<Part> parts;
  std::size_t largest = 0;
  double all = 0;
  for (const std::uint32_t t : triangles) {
    const auto p = scene.corners(t);
    const Vec3 a = widen(p[0]), normal = cross(widen(p[1]) - a, widen(p[2]) - a);
    const double twice = std::sqrt(dot(normal, normal));
    if (!(twice > 0)) continue;
    const Vec3 unit = normal * (1 / twice);
    parts.push_back({unit, dot(unit, middle - a), std::min(twice / 2, face_m2)});
    all += parts.back().area;
    if (parts.back().area > parts[largest].area) largest = parts.size() - 1;
  }
  if (parts.empty()) return std::nullopt;
  Vec3 sum;
  double height = 0, along = 0;
  for (const Part& part : parts) {
    const double turned = dot(part.normal, parts[largest].normal);
    if (std::abs(turned) < kOnePlaneCosine) continue;
    const double signed_area = turned < 0 ? -part.area : part.area;
    sum = sum + part.normal * signed_area;
    height += part.height * signed_area;
    along += part.area;
  }
  if (along < kFlatShare * all) return std::nullopt;
  const Vec3 normal = sum * (1 / std::sqrt(dot(sum, sum)));
  return VoxelPlanes::Plane{normal, dot(normal, middle) - height / along};
}

}  // namespace

VoxelPlanes::VoxelPlanes(const SceneData& scene, const VoxelGrid& grid) : first_(grid.size() + 1, 0) {
  const double voxel = grid.voxel_size(), least = std::max(kWide_m, kWideInVoxels * voxel);
  std::vector<std::uint32_t> plane_of(scene.triangle_count(), kNone);
  struct MeshPlanes {
    std::vector<Plane> planes;
    std::vector<double> area;  // of each plane's surface
  };
  std::vector<MeshPlanes> of_mesh(scene.ranges.size());
  parallel::for_all(std::size_t{0}, scene.ranges.size(), [&](std::size_t m) {
    if (scene.meshes[m].role != Role::surveyed) return;
    const std::uint32_t begin = scene.ranges[m].first_triangle, end = begin + scene.ranges[m].triangle_count;
    Surface surface;
    std::uint32_t first = begin;
    const auto end_surface = [&](std::uint32_t last) {
      if (surface.width() < least) return;
      std::fill(plane_of.begin() + first, plane_of.begin() + last,
                static_cast<std::uint32_t>(of_mesh[m].planes.size()));
      of_mesh[m].planes.push_back({surface.normal, surface.offset});
      of_mesh[m].area.push_back(surface.area);
    };
    for (std::uint32_t t = begin; t < end; ++t) {
      const auto p = scene.corners(t);
      const std::array<Vec3, 3> corners{widen(p[0]), widen(p[1]), widen(p[2])};
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
  });
  std::vector<double> area;
  for (std::size_t m = 0; m < of_mesh.size(); ++m) {
    const auto before = static_cast<std::uint32_t>(planes_.size());
    planes_.insert(planes_.end(), of_mesh[m].planes.begin(), of_mesh[m].planes.end());
    area.insert(area.end(), of_mesh[m].area.begin(), of_mesh[m].area.end());
    if (of_mesh[m].planes.empty()) continue;
    for (std::uint32_t t = 0; t < scene.ranges[m].triangle_count; ++t)
      if (std::uint32_t& plane = plane_of[scene.ranges[m].first_triangle + t]; plane != kNone) plane += before;
  }

  const VoxelTriangles touching = triangle_lists(TouchFinder(scene, grid), grid.size());
  const auto triangles_of = [&](std::size_t v) {
    return std::span(touching.triangle).subspan(touching.offset[v], touching.offset[v + 1] - touching.offset[v]);
  };
  const auto same = [&](std::uint32_t a, std::uint32_t b) {
    if (a == b) return true;
    const double turned = dot(planes_[a].normal, planes_[b].normal);
    return std::abs(turned) > 1 - kSame * kSame &&
           std::abs(planes_[a].offset - (turned < 0 ? -1 : 1) * planes_[b].offset) < kSame * voxel;
  };
  const auto wide_planes = [&](std::size_t v, std::array<std::uint32_t, kMost>& kept) {
    std::vector<std::uint32_t> all;
    for (const std::uint32_t t : triangles_of(v))
      if (plane_of[t] != kNone) all.push_back(plane_of[t]);
    std::ranges::sort(all,
                      [&](std::uint32_t a, std::uint32_t b) { return area[a] != area[b] ? area[a] > area[b] : a < b; });
    std::size_t many = 0;
    for (const std::uint32_t plane : all) {
      if (many == kMost) break;
      if (std::none_of(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(many),
                       [&](std::uint32_t one) { return same(one, plane); }))
        kept[many++] = plane;
    }
    return many;
  };
  const auto flat = [&](std::size_t v) {
    const auto [x, y, z] = morton_decode(grid.key(v));
    const Vec3 middle{static_cast<double>(grid.min()[0]) + (x + 0.5) * voxel,
                      static_cast<double>(grid.min()[1]) + (y + 0.5) * voxel,
                      static_cast<double>(grid.min()[2]) + (z + 0.5) * voxel};
    return flat_plane(scene, triangles_of(v), middle, voxel * voxel);
  };
  const auto voxels = static_cast<std::size_t>(grid.size());
  std::vector<std::optional<Plane>> flat_planes(voxels);
  parallel::for_all(std::size_t{0}, voxels, [&](std::size_t v) {
    std::array<std::uint32_t, kMost> kept;
    first_[v + 1] = static_cast<std::uint32_t>(wide_planes(v, kept));
    if (first_[v + 1] > 0) return;
    flat_planes[v] = flat(v);
    first_[v + 1] = flat_planes[v] ? 1 : 0;
  });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  plane_of_.resize(first_.back());
  for (std::size_t v = 0; v < voxels; ++v)
    if (flat_planes[v]) {
      plane_of_[first_[v]] = static_cast<std::uint32_t>(planes_.size());
      planes_.push_back(*flat_planes[v]);
    }
  parallel::for_all(std::size_t{0}, voxels, [&](std::size_t v) {
    if (flat_planes[v]) return;
    std::array<std::uint32_t, kMost> kept;
    const std::size_t many = wide_planes(v, kept);
    std::copy_n(kept.begin(), many, plane_of_.begin() + first_[v]);
  });
}

}  // namespace vantage
