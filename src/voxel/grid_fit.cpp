// SPDX-License-Identifier: Apache-2.0
#include "voxel/grid_fit.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "scene/positions.hpp"
#include "vantage/error.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {
namespace {

constexpr double kMarginShare = 0.001;  // on either side: the cube's side is 1.002 extents
constexpr double kMaxTilt =
    1.0 / 128;  // off the axis; thickness is the criterion, this only excludes small facets of curves

// Adds up the weights of slabs at the same heights.
void merge(std::vector<Slab>& slabs) {
  std::ranges::sort(slabs, {}, [](const Slab& s) { return std::pair(s.low, s.high); });
  std::size_t out = 0;
  for (const Slab& s : slabs)
    if (out > 0 && slabs[out - 1].low == s.low && slabs[out - 1].high == s.high)
      slabs[out - 1].weight += s.weight;
    else
      slabs[out++] = s;
  slabs.resize(out);
}

constexpr std::size_t kMostSlabs = std::size_t{1} << 20;  // that are kept, 24 MB

AxisSlabs slabs_of(const SceneData& scene, std::span<const MeshRange> surveyed, const GridCube& cube) {
  const std::array<float, 3>& min = cube.fit.min;
  const double thickest = 4 * cube.clearance, area_unit = cube.extent * cube.extent * 0x1p-30;
  constexpr std::size_t kLeastMerged = std::size_t{1} << 18;
  struct Slabs {
    std::vector<Slab> slabs;
    std::size_t merge_at = kLeastMerged;
  };
  tbb::enumerable_thread_specific<std::array<Slabs, 3>> collected;
  for (const MeshRange& mesh : surveyed)
    parallel::for_all(
        tbb::blocked_range<std::uint32_t>(mesh.first_triangle, mesh.first_triangle + mesh.triangle_count, 4096),
        [&](const tbb::blocked_range<std::uint32_t>& range) {
          std::array<Slabs, 3>& own = collected.local();
          for (std::uint32_t t = range.begin(); t != range.end(); ++t) {
            const std::array<glm::dvec3, 3> p = corners_of(scene, t);
            const glm::dvec3 n = cross(p[1] - p[0], p[2] - p[0]);
            const double squared = dot(n, n);
            for (int axis = 0; axis < 3; ++axis) {
              const double low = std::min({p[0][axis], p[1][axis], p[2][axis]}),
                           high = std::max({p[0][axis], p[1][axis], p[2][axis]});
              if (high - low > thickest || n[axis] * n[axis] < squared * (1 - kMaxTilt * kMaxTilt)) continue;
              own[axis].slabs.push_back({low - min[axis], high - min[axis],
                                         static_cast<std::uint64_t>(0.5 * std::sqrt(squared) / area_unit) + 1});
            }
          }
          for (Slabs& of_axis : own) {
            if (of_axis.slabs.size() < of_axis.merge_at) continue;
            merge(of_axis.slabs);
            of_axis.merge_at = std::max(kLeastMerged, 2 * of_axis.slabs.size());
          }
        });
  AxisSlabs all;
  parallel::for_all(0, 3, [&](int axis) {
    for (const auto& some : collected)
      all[axis].insert(all[axis].end(), some[axis].slabs.begin(), some[axis].slabs.end());
    merge(all[axis]);
  });
  return all;
}

Box bounds_of(const SceneData& scene, std::uint32_t first, std::uint32_t count) {
  return parallel::reduce(
      tbb::blocked_range<std::uint32_t>(first, first + count, 4096), Box{},
      [&](const tbb::blocked_range<std::uint32_t>& range, Box box) {
        for (std::uint32_t t = range.begin(); t != range.end(); ++t)
          for (const Float3& p : scene.corners(t)) box.extend(widen(p));
        return box;
      },
      united);
}
// Returns the bounds of a mesh; those of places are stored.
Box bounds_of(const SceneData& scene, const MeshRange& mesh) {
  if (!scene.shares()) return bounds_of(scene, mesh.first_triangle, mesh.triangle_count);
  Box bounds;
  const std::uint32_t end = mesh.first_triangle + mesh.triangle_count;
  for (std::uint32_t t = mesh.first_triangle; t < end;) {
    const MeshInstance& run = scene.instance_of(t);
    t = run.first_triangle + run.triangle_count;
    bounds = united(bounds, run.bounds.empty() ? bounds_of(scene, run.first_triangle, run.triangle_count) : run.bounds);
  }
  return bounds;
}

// Returns the weight of the slabs within `clearance` of a face.
std::uint64_t weight_near_faces(std::span<const Slab> slabs, double voxel, double clearance) {
  std::uint64_t sum = 0;
  for (const Slab& s : slabs)
    if (std::ceil((s.low - clearance) / voxel) <= std::floor((s.high + clearance) / voxel)) sum += s.weight;
  return sum;
}

// Returns the smallest shift of the grid, within ± `most`, with the least weight within `clearance` of a face.
double best_shift(std::span<const Slab> slabs, double voxel, double clearance, double most) {
  struct Event {
    double at;
    std::int64_t change;
  };
  std::vector<Event> events;
  std::int64_t weight = 0;  // at a shift of −most
  for (const Slab& s : slabs) {
    // A shift of x brings face k within reach if s.low − clearance <= k·voxel + x <= s.high + clearance.
    const auto first = std::ceil((s.low - clearance - most) / voxel),
               last = std::floor((s.high + clearance + most) / voxel);
    for (double k = first; k <= last; ++k) {
      const double from = s.low - clearance - k * voxel, to = s.high + clearance - k * voxel;
      const auto change = static_cast<std::int64_t>(s.weight);
      if (from <= -most)
        weight += change;
      else
        events.push_back({from, change});
      if (to < most) events.push_back({to, -change});
    }
  }
  parallel::sort(events.begin(), events.end(),
                 [](const Event& a, const Event& b) { return std::tie(a.at, a.change) < std::tie(b.at, b.change); });

  const double narrowest = clearance / 16;  // a gap wide enough for the rounding of the grid's min
  std::tuple<std::int64_t, double, double> best{std::numeric_limits<std::int64_t>::max(), 0, 0};
  double gap_start = -most;
  const auto offer = [&](double gap_end) {
    if (gap_end - gap_start < narrowest) return;
    const double inset = narrowest / 2;
    const double x = std::clamp(0.0, gap_start + inset, gap_end - inset);
    best = std::min(best, {weight, std::abs(x), -x});
  };
  for (const Event& e : events) {
    offer(e.at);
    gap_start = e.at;
    weight += e.change;
  }
  offer(most);
  return -std::get<2>(best);
}

}  // namespace

double face_clearance(double reach_m, double voxel_size_m) {
  return std::min(std::max(16 * 0x1p-24 * reach_m, 1e-3 * voxel_size_m), voxel_size_m / 8);
}

namespace {

// REQUIRES: bounds that are not empty.
GridCube cube_around(const Box& bounds, const Box& local_bounds, double user_size_m) {
  GridCube cube;
  GridFit& fit = cube.fit;
  cube.low = {bounds.min.x, bounds.min.y, bounds.min.z}, cube.high = {bounds.max.x, bounds.max.y, bounds.max.z};
  const auto &low = cube.low, &high = cube.high;
  const double extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  double reach = 0;
  for (int axis = 0; axis < 3; ++axis) reach = std::max({reach, std::abs(low[axis]), std::abs(high[axis])});
  // If coordinates are very large for their extent, the usual margin does not cover the rounding of min itself.
  const double margin = std::max(kMarginShare * extent, 4 * 0x1p-23 * reach);
  const double side = extent + 2 * margin;

  double size = side;
  while (size > user_size_m) {
    size /= 2;
    if (++fit.depth > kMaxVoxelDepth) {
      std::ostringstream what;
      what << "a user size of " << user_size_m << " m is too small for surveyed meshes " << extent
           << " m wide; the smallest that works is " << side / std::ldexp(1.0, kMaxVoxelDepth) << " m";
      throw Error(Errc::invalid_argument, what.str());
    }
  }
  fit.inverse_size = static_cast<float>(1 / size);
  if (1.0 / fit.inverse_size > user_size_m) fit.inverse_size = std::nextafter(fit.inverse_size, HUGE_VALF);
  const double voxel = 1.0 / fit.inverse_size;
  const double edge = std::ldexp(voxel, fit.depth);

  if (!local_bounds.empty())
    for (const double c : {local_bounds.min.x, local_bounds.min.y, local_bounds.min.z, local_bounds.max.x,
                           local_bounds.max.y, local_bounds.max.z})
      reach = std::max(reach, std::abs(c));
  cube.extent = extent, cube.margin = margin;
  cube.clearance = face_clearance(std::max(reach, edge), voxel);
  for (int axis = 0; axis < 3; ++axis) fit.min[axis] = static_cast<float>(0.5 * (low[axis] + high[axis]) - 0.5 * edge);
  return cube;
}

// Returns the cube, moved off the planes.
GridFit moved_off(const AxisSlabs& slabs_along, const GridCube& cube) {
  GridFit fit = cube.fit;
  const double voxel = 1.0 / fit.inverse_size, edge = std::ldexp(voxel, fit.depth), clearance = cube.clearance;
  for (int axis = 0; axis < 3; ++axis) {
    const double min = fit.min[axis];
    const std::vector<Slab>& slabs = slabs_along[axis];
    if (weight_near_faces(slabs, voxel, clearance) == 0) continue;
    const double slack = std::min(cube.low[axis] - min, min + edge - cube.high[axis]) - 0.25 * cube.margin;
    const double most = std::min(slack, voxel / 2);
    if (most <= 0) continue;
    const double shift = best_shift(slabs, voxel, 1.125 * clearance, most);
    const float moved = static_cast<float>(min + shift);
    std::vector<Slab> shifted(slabs);
    for (Slab& s : shifted) {
      s.low -= moved - min;
      s.high -= moved - min;
    }
    if (weight_near_faces(shifted, voxel, clearance) < weight_near_faces(slabs, voxel, clearance))
      fit.min[axis] = moved;
  }
  return fit;
}

std::size_t count(const AxisSlabs& slabs) { return slabs[0].size() + slabs[1].size() + slabs[2].size(); }

void check_user_size(double user_size_m) {
  if (user_size_m > 0 && std::isfinite(user_size_m)) return;
  std::ostringstream what;
  what << "the user size of voxels must be positive and finite, in metres; it is " << user_size_m;
  throw Error(Errc::invalid_argument, what.str());
}

}  // namespace

GridFit fit_grid(const SceneData& scene, std::span<const MeshRange> surveyed, double user_size_m, FitBasis* basis) {
  check_user_size(user_size_m);
  std::vector<Box> bounds;
  for (const MeshRange& mesh : surveyed) bounds.push_back(bounds_of(scene, mesh));
  Box all;
  for (const Box& box : bounds) all = united(all, box);
  if (all.empty()) {
    GridFit fit;
    fit.inverse_size = static_cast<float>(1 / user_size_m);
    return fit;
  }
  const GridCube cube = cube_around(all, scene.local_bounds, user_size_m);
  AxisSlabs slabs = slabs_of(scene, surveyed, cube);
  const GridFit fit = moved_off(slabs, cube);
  if (basis) {
    *basis = {.bounds = std::move(bounds), .cube = cube, .has_slabs = count(slabs) <= kMostSlabs, .slabs = {}};
    if (basis->has_slabs) basis->slabs = std::move(slabs);
    for (std::vector<Slab>& of_axis : basis->slabs) of_axis.shrink_to_fit();
  }
  return fit;
}

std::optional<GridFit> refit_grid(const FitBasis& before, const SceneData& scene_before, const SceneData& scene,
                                  std::span<const MeshRange> surveyed, const SceneDifference& difference,
                                  double user_size_m, FitBasis& basis) {
  check_user_size(user_size_m);
  if (!before.has_slabs) return std::nullopt;
  // Numbers among surveyed meshes with triangles.
  const auto is_surveyed = [](const SceneData& of, std::size_t m) {
    return of.meshes[m].role == Role::surveyed && of.ranges[m].triangle_count > 0;
  };
  std::vector<std::size_t> number(scene_before.meshes.size());
  for (std::size_t m = 0, next = 0; m < number.size(); ++m) number[m] = is_surveyed(scene_before, m) ? next++ : 0;
  std::vector<MeshRange> is_new, gone;
  basis.bounds.clear();
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    if (!is_surveyed(scene, m)) continue;
    const std::uint32_t same = difference.mesh_before[m];
    if (same == SceneDifference::kNew) is_new.push_back(scene.ranges[m]);
    basis.bounds.push_back(same == SceneDifference::kNew ? bounds_of(scene, scene.ranges[m])
                                                         : before.bounds[number[same]]);
  }
  for (const std::uint32_t m : difference.gone)
    if (is_surveyed(scene_before, m)) gone.push_back(scene_before.ranges[m]);
  Box all;
  for (const Box& box : basis.bounds) all = united(all, box);
  if (all.empty() || surveyed.size() != basis.bounds.size()) return std::nullopt;
  basis.cube = cube_around(all, scene.local_bounds, user_size_m);
  if (!(basis.cube == before.cube)) return std::nullopt;
  const AxisSlabs added = slabs_of(scene, is_new, basis.cube), taken = slabs_of(scene_before, gone, basis.cube);
  basis.slabs = before.slabs;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<Slab>& slabs = basis.slabs[axis];
    if (added[axis].empty() && taken[axis].empty()) continue;
    slabs.insert(slabs.end(), added[axis].begin(), added[axis].end());
    merge(slabs);
    for (const Slab& slab : taken[axis]) {  // each is present: it was counted before
      const auto at = std::ranges::lower_bound(slabs, std::pair(slab.low, slab.high), {},
                                               [](const Slab& s) { return std::pair(s.low, s.high); });
      at->weight -= slab.weight;
    }
    std::erase_if(slabs, [](const Slab& s) { return s.weight == 0; });
  }
  basis.has_slabs = count(basis.slabs) <= kMostSlabs;
  if (!basis.has_slabs) basis.slabs = {};
  return basis.has_slabs ? std::optional(moved_off(basis.slabs, basis.cube)) : std::nullopt;
}

}  // namespace vantage
