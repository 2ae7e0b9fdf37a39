// SPDX-License-Identifier: Apache-2.0
#include "placement/sheets_facing_down.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "core/disjoint_sets.hpp"
#include "scene/positions.hpp"

namespace vantage {
namespace {

constexpr double kLeast_m2 = 2;             // area of a sheet, seen from above
constexpr double kMostUp = 0.01;            // share of it that faces up, as a rim does
constexpr std::size_t kLookedAt = 200;      // triangles of a sheet
constexpr double kSkin_m = 0.01;            // rays begin so far off the sheet
constexpr std::uint32_t kMost = 4'000'000;  // triangles of a mesh that is taken apart

// Area that a triangle shows from above, in m²; negative: it faces down.
double shown_m2(const SceneData& scene, std::uint32_t triangle) {
  const auto t = corners_of(scene, triangle);
  return cross(t[1] - t[0], t[2] - t[0]).z / 2;
}

// The triangles of each connected part of a mesh. Vertices at one place are one, whatever normals they have.
std::vector<std::vector<std::uint32_t>> connected_parts(const SceneData& scene, const MeshRange& range) {
  struct Corner {
    glm::dvec3 at;
    std::uint32_t triangle;
    auto place() const { return std::tuple(at.x, at.y, at.z); }
  };
  std::vector<Corner> corners;
  corners.reserve(3 * std::size_t{range.triangle_count});
  for (std::uint32_t k = 0; k < range.triangle_count; ++k)
    for (const glm::dvec3& at : corners_of(scene, range.first_triangle + k)) corners.push_back({at, k});
  std::ranges::sort(corners, {}, &Corner::place);
  DisjointSets sets(range.triangle_count);
  for (std::size_t c = 1; c < corners.size(); ++c)
    if (corners[c].place() == corners[c - 1].place()) sets.join(corners[c].triangle, corners[c - 1].triangle);
  std::map<std::uint32_t, std::vector<std::uint32_t>> parts;
  for (std::uint32_t k = 0; k < range.triangle_count; ++k) parts[sets.find(k)].push_back(range.first_triangle + k);
  std::vector<std::vector<std::uint32_t>> all;
  for (auto& [first, part] : parts) all.push_back(std::move(part));
  return all;
}

bool is_sheet(const SceneData& scene, const std::vector<std::uint32_t>& part) {
  double up = 0, down = 0;
  for (const std::uint32_t triangle : part) {
    const double area = shown_m2(scene, triangle);
    (area > 0 ? up : down) += std::abs(area);
  }
  return down >= kLeast_m2 && up <= kMostUp * down;
}

bool stands_somebody_on(const SceneData& scene, const MeshTree& tree, const std::vector<std::uint32_t>& sheet,
                        double height_m) {
  const std::size_t stride = std::max<std::size_t>(1, sheet.size() / kLookedAt);
  double on = 0, all = 0;
  for (std::size_t k = 0; k < sheet.size(); k += stride) {
    const auto t = corners_of(scene, sheet[k]);
    const glm::dvec3 middle = (t[0] + t[1] + t[2]) / 3.0, skin{0, 0, kSkin_m}, up{0, 0, 1};
    const double area = std::abs(shown_m2(scene, sheet[k]));
    all += area;
    const auto above = tree.first(middle + skin, up);
    const bool room = !above || (above->distance >= height_m && shown_m2(scene, above->triangle) < 0);
    if (room && (above || !tree.drop(middle - skin))) on += area;
  }
  return 2 * on > all;
}

}  // namespace

std::vector<std::uint32_t> sheets_facing_down(const SceneData& scene, const MeshTree& tree, double height_m) {
  std::vector<std::uint32_t> found;
  for (const MeshRange& range : scene.ranges) {
    if (range.triangle_count > kMost) continue;
    double net = 0;  // a closed solid shows as much from below as from above
    for (std::uint32_t k = 0; k < range.triangle_count; ++k) net += shown_m2(scene, range.first_triangle + k);
    if (net > -kLeast_m2) continue;
    for (const std::vector<std::uint32_t>& part : connected_parts(scene, range))
      if (is_sheet(scene, part) && stands_somebody_on(scene, tree, part, height_m))
        found.insert(found.end(), part.begin(), part.end());
  }
  std::ranges::sort(found);
  return found;
}

}  // namespace vantage
