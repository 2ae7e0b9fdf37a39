// SPDX-License-Identifier: Apache-2.0
#include "scene/splice_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "scene/raw_scene.hpp"
#include "scene/sound_triangle.hpp"

namespace vantage {
namespace {

Box box_of(std::span<const Float3> positions, const Triangle& t) {
  Box box;
  for (const std::uint32_t v : t) box.extend(to_vec3(to_glm(positions[v])));
  return box;
}

bool apart(const Box& a, const Box& b, double slack) {
  return a.min.x > b.max.x + slack || b.min.x > a.max.x + slack || a.min.y > b.max.y + slack ||
         b.min.y > a.max.y + slack || a.min.z > b.max.z + slack || b.min.z > a.max.z + slack;
}

bool in_range(const MeshRange& range, std::size_t triangle) {
  return triangle >= range.first_triangle && triangle < std::size_t{range.first_triangle} + range.triangle_count;
}

// Returns true if a triangle of the piece may overlap one of another role in its plane. The test is wider than
// find_coplanar(), so that a piece which passes here would not be cut there.
bool may_be_coplanar(const SceneData& scene, std::size_t m, std::span<const Float3> positions, const MeshPiece& piece,
                     const Box& piece_box, double reach) {
  constexpr double kParallel = 0.98, kMostPairs = 2e7;
  const double slack = 0x1p-16 * reach;  // 16 times that of find_coplanar()
  std::vector<std::uint32_t> near;
  for (std::size_t other = 0; other < scene.ranges.size(); ++other) {
    if (other == m || scene.meshes[other].role == piece.info.role) continue;
    const MeshRange& range = scene.ranges[other];
    for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count; ++t)
      if (!apart(box_of(scene.positions, scene.triangles[t]), piece_box, slack)) near.push_back(t);
  }
  if (static_cast<double>(near.size()) * static_cast<double>(piece.triangles.size()) > kMostPairs) return true;
  for (const std::uint32_t n : near) {
    const Triangle& other = scene.triangles[n];
    const Box other_box = box_of(scene.positions, other);
    const glm::dvec3 a = to_glm(scene.positions[other[0]]);
    const glm::dvec3 normal =
        normalize(cross(to_glm(scene.positions[other[1]]) - a, to_glm(scene.positions[other[2]]) - a));
    for (const Triangle& t : piece.triangles) {
      if (apart(box_of(positions, t), other_box, slack)) continue;
      const glm::dvec3 p = to_glm(positions[t[0]]);
      const glm::dvec3 own = normalize(cross(to_glm(positions[t[1]]) - p, to_glm(positions[t[2]]) - p));
      if (std::abs(dot(own, normal)) < kParallel) continue;
      double least = 1e300;
      for (const std::uint32_t v : t) least = std::min(least, std::abs(dot(normal, to_glm(positions[v]) - a)));
      if (least <= slack) return true;
    }
  }
  return false;
}

// Returns true if two triangles of the piece, or one of it and one of the rest, have identical corners.
bool repeats(const SceneData& scene, std::size_t m, std::span<const Float3> positions, const MeshPiece& piece,
             const Box& piece_box) {
  std::vector<std::array<Float3, 3>> corners;
  for (const Triangle& t : piece.triangles) corners.push_back(sorted_corners(positions, t));
  const auto within = [&](const Float3& p) {
    const auto [low, high] = piece_box;
    const glm::dvec3 q = to_glm(p);
    return q.x >= low.x && q.x <= high.x && q.y >= low.y && q.y <= high.y && q.z >= low.z && q.z <= high.z;
  };
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    if (in_range(scene.ranges[m], t)) continue;
    if (std::ranges::all_of(scene.triangles[t], [&](std::uint32_t v) { return within(scene.positions[v]); }))
      corners.push_back(sorted_corners(scene.positions, scene.triangles[t]));
  }
  const auto less = [](const std::array<Float3, 3>& a, const std::array<Float3, 3>& b) {
    return std::ranges::lexicographical_compare(a, b, comes_before);
  };
  std::ranges::sort(corners, less);
  return std::ranges::adjacent_find(corners) != corners.end();
}

}  // namespace

std::shared_ptr<const SceneData> splice_mesh(const SceneData& before, std::size_t m, const MeshPiece& piece,
                                             const Box& bounds) {
  if (piece.triangles.empty() || local_origin(bounds) != before.origin) return nullptr;
  std::vector<Float3> positions;
  positions.reserve(piece.positions.size());
  Box piece_box;
  for (const glm::dvec3& p : piece.positions) {
    if (!sound(p)) return nullptr;
    positions.push_back(without_minus_zero(to_float3(p - to_glm(before.origin))));
    piece_box.extend(to_vec3(to_glm(positions.back())));
  }
  for (const Triangle& t : piece.triangles)
    if (!has_area(to_glm(positions[t[0]]), to_glm(positions[t[1]]), to_glm(positions[t[2]]))) return nullptr;
  if (repeats(before, m, positions, piece, piece_box)) return nullptr;

  auto after = std::make_shared<SceneData>();
  after->origin = before.origin;
  after->meshes = before.meshes;
  after->meshes[m] = piece.info;
  after->meshes[m].triangle_count = static_cast<std::uint32_t>(piece.triangles.size());
  after->materials = before.materials;
  after->materials[before.ranges[m].material] = piece.material;
  after->search_positions = before.search_positions;
  after->search_uvs = before.search_uvs;
  after->search_triangles = before.search_triangles;
  after->rooms = before.rooms;
  after->defaults_json = before.defaults_json;
  after->options = before.options;
  // A mesh's own positions are contiguous, as its triangles are.
  const MeshRange& old = before.ranges[m];
  const auto old_first = before.triangles.begin() + old.first_triangle, old_end = old_first + old.triangle_count;
  std::uint32_t low = ~0U, high = 0;
  for (auto t = old_first; t != old_end; ++t)
    for (const std::uint32_t v : *t) low = std::min(low, v), high = std::max(high, v);
  const auto count = static_cast<std::uint32_t>(positions.size());
  const std::uint32_t shift = count - (high + 1 - low);  // shift of later positions; wraps around if there are fewer
  after->positions.reserve(before.positions.size() + count);
  after->positions.assign(before.positions.begin(), before.positions.begin() + low);
  after->positions.insert(after->positions.end(), positions.begin(), positions.end());
  after->positions.insert(after->positions.end(), before.positions.begin() + high + 1, before.positions.end());
  after->triangles.reserve(before.triangles.size() + piece.triangles.size());
  after->triangles.assign(before.triangles.begin(), old_first);
  for (const Triangle& t : piece.triangles) after->triangles.push_back({t[0] + low, t[1] + low, t[2] + low});
  for (auto t = old_end; t != before.triangles.end(); ++t)
    after->triangles.push_back({(*t)[0] + shift, (*t)[1] + shift, (*t)[2] + shift});
  after->ranges = before.ranges;
  after->ranges[m].triangle_count = static_cast<std::uint32_t>(piece.triangles.size());
  for (std::size_t r = m + 1; r < after->ranges.size(); ++r)
    after->ranges[r].first_triangle = after->ranges[r - 1].first_triangle + after->ranges[r - 1].triangle_count;
  double reach = 0;
  for (const Float3& p : after->positions) {
    after->local_bounds.extend(to_vec3(to_glm(p)));
    for (const float c : {p.x, p.y, p.z}) reach = std::max(reach, std::abs(static_cast<double>(c)));
  }
  if (may_be_coplanar(before, m, positions, piece, piece_box, reach)) return nullptr;
  return after;
}

}  // namespace vantage
