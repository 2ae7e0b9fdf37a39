// SPDX-License-Identifier: Apache-2.0
#include "scene/open_doors.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string_view>

#include "scene/sound_triangle.hpp"

namespace vantage {
namespace {

// Sizes of leaves, with their frames where these are one with them. Metres.
constexpr double kLowest = 1.75, kHighest = 3.0, kNarrowest = 0.55, kWidest = 2.6, kThickest = 0.4;
// Of those that no name tells.
constexpr double kLowestPlain = 1.85, kHighestPlain = 2.5, kNarrowestPlain = 0.6, kWidestPlain = 1.3,
                 kThickestPlain = 0.12;
constexpr double kFree = 0.65;             // what is clear before and behind a door; a cabinet is less deep
constexpr double kAside = 0.08;            // how far beside the leaf its wall is looked for
constexpr double kWallHalf = 0.4;          // and how far before and behind
constexpr double kThicker = 0.02;          // by which a wall stands out on either side
constexpr std::size_t kMostLeaves = 2000;  // leaves that are looked at

// A thin upright box, turned about the vertical.
struct Leaf {
  std::uint32_t first = 0, end = 0;  // triangles
  glm::dvec3 middle{};
  glm::dvec3 along{}, through{};  // unit; level
  double width = 0, thickness = 0, height = 0;
};

std::optional<Leaf> leaf_of(const RawScene& raw, const MeshRange& range) {
  Leaf leaf{.first = range.first_triangle, .end = range.first_triangle + range.triangle_count};
  double low = std::numeric_limits<double>::infinity(), high = -low, count = 0;
  glm::dvec2 mean(0);
  const auto for_points = [&](const auto& visit) {
    for (std::uint32_t t = leaf.first; t < leaf.end; ++t)
      for (const std::uint32_t v : raw.triangles[t]) visit(raw.positions[v]);
  };
  bool broken = false;
  for_points([&](const glm::dvec3& p) {
    broken = broken || !sound(p);
    low = std::min(low, p.z), high = std::max(high, p.z);
    mean += glm::dvec2(p.x, p.y), ++count;
  });
  leaf.height = high - low;
  if (broken || count == 0 || leaf.height < kLowest || leaf.height > kHighest) return std::nullopt;
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

// Distances along a line, from its point, to the triangles of other meshes within `far` either way: nearest on each
// side.
struct Sight {
  double before = std::numeric_limits<double>::infinity(), behind = before;
};
Sight look(const RawScene& raw, const Leaf& leaf, const glm::dvec3& from, const glm::dvec3& way, double far) {
  Sight sight;
  for (std::uint32_t i = 0; i < raw.triangles.size(); ++i) {
    if (i >= leaf.first && i < leaf.end) continue;
    const Triangle& t = raw.triangles[i];
    const glm::dvec3 a = raw.positions[t[0]] - from, b = raw.positions[t[1]] - from, c = raw.positions[t[2]] - from;
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

bool leads_through(const RawScene& raw, const Leaf& leaf) {
  const double half = leaf.thickness / 2, far = half + kFree;
  // Beside the middle, where handles and bars are few.
  const glm::dvec3 from = leaf.middle + leaf.along * (0.17 * leaf.width) + glm::dvec3{0, 0, 0.13 * leaf.height};
  const Sight sight = look(raw, leaf, from, leaf.through, far);
  const auto clear = [&](double distance) { return distance >= far || distance <= half + 0.02; };
  return clear(sight.before) && clear(sight.behind);
}

bool in_a_wall(const RawScene& raw, const Leaf& leaf) {
  const double thicker = leaf.thickness / 2 + kThicker;
  const auto wall_at = [&](const glm::dvec3& p) {
    const Sight sight = look(raw, leaf, p, leaf.through, kWallHalf);
    return sight.before >= thicker && sight.before <= kWallHalf && sight.behind >= thicker && sight.behind <= kWallHalf;
  };
  const glm::dvec3 aside = leaf.along * (leaf.width / 2 + kAside), up{0, 0, leaf.height / 2 + kAside};
  return wall_at(leaf.middle + aside) && wall_at(leaf.middle - aside) && wall_at(leaf.middle + up);
}

}  // namespace

bool names_a_door(const std::string& name) {
  std::string low = name;
  std::ranges::transform(low, low.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
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

std::vector<std::string> open_doors(RawScene& raw, const std::vector<std::uint8_t>& candidate) {
  std::vector<std::uint8_t> keep(raw.triangles.size(), 1);
  std::vector<std::string> names;
  std::size_t looked = 0;
  for (std::size_t m = 0; m < raw.meshes.size() && looked < kMostLeaves; ++m) {
    if (!candidate[m]) continue;
    const std::optional<Leaf> leaf = leaf_of(raw, raw.ranges[m]);
    if (!leaf) continue;
    const bool named = names_a_door(raw.meshes[m].name);
    const bool plain = leaf->height >= kLowestPlain && leaf->height <= kHighestPlain &&
                       leaf->width >= kNarrowestPlain && leaf->width <= kWidestPlain &&
                       leaf->thickness <= kThickestPlain;
    if (!named && !plain) continue;
    ++looked;
    if (!leads_through(raw, *leaf) || (!named && !in_a_wall(raw, *leaf))) continue;
    std::fill(keep.begin() + leaf->first, keep.begin() + leaf->end, std::uint8_t{0});
    if (names.empty() || names.back() != raw.meshes[m].name) names.push_back(raw.meshes[m].name);
  }
  if (names.empty() || std::ranges::count(keep, 1) == 0) return {};  // a model of doors alone
  keep_triangles(raw, keep);
  return names;
}

}  // namespace vantage
