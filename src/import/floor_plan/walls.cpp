// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/walls.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "import/floor_plan/join_ends.hpp"
#include "import/program.hpp"

namespace vantage::floor_plan {
namespace {

constexpr double kCurve_m = 0.005;                        // by how much chords stray from arcs
constexpr double kSmallest_m2 = 1.2, kLargest_m2 = 2000;  // rooms, where layers are judged by them

std::vector<Line> lines_of(const Drawing& drawing, const auto& wanted) {
  std::vector<Line> out;
  for (const Line& line : drawing.lines)
    if (wanted(line.from)) out.push_back(line);
  for (const Arc& arc : drawing.arcs) {
    if (!wanted(arc.from)) continue;
    const auto points = chain(arc, kCurve_m);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) out.push_back({points[i], points[i + 1], arc.from});
  }
  return out;
}

// Whether nothing as wide as kThickestWall_m fits in.
bool is_wall(const Shape& face) {
  if (2 * area(face) / perimeter(face) > kThickestWall_m) return false;  // the inscribed circle is no smaller
  return is_empty(grown(face, -kThickestWall_m / 2));
}

struct Faces {
  Shape cut;  // all lines, cut where they meet
  std::vector<Shape> walls, others;
};

Faces faces_of(const std::vector<Line>& lines_in) {
  Faces out;
  std::vector<Shape> all;
  all.push_back(lines(lines_in));
  out.cut = united(std::move(all));
  for (Shape& face : faces(out.cut)) (is_wall(face) ? out.walls : out.others).push_back(std::move(face));
  return out;
}

// Pieces of lines that reach out of `solid`, without stubs that are no longer than lines miss each other by.
std::vector<Line> single_lines(const Shape& cut, const Shape& solid) {
  const Shape out = without(cut, grown(solid, 0.01));
  std::vector<Line> rest;
  for (const Line& line : pieces(out))
    if (distance(line.a, line.b) > 1e-3) rest.push_back(line);
  // A stub ends where nothing else does.
  std::map<std::pair<long, long>, int> meetings;
  const auto key = [](Point p) { return std::pair(std::lround(p.x / 1e-3), std::lround(p.y / 1e-3)); };
  for (const Line& line : rest) ++meetings[key(line.a)], ++meetings[key(line.b)];
  std::erase_if(rest, [&](const Line& line) {
    const bool loose = meetings[key(line.a)] == 1 || meetings[key(line.b)] == 1;
    return loose && distance(line.a, line.b) <= 2 * kTolerance_m;
  });
  return rest;
}

Shape solid_of(const Drawing& drawing, const std::vector<Line>& lines_in, const auto& wanted, bool by_name) {
  Faces found = faces_of(lines_in);
  std::vector<Shape> parts = std::move(found.walls);
  for (const Area& filled : drawing.areas) {
    if (!wanted(filled.from)) continue;
    Shape shape = no_area();
    for (const auto& ring : filled.rings) {  // rings within rings are holes
      const Shape part = polygon(ring);
      const Shape both = common(shape, part);
      shape = areas(without(united(shape, part), both));
    }
    // Elsewhere a hatch may be that of a floor.
    if (!is_empty(shape) && (by_name || is_wall(shape))) parts.push_back(std::move(shape));
  }
  Shape solid = areas(united(std::move(parts)));
  const auto rest = single_lines(found.cut, solid);
  if (!rest.empty()) {
    std::vector<Shape> all;
    all.push_back(std::move(solid));
    all.push_back(strip(lines(rest), kSingleLine_m / 2));
    solid = areas(united(std::move(all)));
  }
  return solid;
}

// How much lines look like those of walls: rooms that they enclose, and the length of double lines.
double likeness(const std::vector<Line>& lines_in) {
  const Faces found = faces_of(join_ends(lines_in).lines);
  double score = 0;
  for (const Shape& face : found.others)
    if (const double m2 = area(face); m2 >= kSmallest_m2 && m2 <= kLargest_m2) score += 1;
  constexpr double kMetresEach = 8;  // of double lines, which count as a room
  for (const Shape& face : found.walls) score += perimeter(face) / 2 / kMetresEach;
  return score;
}

// The layers whose lines look like walls: the best, and each that adds to it.
std::set<int> enclosing_layers(const Drawing& drawing) {
  std::map<int, std::vector<Line>> by_layer;
  for (const Line& line : lines_of(drawing, [](const Origin& from) { return from.kind == Kind::other; }))
    by_layer[line.from.layer].push_back(line);
  constexpr std::size_t kMostLines = 100'000;
  std::optional<std::pair<double, int>> best;
  for (const auto& [layer, own] : by_layer) {
    if (own.size() > kMostLines) continue;
    const double score = likeness(own);
    if (score > 0 && (!best || score > best->first)) best = {score, layer};
  }
  if (!best) return {};
  return {best->second};
}

}  // namespace

Walls find_walls(const Drawing& drawing) {
  Walls out;
  const auto named = [](const Origin& from) { return from.kind == Kind::wall; };
  std::vector<Line> own = lines_of(drawing, named);
  const bool filled = std::ranges::any_of(drawing.areas, [&](const Area& area) { return named(area.from); });
  out.by_name = !own.empty() || filled;
  std::set<int> layers;
  if (out.by_name) {
    for (const Line& line : own) layers.insert(line.from.layer);
    for (const Area& area : drawing.areas)
      if (named(area.from)) layers.insert(area.from.layer);
  } else {
    layers = enclosing_layers(drawing);
  }
  const auto wanted = [&](const Origin& from) {
    return out.by_name ? named(from) : from.kind == Kind::other && layers.contains(from.layer);
  };
  if (!out.by_name) own = lines_of(drawing, wanted);
  if (layers.empty()) {
    std::string names;
    for (std::size_t i = 0; i < drawing.layers.size() && i < 12; ++i)
      names += (names.empty() ? "" : ", ") + drawing.layers[i];
    throw importer::Refused("no layer of the drawing encloses a room; name the walls' with the setting wall-layer" +
                            (names.empty() ? "" : " (it has " + names + ")"));
  }
  for (const int layer : layers) out.layers.push_back(drawing.layers[static_cast<std::size_t>(layer)]);
  Joined joined = join_ends(std::move(own));
  out.joined_ends = joined.ends, out.farthest_join_m = joined.farthest_m;
  out.solid = solid_of(drawing, joined.lines, wanted, out.by_name);
  return out;
}

}  // namespace vantage::floor_plan
