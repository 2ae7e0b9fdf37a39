// SPDX-License-Identifier: Apache-2.0
#include "scene/coplanar.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "core/embree.hpp"
#include "scene/positions.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using Corners = std::array<glm::dvec3, 3>;

struct Soup {
  std::span<const Float3> positions;
  std::span<const Triangle> triangles;
  std::vector<std::uint32_t> chosen;
  double slack = 0;  // metres; planes no farther apart count as one

  Corners corners(std::size_t k) const {
    Corners corners;
    for (std::size_t c = 0; c < 3; ++c) corners[c] = to_glm(positions[triangles[chosen[k]][c]]);
    return corners;
  }
  Box box(std::size_t k) const {
    Box box;
    for (const glm::dvec3& p : corners(k)) box.extend(to_vec3(p));
    return box;
  }
};

void bounds_of(const RTCBoundsFunctionArguments* args) {
  const Soup& soup = *static_cast<const Soup*>(args->geometryUserPtr);
  const Box box = soup.box(args->primID);
  const auto low = [&](double value) { return static_cast<float>(value - soup.slack); };
  const auto high = [&](double value) { return static_cast<float>(value + soup.slack); };
  RTCBounds& b = *args->bounds_o;
  b.lower_x = low(box.min.x), b.lower_y = low(box.min.y), b.lower_z = low(box.min.z);
  b.upper_x = high(box.max.x), b.upper_y = high(box.max.y), b.upper_z = high(box.max.z);
}

embree::Scene tree_over(RTCDevice device, Soup& soup) {
  embree::Scene tree(rtcNewScene(device));
  rtcSetSceneBuildQuality(tree.get(), RTC_BUILD_QUALITY_LOW);  // searched only once, so building dominates
  const embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(soup.chosen.size()));
  rtcSetGeometryUserData(geometry.get(), &soup);
  rtcSetGeometryBoundsFunction(geometry.get(), bounds_of, nullptr);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(tree.get(), geometry.get());
  rtcCommitScene(tree.get());
  embree::check(device, "looking for surfaces in one plane");
  return tree;
}

glm::dvec3 unit_normal(const Corners& t) { return normalize(cross(t[1] - t[0], t[2] - t[0])); }

bool lies_in_plane(const Corners& t, const Corners& other, const glm::dvec3& normal, double slack) {
  return std::ranges::all_of(t, [&](const glm::dvec3& p) { return std::abs(dot(normal, p - other[0])) <= slack; });
}

// Returns true if, seen along `normal`, `b` lies beyond an edge of `a`, or overlaps that edge by less than `slack`.
bool edge_parts(const Corners& a, const Corners& b, const glm::dvec3& normal, double slack) {
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 edge = a[(k + 1) % 3] - a[k];
    const glm::dvec3 out = cross(edge, normal) * (1 / length(edge));
    const double side = dot(out, a[(k + 2) % 3] - a[k]) > 0 ? -1 : 1;
    if (std::ranges::all_of(b, [&](const glm::dvec3& p) { return side * dot(out, p - a[k]) >= -slack; })) return true;
  }
  return false;
}

bool overlap_in_plane(const Corners& a, const Corners& b, double slack) {
  const glm::dvec3 na = unit_normal(a), nb = unit_normal(b);
  if (std::abs(dot(na, nb)) < 0.99) return false;
  if (!lies_in_plane(a, b, nb, slack) && !lies_in_plane(b, a, na, slack)) return false;
  return !edge_parts(a, b, na, 4 * slack) && !edge_parts(b, a, na, 4 * slack);
}

struct Search {
  const Soup &surveyed, &blocking;
  const std::uint64_t most;
  std::mutex mutex;
  std::vector<CoplanarPair> found;
  std::atomic<bool> too_many = false;
};

void compare_pairs(void* user, RTCCollision* pairs, unsigned count) {
  Search& search = *static_cast<Search*>(user);
  if (search.too_many) return;  // Embree takes no exceptions, and cannot be stopped
  for (unsigned k = 0; k < count; ++k) {
    const unsigned s = pairs[k].primID0, b = pairs[k].primID1;
    if (!overlap_in_plane(search.surveyed.corners(s), search.blocking.corners(b), search.surveyed.slack)) continue;
    const std::lock_guard lock(search.mutex);
    if (search.found.size() >= search.most) search.too_many = true;
    if (search.too_many) return;
    search.found.push_back({search.blocking.chosen[b], search.surveyed.chosen[s]});
  }
}

}  // namespace

Coplanar find_coplanar(std::span<const Float3> positions, std::span<const Triangle> triangles,
                       std::span<const MeshRange> ranges, std::span<const MeshInfo> meshes, std::uint64_t most_pairs,
                       const Box& beside) {
  Soup surveyed{positions, triangles, {}}, blocking{positions, triangles, {}};
  for (std::size_t m = 0; m < ranges.size(); ++m) {
    if (meshes[m].glass) continue;  // it hides nothing
    std::vector<std::uint32_t>& chosen = (meshes[m].role == Role::surveyed ? surveyed : blocking).chosen;
    for (std::uint32_t t = 0; t < ranges[m].triangle_count; ++t) chosen.push_back(ranges[m].first_triangle + t);
  }
  if (surveyed.chosen.empty() || blocking.chosen.empty()) return {};
  Box box = beside;
  for (std::size_t k = 0; k < surveyed.chosen.size(); ++k) box = united(box, surveyed.box(k));
  double reach = 0;
  for (const double c : {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z})
    reach = std::max(reach, std::abs(c));
  surveyed.slack = blocking.slack = 0x1p-20 * reach;  // bound on the error of an engine's distances
  // Only triangles near the others' bounds can meet them.
  const auto keep_near = [](Soup& soup, const Box& others) {
    std::vector<std::uint32_t> near;
    Box bounds;
    const double s = 2 * soup.slack;
    for (std::size_t k = 0; k < soup.chosen.size(); ++k) {
      const Box own = soup.box(k);
      if (own.min.x > others.max.x + s || own.min.y > others.max.y + s || own.min.z > others.max.z + s ||
          own.max.x < others.min.x - s || own.max.y < others.min.y - s || own.max.z < others.min.z - s)
        continue;
      near.push_back(soup.chosen[k]);
      bounds.extend(own.min);
      bounds.extend(own.max);
    }
    soup.chosen = std::move(near);
    return bounds;
  };
  keep_near(surveyed, keep_near(blocking, box));
  if (surveyed.chosen.empty() || blocking.chosen.empty()) return {};

  const embree::Device device = embree::new_device();
  const embree::Scene surveyed_tree = tree_over(device.get(), surveyed),
                      blocking_tree = tree_over(device.get(), blocking);
  Search search{surveyed, blocking, most_pairs, {}, {}};
  rtcCollide(surveyed_tree.get(), blocking_tree.get(), compare_pairs, &search);
  embree::check(device.get(), "looking for surfaces in one plane");
  if (search.too_many)
    throw Error(Errc::out_of_memory, "more than " + std::to_string(most_pairs) +
                                         " pairs of surveyed and blocking triangles overlap in one plane; leave "
                                         "either of them out");
  std::ranges::sort(search.found);  // threads found them
  return {surveyed.slack, std::move(search.found)};
}

}  // namespace vantage
