// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/walls.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "import/floor_plan/grid.hpp"
#include "import/floor_plan/join_ends.hpp"
#include "import/program.hpp"

namespace vantage::floor_plan {
namespace {

constexpr double kSmallest_m2 = 1.2, kLargest_m2 = 2000;  // rooms, to judge layers by them

constexpr double kBeside_m = 0.01;  // lines this near a wall belong to it

// Counts the ends of lines at a point.
class Meetings {
 public:
  explicit Meetings(const std::vector<Line>& lines) {
    for (const Line& line : lines) ++count_[key(line.a)], ++count_[key(line.b)];
  }
  int at(Point p) const { return count_.at(key(p)); }

 private:
  static std::pair<long, long> key(Point p) { return {std::lround(p.x / 1e-3), std::lround(p.y / 1e-3)}; }
  std::map<std::pair<long, long>, int> count_;
};

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

// Returns true if nothing as wide as kThickestWall_m fits into the face.
bool is_wall(const Shape& face) {
  const Bounds box = bounds(face);
  if (std::min(box.high.x - box.low.x, box.high.y - box.low.y) <= kThickestWall_m) return true;
  if (2 * area(face) / perimeter(face) > kThickestWall_m) return false;  // the inscribed circle is no smaller
  return is_empty(grown(face, -kThickestWall_m / 2));
}

// Returns true if lines cross so often that they would enclose too many faces, as in an exploded hatch.
bool crosses_often(const std::vector<Line>& lines_in) {
  constexpr std::size_t kMost = 100'000;
  constexpr double kEnd_m = 0.01;  // lines that end at others do not cross them
  const auto amid = [](double share, double size) { return share * size > kEnd_m && (1 - share) * size > kEnd_m; };
  Grid grid(1.0);
  std::size_t crossings = 0;
  for (std::size_t l = 0; l < lines_in.size() && crossings <= kMost; ++l) {
    const Line& line = lines_in[l];
    const Point along = line.b - line.a;
    grid.visit_line(line.a, line.b, [&](std::size_t k, Point low, double cell) {
      const Point other = lines_in[k].b - lines_in[k].a, between = lines_in[k].a - line.a;
      const double turn = cross(along, other);
      if (turn == 0) return;
      const double at = cross(between, other) / turn, on = cross(between, along) / turn;
      if (!amid(at, length(along)) || !amid(on, length(other))) return;
      const Point p = line.a + along * at;  // which lies in one cell
      crossings += p.x >= low.x && p.x < low.x + cell && p.y >= low.y && p.y < low.y + cell;
    });
    grid.add_line(l, line.a, line.b, 0);
  }
  return crossings > kMost;
}

// Cuts lines at their crossings by snap rounding (Hobby: Practical segment intersection with finite precision output,
// 1999). Ends and crossings are rounded to the grid; each line goes through all of them whose square it touches. GEOS
// would compare each slanted line with every other.
std::vector<Line> cut_where_they_meet(const std::vector<Line>& lines_in) {
  constexpr double kMostCells = 4000;          // that a line passes
  constexpr double kHalf = 1.001 * kGrid / 2;  // allows for rounding
  double cell = 1;
  for (const Line& line : lines_in)
    cell = std::max(cell, (std::abs(line.b.x - line.a.x) + std::abs(line.b.y - line.a.y)) / kMostCells);
  const auto rounded = [](Point p) { return Point{std::round(p.x / kGrid) * kGrid, std::round(p.y / kGrid) * kGrid}; };
  const auto before = [](Point a, Point b) { return a.x != b.x ? a.x < b.x : a.y < b.y; };
  std::vector<Point> corners;
  Grid grid(cell);
  for (std::size_t l = 0; l < lines_in.size(); ++l) {
    const Line& line = lines_in[l];
    const Point along = line.b - line.a;
    grid.visit_line(line.a, line.b, [&](std::size_t k, Point, double) {
      const Point other = lines_in[k].b - lines_in[k].a, between = lines_in[k].a - line.a;
      const double turn = cross(along, other);
      if (turn == 0) return;
      const double at = cross(between, other) / turn, on = cross(between, along) / turn;
      if (at >= 0 && at <= 1 && on >= 0 && on <= 1) corners.push_back(rounded(line.a + along * at));
    });
    grid.add_line(l, line.a, line.b, 0);
    corners.push_back(rounded(line.a)), corners.push_back(rounded(line.b));
  }
  const auto sort_out = [](auto& all, const auto& less) {
    std::ranges::sort(all, less);
    all.erase(std::unique(all.begin(), all.end(), [&](const auto& a, const auto& b) { return !less(a, b); }),
              all.end());
  };
  sort_out(corners, before);
  Grid squares(cell);
  for (std::size_t c = 0; c < corners.size(); ++c)
    squares.add(c, corners[c] - Point{kGrid, kGrid}, corners[c] + Point{kGrid, kGrid});
  std::vector<Line> pieces_out;
  std::vector<std::pair<double, std::size_t>> way;
  for (const Line& line : lines_in) {
    const Point along = line.b - line.a, low = lowest(line.a, line.b), high = highest(line.a, line.b);
    way.clear();
    squares.visit_line(line.a, line.b, [&](std::size_t c, Point, double) {
      const Point p = corners[c], from = p - line.a;
      const bool touches = p.x >= low.x - kHalf && p.x <= high.x + kHalf && p.y >= low.y - kHalf &&
                           p.y <= high.y + kHalf &&
                           std::abs(cross(along, from)) <= kHalf * (std::abs(along.x) + std::abs(along.y));
      if (touches) way.emplace_back(dot(from, along), c);
    });
    std::ranges::sort(way);
    way.erase(std::unique(way.begin(), way.end()), way.end());
    for (std::size_t k = 0; k + 1 < way.size(); ++k) {
      const Point a = corners[way[k].second], b = corners[way[k + 1].second];
      pieces_out.push_back(before(a, b) ? Line{a, b, line.from} : Line{b, a, line.from});
    }
  }
  sort_out(pieces_out, [&](const Line& a, const Line& b) { return a.a != b.a ? before(a.a, b.a) : before(a.b, b.b); });
  return pieces_out;
}

struct Faces {
  std::vector<Line> cut;  // all lines, cut where they meet
  std::vector<Shape> walls, others;
};

Faces faces_of(const std::vector<Line>& lines_in) {
  Faces out;
  out.cut = cut_where_they_meet(lines_in);
  for (Shape& face : faces(lines(out.cut))) (is_wall(face) ? out.walls : out.others).push_back(std::move(face));
  return out;
}

// Returns the pieces of lines outside `solid`, without stubs of up to twice kTolerance_m.
std::vector<Line> single_lines(const std::vector<Line>& cut, const Shape& solid) {
  const Region beside(grown(solid, kBeside_m));
  std::vector<Line> rest, touching;
  for (const Line& line : cut) (beside.meets(line.a, line.b) ? touching : rest).push_back(line);
  const auto outside = pieces(without(lines(touching), beside.shape()));
  rest.insert(rest.end(), outside.begin(), outside.end());
  std::erase_if(rest, [](const Line& line) { return distance(line.a, line.b) <= 1e-3; });
  // A stub has a loose end.
  const Meetings meetings(rest);
  std::erase_if(rest, [&](const Line& line) {
    const bool loose = meetings.at(line.a) == 1 || meetings.at(line.b) == 1;
    return loose && distance(line.a, line.b) <= 2 * kTolerance_m;
  });
  return rest;
}

// Returns walls of single lines. Their ends at other walls reach into those.
Shape single_walls(const std::vector<Line>& rest, const Shape& solid) {
  constexpr double kHalf_m = kSingleLine_m / 2;
  const Region beside(grown(solid, 1.5 * kBeside_m));
  const Meetings meetings(rest);
  std::vector<Line> longer = rest;
  std::vector<Shape> all;
  for (Line& line : longer) {
    const Point further = (line.b - line.a) * ((kBeside_m + kHalf_m) / distance(line.a, line.b));
    const bool from_wall = meetings.at(line.a) == 1 && beside.holds(line.a),
               to_wall = meetings.at(line.b) == 1 && beside.holds(line.b);
    for (const Point& end : {line.a, line.b})
      if (meetings.at(end) > 2) all.push_back(disc(end, kHalf_m));  // fills corners between flat ends
    if (from_wall) line.a = line.a - further;
    if (to_wall) line.b = line.b + further;
  }
  all.push_back(strip(chained(lines(longer)), kHalf_m));
  // Drops parts that come out behind a wall: they hold neither begin nor middle of a line.
  Grid grid(1.0);
  for (std::size_t l = 0; l < rest.size(); ++l) grid.add(l, rest[l].a, rest[l].a);
  std::vector<Shape> kept;
  for (Shape& part : polygons(without(areas(united(std::move(all))), solid))) {
    const Bounds box = bounds(part);
    const Region region(std::move(part));
    bool holds = false;
    grid.visit(box.low, box.high, [&](std::size_t l) {
      holds = holds || region.holds(rest[l].a) || region.holds((rest[l].a + rest[l].b) * 0.5);
    });
    if (holds) kept.push_back(clone(region.shape()));
  }
  return areas(united(std::move(kept)));
}

Shape solid_of(const Drawing& drawing, const std::vector<Line>& lines_in, const auto& wanted, bool by_name,
               std::vector<WallFace>& faces_out) {
  std::vector<Line> thin;
  std::map<long, std::vector<Line>> wide;  // by millimetres
  for (const Line& line : lines_in)
    (line.width < kThinnestWall_m ? thin : wide[std::lround(1000 * line.width)]).push_back(line);
  Faces found = faces_of(thin);
  for (const auto* some : {&found.walls, &found.others})
    for (const Shape& face : *some) faces_out.push_back({area(face), perimeter(face)});
  std::vector<Shape> parts = std::move(found.walls);
  for (const auto& [width_mm, own] : wide)
    parts.push_back(strip(chained(lines(own)), static_cast<double>(width_mm) / 2000));
  for (const Area& filled : drawing.areas) {
    if (!wanted(filled.from)) continue;
    std::vector<Shape> rings;
    for (const auto& ring : filled.rings) rings.push_back(polygon(ring));
    Shape shape = odd(rings);
    // On other layers, a hatch may fill a floor.
    if (!is_empty(shape) && (by_name || is_wall(shape))) parts.push_back(std::move(shape));
  }
  Shape solid = straightened(areas(united(std::move(parts))));
  if (const auto rest = single_lines(found.cut, solid); !rest.empty())
    solid = straightened(united(solid, single_walls(rest, solid)));
  return solid;
}

// Fills gaps of up to kTolerance_m between walls whose ends are drawn.
void fill_gaps(Walls& walls) {
  constexpr double kLeast_m2 = 1e-5;  // rounding leaves less
  std::vector<Shape> all;
  for (Shape& gap : polygons(without(closed(walls.solid, kTolerance_m), walls.solid))) {
    if (area(gap) < kLeast_m2) continue;
    const auto corners = outer_ring(around(outer_ring(gap)));
    if (corners.size() != 4) continue;
    const double wide = std::min(distance(corners[0], corners[1]), distance(corners[1], corners[2]));
    ++walls.filled_gaps, walls.widest_gap_m = std::max(walls.widest_gap_m, wide);
    all.push_back(std::move(gap));
  }
  if (all.empty()) return;
  all.push_back(std::move(walls.solid));
  walls.solid = areas(united(std::move(all)));
}

// Scores how much lines look like walls, by the rooms that they enclose and the length of double lines.
double likeness(const std::vector<Line>& lines_in) {
  const Faces found = faces_of(join_ends(lines_in).lines);
  double score = 0;
  for (const Shape& face : found.others)
    if (const double m2 = area(face); m2 >= kSmallest_m2 && m2 <= kLargest_m2) score += 1;
  constexpr double kMetresEach = 8;  // length of double lines that counts as a room
  for (const Shape& face : found.walls) score += perimeter(face) / 2 / kMetresEach;
  return score;
}

// Returns the one layer whose lines look most like walls; empty if none look like walls.
std::set<int> enclosing_layers(const Drawing& drawing) {
  std::map<int, std::vector<Line>> by_layer;
  for (const Line& line : lines_of(drawing, [](const Origin& from) { return from.kind == Kind::other; }))
    by_layer[line.from.layer].push_back(line);
  constexpr std::size_t kMostLines = 100'000;
  std::optional<std::pair<double, int>> best;
  for (const auto& [layer, own] : by_layer) {
    if (own.size() > kMostLines || crosses_often(own)) continue;
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
  if (crosses_often(own))
    throw importer::Refused(
        "the lines of its walls cross more than 100,000 times, as those of an exploded hatch do (layer " +
        out.layers.front() + (out.layers.size() > 1 ? ", …" : "") +
        "); leave these out, or name the layers of walls with the setting wall-layer");
  Joined joined = join_ends(std::move(own));
  out.joined_ends = joined.ends, out.farthest_join_m = joined.farthest_m;
  out.solid = solid_of(drawing, joined.lines, wanted, out.by_name, out.faces);
  fill_gaps(out);
  return out;
}

}  // namespace vantage::floor_plan
