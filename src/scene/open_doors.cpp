// SPDX-License-Identifier: Apache-2.0
#include "scene/open_doors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "scene/door_leaf.hpp"
#include "scene/positions.hpp"
#include "scene/shared_meshes.hpp"

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
  std::vector<Box> placed = {};  // around each shared mesh where it stands, in the order of raw.placed
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
  const auto leaf = leaf_around(range.triangle_count, [&](std::uint32_t triangle) {
    const Triangle& t = triangles[first + triangle];
    return std::array{model.at(t[0]), model.at(t[1]), model.at(t[2])};
  });
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
  const auto meet = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {  // relative to `from`
    if (std::min({a.z, b.z, c.z}) > 0 || std::max({a.z, b.z, c.z}) < 0) return;           // the line is level
    const glm::dvec3 n = cross(b - a, c - a);
    const double across = dot(n, way);
    if (across == 0) return;
    const double at = dot(n, a) / across;
    if (!(std::abs(at) <= far)) return;
    const glm::dvec3 p = way * at;
    const double u = dot(cross(b - a, p - a), n), v = dot(cross(c - b, p - b), n), w = dot(cross(a - c, p - c), n);
    if (std::min({u, v, w}) < 0) return;
    (at > 0 ? sight.before : sight.behind) = std::min(at > 0 ? sight.before : sight.behind, std::abs(at));
  };
  const std::vector<Triangle>& triangles = model.raw.triangles;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    if (i >= leaf.first && i < leaf.end) continue;
    const Triangle& t = triangles[i];
    meet(model.at(t[0]) - from, model.at(t[1]) - from, model.at(t[2]) - from);
  }
  std::size_t box = 0;
  for (const auto& range : model.raw.placed)
    for (const PlacedShared& placed : range) {
      const glm::dvec3 low = to_glm(model.placed[box].min) - far, high = to_glm(model.placed[box].max) + far;
      ++box;
      if (from.x < low.x || from.y < low.y || from.z < low.z || from.x > high.x || from.y > high.y || from.z > high.z)
        continue;
      const SharedMesh& mesh = model.raw.shared[placed.mesh];
      const auto at = [&](std::uint32_t v) { return to_glm(placed.place(mesh.positions[v])) - from; };
      for (const Triangle& t : mesh.triangles) meet(at(t[0]), at(t[1]), at(t[2]));
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

// Whether a shared mesh may be a leaf where it stands.
bool may_be_leaf(const SharedMesh& mesh, const MeshPlace& place, const std::string& name) {
  constexpr std::size_t kMostTriangles = 2000;  // of a leaf that no name tells
  if (names_a_door(name)) return true;
  return mesh.triangles.size() <= kMostTriangles &&
         leaf_around(mesh.triangles.size(), [&](std::uint32_t triangle) {
           const Triangle& t = mesh.triangles[triangle];
           const auto at = [&](std::size_t k) { return to_glm(place(mesh.positions[t[k]])); };
           return std::array{at(0), at(1), at(2)};
         }).has_value();
}

std::vector<Box> boxes_of_placed(const RawScene& raw) {
  std::vector<Box> of_mesh, boxes;
  for (const SharedMesh& mesh : raw.shared) {
    Box& box = of_mesh.emplace_back();
    for (const Float3& p : mesh.positions) box.extend(widen(p));
  }
  for (const auto& range : raw.placed)
    for (const PlacedShared& placed : range) {
      const Box& own = of_mesh[placed.mesh];
      Box& box = boxes.emplace_back();
      for (int k = 0; k < 8; ++k)
        box.extend(placed.place(
            narrow({k & 1 ? own.max.x : own.min.x, k & 2 ? own.max.y : own.min.y, k & 4 ? own.max.z : own.min.z})));
    }
  return boxes;
}

}  // namespace

std::vector<std::size_t> leaves_if(const RawScene& raw, Unit unit, UpAxis up) {
  constexpr std::size_t kFew = 50;  // as few say as much as many
  return leaves_of({raw, metres_in(unit), up}, {}, kFew);
}

std::vector<std::string> open_doors(RawScene& raw, const std::vector<std::uint8_t>& candidate) {
  store_placed(raw, [&](std::size_t range, std::size_t k) {
    const PlacedShared& placed = raw.placed[range][k];
    return candidate[range] && may_be_leaf(raw.shared[placed.mesh], placed.place, raw.meshes[range].name);
  });
  std::vector<std::uint8_t> keep(raw.triangles.size(), 1);
  std::vector<std::string> names;
  for (const std::size_t m : leaves_of({.raw = raw, .placed = boxes_of_placed(raw)}, candidate, kMostLeaves)) {
    const MeshRange& range = raw.ranges[m];
    std::fill_n(keep.begin() + range.first_triangle, range.triangle_count, std::uint8_t{0});
    if (names.empty() || names.back() != raw.meshes[m].name) names.push_back(raw.meshes[m].name);
  }
  const bool shares = std::ranges::any_of(raw.placed, [](const auto& range) { return !range.empty(); });
  if (names.empty() || (!shares && std::ranges::count(keep, 1) == 0)) return {};  // a model of doors alone
  keep_triangles(raw, keep);
  return names;
}

}  // namespace vantage
