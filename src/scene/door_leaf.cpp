// SPDX-License-Identifier: Apache-2.0
#include "scene/door_leaf.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/sound_triangle.hpp"

namespace vantage {
namespace {

// Sizes of leaves that are recognised without a name.
constexpr double kLowestPlain = 1.85, kHighestPlain = 2.6, kNarrowestPlain = 0.6, kWidestPlain = 1.3,
                 kThickestPlain = 0.12;

}  // namespace

std::optional<DoorLeaf> leaf_around(std::size_t triangles,
                                    const std::function<std::array<glm::dvec3, 3>(std::uint32_t triangle)>& corners,
                                    const LeafSizes& sizes) {
  double low = std::numeric_limits<double>::infinity(), high = -low, count = 0;
  glm::dvec2 mean(0);
  const auto for_points = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < triangles; ++t)
      for (const glm::dvec3& p : corners(t)) visit(p);
  };
  bool broken = false;
  for_points([&](const glm::dvec3& p) {
    broken = broken || !sound(p);
    low = std::min(low, p.z), high = std::max(high, p.z);
    mean += glm::dvec2(p.x, p.y), ++count;
  });
  DoorLeaf leaf{.height = high - low};
  if (broken || count == 0 || !sizes.high(leaf.height)) return std::nullopt;
  mean /= count;
  double xx = 0, xy = 0, yy = 0;
  for_points([&](const glm::dvec3& p) {
    xx += (p.x - mean.x) * (p.x - mean.x), xy += (p.x - mean.x) * (p.y - mean.y), yy += (p.y - mean.y) * (p.y - mean.y);
  });
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);  // angle of the longer axis
  leaf.along = {std::cos(angle), std::sin(angle), 0}, leaf.through = {-std::sin(angle), std::cos(angle), 0};
  double from = std::numeric_limits<double>::infinity(), to = -from, before = from, behind = -from;
  for_points([&](const glm::dvec3& p) {
    const double a = dot(p, leaf.along), b = dot(p, leaf.through);
    from = std::min(from, a), to = std::max(to, a), before = std::min(before, b), behind = std::max(behind, b);
  });
  leaf.width = to - from, leaf.thickness = behind - before;
  if (leaf.width < sizes.narrowest || leaf.width > sizes.widest || leaf.thickness > sizes.thickest) return std::nullopt;
  leaf.middle = leaf.along * ((from + to) / 2) + leaf.through * ((before + behind) / 2);
  leaf.middle.z = (low + high) / 2;
  return leaf;
}

bool is_plain_leaf(const DoorLeaf& leaf) {
  return leaf.height >= kLowestPlain && leaf.height <= kHighestPlain && leaf.width >= kNarrowestPlain &&
         leaf.width <= kWidestPlain && leaf.thickness <= kThickestPlain;
}

}  // namespace vantage
