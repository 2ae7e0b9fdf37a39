// SPDX-License-Identifier: Apache-2.0
#include "scene/near_placed.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <string>

#include "core/parallel.hpp"
#include "scene/positions.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using FloatCorners = std::array<Float3, 3>;

Box box_of(const FloatCorners& corners) {
  Box box;
  for (const Float3& p : corners) box.extend(widen(p));
  return box;
}

// Cells over a box, with the roles that meet each. Boxes no farther apart than `reach_m` share a cell.
class RoleCells {
 public:
  RoleCells(const Box& box, double reach_m) : box_(box), reach_m_(reach_m), roles_(kSide * kSide * kSide, 0) {}

  void mark(const Box& box, std::uint8_t role) {
    for_cells(box, [&](std::size_t cell) {
      const std::atomic_ref<std::uint8_t> roles(roles_[cell]);
      if (!(roles.load(std::memory_order_relaxed) & role)) roles.fetch_or(role, std::memory_order_relaxed);
      return true;
    });
  }
  // REQUIRES: no thread marks.
  bool meets(const Box& box, std::uint8_t role) const {
    bool met = false;
    for_cells(box, [&](std::size_t cell) { return !(met = (roles_[cell] & role) != 0); });
    return met;
  }

 private:
  static constexpr std::size_t kSide = 256;

  // Visits cells until `visit` returns false.
  template <class Visit>
  void for_cells(const Box& box, const Visit& visit) const {
    const auto cell = [&](double x, double least, double size) {
      return static_cast<std::size_t>(
          std::clamp((x - least) / std::max(size, 1e-9) * kSide, 0.0, static_cast<double>(kSide - 1)));
    };
    const Vec3 least = box_.min, size = box_.size(), reach{reach_m_, reach_m_, reach_m_};
    const Vec3 low = box.min - reach, high = box.max + reach;
    for (std::size_t z = cell(low.z, least.z, size.z); z <= cell(high.z, least.z, size.z); ++z)
      for (std::size_t y = cell(low.y, least.y, size.y); y <= cell(high.y, least.y, size.y); ++y)
        for (std::size_t x = cell(low.x, least.x, size.x); x <= cell(high.x, least.x, size.x); ++x)
          if (!visit((z * kSide + y) * kSide + x)) return;
  }

  Box box_;
  double reach_m_;
  std::vector<std::uint8_t> roles_;
};

// Returns the role of a mesh as a bit; 0 for glass, which neither counts nor hides.
constexpr std::uint8_t kSurveyed = 1, kBlocks = 2;
std::uint8_t role_of(const MeshInfo& mesh) {
  return mesh.glass ? 0 : mesh.role == Role::surveyed ? kSurveyed : kBlocks;
}
std::uint8_t other(std::uint8_t role) { return role == kSurveyed ? kBlocks : role == kBlocks ? kSurveyed : 0; }

}  // namespace

NearPlaced near_placed(const RawScene& raw, const std::vector<Float3>& positions, const Vec3& origin,
                       std::uint64_t most) {
  const std::vector<PlacedRun> runs = placed_runs(raw);
  const auto role = [&](std::size_t k) { return role_of(raw.meshes[runs[k].range]); };
  NearPlaced near;
  near.positions = positions;
  std::vector<Box> boxes(runs.size());
  for (std::size_t k = 0; k < runs.size(); ++k)
    boxes[k] = placed_bounds(*runs[k].place, runs[k].shared->positions, origin);
  Box all;
  for (const Float3& p : positions) all.extend(widen(p));
  for (std::size_t k = 0; k < runs.size(); ++k) {
    all = united(all, boxes[k]);
    if (role(k) == kSurveyed) near.surveyed = united(near.surveyed, boxes[k]);
  }
  double farthest = 0;
  for (const double c : {all.min.x, all.min.y, all.min.z, all.max.x, all.max.y, all.max.z})
    farthest = std::max(farthest, std::abs(c));
  const double reach_m = 0x1p-18 * farthest;  // above the slack of find_coplanar()

  const auto mark_own = [&](RoleCells& cells) {
    for (std::size_t m = 0; m < raw.ranges.size(); ++m) {
      const MeshRange& own = raw.ranges[m];
      if (const std::uint8_t own_role = role_of(raw.meshes[m]); own_role != 0)
        parallel::for_all(own.first_triangle, own.first_triangle + own.triangle_count, [&](std::uint32_t t) {
          const Triangle& v = raw.triangles[t];
          cells.mark(box_of({positions[v[0]], positions[v[1]], positions[v[2]]}), own_role);
        });
    }
  };
  const auto corners = [&](const PlacedRun& run, std::size_t t) {
    const auto at = [&](std::uint32_t v) { return placed_position(*run.place, run.shared->positions[v], origin); };
    const Triangle v = turned(run.shared->triangles[t], run.place->mirrored);
    return FloatCorners{at(v[0]), at(v[1]), at(v[2])};
  };
  const auto for_triangles = [&](const PlacedRun& run, const auto& body) {
    parallel::for_all(std::uint32_t{0}, run.count(), [&](std::uint32_t t) { body(t, box_of(corners(run, t))); });
  };
  std::vector<std::uint8_t> may_be_near(runs.size());  // as a whole
  {
    RoleCells cells(all, reach_m);
    mark_own(cells);
    parallel::for_all(std::size_t{0}, runs.size(), [&](std::size_t k) { cells.mark(boxes[k], role(k)); });
    parallel::for_all(std::size_t{0}, runs.size(),
                      [&](std::size_t k) { may_be_near[k] = cells.meets(boxes[k], other(role(k))); });
  }
  RoleCells cells(all, reach_m);
  mark_own(cells);
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (may_be_near[k]) for_triangles(runs[k], [&](std::size_t, const Box& box) { cells.mark(box, role(k)); });

  std::uint64_t added = 0;
  std::size_t k = 0;  // run
  for (std::size_t m = 0; m < raw.ranges.size(); ++m) {
    const MeshRange& own = raw.ranges[m];
    const auto first = static_cast<std::uint32_t>(near.triangles.size());
    for (std::uint32_t t = own.first_triangle; t < own.first_triangle + own.triangle_count; ++t)
      near.triangles.push_back(raw.triangles[t]), near.numbers.push_back(t);
    for (; k < runs.size() && runs[k].range == m; ++k) {
      if (!may_be_near[k]) continue;
      std::vector<std::uint8_t> is_near(runs[k].count());
      for_triangles(runs[k], [&](std::size_t t, const Box& box) { is_near[t] = cells.meets(box, other(role(k))); });
      for (std::uint32_t t = 0; t < is_near.size(); ++t) {
        if (!is_near[t]) continue;
        if (++added > most)
          throw Error(Errc::out_of_memory, "more than " + std::to_string(most) +
                                               " triangles of meshes that nodes share are beside surfaces of the "
                                               "other role, and may lie in one plane with them; leave either of "
                                               "them out, or allow more memory");
        const auto v = static_cast<std::uint32_t>(near.positions.size());
        for (const Float3& p : corners(runs[k], t)) near.positions.push_back(p);
        near.triangles.push_back({v, v + 1, v + 2}), near.numbers.push_back(runs[k].first + t);
      }
    }
    near.ranges.push_back({first, static_cast<std::uint32_t>(near.triangles.size()) - first, own.material});
  }
  return near;
}

}  // namespace vantage
