// SPDX-License-Identifier: Apache-2.0
#include "placement/drawn_face_down.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/parallel.hpp"
#include "scene/connected_triangles.hpp"
#include "scene/positions.hpp"

namespace vantage {
namespace {

constexpr double kLeast_m2 = 2;             // area of a sheet, seen from above
constexpr double kMostUp = 0.01;            // share of its area that faces up, as a rim does
constexpr std::size_t kLookedAt = 200;      // triangles of a sheet that are tested
constexpr std::size_t kLookedAtFirst = 50;  // largest triangles of a mesh that are tested, and as many others
constexpr double kSkin_m = 0.01;            // distance of rays' origins from the sheet
constexpr double kSlab_m = 1;               // nobody is in a lower gap below a sheet
constexpr std::uint32_t kMost = 4'000'000;  // triangles of a mesh that is split into components

// Returns the area that a triangle shows from above, in m²; negative if it faces down.
double shown_m2(const SceneData& scene, std::uint32_t triangle) {
  const auto t = corners_of(scene, triangle);
  return cross(t[1] - t[0], t[2] - t[0]).z / 2;
}

// Returns the triangles of each connected component of a mesh.
std::vector<std::vector<std::uint32_t>> connected_parts(const SceneData& scene, const MeshRange& range) {
  std::vector<Float3> corners;
  corners.reserve(3 * std::size_t{range.triangle_count});
  std::vector<Triangle> triangles;
  triangles.reserve(range.triangle_count);
  for (std::uint32_t k = 0; k < range.triangle_count; ++k) {
    const auto t = scene.corners(range.first_triangle + k);
    corners.insert(corners.end(), t.begin(), t.end());
    triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  const Connected connected = connect<Float3>(triangles, corners);
  std::vector<std::vector<std::uint32_t>> parts;
  for (std::size_t part = 0; part + 1 < connected.begin.size(); ++part) {
    std::vector<std::uint32_t>& own = parts.emplace_back();
    for (std::uint32_t k = connected.begin[part]; k < connected.begin[part + 1]; ++k)
      own.push_back(range.first_triangle + connected.triangles[k]);
  }
  return parts;
}

// Returns six times the volume that a triangle adds to a closed part, seen from `middle`; negative if it faces inwards.
double volume(const SceneData& scene, std::uint32_t triangle, const glm::dvec3& middle) {
  const auto t = corners_of(scene, triangle);
  return dot(t[0] - middle, cross(t[1] - middle, t[2] - middle));
}

struct Shape {
  double up_m2 = 0, down_m2 = 0, volume = 0;
  Box box;
  // Coincident copies of a sheet do not count as a sheet.
  bool is_sheet() const { return up_m2 <= kMostUp * down_m2 && down_m2 <= (1 + kMostUp) * box.size().x * box.size().y; }
  bool is_inside_out() const { return volume < 0 && std::abs(up_m2 - down_m2) <= kMostUp * down_m2; }
};

Shape shape_of(const SceneData& scene, const std::vector<std::uint32_t>& part) {
  Shape shape;
  const glm::dvec3 middle = corners_of(scene, part.front())[0];
  for (const std::uint32_t triangle : part) {
    const double area = shown_m2(scene, triangle);
    (area > 0 ? shape.up_m2 : shape.down_m2) += std::abs(area);
    shape.volume += volume(scene, triangle, middle);
    for (const glm::dvec3& corner : corners_of(scene, triangle)) shape.box.extend(to_vec3(corner));
  }
  return shape;
}

// Returns true if a person may stand on the back of a triangle that faces down. `own(triangle)`: true if that triangle,
// straight below, may belong to the same part; `sheet`: true if the part may be an open sheet. A face above that looks
// up is drawn the wrong way around, too, if two sheets make a floor between storeys: the lower one is a ceiling that
// faces up, and nobody sees the upper one from so low a gap.
template <class Own>
bool carries(const SceneData& scene, const MeshTree& tree, std::uint32_t triangle, double height_m, Own own,
             bool sheet) {
  const auto t = corners_of(scene, triangle);
  const glm::dvec3 middle = (t[0] + t[1] + t[2]) / 3.0, skin{0, 0, kSkin_m}, up{0, 0, 1};
  const auto above = tree.first(middle + skin, up);
  if (above && above->distance < height_m) return false;
  const auto below = tree.first(middle - skin, -up);
  if (above && shown_m2(scene, above->triangle) > 0)
    return sheet && below && below->distance < kSlab_m && shown_m2(scene, below->triangle) > 0;
  return above || !below || (below->distance < height_m && own(below->triangle));
}

bool carries(const SceneData& scene, const MeshTree& tree, const std::vector<std::uint32_t>& part, double height_m,
             bool sheet) {
  const std::size_t stride = std::max<std::size_t>(1, part.size() / kLookedAt);
  double on = 0, all = 0;
  for (std::size_t k = 0; k < part.size(); k += stride) {
    const double area = -shown_m2(scene, part[k]);
    if (!(area > 0)) continue;
    all += area;
    if (carries(
            scene, tree, part[k], height_m,
            [&](std::uint32_t below) { return std::ranges::binary_search(part, below); }, sheet))
      on += area;
  }
  return 2 * on > all;
}

// Returns true if any of the largest triangles that face down, or of some others, may carry a person. Most models have
// none, and need not be split into components.
bool may_carry(const SceneData& scene, const MeshTree& tree, const MeshRange& range, double height_m) {
  std::vector<std::pair<double, std::uint32_t>> down;  // by area, negative
  double all = 0;
  for (std::uint32_t k = 0; k < range.triangle_count; ++k)
    if (const double area = shown_m2(scene, range.first_triangle + k); area < 0)
      down.emplace_back(area, range.first_triangle + k), all -= area;
  if (all < kLeast_m2) return false;
  const std::size_t stride = std::max<std::size_t>(1, down.size() / kLookedAtFirst);
  const std::size_t largest = std::min(kLookedAtFirst, down.size());
  std::vector<std::uint32_t> some;
  for (std::size_t k = 0; k < down.size(); k += stride) some.push_back(down[k].second);
  std::ranges::nth_element(down, down.begin() + static_cast<std::ptrdiff_t>(largest - 1));
  for (std::size_t k = 0; k < largest; ++k) some.push_back(down[k].second);
  return std::ranges::any_of(some, [&](std::uint32_t triangle) {
    return carries(
        scene, tree, triangle, height_m, [&](std::uint32_t below) { return shown_m2(scene, below) > 0; }, true);
  });
}

// Adds the triangles of a mesh that face down and have room above, as they may as well face up.
void add_with_room(std::vector<std::uint32_t>& found, const SceneData& scene, const MeshTree& tree,
                   const MeshRange& range, double height_m) {
  std::vector<std::uint8_t> has_room(range.triangle_count);
  parallel::for_all(std::uint32_t{0}, range.triangle_count, [&](std::uint32_t k) {
    const std::uint32_t triangle = range.first_triangle + k;
    if (!(shown_m2(scene, triangle) < 0)) return;
    const auto t = corners_of(scene, triangle);
    const glm::dvec3 middle = (t[0] + t[1] + t[2]) / 3.0;
    // Tests several points, as a table may stand on the middle.
    has_room[k] = std::ranges::any_of(std::array{middle, t[0], t[1], t[2]}, [&](const glm::dvec3& towards) {
      const auto above = tree.first((middle + towards) / 2.0 + glm::dvec3{0, 0, kSkin_m}, {0, 0, 1});
      return !above || above->distance >= height_m;
    });
  });
  for (std::uint32_t k = 0; k < range.triangle_count; ++k)
    if (has_room[k]) found.push_back(range.first_triangle + k);
}

}  // namespace

std::vector<std::uint32_t> drawn_face_down(const SceneData& scene, const MeshTree& tree, double height_m) {
  std::vector<std::uint8_t> may(scene.ranges.size());
  parallel::for_all(std::size_t{0}, may.size(), [&](std::size_t m) {
    const MeshRange& range = scene.ranges[m];
    may[m] = range.triangle_count <= kMost && !tree.wound_either_way(static_cast<std::uint32_t>(m)) &&
             may_carry(scene, tree, range, height_m);
  });
  std::vector<std::uint32_t> found;
  for (std::size_t m = 0; m < may.size(); ++m) {
    const MeshRange& range = scene.ranges[m];
    if (tree.wound_either_way(static_cast<std::uint32_t>(m))) add_with_room(found, scene, tree, range, height_m);
    if (!may[m]) continue;
    for (const std::vector<std::uint32_t>& part : connected_parts(scene, range)) {
      const Shape shape = shape_of(scene, part);
      if (shape.down_m2 < kLeast_m2 || !(shape.is_sheet() || shape.is_inside_out())) continue;
      if (!carries(scene, tree, part, height_m, shape.is_sheet())) continue;
      std::ranges::copy_if(part, std::back_inserter(found),
                           [&](std::uint32_t triangle) { return shown_m2(scene, triangle) < 0; });
    }
  }
  std::ranges::sort(found);
  return found;
}

}  // namespace vantage
