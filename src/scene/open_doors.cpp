// SPDX-License-Identifier: Apache-2.0
#include "scene/open_doors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "scene/door_leaf.hpp"
#include "scene/positions.hpp"

namespace vantage {
namespace {

constexpr double kFree = 0.65;             // what is clear before and behind a door; a cabinet is less deep
constexpr double kAside = 0.08;            // how far beside the leaf its wall is looked for
constexpr double kWallHalf = 0.4;          // and how far before and behind
constexpr double kThicker = 0.02;          // by which a wall stands out on either side
constexpr std::size_t kMostLeaves = 2000;  // leaves that are looked at

// The model, or what it would be in another unit and with another axis up: metres, z up.
struct Reading {
  const RawScene& raw;
  double metres = 1;
  UpAxis up = UpAxis::y;
  glm::dvec3 at(std::uint32_t vertex) const { return with_up(up, raw.positions[vertex]) * metres; }
};

// The leaf that a mesh may be, and its triangles.
struct Leaf : DoorLeaf {
  std::uint32_t first = 0, end = 0;
};

std::optional<Leaf> leaf_of(const Reading& model, std::size_t mesh) {
  const MeshRange& range = model.raw.ranges[mesh];
  const std::uint32_t first = range.first_triangle, end = first + range.triangle_count;
  const std::span<const Triangle> triangles(model.raw.triangles);
  const auto leaf = leaf_around(triangles.subspan(first, range.triangle_count),
                                [&](std::uint32_t vertex) { return model.at(vertex); });
  if (!leaf || !(names_a_door(model.raw.meshes[mesh].name) || is_plain_leaf(*leaf))) return std::nullopt;
  return Leaf{*leaf, first, end};
}

// Distances along a line, from its point, to the triangles of other meshes within `far` either way: nearest on each
// side.
struct Sight {
  double before = std::numeric_limits<double>::infinity(), behind = before;
};
Sight look(const Reading& model, const Leaf& leaf, const glm::dvec3& from, const glm::dvec3& way, double far) {
  Sight sight;
  const std::vector<Triangle>& triangles = model.raw.triangles;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    if (i >= leaf.first && i < leaf.end) continue;
    const Triangle& t = triangles[i];
    const glm::dvec3 a = model.at(t[0]) - from, b = model.at(t[1]) - from, c = model.at(t[2]) - from;
    if (std::min({a.z, b.z, c.z}) > 0 || std::max({a.z, b.z, c.z}) < 0) continue;  // the line is level
    const glm::dvec3 n = cross(b - a, c - a);
    const double across = dot(n, way);
    if (across == 0) continue;
    const double at = dot(n, a) / across;
    if (!(std::abs(at) <= far)) continue;
    const glm::dvec3 p = way * at;
    const double u = dot(cross(b - a, p - a), n), v = dot(cross(c - b, p - b), n), w = dot(cross(a - c, p - c), n);
    if (std::min({u, v, w}) < 0) continue;
    (at > 0 ? sight.before : sight.behind) = std::min(at > 0 ? sight.before : sight.behind, std::abs(at));
  }
  return sight;
}

bool leads_through(const Reading& model, const Leaf& leaf) {
  const double half = leaf.thickness / 2, far = half + kFree;
  // Beside the middle, where handles and bars are few.
  const glm::dvec3 from = leaf.middle + leaf.along * (0.17 * leaf.width) + glm::dvec3{0, 0, 0.13 * leaf.height};
  const Sight sight = look(model, leaf, from, leaf.through, far);
  const auto clear = [&](double distance) { return distance >= far || distance <= half + 0.02; };
  return clear(sight.before) && clear(sight.behind);
}

bool in_a_wall(const Reading& model, const Leaf& leaf) {
  const double thicker = leaf.thickness / 2 + kThicker;
  const auto wall_at = [&](const glm::dvec3& p) {
    const Sight sight = look(model, leaf, p, leaf.through, kWallHalf);
    return sight.before >= thicker && sight.before <= kWallHalf && sight.behind >= thicker && sight.behind <= kWallHalf;
  };
  const glm::dvec3 aside = leaf.along * (leaf.width / 2 + kAside), up{0, 0, leaf.height / 2 + kAside};
  return wall_at(leaf.middle + aside) && wall_at(leaf.middle - aside) && wall_at(leaf.middle + up);
}

// Meshes that are leaves of doors, among at most so many that look like one.
std::vector<std::size_t> leaves_of(const Reading& model, const std::vector<std::uint8_t>& candidate, std::size_t most) {
  std::vector<std::size_t> leaves;
  std::size_t looked = 0;
  for (std::size_t m = 0; m < model.raw.meshes.size() && looked < most; ++m) {
    if (!candidate.empty() && !candidate[m]) continue;
    const std::optional<Leaf> leaf = leaf_of(model, m);
    if (!leaf) continue;
    ++looked;
    if (leads_through(model, *leaf) && (names_a_door(model.raw.meshes[m].name) || in_a_wall(model, *leaf)))
      leaves.push_back(m);
  }
  return leaves;
}

}  // namespace

std::vector<std::size_t> leaves_if(const RawScene& raw, Unit unit, UpAxis up) {
  constexpr std::size_t kFew = 50;  // as few say as much as many
  return leaves_of({raw, metres_in(unit), up}, {}, kFew);
}

std::vector<std::string> open_doors(RawScene& raw, const std::vector<std::uint8_t>& candidate) {
  std::vector<std::uint8_t> keep(raw.triangles.size(), 1);
  std::vector<std::string> names;
  for (const std::size_t m : leaves_of({raw}, candidate, kMostLeaves)) {
    const MeshRange& range = raw.ranges[m];
    std::fill_n(keep.begin() + range.first_triangle, range.triangle_count, std::uint8_t{0});
    if (names.empty() || names.back() != raw.meshes[m].name) names.push_back(raw.meshes[m].name);
  }
  if (names.empty() || std::ranges::count(keep, 1) == 0) return {};  // a model of doors alone
  keep_triangles(raw, keep);
  return names;
}

}  // namespace vantage
