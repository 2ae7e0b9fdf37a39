// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/occluding_patch.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "core/parallel.hpp"
#include "shared/trace_types.h"
#include "trace/embree/seen_triangle.hpp"
#include "trace/triangle_neighbours.hpp"

namespace vantage {
namespace {

constexpr std::size_t kMost = 16;  // triangles of a patch
// Largest radius around a corner within which rays may be in doubt; a larger one means a sliver.
constexpr double kMostDoubt = 0x1p-6;

struct Member {
  std::array<Vec3, 3> corner;  // relative to the head
  SeenTriangle seen;
};

}  // namespace

std::vector<std::uint32_t> OccludingPatches::neighbours_after(const SceneData& scene,
                                                              const SceneDifference& difference) const {
  return vantage::neighbours_after(neighbours_, scene, difference);
}

bool OccludingPatches::hide(std::uint32_t triangle, const Vec3& head, const Box& box, double start,
                            const AnyRayNear& any_ray_near) const {
  if (scene_.shares()) return false;
  std::call_once(once_, [&] {
    // A thread that waits here must not take up other work, which might wait here, too.
    tbb::this_task_arena::isolate([&] {
      if (neighbours_.empty()) neighbours_ = triangle_neighbours(scene_.positions, scene_.opaque_triangles());
    });
  });
  const auto member = [&](std::uint32_t t) {
    const auto corner = [&](std::size_t k) { return widen(scene_.positions[scene_.triangles[t][k]]) - head; };
    const std::array<Vec3, 3> corners{corner(0), corner(1), corner(2)};
    return Member{corners, SeenTriangle(corners[0], corners[1], corners[2])};
  };
  const SeenBox seen_box(box);
  const double away = std::sqrt(dot(seen_box.middle, seen_box.middle)),
               width = std::sqrt(dot(seen_box.half, seen_box.half)) / away;
  // Returns true if a ray to the box may pass this near to a corner.
  const auto is_near = [&](const Vec3& corner, double doubt) {
    const Vec3 across = cross(corner, seen_box.middle);
    return !(std::sqrt(dot(across, across)) > (width + doubt) * away * std::sqrt(dot(corner, corner)));
  };
  std::array<std::uint32_t, kMost> members{triangle};
  std::array<std::optional<Member>, kMost> seen;
  seen[0].emplace(member(triangle));
  std::size_t count = 1;
  for (std::size_t m = 0; m < count; ++m) {
    const Member& one = *seen[m];
    std::array<bool, 3> inside{};
    bool outside = false;
    for (std::size_t k = 0; k < 3; ++k) {
      inside[k] = one.seen.inside(k, seen_box);
      outside |= !inside[k] && one.seen.outside(k, seen_box);
    }
    if (outside) {  // it covers no part of the box
      if (m == 0) return false;
      continue;
    }
    if (!one.seen.is_before(seen_box, start)) return false;
    for (std::size_t k = 0; k < 3; ++k)
      if (!inside[k] && neighbours_[3 * members[m] + k] == no_primitive) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (inside[k]) continue;
      const std::uint32_t other = neighbours_[3 * members[m] + k];
      const auto known = static_cast<std::size_t>(
          std::find(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(count), other) - members.begin());
      if (known == kMost) return false;
      if (known == count) {
        members[count] = other;
        seen[count++].emplace(member(other));
      }
      const Member& next = *seen[known];
      std::size_t back = 0;  // the common edge among those of the other triangle
      while (back < 3 && neighbours_[3 * other + back] != members[m]) ++back;
      if (back == 3 || !one.seen.is_outside(k, next.corner[(back + 2) % 3])) return false;  // folded back
      // Tests both ends with the edges that meet there. The other triangle may list its corners in the same order.
      for (const std::size_t end : {k, (k + 1) % 3}) {
        const std::size_t own = end == k ? (k + 2) % 3 : (k + 1) % 3;
        const Vec3& corner = one.corner[end];
        const bool first = dot(next.corner[back] - corner, next.corner[back] - corner) == 0;
        const std::size_t others = first ? (back + 2) % 3 : (back + 1) % 3;
        if (inside[own] && next.seen.inside(others, seen_box)) continue;
        const double doubt = one.seen.doubt_at(k, own) + next.seen.doubt_at(back, others);
        if (!(doubt < kMostDoubt)) return false;
        if (is_near(corner, doubt) && any_ray_near(corner, doubt * std::sqrt(dot(corner, corner)))) return false;
      }
    }
  }
  return true;
}

}  // namespace vantage
