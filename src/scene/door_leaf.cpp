// SPDX-License-Identifier: Apache-2.0
#include "scene/door_leaf.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string_view>

#include "core/text.hpp"
#include "scene/sound_triangle.hpp"

namespace vantage {
namespace {

// Sizes of leaves, with their frames where these are one with them. Metres.
constexpr double kLowest = 1.75, kHighest = 3.0, kNarrowest = 0.55, kWidest = 2.6, kThickest = 0.4;
// Of those that no name tells.
constexpr double kLowestPlain = 1.85, kHighestPlain = 2.6, kNarrowestPlain = 0.6, kWidestPlain = 1.3,
                 kThickestPlain = 0.12;

}  // namespace

std::optional<DoorLeaf> leaf_around(std::size_t triangles,
                                    const std::function<std::array<glm::dvec3, 3>(std::uint32_t triangle)>& corners) {
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
  if (broken || count == 0 || !is_leaf_high(leaf.height)) return std::nullopt;
  mean /= count;
  double xx = 0, xy = 0, yy = 0;
  for_points([&](const glm::dvec3& p) {
    xx += (p.x - mean.x) * (p.x - mean.x), xy += (p.x - mean.x) * (p.y - mean.y), yy += (p.y - mean.y) * (p.y - mean.y);
  });
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);  // of the longer axis
  leaf.along = {std::cos(angle), std::sin(angle), 0}, leaf.through = {-std::sin(angle), std::cos(angle), 0};
  double from = std::numeric_limits<double>::infinity(), to = -from, before = from, behind = -from;
  for_points([&](const glm::dvec3& p) {
    const double a = dot(p, leaf.along), b = dot(p, leaf.through);
    from = std::min(from, a), to = std::max(to, a), before = std::min(before, b), behind = std::max(behind, b);
  });
  leaf.width = to - from, leaf.thickness = behind - before;
  if (leaf.width < kNarrowest || leaf.width > kWidest || leaf.thickness > kThickest) return std::nullopt;
  leaf.middle = leaf.along * ((from + to) / 2) + leaf.through * ((before + behind) / 2);
  leaf.middle.z = (low + high) / 2;
  return leaf;
}

bool is_leaf_high(double height) { return height >= kLowest && height <= kHighest; }

bool is_plain_leaf(const DoorLeaf& leaf) {
  return leaf.height >= kLowestPlain && leaf.height <= kHighestPlain && leaf.width >= kNarrowestPlain &&
         leaf.width <= kWidestPlain && leaf.thickness <= kThickestPlain;
}

bool names_a_door(const std::string& name) {
  const std::string low = lower_case(name);
  const auto has = [&](std::initializer_list<std::string_view> words) {
    return std::ranges::any_of(words, [&](std::string_view word) { return low.find(word) != std::string::npos; });
  };
  const auto letter = [&](std::size_t at) {
    return at < low.size() && (std::isalpha(static_cast<unsigned char>(low[at])) || (low[at] & 0x80));
  };
  const auto has_whole = [&](std::initializer_list<std::string_view> words) {
    return std::ranges::any_of(words, [&](std::string_view word) {
      const std::size_t at = low.find(word);
      return at != std::string::npos && (at == 0 || !letter(at - 1)) && !letter(at + word.size());
    });
  };
  if (has({"outdoor", "indoor", "cabinet", "cupboard", "wardrobe", "closet", "fridge", "schrank", "armoire", "armario",
           "armadio", "kast", "шкаф", "柜", "棚"}))
    return false;
  return has({"door", "tür", "TÜR", "tuer", "puerta", "deur", "drzwi", "dveř", "dvere", "двер", "Двер", "ДВЕР", "πόρτα",
              "θύρα", "门", "門", "ドア", "扉", "문"}) ||
         has_whole({"porte", "portes", "porta", "porte-fenêtre", "ovi", "dør", "dörr", "kapı", "ajtó", "ușă", "врата"});
}

}  // namespace vantage
